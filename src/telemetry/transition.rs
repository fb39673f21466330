//! The reasons for transitions of the state machine.

use std::fmt;

use super::refusal::{AbortReason, Refusal};

/// The cause of a transition. `Display` gives the word in events and on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TransitionReason {
    Reset,
    /// The mission continues where it was interrupted.
    Resume,
    /// Commanded to go to a waypoint.
    SetCurrent,
    /// Commanded to hold here.
    HoldHere,
    /// Commanded to land here.
    Emergency,
    /// Commanded to return home.
    ReturnHome,
    /// The switch went off.
    Disengage,
    Disarm,
    /// The mission cannot start again.
    Refused(Refusal),
    /// The mission is aborted.
    GivenUp(AbortReason),
    Fence,
    /// The climb before the first leg is done.
    Climb,
    /// Within the radius of the waypoint.
    Arrival,
    /// At the position of a HOLD, but no longer approaching its altitude.
    HeldOffAltitude,
    /// Passed the plane through the waypoint.
    Plane,
    /// Within the turn radius of a FLYBY.
    TurnRadius,
    /// Passed too far beside the waypoint.
    Missed,
    /// Continues with the next waypoint, or completes the plan.
    Advance,
    Hold,
    /// The wait of a LAND or TAKEOFF begins.
    Loiter,
    Land,
    /// The hold pattern begins.
    Pattern,
    /// The time of the hold has elapsed.
    HoldTime,
    Touchdown,
}

impl TransitionReason {
    /// The words of all causes except refusals and aborts, which have their own.
    pub const WORDS: [&'static str; 22] = [
        "reset",
        "resume",
        "set_current",
        "hold here",
        "emergency",
        "return to home",
        "disengage",
        "disarm",
        "fence",
        "climb",
        "arrival",
        "held_off_altitude",
        "plane",
        "turn radius",
        "missed",
        "advance",
        "hold",
        "loiter",
        "land",
        "pattern",
        "hold time",
        "touchdown",
    ];

    /// Returns the cause as a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Reset => "reset",
            Self::Resume => "resume",
            Self::SetCurrent => "set_current",
            Self::HoldHere => "hold here",
            Self::Emergency => "emergency",
            Self::ReturnHome => "return to home",
            Self::Disengage => "disengage",
            Self::Disarm => "disarm",
            Self::Refused(refusal) => refusal.into(),
            Self::GivenUp(why) => why.into(),
            Self::Fence => "fence",
            Self::Climb => "climb",
            Self::Arrival => "arrival",
            Self::HeldOffAltitude => "held_off_altitude",
            Self::Plane => "plane",
            Self::TurnRadius => "turn radius",
            Self::Missed => "missed",
            Self::Advance => "advance",
            Self::Hold => "hold",
            Self::Loiter => "loiter",
            Self::Land => "land",
            Self::Pattern => "pattern",
            Self::HoldTime => "hold time",
            Self::Touchdown => "touchdown",
        }
    }
}

impl fmt::Display for TransitionReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.word())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_has_the_words_of_all_causes() {
        use TransitionReason as Reason;
        let all = [
            Reason::Reset,
            Reason::Resume,
            Reason::SetCurrent,
            Reason::HoldHere,
            Reason::Emergency,
            Reason::ReturnHome,
            Reason::Disengage,
            Reason::Disarm,
            Reason::Fence,
            Reason::Climb,
            Reason::Arrival,
            Reason::HeldOffAltitude,
            Reason::Plane,
            Reason::TurnRadius,
            Reason::Missed,
            Reason::Advance,
            Reason::Hold,
            Reason::Loiter,
            Reason::Land,
            Reason::Pattern,
            Reason::HoldTime,
            Reason::Touchdown,
        ];
        assert_eq!(all.map(Reason::word), Reason::WORDS);
    }
}
