//! A condition of the state machine with its value, limit and unit.

/// The comparison of a guard.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, serde::Serialize, serde::Deserialize)]
pub enum GuardOp {
    /// ≤
    #[strum(to_string = "≤")]
    AtMost,
    /// ≥
    #[strum(to_string = "≥")]
    AtLeast,
    /// <
    #[strum(to_string = "<")]
    Below,
    /// >
    #[strum(to_string = ">")]
    Above,
}

/// Defines the quantities, each with its name, its unit, and a sentence or two that explain it.
macro_rules! guards {
    ($($variant:ident $name:literal $unit:ident $explanation:literal;)*) => {
        /// The quantity that a guard compares.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::IntoStaticStr, serde::Serialize, serde::Deserialize)]
        pub enum GuardName {
            $(#[doc = $explanation] #[strum(to_string = $name)] $variant,)*
        }

        impl GuardName {
            /// Returns the compared quantity and the consequence, in a sentence or two.
            pub fn explanation(self) -> &'static str {
                match self {
                    $(Self::$variant => $explanation,)*
                }
            }

            /// Returns the unit of the value and its limit.
            pub fn unit(self) -> GuardUnit {
                match self {
                    $(Self::$variant => GuardUnit::$unit,)*
                }
            }
        }
    };
}

guards! {
    Fix "fix" None "A GPS fix with altitude is needed: 1 when there is one.";
    Plan "plan" Waypoints "Number of waypoints of the plan: there must be one to fly.";
    Fence "fence" Metres "Distance from home. Beyond the limit the mission ends.";
    Climb "climb" Metres
        "Altitude reached in the climb before the first leg. The leg begins when it is high enough.";
    NoProgress "no progress" Seconds
        "Time since the craft last came nearer to the waypoint. The mission is given up at the limit.";
    Flyaway "flyaway" Metres
        "Distance to the waypoint, against the least so far and a margin. The mission is given up beyond it.";
    Arrival "arrival" Metres "Distance to the waypoint. It is reached within the arrival or hold radius.";
    Altitude "altitude" Metres "Altitude error. A TAKEOFF or a HOLD waits until it is small enough.";
    HeldOffAltitude "held off altitude" Seconds
        "Time within the hold radius without getting nearer to the altitude of the HOLD. At the limit it goes on.";
    TurnRadius "turn radius" Metres
        "Distance to a FLYBY. The turn to the next leg begins at its turn radius.";
    Overrun "overrun" Metres
        "Distance to a waypoint that was flown past. Beyond the limit the next leg begins.";
    Plane "plane" Metres
        "Distance past the plane through the waypoint, square to the leg. 0 is the waypoint.";
    Beside "beside" Metres
        "Distance from the waypoint where the craft crossed its plane. Nearer than the limit counts as reached.";
    HoldTime "hold time" Seconds "Time in the hold. At the limit the mission goes on.";
    TouchdownAltitude "touchdown altitude" Metres "Altitude: a landing ends only this low.";
    TouchdownSpeed "touchdown speed" MetresPerSecond "Ground speed: a landing ends only this slow.";
    TouchdownThrottle "touchdown throttle" Microseconds
        "Commanded throttle: a craft on the ground needs less than this.";
    TouchdownSink "touchdown sink" MetresPerSecond "Climb rate: a craft on the ground sinks no more.";
    Descent "descent" Metres "Way down since the landing began: there must be some.";
    BelowHover "below hover" Microseconds
        "How far the commanded throttle is below the hover throttle: the ground carries the rest.";
    TouchdownTime "touchdown time" Seconds
        "Time for which all other guards of the touchdown have held. At the limit the craft disarms.";
    Gate "gate" Metres "Distance to a waypoint between two legs. It is reached within the gate of its corner.";
    CornerSpeed "corner speed" MetresPerSecond
        "Ground speed, against the speed through the corner ahead. The carrot slows down to it.";
    Carrot "carrot" Metres "Distance of the carrot ahead of the craft on the leg, against the longest one.";
    Overspeed "overspeed hold" MetresPerSecond
        "Ground speed above that of the leg. Above the limit the carrot waits for the craft.";
    WrongHeading "wrong heading" Seconds
        "Time for which the course was far off a nose that points at the target. The mission is given up beyond the limit.";
    Stationary "stationary time" Seconds
        "Time for which the craft has not moved although it is commanded to descend.";
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
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Guard {
    /// The name.
    pub name: GuardName,
    /// The value, in the unit of the guard.
    #[serde(deserialize_with = "or_nan")]
    pub value: f64,
    /// The limit in the same unit.
    #[serde(deserialize_with = "or_nan")]
    pub limit: f64,
    /// The comparison of the value with the limit.
    pub op: GuardOp,
}

/// Reads a number. JSON has no form for one that is not finite.
fn or_nan<'de, D: serde::Deserializer<'de>>(source: D) -> Result<f64, D::Error> {
    Ok(<Option<f64> as serde::Deserialize>::deserialize(source)?.unwrap_or(f64::NAN))
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
