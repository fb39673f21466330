//! The signals of a flight and its yes-or-no flags, for expectations.

use super::quantity::Dimension;

macro_rules! signals {
    ($($variant:ident $name:literal $dimension:ident $help:literal;)*) => {
        /// A number that is sampled during the flight.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(usize)]
        pub enum Signal {
            $(#[doc = $help] $variant,)*
        }

        /// All signals, in the order of the reference.
        pub const SIGNALS: &[SignalInfo] = &[
            $(SignalInfo { signal: Signal::$variant, name: $name, dimension: Dimension::$dimension, help: $help },)*
        ];
    };
}

/// A signal with its name.
#[derive(Debug, Clone, Copy)]
pub struct SignalInfo {
    pub signal: Signal,
    /// The written name.
    pub name: &'static str,
    pub dimension: Dimension,
    pub help: &'static str,
}

signals! {
    Time "time" TIME "time since the first engagement";
    BootTime "boot_time" TIME "time since boot";
    North "north" LENGTH "true place north of the boot place";
    East "east" LENGTH "true place east of the boot place";
    Altitude "altitude" LENGTH "true height above the boot place";
    Speed "speed" SPEED "true ground speed";
    SpeedNorth "speed_north" SPEED "true speed to the north";
    SpeedEast "speed_east" SPEED "true speed to the east";
    Climb "climb" SPEED "true climb rate, sinking negative";
    Roll "roll" ANGLE "true roll, right positive";
    Pitch "pitch" ANGLE "true pitch, nose up positive";
    Heading "heading" ANGLE "true heading, 0 to 360 clockwise from north";
    Course "course" ANGLE "direction of the true motion, 0 to 360; unknown below 0.3 m/s";
    Lean "lean" ANGLE "true tilt from level";
    Force "force" ACCELERATION "specific force on the craft, 9.8 at rest";
    EstNorth "est_north" LENGTH "the estimator's place north of the boot place";
    EstEast "est_east" LENGTH "the estimator's place east of the boot place";
    EstAltitude "est_altitude" LENGTH "the estimator's altitude";
    Waypoint "waypoint" NONE "index of the current waypoint in the active plan";
    WpDistance "wp_distance" LENGTH "the navigator's distance to the current waypoint";
    CrossTrack "cross_track" LENGTH "the navigator's cross-track error, right of the leg positive";
    TargetAltitude "target_altitude" LENGTH "the navigator's altitude setpoint";
    SpeedSetpoint "speed_setpoint" SPEED "the navigator's speed setpoint";
    HomeDistance "home_distance" LENGTH "the navigator's distance from home";
    FenceMargin "fence_margin" LENGTH "the navigator's distance left to the fence";
    HoldRemaining "hold_remaining" TIME "time left in a hold with a duration";
    TouchdownHeld "touchdown_held" TIME "time for which the touchdown conditions have held";
    Hover "hover_throttle" PULSE "the hover throttle in use";
    RollDemand "roll_demand" ANGLE "the autopilot's roll demand, right positive";
    PitchDemand "pitch_demand" ANGLE "the autopilot's pitch demand, nose up positive";
    Throttle "throttle" PULSE "the throttle that drives the mixer";
    Motor1 "motor1" NONE "command of motor 1, 0 to 100 %";
    Motor2 "motor2" NONE "command of motor 2";
    Motor3 "motor3" NONE "command of motor 3";
    Motor4 "motor4" NONE "command of motor 4";
    Battery "battery" VOLTAGE "true voltage of the battery";
    Cell "cell" VOLTAGE "true voltage of a cell of the battery";
    Current "current" CURRENT "true current of the battery";
    Charge "charge" CHARGE "charge drawn since boot";
    BatteryUsed "battery_used" NONE "charge drawn as a share of the capacity";
    Wind "wind" SPEED "wind speed at the craft, with gusts and turbulence";
    Satellites "satellites" NONE "satellites in use";
}

impl Signal {
    /// The number of signals.
    pub const COUNT: usize = SIGNALS.len();

    /// Returns the name, the dimension and the meaning.
    pub fn info(self) -> &'static SignalInfo {
        &SIGNALS[self as usize]
    }

    /// Returns the signal with this name.
    pub fn find(name: &str) -> Option<Self> {
        SIGNALS.iter().find(|info| info.name == name).map(|info| info.signal)
    }
}

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signal_is_at_its_place_and_has_its_own_name() {
        for (index, info) in SIGNALS.iter().enumerate() {
            assert_eq!(info.signal as usize, index);
            assert_eq!(Signal::find(info.name), Some(info.signal));
        }
    }
}
