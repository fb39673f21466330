//! `aux` and `adjrange`: the switches for modes and adjustments.

use super::super::config::{ADJUSTMENT_RANGES, AdjustmentRange, MODE_CONDITIONS, ModeCondition, ModeLogic};
use super::session::{Session, integer};
use crate::telemetry::ModeBox;

/// Formats the row of one mode condition.
pub(super) fn aux_row(at: usize, condition: &ModeCondition) -> String {
    format!(
        "aux {at} {} {} {} {} {} {}",
        condition.box_id,
        condition.aux_channel,
        condition.start_us,
        condition.end_us,
        condition.logic as u8,
        condition.linked
    )
}

/// `aux [<index> [<mode> <channel> <start> <end> [<logic> [<linked mode>]]]]`.
pub(super) fn aux(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let Some((index, arguments)) = words.split_first() else {
        for (at, condition) in
            session.configuration.modes.iter().enumerate().map(|(at, row)| (at, *row)).collect::<Vec<_>>()
        {
            session.line(aux_row(at, &condition));
        }
        return;
    };
    let Some(index) = session.bounded(index, "INDEX", 0, MODE_CONDITIONS as i64 - 1) else { return };
    let at = index as usize;
    let numbers: Option<Vec<i64>> = arguments.iter().map(|word| integer(word)).collect();
    let Some(numbers) = session.understood(numbers) else { return };
    let condition = match numbers.as_slice() {
        [] => None,
        &[mode, channel, start, end] => Some((mode, channel, start, end, 0, 0)),
        &[mode, channel, start, end, logic] => Some((mode, channel, start, end, logic, 0)),
        &[mode, channel, start, end, logic, linked] => Some((mode, channel, start, end, logic, linked)),
        _ => {
            session.wrong_count();
            return;
        }
    };
    if let Some((mode, channel, start, end, logic, linked)) = condition {
        let Some(box_id) = known_box(session, mode) else { return };
        let Some(linked) = known_box(session, linked) else { return };
        let Some(aux_channel) = channel_number(session, channel) else { return };
        let Some(logic) = u8::try_from(logic).ok().and_then(ModeLogic::from_repr) else {
            session.error("LOGIC NOT BETWEEN 0 AND 1");
            return;
        };
        let (start_us, end_us) = (ModeCondition::snap(start), ModeCondition::snap(end));
        if let Some(slot) = session.configuration.modes.get_mut(at) {
            *slot = ModeCondition { box_id, aux_channel, start_us, end_us, logic, linked };
        }
    }
    if let Some(condition) = session.configuration.modes.get(at).copied() {
        session.line(aux_row(at, &condition));
    }
}

fn known_box(session: &mut Session<'_>, id: i64) -> Option<u8> {
    let known = u8::try_from(id).ok().filter(|id| ModeBox::from_repr(*id).is_some());
    if known.is_none() {
        session.error(format_args!("MODE ID NOT KNOWN: {id}"));
    }
    known
}

fn channel_number(session: &mut Session<'_>, channel: i64) -> Option<u8> {
    let known = u8::try_from(channel).ok().filter(|channel| *channel <= ModeCondition::MAX_AUX);
    if known.is_none() {
        session.error(format_args!("CHANNEL NOT BETWEEN 0 AND {}", ModeCondition::MAX_AUX));
    }
    known
}

/// Formats the row of one adjustment.
pub(super) fn adjustment_row(at: usize, range: &AdjustmentRange) -> String {
    format!(
        "adjrange {at} 0 {} {} {} {} {} {} {}",
        range.aux_channel,
        range.start_us,
        range.end_us,
        range.function,
        range.select_channel,
        range.center,
        range.scale
    )
}

/// `adjrange [<index> [0 <range channel> <start> <end> <function> <select channel> [<center> <scale>]]]`.
pub(super) fn adjrange(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let Some((index, arguments)) = words.split_first() else {
        for (at, range) in session.configuration.adjustments.into_iter().enumerate() {
            session.line(adjustment_row(at, &range));
        }
        return;
    };
    let Some(index) = session.bounded(index, "INDEX", 0, ADJUSTMENT_RANGES as i64 - 1) else { return };
    let at = index as usize;
    let numbers: Option<Vec<i64>> = arguments.iter().map(|word| integer(word)).collect();
    let Some(numbers) = session.understood(numbers) else { return };
    let change = match numbers.as_slice() {
        [] => None,
        &[_, channel, start, end, function, select] => Some((channel, start, end, function, select, 0, 0)),
        &[_, channel, start, end, function, select, center, scale] => {
            Some((channel, start, end, function, select, center, scale))
        }
        _ => {
            session.wrong_count();
            return;
        }
    };
    if let Some((channel, start, end, function, select, center, scale)) = change {
        let Some(aux_channel) = channel_number(session, channel) else { return };
        let Some(select_channel) = channel_number(session, select) else { return };
        let small = (u8::try_from(function), u16::try_from(center), u16::try_from(scale));
        let (Ok(function), Ok(center), Ok(scale)) = small else {
            session.error("ARGUMENT OUT OF RANGE");
            return;
        };
        let (start_us, end_us) = (ModeCondition::snap(start), ModeCondition::snap(end));
        if let Some(slot) = session.configuration.adjustments.get_mut(at) {
            *slot =
                AdjustmentRange { aux_channel, start_us, end_us, function, select_channel, center, scale };
        }
    }
    if let Some(range) = session.configuration.adjustments.get(at).copied() {
        session.line(adjustment_row(at, &range));
    }
}
