//! The signals of a flight: the numbers that scenarios judge, graphs draw and samples write, each with its name, unit,
//! meaning and source.
//!
//! Values are in SI units and degrees. Places count from the place of the craft at boot, north and east. Roll is
//! positive to the right, pitch with the nose up, headings run clockwise from north.

use super::nav::NavTelemetry;
use super::quantity::Dimension;
use super::snapshot::{CraftView, EstimateView, Snapshot, TruthView};
use crate::math;
use crate::signals::SimTime;

/// The ground speed below which the course has no meaning, m/s.
const COURSE_MPS: f64 = 0.3;

/// The sources of the signals at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Observed<'a> {
    /// Simulated time since boot.
    pub time: SimTime,
    /// The time of the first engagement.
    pub engaged_at: Option<SimTime>,
    /// True motion of the craft, if it is known.
    pub truth: Option<&'a TruthView>,
    /// Estimate of the motion of the craft.
    pub estimate: &'a EstimateView,
    /// Modes, arming, receiver and battery.
    pub craft: &'a CraftView,
    /// State of the navigator, if it is known.
    pub nav: Option<&'a NavTelemetry>,
}

impl<'a> Observed<'a> {
    /// Returns the sources in a snapshot, which does not know the time of the engagement.
    pub fn of(snapshot: &'a Snapshot) -> Self {
        Self {
            time: snapshot.time,
            engaged_at: None,
            truth: snapshot.truth.as_ref(),
            estimate: &snapshot.estimate,
            craft: &snapshot.craft,
            nav: snapshot.nav.as_ref(),
        }
    }

    fn motor(&self, index: usize) -> Option<f64> {
        self.craft.motors.and_then(|motors| motors.get(index).copied())
    }

    /// Returns the telemetry of the navigator while it flies a mission.
    fn engaged(&self) -> Option<&'a NavTelemetry> {
        self.nav.filter(|nav| nav.engaged)
    }
}

macro_rules! signals {
    ($($variant:ident $name:literal $dimension:ident $help:literal = |$observed:ident| $value:expr;)*) => {
        /// A number that changes in flight.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[repr(usize)]
        pub enum Signal {
            $(#[doc = $help] $variant,)*
        }

        /// All signals, in the order of the reference.
        pub const SIGNALS: &[SignalInfo] = &[
            $(SignalInfo {
                signal: Signal::$variant,
                name: $name,
                dimension: Dimension::$dimension,
                help: $help,
                read: |$observed| $value,
            },)*
        ];

        impl SignalValues {
            /// Returns the values of all signals.
            pub fn of(observed: &Observed<'_>) -> Self {
                // Without the table, so that the compiler sees all reads at once.
                let rounded = |value: Option<f64>| value.map_or(f32::NAN, |value| value as f32);
                Self([$(rounded((|$observed: &Observed<'_>| -> Option<f64> { $value })(observed)),)*])
            }
        }
    };
}

/// A signal with its name, its unit and its source.
#[derive(Debug, Clone, Copy)]
pub struct SignalInfo {
    /// The signal.
    pub signal: Signal,
    /// The written name.
    pub name: &'static str,
    /// The dimension of its unit.
    pub dimension: Dimension,
    /// A description for people.
    pub help: &'static str,
    read: fn(&Observed<'_>) -> Option<f64>,
}

impl SignalInfo {
    /// Returns the signal with which the flight controller estimates or reports this true value, if there is one.
    pub fn counterpart(&self) -> Option<Signal> {
        ["est", "reported"].iter().find_map(|prefix| Signal::find(&format!("{prefix}_{}", self.name)))
    }
}

signals! {
    Time "time" TIME "time since the first engagement"
        = |o| o.engaged_at.map(|engaged| o.time.as_secs_f64() - engaged.as_secs_f64());
    BootTime "boot_time" TIME "time since boot" = |o| Some(o.time.as_secs_f64());
    North "north" LENGTH "true place north of the boot place" = |o| o.truth.map(|truth| truth.n);
    East "east" LENGTH "true place east of the boot place" = |o| o.truth.map(|truth| truth.e);
    Altitude "altitude" LENGTH "true height above the boot place" = |o| o.truth.map(|truth| truth.alt);
    Speed "speed" SPEED "true ground speed" = |o| o.truth.map(TruthView::ground_speed_mps);
    SpeedNorth "speed_north" SPEED "true speed to the north" = |o| o.truth.map(|truth| truth.vn);
    SpeedEast "speed_east" SPEED "true speed to the east" = |o| o.truth.map(|truth| truth.ve);
    Climb "climb" SPEED "true climb rate, sinking negative" = |o| o.truth.map(|truth| truth.vu);
    Roll "roll" ANGLE "true roll, right positive" = |o| o.truth.map(|truth| truth.roll_deg);
    Pitch "pitch" ANGLE "true pitch, nose up positive" = |o| o.truth.map(|truth| truth.pitch_deg);
    Heading "heading" ANGLE "true heading, 0 to 360 clockwise from north"
        = |o| o.truth.map(|truth| truth.heading_deg);
    Course "course" ANGLE "direction of the true motion, 0 to 360; unknown below 0.3 m/s" = |o| {
        o.truth
            .filter(|truth| truth.ground_speed_mps() >= COURSE_MPS)
            .map(|truth| math::atan2(truth.ve, truth.vn).to_degrees().rem_euclid(360.0))
    };
    Tilt "lean" ANGLE "true tilt from level" = |o| {
        let cos = |degrees: f64| math::cos(degrees.to_radians());
        o.truth.map(|truth| math::acos(cos(truth.roll_deg) * cos(truth.pitch_deg)).to_degrees())
    };
    Force "force" ACCELERATION "specific force on the craft, 9.8 at rest"
        = |o| o.truth.and_then(|truth| truth.force_mps2);
    EstNorth "est_north" LENGTH "the estimator's place north of the boot place" = |o| o.estimate.n;
    EstEast "est_east" LENGTH "the estimator's place east of the boot place" = |o| o.estimate.e;
    EstAltitude "est_altitude" LENGTH "the estimator's altitude" = |o| o.estimate.alt;
    Waypoint "waypoint" NONE "index of the current waypoint in the active plan"
        = |o| o.engaged().map(|nav| f64::from(nav.wp));
    WpDistance "wp_distance" LENGTH "the navigator's distance to the current waypoint"
        = |o| o.nav.and_then(|nav| nav.distance_m);
    CrossTrack "cross_track" LENGTH "the navigator's cross-track error, right of the leg positive"
        = |o| o.nav.and_then(|nav| nav.xte_m);
    TargetAltitude "target_altitude" LENGTH "the navigator's altitude setpoint"
        = |o| o.nav.and_then(|nav| nav.target_alt_m);
    SpeedSetpoint "speed_setpoint" SPEED "the navigator's speed setpoint"
        = |o| o.nav.and_then(|nav| nav.speed_setpoint_mps);
    HomeDistance "home_distance" LENGTH "the navigator's distance from home"
        = |o| o.nav.and_then(|nav| nav.home_distance_m);
    FenceMargin "fence_margin" LENGTH "the navigator's distance left to the fence"
        = |o| o.nav.and_then(|nav| nav.fence_margin_m);
    HoldRemaining "hold_remaining" TIME "time left in a hold with a duration"
        = |o| o.nav.and_then(|nav| nav.hold_remaining_s).filter(|left_s| left_s.is_finite());
    TouchdownHeld "touchdown_held" TIME "time for which the touchdown conditions have held"
        = |o| o.nav.and_then(|nav| nav.touchdown_held_s);
    Hover "hover_throttle" PULSE "the hover throttle in use" = |o| o.nav.map(|nav| nav.hover_us);
    RollDemand "roll_demand" ANGLE "the autopilot's roll demand, right positive"
        = |o| o.engaged().map(|nav| nav.roll_demand_rad.to_degrees());
    PitchDemand "pitch_demand" ANGLE "the autopilot's pitch demand, nose up positive"
        = |o| o.engaged().map(|nav| -nav.pitch_down_demand_rad.to_degrees());
    Throttle "throttle" PULSE "the throttle that drives the mixer" = |o| o.craft.throttle_us;
    Motor1 "motor1" NONE "command of motor 1, 0 to 100 %" = |o| o.motor(0);
    Motor2 "motor2" NONE "command of motor 2" = |o| o.motor(1);
    Motor3 "motor3" NONE "command of motor 3" = |o| o.motor(2);
    Motor4 "motor4" NONE "command of motor 4" = |o| o.motor(3);
    Battery "battery" VOLTAGE "true voltage of the battery"
        = |o| o.truth.and_then(|truth| truth.battery).map(|battery| battery.voltage_v);
    Cell "cell" VOLTAGE "true voltage of a cell of the battery" = |o| {
        // From the voltage as it is sampled, so that the cells add up to the battery.
        let voltage_v = o.truth?.battery?.voltage_v as f32;
        Some(f64::from(voltage_v) / f64::from(o.craft.battery_cells?))
    };
    Current "current" CURRENT "true current of the battery"
        = |o| o.truth.and_then(|truth| truth.battery).map(|battery| battery.current_a);
    Charge "charge" CHARGE "charge drawn since boot"
        = |o| o.truth.and_then(|truth| truth.battery).map(|battery| battery.drawn_mah * 3.6);
    BatteryUsed "battery_used" NONE "charge drawn as a share of the capacity"
        = |o| o.truth.and_then(|truth| truth.battery).map(|battery| battery.drawn_mah / battery.capacity_mah);
    Wind "wind" SPEED "wind speed at the craft, with gusts and turbulence"
        = |o| o.truth.and_then(|truth| truth.wind_mps);
    Satellites "satellites" NONE "satellites in use" = |o| o.craft.sats.map(f64::from);
    EstSpeed "est_speed" SPEED "the estimator's ground speed" = |o| o.estimate.ground_speed_mps;
    EstClimb "est_climb" SPEED "the estimator's climb rate, sinking negative" = |o| o.estimate.climb_mps;
    EstRoll "est_roll" ANGLE "the estimator's roll, right positive" = |o| o.estimate.roll_deg;
    EstPitch "est_pitch" ANGLE "the estimator's pitch, nose up positive" = |o| o.estimate.pitch_deg;
    EstHeading "est_heading" ANGLE "the estimator's heading, clockwise from north" = |o| o.estimate.heading_deg;
    RollSetpoint "roll_setpoint" ANGLE "roll setpoint of the angle loop, right positive"
        = |o| o.estimate.roll_demand_deg;
    PitchSetpoint "pitch_setpoint" ANGLE "pitch setpoint of the angle loop, nose up positive"
        = |o| o.estimate.pitch_demand_deg;
    Bearing "bearing" ANGLE "the navigator's bearing to the current waypoint, clockwise from north"
        = |o| o.nav.and_then(|nav| nav.bearing_rad).map(f64::to_degrees);
    TargetNorth "target_north" LENGTH "the navigator's target north of the boot place"
        = |o| o.nav.and_then(|nav| nav.target_ne).map(|ne| ne.x);
    TargetEast "target_east" LENGTH "the navigator's target east of the boot place"
        = |o| o.nav.and_then(|nav| nav.target_ne).map(|ne| ne.y);
    ReportedBattery "reported_battery" VOLTAGE "battery voltage that the flight controller reports"
        = |o| o.craft.battery_v;
    ReportedCurrent "reported_current" CURRENT "battery current that the flight controller reports"
        = |o| o.craft.battery_a;
    ReportedCharge "reported_charge" CHARGE "charge drawn that the flight controller reports"
        = |o| o.craft.battery_mah.map(|mah| mah * 3.6);
    WindNorth "wind_north" SPEED "wind at the craft, towards north"
        = |o| o.truth.and_then(|truth| truth.wind_ne).map(|ne| ne.x);
    WindEast "wind_east" SPEED "wind at the craft, towards east"
        = |o| o.truth.and_then(|truth| truth.wind_ne).map(|ne| ne.y);
}

/// The values of all signals at one instant; NaN for an unknown one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SignalValues([f32; Signal::COUNT]);

impl SignalValues {
    /// No value is known.
    pub const UNKNOWN: Self = Self([f32::NAN; Signal::COUNT]);

    /// Returns the value of a signal, NaN if it is unknown.
    pub fn get(&self, signal: Signal) -> f64 {
        f64::from(self.0[signal as usize])
    }

    /// Sets the value of a signal, in its unit.
    pub fn set(&mut self, signal: Signal, value: f64) {
        self.0[signal as usize] = value as f32;
    }

    /// Returns the values in the order of [`SIGNALS`].
    pub fn iter(&self) -> impl Iterator<Item = f32> {
        self.0.into_iter()
    }
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

    /// Returns the value at an instant, in SI units or degrees, if it is known.
    pub fn read(self, observed: &Observed<'_>) -> Option<f64> {
        (self.info().read)(observed)
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

    #[test]
    fn every_estimate_is_the_counterpart_of_a_true_value() {
        let counterparts: Vec<&str> =
            SIGNALS.iter().filter_map(SignalInfo::counterpart).map(|signal| signal.info().name).collect();
        let is_belief = |name: &str| name.starts_with("est_") || name.starts_with("reported_");
        let beliefs = SIGNALS.iter().map(|info| info.name).filter(|name| is_belief(name));
        assert_eq!(beliefs.filter(|name| !counterparts.contains(name)).collect::<Vec<_>>(), [""; 0]);
        assert_eq!(Signal::Altitude.info().counterpart(), Some(Signal::EstAltitude));
        assert_eq!(Signal::Battery.info().counterpart(), Some(Signal::ReportedBattery));
        assert_eq!(Signal::Wind.info().counterpart(), None);
    }

    #[test]
    fn an_empty_snapshot_has_only_its_time() {
        let snapshot = Snapshot::default();
        let values = SignalValues::of(&Observed::of(&snapshot));
        let known = SIGNALS.iter().filter(|info| !values.get(info.signal).is_nan());
        assert_eq!(known.map(|info| info.name).collect::<Vec<_>>(), ["boot_time"]);
    }

    #[test]
    fn signs_and_frames_are_those_of_the_table() {
        let truth = TruthView { vn: 0.0, ve: -2.0, pitch_deg: 10.0, ..TruthView::default() };
        let mut nav = NavTelemetry { engaged: true, ..NavTelemetry::idle() };
        nav.pitch_down_demand_rad = 0.1;
        let snapshot = Snapshot { truth: Some(truth), nav: Some(nav), ..Snapshot::default() };
        let read = |signal: Signal| signal.read(&Observed::of(&snapshot)).unwrap();
        assert!((read(Signal::Course) - 270.0).abs() < 1e-9);
        assert!((read(Signal::Tilt) - 10.0).abs() < 1e-9);
        assert!((read(Signal::PitchDemand) + 0.1_f64.to_degrees()).abs() < 1e-9, "nose down is negative");
    }
}
