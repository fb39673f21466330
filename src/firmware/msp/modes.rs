//! Boxes, mode ranges and adjustment ranges.

use super::{Call, MspFacts, Refused};
use crate::firmware::config::{
    ADJUSTMENT_RANGES, AdjustmentRange, Configuration, Feature, MODE_CONDITIONS, ModeCondition, ModeLogic,
};
use crate::firmware::modes::boxes::{self, BoxInfo, Equipment};
use crate::telemetry::Mode;

/// The number of boxes on one page of the lists.
const PAGE: usize = 32;
/// The pulse of step 0 of a range, µs.
const RANGE_START_US: u16 = 900;
/// The pulse step of a range, µs.
const RANGE_STEP_US: u16 = 25;
/// The highest step of a range.
const RANGE_STEPS: u8 = 48;

/// Returns the boxes that this craft lists, in order. Names, ids and mode bits all use this list.
fn listed(configuration: &Configuration, facts: &MspFacts) -> impl Iterator<Item = &'static BoxInfo> {
    boxes::listed(Equipment {
        gps: configuration.features.has(Feature::Gps),
        airmode_feature: configuration.features.has(Feature::AirMode),
        anti_gravity_feature: configuration.features.has(Feature::AntiGravity),
        mag: facts.has_mag,
    })
}

pub(super) fn box_names(call: &mut Call<'_>) -> Result<(), Refused> {
    let page = usize::from(call.request.u8());
    for entry in listed(call.configuration, call.facts).skip(page * PAGE).take(PAGE) {
        call.reply.bytes(entry.name().as_bytes());
        call.reply.u8(b';');
    }
    Ok(())
}

pub(super) fn box_ids(call: &mut Call<'_>) -> Result<(), Refused> {
    let page = usize::from(call.request.u8());
    for entry in listed(call.configuration, call.facts).skip(page * PAGE).take(PAGE) {
        call.reply.u8(entry.id());
    }
    Ok(())
}

/// Returns the state of the listed boxes, bit i for the i-th box.
pub(super) fn mode_bits(configuration: &Configuration, facts: &MspFacts) -> u64 {
    let mut bits = 0;
    for (index, entry) in listed(configuration, facts).enumerate().take(64) {
        if is_on(facts, entry) {
            bits |= 1 << index;
        }
    }
    bits
}

/// Returns `true` while a flight mode is active; for other boxes, while they are switched on.
fn is_on(facts: &MspFacts, entry: &BoxInfo) -> bool {
    let mode = match entry.id() {
        boxes::ARM => return facts.armed,
        boxes::ANGLE => Mode::Angle,
        boxes::HORIZON => Mode::Horizon,
        boxes::MAG => Mode::Mag,
        boxes::ALTHOLD => Mode::AltHold,
        boxes::HEADFREE => Mode::HeadFree,
        boxes::FAILSAFE => Mode::Failsafe,
        boxes::POS_HOLD => Mode::PosHold,
        boxes::GPS_RESCUE => Mode::GpsRescue,
        boxes::AUTOPILOT => Mode::Autopilot,
        other => return facts.switches.has(other),
    };
    facts.modes.has(mode)
}

fn step(pulse_us: u16) -> u16 {
    pulse_us.saturating_sub(RANGE_START_US) / RANGE_STEP_US
}

fn pulse_us(step: u8) -> u16 {
    RANGE_START_US + RANGE_STEP_US * u16::from(step.min(RANGE_STEPS))
}

pub(super) fn mode_ranges(call: &mut Call<'_>) -> Result<(), Refused> {
    for condition in &call.configuration.modes {
        call.reply.u8(condition.box_id);
        call.reply.u8(condition.aux_channel);
        call.reply.u8(step(condition.start_us));
        call.reply.u8(step(condition.end_us));
    }
    Ok(())
}

pub(super) fn mode_ranges_extra(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.u8(MODE_CONDITIONS as i64);
    for condition in &call.configuration.modes {
        call.reply.u8(condition.box_id);
        call.reply.u8(condition.logic as u8);
        call.reply.u8(condition.linked);
    }
    Ok(())
}

pub(super) fn set_mode_range(call: &mut Call<'_>) -> Result<(), Refused> {
    let request = &mut call.request;
    let slot = usize::from(request.u8());
    let condition = ModeCondition {
        box_id: request.u8(),
        aux_channel: request.u8(),
        start_us: pulse_us(request.u8()),
        end_us: pulse_us(request.u8()),
        logic: ModeLogic::from_repr(request.u8()).unwrap_or_default(),
        linked: request.u8(),
    };
    let is_valid = boxes::is_known(condition.box_id)
        && boxes::is_known(condition.linked)
        && condition.aux_channel <= ModeCondition::MAX_AUX;
    match call.configuration.modes.get_mut(slot) {
        Some(place) if is_valid => *place = condition,
        _ => return Err(Refused),
    }
    Ok(())
}

pub(super) fn adjustment_ranges(call: &mut Call<'_>) -> Result<(), Refused> {
    for range in &call.configuration.adjustments {
        call.reply.u8(0);
        call.reply.u8(range.aux_channel);
        call.reply.u8(step(range.start_us));
        call.reply.u8(step(range.end_us));
        call.reply.u8(range.function);
        call.reply.u8(range.select_channel);
        call.reply.u16(range.center);
        call.reply.u16(range.scale);
    }
    Ok(())
}

pub(super) fn set_adjustment_range(call: &mut Call<'_>) -> Result<(), Refused> {
    let request = &mut call.request;
    let slot = usize::from(request.u8());
    request.u8();
    let range = AdjustmentRange {
        aux_channel: request.u8(),
        start_us: pulse_us(request.u8()),
        end_us: pulse_us(request.u8()),
        function: request.u8(),
        select_channel: request.u8(),
        center: request.u16(),
        scale: request.u16(),
    };
    debug_assert_eq!(call.configuration.adjustments.len(), ADJUSTMENT_RANGES);
    *call.configuration.adjustments.get_mut(slot).ok_or(Refused)? = range;
    Ok(())
}
