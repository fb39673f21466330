//! A condition of the state machine with its value, limit and unit.

/// The comparison of a guard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
pub enum GuardOp {
    #[strum(to_string = "≤")]
    AtMost,
    #[strum(to_string = "≥")]
    AtLeast,
    #[strum(to_string = "<")]
    Below,
    #[strum(to_string = ">")]
    Above,
}

/// The quantity that a guard compares.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr)]
pub enum GuardName {
    /// A 3-D fix is present, 0 or 1.
    #[strum(to_string = "fix")]
    Fix,
    /// Number of waypoints in the active plan.
    #[strum(to_string = "plan")]
    Plan,
    #[strum(to_string = "fence")]
    Fence,
    /// Altitude in the climb before the first leg.
    #[strum(to_string = "climb")]
    Climb,
    /// Time since the craft last came nearer.
    #[strum(to_string = "no progress")]
    NoProgress,
    /// Distance to the waypoint, against the nearest so far.
    #[strum(to_string = "flyaway")]
    Flyaway,
    /// Distance to the waypoint.
    #[strum(to_string = "arrival")]
    Arrival,
    /// Altitude error of a TAKEOFF or a HOLD.
    #[strum(to_string = "altitude")]
    Altitude,
    /// Time within the hold radius of a HOLD without getting nearer to its altitude.
    #[strum(to_string = "held off altitude")]
    HeldOffAltitude,
    /// Distance to a FLYBY.
    #[strum(to_string = "turn radius")]
    TurnRadius,
    /// Distance to a waypoint that was flown past.
    #[strum(to_string = "overrun")]
    Overrun,
    /// Distance to the plane through the waypoint.
    #[strum(to_string = "plane")]
    Plane,
    /// Distance from the waypoint at the crossing of its plane.
    #[strum(to_string = "beside")]
    Beside,
    /// Time in the hold.
    #[strum(to_string = "hold time")]
    HoldTime,
    /// Altitude of a landing.
    #[strum(to_string = "touchdown altitude")]
    TouchdownAltitude,
    /// Ground speed of a landing.
    #[strum(to_string = "touchdown speed")]
    TouchdownSpeed,
    /// Commanded throttle of a landing.
    #[strum(to_string = "touchdown throttle")]
    TouchdownThrottle,
    /// Climb rate of a landing.
    #[strum(to_string = "touchdown sink")]
    TouchdownSink,
    /// Descent since the landing began.
    #[strum(to_string = "descent")]
    Descent,
    /// Commanded throttle below the hover throttle in use.
    #[strum(to_string = "below hover")]
    BelowHover,
    /// Time for which all other conditions of the touchdown have held.
    #[strum(to_string = "touchdown time")]
    TouchdownTime,
    /// Time for which the craft has not moved although it is commanded to descend.
    #[strum(to_string = "stationary time")]
    Stationary,
}

impl GuardName {
    /// Returns the compared quantity and the consequence, in a sentence or two.
    pub fn explanation(self) -> &'static str {
        match self {
            Self::Fix => "A GPS fix with altitude is needed: 1 when there is one.",
            Self::Plan => "Number of waypoints of the plan: there must be one to fly.",
            Self::Fence => "Distance from home. Beyond the limit the mission ends.",
            Self::Climb => {
                "Altitude reached in the climb before the first leg. The leg begins when it is high enough."
            }
            Self::NoProgress => {
                "Time since the craft last came nearer to the waypoint. The mission is given up at the limit."
            }
            Self::Flyaway => {
                "Distance to the waypoint, against the least so far and a margin. The mission is given up beyond it."
            }
            Self::Arrival => "Distance to the waypoint. It is reached within the arrival or hold radius.",
            Self::Altitude => "Altitude error. A TAKEOFF or a HOLD waits until it is small enough.",
            Self::HeldOffAltitude => {
                "Time within the hold radius without getting nearer to the altitude of the HOLD. At the limit it goes on."
            }
            Self::TurnRadius => "Distance to a FLYBY. The turn to the next leg begins at its turn radius.",
            Self::Overrun => {
                "Distance to a waypoint that was flown past. Beyond the limit the next leg begins."
            }
            Self::Plane => {
                "Distance past the plane through the waypoint, square to the leg. 0 is the waypoint."
            }
            Self::Beside => {
                "Distance from the waypoint where the craft crossed its plane. Nearer than the limit counts as reached."
            }
            Self::HoldTime => "Time in the hold. At the limit the mission goes on.",
            Self::TouchdownAltitude => "Altitude: a landing ends only this low.",
            Self::TouchdownSpeed => "Ground speed: a landing ends only this slow.",
            Self::TouchdownThrottle => "Commanded throttle: a craft on the ground needs less than this.",
            Self::TouchdownSink => "Climb rate: a craft on the ground sinks no more.",
            Self::Descent => "Way down since the landing began: there must be some.",
            Self::BelowHover => {
                "How far the commanded throttle is below the hover throttle: the ground carries the rest."
            }
            Self::TouchdownTime => {
                "Time for which all other guards of the touchdown have held. At the limit the craft disarms."
            }
            Self::Stationary => "Time for which the craft has not moved although it is commanded to descend.",
        }
    }

    /// Returns the unit of the value and its limit.
    pub fn unit(self) -> GuardUnit {
        match self {
            Self::Fix => GuardUnit::None,
            Self::Plan => GuardUnit::Waypoints,
            Self::Fence
            | Self::Climb
            | Self::Flyaway
            | Self::Arrival
            | Self::Altitude
            | Self::TurnRadius
            | Self::Overrun
            | Self::Plane
            | Self::Beside
            | Self::TouchdownAltitude
            | Self::Descent => GuardUnit::Metres,
            Self::NoProgress
            | Self::HeldOffAltitude
            | Self::HoldTime
            | Self::TouchdownTime
            | Self::Stationary => GuardUnit::Seconds,
            Self::TouchdownSpeed | Self::TouchdownSink => GuardUnit::MetresPerSecond,
            Self::TouchdownThrottle | Self::BelowHover => GuardUnit::Microseconds,
        }
    }
}

/// The unit of a guard's value and limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr)]
pub enum GuardUnit {
    /// A yes or no.
    #[strum(to_string = "")]
    None,
    /// A count of waypoints.
    #[strum(to_string = "waypoints")]
    Waypoints,
    /// m
    #[strum(to_string = "m")]
    Metres,
    /// s
    #[strum(to_string = "s")]
    Seconds,
    /// m/s
    #[strum(to_string = "m/s")]
    MetresPerSecond,
    /// µs of a servo pulse.
    #[strum(to_string = "µs")]
    Microseconds,
}

/// A named condition of the state machine with all values that explain its result.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    pub name: GuardName,
    pub value: f64,
    /// The limit in the same unit.
    pub limit: f64,
    pub op: GuardOp,
}

impl Guard {
    /// Creates a condition on a measured value.
    pub fn new(name: GuardName, value: f64, op: GuardOp, limit: f64) -> Self {
        Self { name, value, limit, op }
    }

    /// Returns the unit of value and limit.
    pub fn unit(&self) -> GuardUnit {
        self.name.unit()
    }

    /// Returns `true` if the condition holds; `false` for NaN.
    pub fn holds(&self) -> bool {
        match self.op {
            GuardOp::AtMost => self.value <= self.limit,
            GuardOp::AtLeast => self.value >= self.limit,
            GuardOp::Below => self.value < self.limit,
            GuardOp::Above => self.value > self.limit,
        }
    }

    /// Returns the distance from the limit on the fulfilled side: ≥ 0 if the condition holds.
    pub fn margin(&self) -> f64 {
        match self.op {
            GuardOp::AtMost | GuardOp::Below => self.limit - self.value,
            GuardOp::AtLeast | GuardOp::Above => self.value - self.limit,
        }
    }
}
