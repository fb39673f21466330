//! The views of displays and links on the firmware: plain data of the present instant.

use crate::autopilot::io::NavOutput;
use crate::autopilot::master::PATTERN_RPS;
use crate::geo::LatLon;
use crate::math;
use crate::plan::FlightPlan;
use crate::plan::estimate::{ReturnFlight, ReturnMode, TouchdownThrottle};
use crate::signals::{RC_CHANNELS, RcSource, SimTime};
use crate::telemetry::snapshot::{CraftView, EstimateView, GpsView, ModeRange, SettingsView};
use crate::telemetry::{
    ArmingFlags, DisarmReason, FailsafeAhead, FirmwareEvent, FirmwareProfile, ModeBox, ModeFlags,
    NavTelemetry,
};

use super::blackbox::{LogStep, Recorder};
use super::config::{Configuration, ModeCondition};
use super::estimate::Estimate;
use super::modes::BoxSet;
use super::parameters::{Parameters, RescueAltitude};
use super::rx::{Receiver, channels};
use super::{Firmware, FirmwareOptions, battery};

/// The margin above the threshold at which a throttle stick is put as raised, µs.
const RAISED_MARGIN_US: f64 = 12.5;
/// A tilt that gains speed quickly, degrees.
const AHEAD_TILT_DEG: f64 = 15.0;
/// A sink rate that every landing gear withstands, m/s.
const GENTLE_SINK_MPS: f64 = 1.0;

impl Firmware {
    /// Takes the oldest event that has not been taken yet.
    pub fn take_event(&mut self) -> Option<FirmwareEvent> {
        self.outbox.take()
    }

    /// Returns the number of events lost since the last call because they were not taken in time; 0 if they are taken
    /// after every step.
    pub fn take_events_lost(&mut self) -> u32 {
        self.outbox.take_lost()
    }

    /// Returns `true` if the motors may turn.
    pub fn is_armed(&self) -> bool {
        self.safety.arming.armed()
    }

    /// Returns the reason of the last disarming.
    pub fn last_disarm(&self) -> Option<DisarmReason> {
        self.safety.last_disarm
    }

    /// Returns all arming disable flags that are set.
    pub fn arming_flags(&self) -> ArmingFlags {
        self.safety.arming.flags()
    }

    /// Returns the flags that block arming while disarmed; no flags while armed.
    pub fn arming_blocks(&self) -> ArmingFlags {
        if self.is_armed() { ArmingFlags::NONE } else { self.arming_flags() }
    }

    /// Returns the active modes.
    pub fn modes(&self) -> ModeFlags {
        self.modes
    }

    /// Returns the boxes that are switched on.
    #[doc(hidden)]
    pub fn boxes(&self) -> BoxSet {
        self.rc.boxes
    }

    #[doc(hidden)]
    pub fn receiver(&self) -> &Receiver {
        &self.rc.receiver
    }

    /// Returns the results of the controller's last step.
    #[doc(hidden)]
    pub fn control(&self) -> &super::control::ControlState {
        self.control.controller.state()
    }

    #[doc(hidden)]
    pub fn battery(&self) -> &battery::Battery {
        &self.sensing.battery
    }

    /// Returns the estimate of the last step.
    pub fn estimate(&self) -> &Estimate {
        self.sensing.estimate()
    }

    /// Returns the altitude above home, m.
    pub fn altitude_m(&self) -> f64 {
        self.estimate().alt_m
    }

    /// Returns the climb rate, m/s.
    pub fn climb_mps(&self) -> f64 {
        self.estimate().climb_mps
    }

    /// Returns the navigator's telemetry. Its points count from [`Firmware::origin`].
    pub fn nav(&self) -> &NavTelemetry {
        self.navigation.navigator.telemetry()
    }

    /// Returns the demands of the navigator's last update, if it flies.
    #[doc(hidden)]
    pub fn nav_demand(&self) -> Option<NavOutput> {
        self.navigation.output
    }

    /// Returns the origin of the local frame of estimate and navigator; `None` before the first fix.
    pub fn origin(&self) -> Option<LatLon> {
        self.estimate().origin
    }

    /// Returns the neutral position of the throttle stick in ALTHOLD, µs: the hover throttle in use, or the middle
    /// while it is not learned yet.
    pub fn hover_stick_us(&self) -> u16 {
        self.navigation.hover_stick_us(self.parameters()).round().clamp(1100.0, 1900.0) as u16
    }

    /// Returns the pitch stick that tilts the craft forward by 15° in ANGLE, µs.
    pub fn forward_stick_us(&self) -> u16 {
        let share = AHEAD_TILT_DEG / self.parameters().control.level.limit_deg.max(AHEAD_TILT_DEG);
        (1500.0 + 500.0 * share).round() as u16
    }

    /// Returns the throttle stick from which the throttle counts as raised, with a margin for rounding in the radio
    /// link, µs.
    pub fn raised_stick_us(&self) -> u16 {
        (self.parameters().arming.raised_throttle_us + RAISED_MARGIN_US).min(2000.0) as u16
    }

    /// Returns the throttle stick that brings a craft down gently in ALTHOLD, µs; `None` if no stick does.
    pub fn sink_stick_us(&self) -> Option<u16> {
        let parameters = self.parameters();
        let hover_us = self.navigation.hover_stick_us(parameters);
        let stick = parameters.hold.sink_stick_us(GENTLE_SINK_MPS, hover_us, &parameters.nav)?;
        Some(stick.round() as u16)
    }

    /// Returns home, if known.
    pub fn home(&self) -> Option<LatLon> {
        self.safety.home
    }

    /// Returns `true` if an armed craft should climb but has not left the ground at full throttle.
    pub fn is_too_heavy(&self) -> bool {
        self.safety.arming.armed() && self.navigation.is_too_heavy()
    }

    /// Returns `true` if there is a fix.
    pub fn gps_fix(&self) -> bool {
        self.sensing.fix
    }

    /// Returns what the last step noted for a log; `None` if logs are off.
    #[doc(hidden)]
    pub fn log_step(&self) -> Option<LogStep<'_>> {
        self.recorder.as_deref().map(Recorder::last_step)
    }

    /// Returns the options that the firmware was created with.
    pub fn options(&self) -> FirmwareOptions {
        self.setup.options
    }

    /// Returns the configuration in memory.
    pub fn configuration(&self) -> &Configuration {
        &self.setup.configuration
    }

    /// Returns the typed parameters in force.
    #[doc(hidden)]
    pub fn parameters(&self) -> &Parameters {
        &self.setup.parameters
    }

    /// Returns the plan in the craft's memory.
    pub fn stored_plan(&self) -> &FlightPlan {
        &self.setup.configuration.plan
    }

    /// Returns the plan being flown, if any.
    pub fn active_plan(&self) -> Option<&FlightPlan> {
        self.navigation.active_plan()
    }

    /// Returns the last solution of the GPS.
    pub(super) fn gps_view(&self) -> Option<GpsView> {
        let solution = self.estimate().gps.solution?;
        Some(GpsView {
            position: solution.position,
            alt_amsl_m: f64::from(solution.alt_amsl_cm) / 100.0,
            ground_speed_mps: math::hypot(solution.vel_enu.x, solution.vel_enu.y),
        })
    }

    /// Returns modes, arming, receiver, battery. The mode ranges are left out, because they need memory from the heap.
    pub fn craft_view(&self) -> CraftView {
        let gps = &self.estimate().gps;
        let battery = self.battery().sample();
        let inner = self.receiver().channels();
        let mut wire_order = *inner;
        wire_order[2] = inner[channels::THROTTLE];
        wire_order[3] = inner[channels::YAW];
        let source: Option<RcSource> = self.receiver().sources().in_charge();
        CraftView {
            armed: Some(self.safety.arming.armed()),
            mode_name: None,
            modes: Some(self.modes),
            arming_blocked_by: Some(self.arming_blocks()),
            gps_fix: Some(self.gps_fix()),
            gps: self.gps_view(),
            sats: Some(gps.sats),
            hdop: Some(gps.hdop).filter(|&hdop| hdop > 0.0),
            home: self.home(),
            battery_v: battery.map(|sample| sample.voltage_v),
            battery_a: battery.map(|sample| sample.current_a),
            battery_mah: battery.map(|sample| sample.drawn_mah),
            battery_cells: Some(self.battery().cells()).filter(|&cells| cells > 0),
            throttle_us: Some(self.control.controller.state().throttle_us),
            motors: Some(self.control.controller.state().motors.0),
            channels: Some(wire_order),
            rc_source: source,
            rc_age_s: self.receiver().last_frame().map(|last| self.now.seconds_since(last)),
            rc_link: Some(self.receiver().signal()),
            failsafe_stage: Some(self.navigation.failsafe.stage()),
            failsafe_ahead: self.failsafe_ahead(),
            commanded: Some(self.navigation.orders.is_commanded()),
            mode_ranges: None,
        }
    }

    /// Returns the failsafe that starts if the lost link does not come back in time.
    fn failsafe_ahead(&self) -> Option<FailsafeAhead> {
        let receiver = self.receiver();
        if !self.is_armed() || receiver.signal() || self.navigation.failsafe.active() {
            return None;
        }
        let lost_for_s = self.now.seconds_since(receiver.last_frame()?);
        let in_s = (self.parameters().link.delay_s - lost_for_s).max(0.0);
        let procedure = self.navigation.failsafe_response(self.parameters()).procedure();
        Some(FailsafeAhead { in_s, procedure })
    }

    /// Returns the view of the estimate. `n` and `e` count from [`Firmware::origin`].
    pub fn estimate_view(&self) -> EstimateView {
        let estimate = self.estimate();
        let known = estimate.origin.is_some();
        let demand = self.control.controller.state().angle_demand_rad;
        EstimateView {
            n: known.then_some(estimate.pos_ne.x),
            e: known.then_some(estimate.pos_ne.y),
            alt: estimate.altitude_valid.then_some(estimate.alt_m),
            ground_speed_mps: Some(estimate.vel_ne.norm()),
            climb_mps: Some(estimate.climb_mps),
            roll_deg: Some(estimate.roll_rad.to_degrees()),
            pitch_deg: Some(-estimate.pitch_down_rad.to_degrees()),
            heading_deg: Some(estimate.heading_rad.to_degrees()),
            roll_demand_deg: demand.map(|[roll, _]| roll.to_degrees()),
            pitch_demand_deg: demand.map(|[_, pitch]| -pitch.to_degrees()),
        }
    }

    /// Returns the settings that affect the map.
    pub fn settings_view(&self) -> SettingsView {
        let nav = &self.parameters().nav;
        // Master flies both patterns within the hold radius.
        let [orbit_radius_m, figure8_width_m, max_turn_rate_dps] = match nav.profile {
            FirmwareProfile::Guide => [
                f64::from(nav.hold_orbit_radius) / 100.0,
                f64::from(nav.hold_figure8_width) / 100.0,
                f64::from(nav.max_turn_rate),
            ],
            FirmwareProfile::Master => [nav.hold_radius_m(), nav.hold_radius_m(), PATTERN_RPS.to_degrees()],
        };
        SettingsView {
            profile: nav.profile,
            arrival_radius_m: nav.arrival_radius_m(),
            hold_radius_m: nav.hold_radius_m(),
            orbit_radius_m,
            figure8_width_m,
            fence_m: nav.fence_m(),
            max_angle_deg: f64::from(nav.max_angle),
            max_velocity_mps: nav.max_velocity_mps(),
            max_turn_rate_dps,
            climb_mps: nav.climb_rate_mps(),
            landing_mps: nav.descent_rate_mps(),
            landing_alt_m: f64::from(nav.landing_altitude_m),
            min_nav_alt_m: f64::from(nav.min_nav_altitude_m),
            buildup_deg: f64::from(nav.velocity_buildup_max_pitch),
            position_p: f64::from(nav.position_p),
            return_flight: self.return_flight(),
            touchdown_throttle: TouchdownThrottle {
                hover_us: f64::from(nav.hover_throttle),
                threshold_us: f64::from(nav.landing_throttle_threshold),
                min_us: f64::from(nav.throttle_min),
            },
            hover_stick_us: self.hover_stick_us(),
            raised_stick_us: self.raised_stick_us(),
            sink_stick_us: self.sink_stick_us(),
        }
    }

    fn return_flight(&self) -> ReturnFlight {
        let rescue = &self.parameters().rescue;
        let mode = match rescue.altitude {
            RescueAltitude::HighestOfFlight => ReturnMode::Highest,
            RescueAltitude::Fixed => ReturnMode::Fixed,
            RescueAltitude::Present => ReturnMode::Present,
        };
        ReturnFlight { mode, climb_m: rescue.initial_climb_m, fixed_m: rescue.return_alt_m }
    }

    /// Returns the time of the newest step.
    pub fn time(&self) -> SimTime {
        self.now
    }

    /// Returns the mode conditions in force that depend on a channel.
    pub fn mode_ranges(&self) -> Vec<ModeRange> {
        let live = (channels::AUX1 + usize::from(self.parameters().rx.channels.max_aux)).min(RC_CHANNELS);
        let by_channel = |condition: &&ModeCondition| condition.linked == 0 && condition.is_usable();
        self.parameters()
            .modes
            .iter()
            .filter(by_channel)
            .filter_map(|condition| {
                let channel = condition.aux_channel + channels::AUX1 as u8;
                let mode_box = ModeBox::from_repr(condition.box_id)?;
                (usize::from(channel) < live).then_some(ModeRange {
                    mode_box,
                    channel,
                    start_us: condition.start_us,
                    end_us: condition.end_us,
                })
            })
            .collect()
    }
}
