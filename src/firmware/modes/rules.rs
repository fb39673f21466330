//! The active flight modes, from the switches, the autopilot and the failsafe by fixed rules.

use super::boxes::{self, BoxSet};
use crate::telemetry::{Mode, ModeFlags};

/// The inputs of the rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ModeFacts {
    pub switches: BoxSet,
    pub armed: bool,
    /// `true` once the throttle has passed the raised threshold since arming.
    pub raised: bool,
    /// `true` if the altitude estimate is valid.
    pub altitude_valid: bool,
    /// `true` if the FAILSAFE mode must be shown.
    pub failsafe_shown: bool,
    /// `true` while a failsafe procedure (stage 2) runs.
    pub failsafe_active: bool,
    /// `true` while the navigator flies and the failsafe does not control the flight.
    pub autopilot: bool,
    /// `true` while the navigator flies home by the GPS RESCUE switch.
    pub rescue: bool,
    /// The holds that an aborted mission leaves on.
    pub after_abort: AfterAbort,
}

/// The holds that stay on after a mission was aborted, while its switch stays on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AfterAbort {
    /// Nothing. The pilot's own switches decide.
    #[default]
    Nothing,
    /// Level and at the present altitude. The pilot steers, because no position is known.
    Altitude,
    /// Level and down to the ground, because the fix was lost in a landing or a rescue.
    Descent,
    /// Level, at the present altitude and position.
    Position,
}

/// Returns the flight modes for these facts. AUTOPILOT and the failsafe turn on ANGLE, ALTHOLD and POS HOLD in the same
/// pass.
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
    modes.set(Mode::GpsRescue, autopilot && facts.rescue);
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
            (
                with(&[46], |f| (f.autopilot, f.rescue) = (true, true)),
                "ARM+ANGLE+ALTHOLD+POS HOLD+GPS RESCUE+AUTOPILOT",
            ),
            (with(&[46], keep), "ARM"),
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
