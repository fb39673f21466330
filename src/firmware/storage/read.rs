//! Reads the records of an image, as far as they can be used.

use super::super::config::{
    AdjustmentRange, BOARD_NAME_MAX, ChannelMap, Configuration, Features, KeptLine, MANUFACTURER_ID_MAX,
    MixRow, MixerKind, ModeCondition, ModeLogic, RxFail, RxFailMode, RxRange, SerialRow,
};
use super::super::settings::{Scope, find};
use crate::geo::LatLon;
use crate::plan::{HoldPattern, WaypointRecord, WaypointType};
use std::str::FromStr;
use strum::IntoEnumIterator;

/// The most fields of a record that are read. No record has that many.
const MAX_FIELDS: usize = 16;
/// The most bytes of records of other versions that are kept.
const MAX_UNKNOWN: usize = 1 << 16;
/// The cost of such a record in addition to its own bytes.
const UNKNOWN_COST: usize = 32;
/// The most unusable records that are named. The others are only counted.
const MAX_NAMED: usize = 20;
/// The most characters of a name in a finding.
const MAX_NAME: usize = 40;

/// Builds a configuration from a payload. The sentences list the records that could not be used.
pub(super) fn configuration(payload: &str) -> (Configuration, Vec<String>) {
    let mut configuration = Configuration::default();
    let mut findings = Vec::new();
    let mut plan_is_too_long = false;
    let (mut unknown, mut dropped, mut unnamed) = (0, 0_usize, 0_usize);
    for line in payload.lines().filter(|line| !line.is_empty()) {
        let (kind, rest) = line.split_once('\t').unwrap_or((line, ""));
        let fields: Vec<&str> = rest.split('\t').take(MAX_FIELDS).collect();
        match record(&mut configuration, kind, &fields) {
            Outcome::Taken => {}
            Outcome::Unknown if unknown + line.len() + UNKNOWN_COST > MAX_UNKNOWN => dropped += 1,
            Outcome::Unknown => {
                unknown += line.len() + UNKNOWN_COST;
                configuration.unknown_records.push(line.to_owned());
            }
            Outcome::Refused if findings.len() == MAX_NAMED => unnamed += 1,
            Outcome::Refused => findings.push(describe(kind, &fields)),
            Outcome::PlanFull => plan_is_too_long = true,
        }
    }
    if unnamed > 0 {
        findings.push(format!("Further stored values are not allowed ({unnamed}): their defaults are used."));
    }
    if dropped > 0 {
        findings.push(format!("Records of another version do not fit ({dropped}): they are lost."));
    }
    if plan_is_too_long {
        configuration.plan.waypoints.clear();
        findings.push("The stored plan has more waypoints than fit: it was emptied.".to_owned());
    }
    (configuration, findings)
}

fn describe(kind: &str, fields: &[&str]) -> String {
    let what = match fields.first() {
        Some(first) if matches!(kind, "setting" | "mode" | "mix" | "rxfail" | "rxrange" | "serial") => {
            format!("{kind} {}", first.chars().take(MAX_NAME).collect::<String>())
        }
        _ => kind.to_owned(),
    };
    format!("The stored value of {what} is not allowed: its default is used.")
}

enum Outcome {
    Taken,
    /// A record of another version.
    Unknown,
    /// A record with contents that are not allowed here.
    Refused,
    PlanFull,
}

impl From<Option<()>> for Outcome {
    fn from(taken: Option<()>) -> Self {
        taken.map_or(Self::Refused, |()| Self::Taken)
    }
}

fn record(configuration: &mut Configuration, kind: &str, fields: &[&str]) -> Outcome {
    match kind {
        "setting" => return setting(configuration, fields),
        "waypoint" => return waypoint(configuration, fields),
        "active" => active(configuration, fields),
        "features" => number(fields, 0).map(|mask| configuration.features = Features(mask)),
        "mixer" => {
            let name = fields.first().copied().unwrap_or("");
            MixerKind::iter().find(|kind| kind.to_string() == name).map(|kind| configuration.mixer = kind)
        }
        "mix" => mix(configuration, fields),
        "map" => fields
            .first()
            .and_then(|order| ChannelMap::parse(order))
            .map(|map| configuration.channel_map = map),
        "mode" => mode(configuration, fields),
        "adjustment" => adjustment(configuration, fields),
        "rxrange" => rx_range(configuration, fields),
        "rxfail" => rx_fail(configuration, fields),
        "serial" => serial(configuration, fields),
        "board" => identity(fields, BOARD_NAME_MAX).map(|name| configuration.board_name = name),
        "manufacturer" => identity(fields, MANUFACTURER_ID_MAX).map(|id| configuration.manufacturer_id = id),
        "kept" => kept(configuration, fields),
        _ => return Outcome::Unknown,
    }
    .into()
}

fn number<T: FromStr>(fields: &[&str], at: usize) -> Option<T> {
    fields.get(at)?.parse().ok()
}

/// Returns the place in a table that the first field selects.
fn slot<'t, T>(table: &'t mut [T], fields: &[&str]) -> Option<&'t mut T> {
    table.get_mut(number::<usize>(fields, 0)?)
}

fn scope(word: &str) -> Option<Scope> {
    Scope::iter().find(|scope| scope.word() == word)
}

fn setting(configuration: &mut Configuration, fields: &[&str]) -> Outcome {
    let Some((name, values)) = fields.split_first() else { return Outcome::Refused };
    // Old names are for people. An image always contains the current name.
    let Some(setting) = find(name).filter(|setting| setting.name == *name) else { return Outcome::Unknown };
    let mut all_fit = true;
    for (instance, value) in (0..setting.scope.instances()).zip(values) {
        all_fit &= configuration.settings.assign_in(setting, instance, value).is_ok();
    }
    if all_fit { Outcome::Taken } else { Outcome::Refused }
}

fn active(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let scope = scope(fields.first()?)?;
    configuration.settings.select(scope, number(fields, 1)?).then_some(())
}

/// Returns the name of a board, as the command line would accept it.
fn identity(fields: &[&str], max: usize) -> Option<String> {
    let name = fields.first()?;
    let is_typed = name.bytes().all(|byte| (b' '..=b'~').contains(&byte) && byte != b'#');
    (is_typed && name.len() <= max && name.trim() == *name).then(|| (*name).to_owned())
}

fn mix(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let share = |at| number::<f64>(fields, at).filter(|share| share.is_finite());
    let row = MixRow { throttle: share(1)?, roll: share(2)?, pitch_down: share(3)?, yaw: share(4)? };
    *slot(&mut configuration.custom_mix, fields)? = row;
    Some(())
}

fn mode(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let row = ModeCondition {
        box_id: number(fields, 1)?,
        aux_channel: number(fields, 2).filter(|channel| *channel <= ModeCondition::MAX_AUX)?,
        start_us: ModeCondition::snap(number(fields, 3)?),
        end_us: ModeCondition::snap(number(fields, 4)?),
        logic: ModeLogic::from_repr(number(fields, 5)?)?,
        linked: number(fields, 6)?,
    };
    *slot(&mut configuration.modes, fields)? = row;
    Some(())
}

fn adjustment(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let row = AdjustmentRange {
        aux_channel: number(fields, 1)?,
        start_us: number(fields, 2)?,
        end_us: number(fields, 3)?,
        function: number(fields, 4)?,
        select_channel: number(fields, 5)?,
        center: number(fields, 6)?,
        scale: number(fields, 7)?,
    };
    *slot(&mut configuration.adjustments, fields)? = row;
    Some(())
}

fn rx_range(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let row = RxRange { min_us: number(fields, 1)?, max_us: number(fields, 2)? };
    if row.min_us >= row.max_us {
        return None;
    }
    *slot(&mut configuration.rx_ranges, fields)? = row;
    Some(())
}

fn rx_fail(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let row = match RxFailMode::from_repr(number(fields, 1)?)? {
        RxFailMode::Set => RxFail::set_to(number(fields, 2)?),
        mode => RxFail::without_value(mode),
    };
    *slot(&mut configuration.rx_fail.0, fields)? = row;
    Some(())
}

fn serial(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let row = SerialRow {
        functions: number(fields, 1)?,
        msp_baud: number(fields, 2)?,
        gps_baud: number(fields, 3)?,
        telemetry_baud: number(fields, 4)?,
        blackbox_baud: number(fields, 5)?,
    };
    *slot(&mut configuration.serial.0, fields)? = row;
    Some(())
}

fn waypoint(configuration: &mut Configuration, fields: &[&str]) -> Outcome {
    let read = || {
        Some(WaypointRecord {
            position: LatLon::new(number(fields, 0)?, number(fields, 1)?),
            alt_cm: number(fields, 2)?,
            speed: number(fields, 3)?,
            kind: WaypointType::from_repr(number(fields, 4)?)?,
            duration_ds: number(fields, 5)?,
            pattern: HoldPattern::from_repr(number(fields, 6)?)?,
        })
    };
    match read().filter(|waypoint| waypoint.position.is_on_globe()) {
        None => Outcome::Refused,
        Some(waypoint) => match configuration.plan.waypoints.try_push(waypoint.into()) {
            Ok(()) => Outcome::Taken,
            Err(_) => Outcome::PlanFull,
        },
    }
}

fn kept(configuration: &mut Configuration, fields: &[&str]) -> Option<()> {
    let &[word, _, name, text] = fields else { return None };
    let line = KeptLine {
        scope: scope(word)?,
        instance: number(fields, 1)?,
        name: name.to_owned(),
        text: text.to_owned(),
    };
    configuration.kept.keep(line).then_some(())
}
