//! The reasons for transitions of the state machine.

use std::fmt;

use super::refusal::{AbortReason, Refusal};

/// Defines the causes, each with its word.
macro_rules! reasons {
    ($($(#[$doc:meta])* $variant:ident $word:literal;)*) => {
        /// The cause of a transition. `Display` gives the word in events and on the screen.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
        pub enum TransitionReason {
            $($(#[$doc])* $variant,)*
            /// The mission cannot start again.
            Refused(Refusal),
            /// The mission is aborted.
            GivenUp(AbortReason),
        }

        impl TransitionReason {
            /// The words of all causes except refusals and aborts, which have their own.
            pub const WORDS: [&'static str; [$($word),*].len()] = [$($word),*];

            /// Returns the cause as a word.
            pub fn word(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)*
                    Self::Refused(refusal) => refusal.into(),
                    Self::GivenUp(why) => why.into(),
                }
            }
        }
    };
}

reasons! {
    /// The mission starts at its first waypoint.
    Reset "reset";
    /// The mission continues where it was interrupted.
    Resume "resume";
    /// Commanded to go to a waypoint.
    SetCurrent "set_current";
    /// Commanded to hold here.
    HoldHere "hold here";
    /// Commanded to land here.
    Emergency "emergency";
    /// Commanded to return home.
    ReturnHome "return to home";
    /// The switch went off.
    Disengage "disengage";
    /// The craft was disarmed.
    Disarm "disarm";
    /// The craft left the fence.
    Fence "fence";
    /// The climb before the first leg is done.
    Climb "climb";
    /// Within the radius of the waypoint.
    Arrival "arrival";
    /// At the position of a HOLD, but no longer approaching its altitude.
    HeldOffAltitude "held_off_altitude";
    /// Passed the plane through the waypoint.
    Plane "plane";
    /// Within the turn radius of a FLYBY.
    TurnRadius "turn radius";
    /// Passed too far beside the waypoint.
    Missed "missed";
    /// Continues with the next waypoint, or completes the plan.
    Advance "advance";
    /// The hold at the waypoint begins.
    Hold "hold";
    /// The wait of a LAND or TAKEOFF begins.
    Loiter "loiter";
    /// The descent of a LAND begins.
    Land "land";
    /// The hold pattern begins.
    Pattern "pattern";
    /// The time of the hold has elapsed.
    HoldTime "hold time";
    /// The touchdown was detected.
    Touchdown "touchdown";
}

impl fmt::Display for TransitionReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.word())
    }
}
