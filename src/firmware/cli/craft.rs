//! `feature`, `mixer` and `mmix`: the equipment of the craft.

use strum::IntoEnumIterator;

use super::super::config::{Feature, MAX_MIX_ROWS, MixRow, MixerKind};
use super::session::Session;

/// `feature [list | [-]<name>]`.
pub(super) fn feature(session: &mut Session<'_>, rest: &str) {
    if rest.is_empty() || rest.eq_ignore_ascii_case("list") {
        feature_list(session);
        return;
    }
    if session.refused_while_armed() {
        return;
    }
    let (on, name) = rest.strip_prefix('-').map_or((true, rest), |name| (false, name));
    let Some(feature) = Feature::by_name(name) else {
        session.error(format_args!("INVALID NAME: {name}"));
        return;
    };
    if !feature.is_available() {
        session.line(format_args!("Unavailable {feature}"));
        return;
    }
    let already = session.configuration.features.has(feature) == on;
    session.configuration.features.set(feature, on);
    let word = if on { "Enabled" } else { "Disabled" };
    session.line(format_args!("{}{word} {feature}", if already { "Already" } else { "" }));
}

fn feature_list(session: &mut Session<'_>) {
    let features = session.configuration.features;
    let rows: [(&str, &dyn Fn(Feature) -> bool); 3] = [
        ("Enabled: ", &|feature| features.has(feature)),
        ("Available: ", &|feature| feature.is_available() && !features.has(feature)),
        ("Unavailable:", &|feature| !feature.is_available() && !features.has(feature)),
    ];
    for (title, wanted) in rows {
        session.raw(title);
        for feature in Feature::iter().filter(|feature| wanted(*feature)) {
            session.raw(format_args!(" {feature}"));
        }
        session.line("");
    }
}

/// `mixer [list | <name>]`.
pub(super) fn mixer(session: &mut Session<'_>, name: &str) {
    if name.eq_ignore_ascii_case("list") {
        let names: Vec<String> = MixerKind::iter().map(|kind| kind.to_string()).collect();
        session.line(format_args!("Available: {}", names.join(" ")));
        return;
    }
    if !name.is_empty() {
        if session.refused_while_armed() {
            return;
        }
        let Some(kind) = MixerKind::by_name(name) else {
            session.error(format_args!("INVALID NAME: {name}"));
            return;
        };
        session.configuration.mixer = kind;
    }
    let kind = session.configuration.mixer;
    session.line(format_args!("Mixer: {kind}"));
}

/// Formats one row of the custom mix.
pub(super) fn mix_row(at: usize, row: &MixRow) -> String {
    format!("mmix {at} {:>6.3} {:>6.3} {:>6.3} {:>6.3}", row.throttle, row.roll, row.pitch_down, row.yaw)
}

/// `mmix [reset | load <mixer> | <row> <throttle> <roll> <pitch> <yaw>]`.
pub(super) fn mmix(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    if !words.is_empty() && session.refused_while_armed() {
        return;
    }
    match words.as_slice() {
        [] => {}
        [word] if word.eq_ignore_ascii_case("reset") => {
            session.configuration.custom_mix = [MixRow::default(); MAX_MIX_ROWS];
            return;
        }
        [word, name] if word.eq_ignore_ascii_case("load") => {
            let Some((kind, rows)) = MixerKind::by_name(name).and_then(|kind| Some((kind, kind.rows()?)))
            else {
                session.error(format_args!("INVALID NAME: {name}"));
                return;
            };
            let mut mix = [MixRow::default(); MAX_MIX_ROWS];
            for (place, row) in mix.iter_mut().zip(rows) {
                *place = row;
            }
            session.configuration.custom_mix = mix;
            session.line(format_args!("Loaded {kind}"));
        }
        [index, throttle, roll, pitch_down, yaw] => {
            let Some(index) = session.bounded(index, "INDEX", 0, MAX_MIX_ROWS as i64 - 1) else { return };
            let shares: Option<Vec<f64>> =
                [throttle, roll, pitch_down, yaw].map(|word| share(word)).into_iter().collect();
            let Some(&[throttle, roll, pitch_down, yaw]) = shares.as_deref() else {
                session.not_understood();
                return;
            };
            if let Some(row) = session.configuration.custom_mix.get_mut(index as usize) {
                *row = MixRow { throttle, roll, pitch_down, yaw };
            }
        }
        _ => {
            session.wrong_count();
            return;
        }
    }
    // The mix ends at the first row without throttle.
    let mix = session.configuration.custom_mix;
    for (at, row) in mix.iter().take_while(|row| row.throttle != 0.0).enumerate() {
        session.line(mix_row(at, row));
    }
}

/// Parses a share of a motor, rounded to thousandths, so that the stored value is exactly the printed one.
fn share(word: &str) -> Option<f64> {
    const LARGEST: f64 = 10.0;
    let number: f64 = word.parse().ok()?;
    let rounded = (number * 1000.0).round() / 1000.0;
    // Adding zero turns a negative zero into zero.
    (rounded.abs() <= LARGEST).then_some(rounded + 0.0)
}
