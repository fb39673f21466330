//! Which flight modes are on: the switches, the autopilot and the failsafe, weighed by fixed rules.

use super::boxes::{self, BoxSet};
use crate::telemetry::{Mode, ModeFlags};

/// What the rules look at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModeFacts {
    pub switches: BoxSet,
    pub armed: bool,
    /// The throttle has passed the raised threshold since arming.
    pub raised: bool,
    /// The altitude estimate is valid.
    pub altitude_valid: bool,
    /// The FAILSAFE mode is to be shown.
    pub failsafe_shown: bool,
    /// A failsafe procedure (stage 2) is running.
    pub failsafe_active: bool,
    /// The navigator flies, and the failsafe does not own the flight.
    pub autopilot: bool,
    /// What a given-up mission leaves behind.
    pub after_abort: AfterAbort,
}

/// Which holds stay on when a mission was given up while its switch stays on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AfterAbort {
    /// Nothing: the pilot's own switches decide.
    #[default]
    Nothing,
    /// Level and at the present altitude; the pilot steers (no position is known).
    Altitude,
    /// Level and down to the ground: the fix was lost in a landing or a rescue.
    Descent,
    /// Level, at the present altitude and place.
    Position,
}

/// The flight modes for these facts. AUTOPILOT and the failsafe bring ANGLE, ALTHOLD and POS HOLD with them in the
/// same pass.
pub fn flight_modes(facts: &ModeFacts) -> ModeFlags {
    let switch = |id| facts.switches.has(id);
    let flying = facts.armed && facts.raised;
    let autopilot = facts.armed && facts.autopilot;
    let driven = autopilot || facts.failsafe_active;

    let alt_hold = flying
        && facts.altitude_valid
        && (switch(boxes::ALTHOLD) || driven || facts.after_abort != AfterAbort::Nothing);
    let pos_hold = flying && (switch(boxes::POS_HOLD) || driven || facts.after_abort == AfterAbort::Position);
    let angle = switch(boxes::ANGLE) || facts.failsafe_active || alt_hold || pos_hold;

    let mut modes = ModeFlags::NONE;
    modes.set(Mode::Arm, facts.armed);
    modes.set(Mode::Angle, angle);
    modes.set(Mode::Horizon, switch(boxes::HORIZON) && !angle);
    modes.set(Mode::Mag, switch(boxes::MAG));
    modes.set(Mode::HeadFree, switch(boxes::HEADFREE));
    modes.set(Mode::AltHold, alt_hold);
    modes.set(Mode::PosHold, pos_hold);
    modes.set(Mode::Failsafe, facts.failsafe_shown);
    modes.set(Mode::Autopilot, autopilot);
    modes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn facts(switches: &[u8]) -> ModeFacts {
        let mut set = BoxSet::NONE;
        for &id in switches {
            set.set(id, true);
        }
        ModeFacts { switches: set, armed: true, raised: true, altitude_valid: true, ..ModeFacts::default() }
    }

    fn names(facts: &ModeFacts) -> String {
        flight_modes(facts).iter().map(|mode| mode.to_string()).collect::<Vec<_>>().join("+")
    }

    #[test]
    fn modes_by_situation() {
        let with = |switches: &[u8], change: fn(&mut ModeFacts)| {
            let mut facts = facts(switches);
            change(&mut facts);
            names(&facts)
        };
        let keep: fn(&mut ModeFacts) = |_| {};
        let cases = [
            (with(&[], keep), "ARM"),
            (with(&[1], keep), "ARM+ANGLE"),
            (with(&[2], keep), "ARM+HORIZON"),
            (with(&[1, 2], keep), "ARM+ANGLE"),
            (with(&[3], keep), "ARM+ANGLE+ALTHOLD"),
            (with(&[11], keep), "ARM+ANGLE+POS HOLD"),
            (with(&[2, 11], keep), "ARM+ANGLE+POS HOLD"),
            (with(&[5, 6], keep), "ARM+MAG+HEADFREE"),
            (with(&[3, 11], |f| f.raised = false), "ARM"),
            (with(&[3, 11], |f| f.altitude_valid = false), "ARM+ANGLE+POS HOLD"),
            (with(&[1, 3, 11], |f| f.armed = false), "ANGLE"),
            (with(&[], |f| f.autopilot = true), "ARM+ANGLE+ALTHOLD+POS HOLD+AUTOPILOT"),
            (with(&[2], |f| f.autopilot = true), "ARM+ANGLE+ALTHOLD+POS HOLD+AUTOPILOT"),
            (with(&[56], keep), "ARM"),
            (
                with(&[56], |f| {
                    f.failsafe_shown = true;
                    f.failsafe_active = true;
                }),
                "ARM+ANGLE+ALTHOLD+POS HOLD+FAILSAFE",
            ),
            (with(&[56], |f| f.after_abort = AfterAbort::Altitude), "ARM+ANGLE+ALTHOLD"),
            (with(&[56], |f| f.after_abort = AfterAbort::Position), "ARM+ANGLE+ALTHOLD+POS HOLD"),
            (
                with(&[27], |f| {
                    f.armed = false;
                    f.failsafe_shown = true;
                }),
                "FAILSAFE",
            ),
        ];
        for (got, expected) in cases {
            assert_eq!(got, expected);
        }
    }
}
