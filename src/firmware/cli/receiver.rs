//! `map`, `rxrange` and `rxfail`.

use super::super::config::{ChannelMap, RX_FAIL_CHANNELS, RX_RANGES, RxFail, RxFailMode, RxRange};
use super::session::{Session, integer};

/// The limits of a receiver range, µs.
const PULSE_US: std::ops::RangeInclusive<i64> = 750..=2250;
/// The number of channels that may use the automatic loss rule: the sticks.
const STICKS: usize = 4;

/// `map [<order>]`.
pub(super) fn map(session: &mut Session<'_>, order: &str) {
    if !order.is_empty() {
        if session.refused_while_armed() {
            return;
        }
        if order.len() != 8 {
            session.wrong_count();
            return;
        }
        let Some(map) = session.understood(ChannelMap::parse(order)) else { return };
        session.configuration.channel_map = map;
    }
    let map = session.configuration.channel_map;
    session.line(format_args!("map {map}"));
}

/// Formats the row of one receiver range.
pub(super) fn range_row(channel: usize, range: RxRange) -> String {
    format!("rxrange {channel} {} {}", range.min_us, range.max_us)
}

/// `rxrange [reset | <channel> <min> <max>]`.
pub(super) fn rxrange(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    match words.as_slice() {
        [] => {
            for (channel, range) in session.configuration.rx_ranges.into_iter().enumerate() {
                session.line(range_row(channel, range));
            }
        }
        [word] if word.eq_ignore_ascii_case("reset") => {
            session.configuration.rx_ranges = [RxRange::default(); RX_RANGES];
        }
        [channel, min, max] => {
            let Some(channel) = session.bounded(channel, "CHANNEL", 0, RX_RANGES as i64 - 1) else { return };
            let (Some(min), Some(max)) = (integer(min), integer(max)) else {
                session.not_understood();
                return;
            };
            if !PULSE_US.contains(&min) || !PULSE_US.contains(&max) {
                session.error(format_args!(
                    "range min/max NOT BETWEEN {} AND {}",
                    PULSE_US.start(),
                    PULSE_US.end()
                ));
                return;
            }
            if min >= max {
                session.error("ARGUMENT OUT OF RANGE");
                return;
            }
            let range = RxRange { min_us: min as u16, max_us: max as u16 };
            if let Some(slot) = session.configuration.rx_ranges.get_mut(channel as usize) {
                *slot = range;
            }
            session.line(range_row(channel as usize, range));
        }
        _ => session.wrong_count(),
    }
}

/// Formats the row of one loss rule.
pub(super) fn fail_row(channel: usize, rule: RxFail) -> String {
    let letter = rule.mode.letter();
    match rule.mode {
        RxFailMode::Set => format!("rxfail {channel} {letter} {}", rule.value_us),
        RxFailMode::Auto | RxFailMode::Hold => format!("rxfail {channel} {letter}"),
    }
}

/// `rxfail [<channel> [a | h | s <value>]]`.
pub(super) fn rxfail(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let Some((channel, arguments)) = words.split_first() else {
        for (channel, rule) in session.configuration.rx_fail.0.into_iter().enumerate() {
            session.line(fail_row(channel, rule));
        }
        return;
    };
    let Some(channel) = session.bounded(channel, "CHANNEL", 0, RX_FAIL_CHANNELS as i64 - 1) else { return };
    let at = channel as usize;
    if let Some((letter, value)) = arguments.split_first() {
        let rule = match (letter.to_ascii_lowercase().as_str(), value) {
            ("a", []) if at < STICKS => Some(RxFail::without_value(RxFailMode::Auto)),
            ("h", []) => Some(RxFail::without_value(RxFailMode::Hold)),
            ("s", [value]) => integer(value).map(RxFail::set_to),
            ("s", _) | ("a" | "h", [_, ..]) => {
                session.wrong_count();
                return;
            }
            _ => None,
        };
        let Some(rule) = session.understood(rule) else { return };
        if let Some(slot) = session.configuration.rx_fail.0.get_mut(at) {
            *slot = rule;
        }
    }
    if let Some(rule) = session.configuration.rx_fail.0.get(at).copied() {
        session.line(fail_row(at, rule));
    }
}
