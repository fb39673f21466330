//! The boxes that the AUX channels switch on.

use super::super::config::{ModeCondition, ModeLogic};
use super::boxes::{BoxId, BoxSet};

/// The conditions of each box, collected while they are evaluated.
#[derive(Clone, Copy, Default)]
struct Votes {
    any_or: BoxSet,
    has_and: BoxSet,
    failed_and: BoxSet,
}

impl Votes {
    fn add(&mut self, condition: &ModeCondition, holds: bool) {
        match condition.logic {
            ModeLogic::Or if holds => self.any_or.set(condition.box_id, true),
            ModeLogic::Or => {}
            ModeLogic::And => {
                self.has_and.set(condition.box_id, true);
                if !holds {
                    self.failed_and.set(condition.box_id, true);
                }
            }
        }
    }

    fn is_on(&self, id: BoxId) -> bool {
        self.any_or.has(id) || (self.has_and.has(id) && !self.failed_and.has(id))
    }
}

/// Returns the boxes that the conditions switch on. `aux` are the AUX channels in µs; absent channels never match.
///
/// Links are one level deep: a link to a box follows only the ranges of that box.
pub fn evaluate(conditions: &[ModeCondition], aux: &[u16]) -> BoxSet {
    let usable = || conditions.iter().filter(|condition| condition.is_usable());
    let mut direct = Votes::default();
    for condition in usable().filter(|condition| condition.linked == 0) {
        let pulse = aux.get(usize::from(condition.aux_channel));
        direct.add(condition, pulse.is_some_and(|&pulse| condition.contains(f64::from(pulse))));
    }
    let mut all = direct;
    for condition in usable().filter(|condition| condition.linked != 0) {
        all.add(condition, direct.is_on(condition.linked));
    }
    let mut on = BoxSet::NONE;
    for condition in usable() {
        on.set(condition.box_id, all.is_on(condition.box_id));
    }
    on
}

#[cfg(test)]
mod tests {
    use super::super::boxes::{ANGLE, ARM, AUTOPILOT, HORIZON};
    use super::*;

    fn range(box_id: BoxId, aux_channel: u8, start_us: u16, end_us: u16, logic: ModeLogic) -> ModeCondition {
        ModeCondition { box_id, aux_channel, start_us, end_us, logic, linked: 0 }
    }

    fn link(box_id: BoxId, linked: BoxId) -> ModeCondition {
        ModeCondition { box_id, linked, ..ModeCondition::default() }
    }

    #[test]
    fn range_includes_its_start_and_excludes_its_end() {
        let condition = [range(ARM, 0, 1700, 2100, ModeLogic::Or)];
        for (pulse, on) in [(1699, false), (1700, true), (2099, true), (2200, true), (850, false)] {
            assert_eq!(evaluate(&condition, &[pulse]).has(ARM), on, "{pulse}");
        }
        let low = [range(ARM, 0, 900, 1300, ModeLogic::Or)];
        assert!(evaluate(&low, &[800]).has(ARM), "below the end stop counts as at it");
    }

    #[test]
    fn empty_or_reversed_range_never_holds() {
        for (start, end) in [(1500, 1500), (1700, 1300)] {
            assert!(!evaluate(&[range(ARM, 0, start, end, ModeLogic::Or)], &[1500]).has(ARM));
        }
    }

    #[test]
    fn absent_channel_switches_nothing() {
        assert!(!evaluate(&[range(ARM, 9, 900, 2100, ModeLogic::Or)], &[1500; 4]).has(ARM));
    }

    #[test]
    fn all_and_conditions_must_hold_but_one_or_is_enough() {
        let both = [range(ANGLE, 0, 1700, 2100, ModeLogic::And), range(ANGLE, 1, 1700, 2100, ModeLogic::And)];
        assert!(evaluate(&both, &[2000, 2000]).has(ANGLE));
        assert!(!evaluate(&both, &[2000, 1000]).has(ANGLE));
        let with_or = [both[0], both[1], range(ANGLE, 2, 1700, 2100, ModeLogic::Or)];
        assert!(evaluate(&with_or, &[1000, 1000, 2000]).has(ANGLE));
    }

    #[test]
    fn link_follows_the_target_one_level_deep() {
        let conditions =
            [range(HORIZON, 0, 1700, 2100, ModeLogic::Or), link(ANGLE, HORIZON), link(AUTOPILOT, ANGLE)];
        let on = evaluate(&conditions, &[2000]);
        assert!(on.has(ANGLE));
        assert!(!on.has(AUTOPILOT), "a link to a linked box sees only that box's ranges");
    }
}
