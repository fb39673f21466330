//! The yes-or-no flags of a flight, for expectations.

/// A yes-or-no value that is sampled during the flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumIter, strum::EnumString)]
#[strum(serialize_all = "snake_case")]
#[repr(u8)]
pub enum Flag {
    /// The craft is armed.
    Armed,
    /// The autopilot flies a mission.
    Engaged,
    /// The climb before the first leg is active.
    Climbing,
    /// There is a 3-D fix.
    Fix,
    /// A leg of the craft touches the ground.
    OnGround,
    /// The craft has crashed.
    Crashed,
    /// The pilot's sticks fly roll and pitch.
    StickOverride,
    /// The receiver link is up.
    RxLink,
    /// The navigator reports that it cannot hold its position.
    CannotHold,
}

impl Flag {
    /// Returns a description for people.
    pub fn help(self) -> &'static str {
        match self {
            Self::Armed => "the craft is armed",
            Self::Engaged => "a mission is flown",
            Self::Climbing => "the climb before the first leg is active",
            Self::Fix => "the GPS has a fix",
            Self::OnGround => "a leg of the craft touches the ground",
            Self::Crashed => "the craft has crashed",
            Self::StickOverride => "the pilot's sticks fly roll and pitch",
            Self::RxLink => "the receiver link is up",
            Self::CannotHold => "the navigator reports that it cannot hold its target",
        }
    }
}
