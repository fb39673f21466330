//! Boxes, mode ranges and adjustment ranges.

use strum::IntoEnumIterator as _;

use super::{Call, MspFacts, Refused};
use crate::firmware::config::{
    ADJUSTMENT_RANGES, AdjustmentRange, Configuration, Feature, ModeCondition, ModeLogic,
};
use crate::firmware::modes::boxes::{self, BoxId, Equipment};
use crate::msp::{ModeLink, ModeSlot, range_step, range_us};
use crate::telemetry::{Mode, ModeBox};

/// The number of boxes on one page of the lists.
const PAGE: usize = 32;

/// Returns the boxes that this craft lists, in order. Names, ids and mode bits all use this list.
fn listed(configuration: &Configuration, facts: &MspFacts) -> impl Iterator<Item = ModeBox> {
    boxes::listed(Equipment {
        gps: configuration.features.has(Feature::Gps),
        airmode_feature: configuration.features.has(Feature::AirMode),
        anti_gravity_feature: configuration.features.has(Feature::AntiGravity),
        mag: facts.has_mag,
    })
}

pub(super) fn box_names(call: &mut Call<'_>) {
    let page = usize::from(call.request.u8());
    for entry in listed(call.configuration, call.facts).skip(page * PAGE).take(PAGE) {
        call.reply.bytes(<&str>::from(entry).as_bytes());
        call.reply.u8(b';');
    }
}

pub(super) fn box_ids(call: &mut Call<'_>) {
    let page = usize::from(call.request.u8());
    for entry in listed(call.configuration, call.facts).skip(page * PAGE).take(PAGE) {
        call.reply.u8(entry as BoxId);
    }
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
fn is_on(facts: &MspFacts, entry: ModeBox) -> bool {
    match Mode::iter().find(|&mode| ModeBox::from(mode) == entry) {
        Some(Mode::Arm) => facts.armed,
        Some(mode) => facts.modes.has(mode),
        None => facts.switches.has(entry as BoxId),
    }
}

pub(super) fn mode_ranges(call: &mut Call<'_>) {
    for &ModeCondition { box_id, aux_channel, start_us, end_us, .. } in &call.configuration.modes {
        ModeSlot { box_id, aux_channel, start_us, end_us }.encode(&mut call.reply);
    }
}

pub(super) fn mode_ranges_extra(call: &mut Call<'_>) {
    let link = |condition: &ModeCondition| ModeLink {
        box_id: condition.box_id,
        logic: condition.logic as u8,
        linked: condition.linked,
    };
    ModeLink::encode_all(call.configuration.modes.iter().map(link), &mut call.reply);
}

pub(super) fn set_mode_range(call: &mut Call<'_>) -> Result<(), Refused> {
    let request = &mut call.request;
    let slot = usize::from(request.u8());
    let condition = ModeCondition {
        box_id: request.u8(),
        aux_channel: request.u8(),
        start_us: range_us(request.u8()),
        end_us: range_us(request.u8()),
        logic: ModeLogic::from_repr(request.u8()).unwrap_or_default(),
        linked: request.u8(),
    };
    let is_valid = ModeBox::from_repr(condition.box_id).is_some()
        && ModeBox::from_repr(condition.linked).is_some()
        && condition.aux_channel <= ModeCondition::MAX_AUX;
    match call.configuration.modes.get_mut(slot) {
        Some(place) if is_valid => *place = condition,
        _ => return Err(Refused),
    }
    Ok(())
}

pub(super) fn adjustment_ranges(call: &mut Call<'_>) {
    for range in &call.configuration.adjustments {
        call.reply.u8(0);
        call.reply.u8(range.aux_channel);
        call.reply.u8(range_step(range.start_us));
        call.reply.u8(range_step(range.end_us));
        call.reply.u8(range.function);
        call.reply.u8(range.select_channel);
        call.reply.u16(range.center);
        call.reply.u16(range.scale);
    }
}

pub(super) fn set_adjustment_range(call: &mut Call<'_>) -> Result<(), Refused> {
    let request = &mut call.request;
    let slot = usize::from(request.u8());
    request.u8();
    let range = AdjustmentRange {
        aux_channel: request.u8(),
        start_us: range_us(request.u8()),
        end_us: range_us(request.u8()),
        function: request.u8(),
        select_channel: request.u8(),
        center: request.u16(),
        scale: request.u16(),
    };
    debug_assert_eq!(call.configuration.adjustments.len(), ADJUSTMENT_RANGES);
    *call.configuration.adjustments.get_mut(slot).ok_or(Refused)? = range;
    Ok(())
}
