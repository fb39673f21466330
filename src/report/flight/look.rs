//! The colours of the parts of a flight.

use crate::report::plot::Colour;
use crate::report::record::RecordedSample;
use crate::telemetry::{Mode, ModeFlags, NavState};

/// The modes that fly a craft, the one that overrides the others first.
const MODES: [(Mode, &str, Colour); 8] = [
    (Mode::GpsRescue, "GPS RESCUE", Colour::Holding),
    (Mode::Failsafe, "FAILSAFE", Colour::Landing),
    (Mode::Autopilot, "AUTOPILOT", Colour::Approaching),
    (Mode::PosHold, "POS HOLD", Colour::Arrived),
    (Mode::AltHold, "ALTHOLD", Colour::Orbiting),
    (Mode::Angle, "ANGLE", Colour::Figure8),
    (Mode::Horizon, "HORIZON", Colour::Complete),
    (Mode::Arm, "ACRO", Colour::First),
];

/// Returns the colour of a state and its name.
pub(in crate::report) fn of_state(state: NavState) -> (Colour, &'static str) {
    let colour = match state {
        NavState::Idle => Colour::Idle,
        NavState::Approaching => Colour::Approaching,
        NavState::Arrived => Colour::Arrived,
        NavState::Holding => Colour::Holding,
        NavState::Orbiting => Colour::Orbiting,
        NavState::Figure8 => Colour::Figure8,
        NavState::Landing => Colour::Landing,
        NavState::Complete => Colour::Complete,
    };
    (colour, state.into())
}

/// Returns the colour and the name of a sample: of its state, or of its mode if no state is
/// known.
pub(super) fn of_sample(sample: &RecordedSample) -> (Colour, &'static str) {
    match (sample.state, sample.modes) {
        (Some(state), _) => of_state(state),
        (None, Some(modes)) => of_modes(modes),
        (None, None) => (Colour::First, "track"),
    }
}

fn of_modes(modes: ModeFlags) -> (Colour, &'static str) {
    let leading = MODES.iter().find(|(mode, ..)| modes.has(*mode));
    leading.map_or((Colour::Idle, "DISARMED"), |(_, name, colour)| (*colour, *name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mode_that_overrides_the_others_gives_the_name() {
        let named = |all: &[Mode]| {
            let mut modes = ModeFlags::NONE;
            all.iter().for_each(|mode| modes.set(*mode, true));
            of_modes(modes).1
        };
        assert_eq!(named(&[]), "DISARMED");
        assert_eq!(named(&[Mode::Arm]), "ACRO");
        assert_eq!(named(&[Mode::Arm, Mode::Angle, Mode::AltHold]), "ALTHOLD");
        assert_eq!(named(&[Mode::Arm, Mode::Angle, Mode::GpsRescue]), "GPS RESCUE");
    }
}
