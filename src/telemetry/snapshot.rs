//! A snapshot of the whole vehicle at one instant: plain data for displays, links and recorders.
//!
//! All `n`, `e` and `alt`, including those of estimates and targets, are in metres from the position of the
//! craft at boot.

use nalgebra::Vector2;

use crate::geo::{GRAVITY, LatLon};
use crate::math;
use crate::plan::estimate::{Assumptions, ReturnFlight, TouchdownThrottle};
use crate::plan::{FlightPlan, Waypoint};
use crate::signals::{PerMotor, RC_CHANNELS, RcSource, SimTime};
use crate::telemetry::{
    ArmingFlags, FailsafeAhead, FaultKind, FaultValue, FirmwareProfile, Mode, ModeBox, ModeFlags,
    NavTelemetry, Turbulence, switch,
};

/// The vehicle at an instant, as displays show it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Snapshot {
    /// Simulated time since boot.
    pub time: SimTime,
    /// The origin of positions, if known.
    pub origin: Option<LatLon>,
    /// The true state; `None` with an external simulator that does not report it.
    pub truth: Option<TruthView>,
    /// The firmware's estimate.
    pub estimate: EstimateView,
    /// Modes, arming and receiver.
    pub craft: CraftView,
    /// The navigator. Like all data of the flight controller it is `None` if a remote one does not report it.
    pub nav: Option<NavTelemetry>,
    /// The plan that is being flown, if any.
    pub active_plan: Option<FlightPlan>,
    /// The plan stored in the craft.
    pub stored_plan: Option<FlightPlan>,
    /// The settings for displays, as the firmware uses them.
    pub settings: Option<SettingsView>,
    /// Wind, noise and faults.
    pub world: WorldView,
}

impl Snapshot {
    /// Returns `true` if the autopilot is known to fly a mission.
    pub fn is_engaged(&self) -> bool {
        self.nav.as_ref().is_some_and(|nav| nav.engaged)
    }
}

/// The craft's true motion.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct TruthView {
    /// Latitude, degrees.
    #[serde(rename = "lat_e9", with = "degrees9")]
    pub lat_deg: f64,
    /// Longitude, degrees.
    #[serde(rename = "lon_e9", with = "degrees9")]
    pub lon_deg: f64,
    /// North of the boot position, m.
    pub n: f64,
    /// East of the boot position, m.
    pub e: f64,
    /// Above the boot position, m.
    pub alt: f64,
    /// Velocity north, m/s.
    pub vn: f64,
    /// Velocity east, m/s.
    pub ve: f64,
    /// Velocity up, m/s.
    pub vu: f64,
    /// Roll, degrees, right positive.
    pub roll_deg: f64,
    /// Pitch, degrees, nose **up** positive.
    pub pitch_deg: f64,
    /// Heading, degrees clockwise from north, 0…360.
    pub heading_deg: f64,
    /// Motor commands M1…M4, 0…1.
    pub motors: PerMotor,
    /// Wind at the craft, towards north and east, m/s; `None` from an external simulator, which does not
    /// report it.
    pub wind_ne: Option<Vector2<f64>>,
    /// Wind speed at the craft with its vertical part, m/s.
    pub wind_mps: Option<f64>,
    /// Specific force at the centre of mass, m/s²; `None` from an external simulator.
    pub force_mps2: Option<f64>,
    /// The battery; `None` from an external simulator.
    pub battery: Option<BatteryView>,
    /// `true` on the ground; with an external simulator: low and slow.
    pub on_ground: bool,
    /// `true` after a crash.
    pub crashed: bool,
    /// `true` once the simulation has left the range in which its numbers are valid.
    pub diverged: bool,
}

/// Degrees, stored as whole numbers of 10⁻⁹ degrees.
mod degrees9 {
    use serde::{Deserialize as _, Deserializer, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes a reference")]
    pub(super) fn serialize<S: Serializer>(degrees: &f64, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_i64((degrees * 1e9).round() as i64)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
        Ok(i64::deserialize(from)? as f64 / 1e9)
    }
}

impl TruthView {
    /// Returns the true horizontal speed over ground, m/s.
    pub fn ground_speed_mps(&self) -> f64 {
        math::hypot(self.vn, self.ve)
    }
}

/// The true state of the battery.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct BatteryView {
    /// Terminal voltage, V.
    pub voltage_v: f64,
    /// Current, A.
    pub current_a: f64,
    /// Charge drawn since boot, mAh.
    pub drawn_mah: f64,
    /// Capacity of a full pack, mAh.
    pub capacity_mah: f64,
}

/// The state as estimated by the firmware.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct EstimateView {
    /// North of the boot position, m; `None` before the first fix.
    pub n: Option<f64>,
    /// East of the boot position, m.
    pub e: Option<f64>,
    /// Above the boot position, m.
    pub alt: Option<f64>,
    /// Ground speed, m/s.
    pub ground_speed_mps: Option<f64>,
    /// Climb rate, m/s.
    pub climb_mps: Option<f64>,
    /// Roll, degrees, right positive.
    pub roll_deg: Option<f64>,
    /// Pitch, degrees, nose **up** positive.
    pub pitch_deg: Option<f64>,
    /// Heading, degrees clockwise from north.
    pub heading_deg: Option<f64>,
    /// Demanded roll, degrees, right positive, in a levelling mode.
    pub roll_demand_deg: Option<f64>,
    /// Demanded pitch, degrees, nose **up** positive, in a levelling mode.
    pub pitch_demand_deg: Option<f64>,
}

/// Modes, arming, receiver, battery. Values that a remote flight controller does not report are `None`.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct CraftView {
    /// `true` if the craft is armed.
    pub armed: Option<bool>,
    /// The active modes.
    pub modes: Option<ModeFlags>,
    /// The name of the mode, of a craft whose modes are not those of Betaflight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode_name: Option<String>,
    /// The arming disable flags that are set; empty while armed.
    pub arming_blocked_by: Option<ArmingFlags>,
    /// `true` with a 3-D fix.
    pub gps_fix: Option<bool>,
    /// The last GPS data, if any; outdated once the fix is lost.
    pub gps: Option<GpsView>,
    /// The number of satellites.
    pub sats: Option<u8>,
    /// Horizontal dilution of precision, if reported.
    pub hdop: Option<f64>,
    /// The home position, if known.
    pub home: Option<LatLon>,
    /// Battery voltage, V.
    pub battery_v: Option<f64>,
    /// Battery current, A.
    pub battery_a: Option<f64>,
    /// Charge drawn, mAh.
    pub battery_mah: Option<f64>,
    /// The number of battery cells, once counted.
    pub battery_cells: Option<u8>,
    /// Throttle that drives the mixer, RC µs.
    pub throttle_us: Option<f64>,
    /// Motor outputs M1…M4 in force, 0…1.
    pub motors: Option<PerMotor>,
    /// Channel values that the firmware uses, µs (substituted while the link is lost).
    pub channels: Option<[u16; RC_CHANNELS]>,
    /// The source of the channels; `None` before the first frame.
    pub rc_source: Option<RcSource>,
    /// Age of the newest frame, s.
    pub rc_age_s: Option<f64>,
    /// `true` while the receiver link is up.
    pub rc_link: Option<bool>,
    /// Failsafe stage: 0 none, 1 guard time, 2 procedure.
    pub failsafe_stage: Option<u8>,
    /// The failsafe that is about to start; `None` if there is none, or if it is not known.
    pub failsafe_ahead: Option<FailsafeAhead>,
    /// `true` while a command instead of a switch makes the craft fly home or land.
    pub commanded: Option<bool>,
    /// The mode conditions in force, which the RC panel draws on the AUX bars.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode_ranges: Option<Vec<ModeRange>>,
}

/// The unfiltered data of the GPS.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct GpsView {
    /// The position, degrees × 10⁷.
    pub position: LatLon,
    /// Altitude above mean sea level, m.
    pub alt_amsl_m: f64,
    /// Speed over ground, m/s.
    pub ground_speed_mps: f64,
}

impl CraftView {
    /// Returns `true` if the craft is known to be armed.
    pub fn is_armed(&self) -> bool {
        self.armed == Some(true)
    }

    /// Returns `true` if a mode is known to be active.
    pub fn is_active(&self, mode: Mode) -> bool {
        self.modes.is_some_and(|modes| modes.has(mode))
    }

    /// Returns `true` if there is known to be a fix.
    pub fn has_fix(&self) -> bool {
        self.gps_fix == Some(true)
    }

    /// Returns `true` if the craft is known to fly home or land by a command.
    pub fn is_commanded(&self) -> bool {
        self.commanded == Some(true)
    }

    /// Returns the known mode conditions.
    pub fn mode_ranges(&self) -> &[ModeRange] {
        self.mode_ranges.as_deref().unwrap_or_default()
    }

    /// Returns `true` if the switch of a mode is known to be on, by the channel value in the flight
    /// controller.
    pub fn is_switched_on(&self, mode: Mode) -> bool {
        self.channels.is_some_and(|channels| switch::is_on(mode, self.mode_ranges(), &channels))
    }

    /// Returns the arming disable flags that are known to be set.
    pub fn arming_flags(&self) -> ArmingFlags {
        self.arming_blocked_by.unwrap_or_default()
    }
}

/// A switch range that turns a mode on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ModeRange {
    /// The box that the range switches on.
    pub mode_box: ModeBox,
    /// The index into [`CraftView::channels`].
    pub channel: u8,
    /// The first value inside the range, µs.
    pub start_us: u16,
    /// The first value above the range, µs.
    pub end_us: u16,
}

impl ModeRange {
    /// Returns `true` if a value is inside the range.
    pub fn contains(&self, us: u16) -> bool {
        (self.start_us..self.end_us).contains(&us)
    }
}

/// The settings that displays and sticks need, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct SettingsView {
    /// The laws of the autopilot.
    pub profile: FirmwareProfile,
    /// `ap_waypoint_arrival_radius`, m.
    pub arrival_radius_m: f64,
    /// `ap_waypoint_hold_radius`, m.
    pub hold_radius_m: f64,
    /// `ap_hold_orbit_radius`, m.
    pub orbit_radius_m: f64,
    /// `ap_hold_figure8_width`, m.
    pub figure8_width_m: f64,
    /// `ap_max_distance_from_home`, m; `None` = no fence.
    pub fence_m: Option<f64>,
    /// `ap_max_angle`, degrees.
    pub max_angle_deg: f64,
    /// `ap_max_velocity`, m/s.
    pub max_velocity_mps: f64,
    /// `ap_max_turn_rate`, degrees per second.
    pub max_turn_rate_dps: f64,
    /// `alt_hold_climb_rate`, m/s.
    pub climb_mps: f64,
    /// `ap_landing_descent_rate`, m/s.
    pub landing_mps: f64,
    /// `ap_landing_altitude_m`.
    pub landing_alt_m: f64,
    /// `ap_min_nav_altitude_m`.
    pub min_nav_alt_m: f64,
    /// `ap_velocity_buildup_max_pitch`, degrees.
    pub buildup_deg: f64,
    /// `ap_position_p`.
    pub position_p: f64,
    /// The altitude of a GPS rescue.
    pub return_flight: ReturnFlight,
    /// The throttle condition of a touchdown.
    pub touchdown_throttle: TouchdownThrottle,
    /// The rest position of the throttle stick in ALTHOLD, µs.
    pub hover_stick_us: u16,
    /// The throttle stick position above which the throttle counts as raised, µs.
    pub raised_stick_us: u16,
    /// The throttle stick position that brings the craft down gently in ALTHOLD, µs; `None` if there is none.
    pub sink_stick_us: Option<u16>,
}

impl SettingsView {
    /// Returns the settings without the values that the craft learns in flight.
    pub fn chosen(self) -> Self {
        Self { hover_stick_us: 0, raised_stick_us: 0, sink_stick_us: None, ..self }
    }

    /// Returns the assumptions for estimates and reviews of plans on this craft.
    pub fn assumptions(&self) -> Assumptions {
        Assumptions {
            max_velocity_mps: self.max_velocity_mps,
            climb_mps: self.climb_mps,
            landing_mps: self.landing_mps,
            fence_m: self.fence_m,
            touchdown_throttle: self.touchdown_throttle,
            landing_alt_m: self.landing_alt_m,
            min_nav_alt_m: self.min_nav_alt_m,
            arrival_radius_m: self.arrival_radius_m,
            hold_radius_m: self.hold_radius_m,
            orbit_radius_m: self.orbit_radius_m,
            turn_rate_dps: self.max_turn_rate_dps,
            max_angle_deg: self.max_angle_deg,
            buildup_deg: self.buildup_deg,
            position_p: self.position_p,
            return_flight: self.return_flight,
            ..Assumptions::default()
        }
    }

    /// Returns the radius of a coordinated turn at this speed, m: R = V² / (g·tan θ) with the maximum tilt.
    pub fn turn_radius_m(&self, speed_mps: f64) -> f64 {
        speed_mps * speed_mps / (GRAVITY * math::tan(self.max_angle_deg.to_radians())).max(0.1)
    }

    /// Returns the number of laps that an ORBIT of this waypoint flies in its time; `None` if it has no end.
    pub fn orbit_laps(&self, wp: &Waypoint) -> Option<f64> {
        if wp.duration.is_zero() {
            return None;
        }
        let speed_mps = wp.speed.own_mps().unwrap_or(self.max_velocity_mps);
        let radius_m = self.orbit_radius_m.max(0.1);
        // The autopilot has the same limits: the setting, the speed of the leg and half of the maximum tilt.
        let by_tilt = (0.5 * GRAVITY * math::tan(self.max_angle_deg.to_radians()) / radius_m).sqrt();
        let rate_rps = self.max_turn_rate_dps.to_radians().min(speed_mps / radius_m).min(by_tilt);
        Some(rate_rps * wp.duration.get() / std::f64::consts::TAU)
    }
}

/// The air and the faults of the craft.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct WorldView {
    /// Name of the airframe.
    pub airframe: String,
    /// The mean wind, if known.
    pub wind: Option<WindView>,
    /// Gust amplitude, m/s.
    pub gust_mps: f64,
    /// Level of turbulence.
    pub turbulence: Turbulence,
    /// `true` if the sensors have errors.
    pub noise: bool,
    /// The active faults.
    pub faults: Vec<FaultView>,
}

/// The mean wind.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct WindView {
    /// Speed, m/s.
    pub speed_mps: f64,
    /// The direction from which it comes, degrees.
    pub from_deg: f64,
}

/// An active fault.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FaultView {
    /// The kind.
    pub kind: FaultKind,
    /// Its value.
    pub value: FaultValue,
    /// The remaining time, s; `None` = until the end of the flight.
    pub left_s: Option<f64>,
}
