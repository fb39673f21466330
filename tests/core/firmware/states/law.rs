//! The rules that must hold in every step, whatever happens.

use std::collections::BTreeSet;

use betadeck_core::autopilot::Params;
use betadeck_core::firmware::Firmware;
use betadeck_core::firmware::failsafe::Procedure;
use betadeck_core::firmware::modes::boxes;
use betadeck_core::telemetry::{FirmwareEvent, Mode, NavEvent, NavState, PlanSource, TransitionReason};

/// The number of updates that a changed limit may take to be in force.
const SETTLE: u32 = 300;
/// The number of updates that a switch may take to have its effect or its refusal.
const REACTION: u32 = 30;
/// The number of updates that the GPS RESCUE switch may take, while a fix comes back.
const RESCUE_REACTION: u32 = REACTION + 200;
/// The slack of the longest AUTO-LAND, updates.
const LANDING_SLACK: u32 = 10;

/// The transitions and responses that a useful search must have seen.
pub(crate) const NEEDED: &[&str] = &[
    "IDLE -> APPROACHING",
    "APPROACHING -> ARRIVED",
    "ARRIVED -> APPROACHING",
    "ARRIVED -> HOLDING",
    "HOLDING -> ORBITING",
    "HOLDING -> FIGURE8",
    "ARRIVED -> LANDING",
    "ARRIVED -> COMPLETE",
    "LANDING -> COMPLETE",
    "failsafe CONTINUE",
    "failsafe LAND",
    "failsafe AUTO-LAND",
    "failsafe DROP",
    "failsafe GPS-RESCUE",
    "failsafe CONTINUE then AUTO-LAND",
    "failsafe CONTINUE then DROP",
    "failsafe LAND then AUTO-LAND",
    "failsafe GPS-RESCUE then AUTO-LAND",
    "recovered",
    "armed",
    "disarmed SWITCH",
    "disarmed FAILSAFE",
    "disarmed LANDING",
    "disarmed SYSTEM",
];

/// The limits of throttle (µs) and tilt (degrees). After a change, the widest of the old and the new ones.
#[derive(Debug, Clone, Copy)]
struct Limits {
    low_us: f64,
    high_us: f64,
    tilt_deg: f64,
}

impl Limits {
    fn of(params: &Params) -> Self {
        let low_us = f64::from(params.throttle_min);
        let high_us = f64::from(params.throttle_max).max(low_us);
        Self { low_us, high_us, tilt_deg: f64::from(params.max_angle) }
    }

    fn widest(self, other: Self) -> Self {
        Self {
            low_us: self.low_us.min(other.low_us),
            high_us: self.high_us.max(other.high_us),
            tilt_deg: self.tilt_deg.max(other.tilt_deg),
        }
    }
}

/// The judge, with its memory of the earlier updates.
#[derive(Debug, Clone, Default)]
pub(crate) struct Law {
    state: NavState,
    arrived_for: u32,
    limits: Option<Limits>,
    limits_changed_at: u32,
    stage: u8,
    response: Option<&'static str>,
    auto_landing_for: u32,
    was_armed: bool,
    armed_before: bool,
    ignored_for: u32,
    unarmed_for: u32,
    unrescued_for: u32,
    pub(crate) armings: u32,
    pub(crate) seen: BTreeSet<String>,
}

impl Law {
    /// Forgets the records of a flight. The next flight begins from the same craft.
    pub(crate) fn forget(&mut self) {
        self.seen.clear();
        self.armings = 0;
    }

    fn see(&mut self, what: String) {
        self.seen.insert(what);
    }

    /// Forgets the state of the firmware, as a restart does. The limits and the records remain.
    pub(crate) fn restarted(&mut self) {
        *self = Self {
            armings: self.armings,
            limits: self.limits,
            limits_changed_at: self.limits_changed_at,
            was_armed: self.was_armed,
            armed_before: self.armed_before,
            seen: std::mem::take(&mut self.seen),
            ..Self::default()
        };
    }

    /// Widens the limits. Must be called before and after a change of settings.
    pub(crate) fn settings_changed(&mut self, firmware: &Firmware, update: u32) {
        let now = Limits::of(&firmware.parameters().nav);
        self.limits = Some(self.limits.map_or(now, |limits| limits.widest(now)));
        self.limits_changed_at = update;
    }

    /// Checks the motors after every step.
    pub(crate) fn judge_motors(&mut self, firmware: &Firmware) {
        let control = firmware.control();
        let motors = control.motors.0;
        assert!(motors.iter().all(|motor| (0.0..=1.0).contains(motor)), "{motors:?}");
        assert!((1000.0..=2000.0).contains(&control.throttle_us), "{}", control.throttle_us);
        if !firmware.is_armed() && !self.was_armed {
            assert!(motors.iter().all(|motor| *motor == 0.0), "disarmed, and motors turn: {motors:?}");
        }
        self.was_armed = firmware.is_armed();
    }

    /// Checks each event after the step that made it.
    pub(crate) fn judge_event(&mut self, event: &FirmwareEvent, firmware: &Firmware) {
        match event {
            FirmwareEvent::Nav(NavEvent::State { from, to, guard, target_alt_m, reason, .. }) => {
                assert_eq!(*from, self.state, "a state changed without an event");
                let at_once = *to == NavState::Complete && *reason == TransitionReason::Reset;
                assert!(legal(*from, *to) || at_once, "{from} -> {to}: {reason}");
                assert!(guard.is_none_or(|guard| guard.holds()), "{guard:?} fired");
                assert!(target_alt_m.is_finite());
                self.state = *to;
                self.arrived_for = 0;
                self.see(format!("{from} -> {to}"));
            }
            FirmwareEvent::Armed => {
                let flags = firmware.arming_flags();
                assert!(flags.is_empty(), "armed against {:?}", flags.iter().collect::<Vec<_>>());
                let forbidden =
                    [boxes::AUTOPILOT, boxes::ALTHOLD, boxes::POS_HOLD, boxes::FAILSAFE, boxes::GPS_RESCUE];
                let on = forbidden.iter().find(|id| firmware.boxes().has(**id));
                let rescue = firmware.parameters().arming.rescue_configured;
                assert!(on.is_none_or(|id| *id == boxes::GPS_RESCUE && !rescue), "armed with box {on:?} on");
                assert!(firmware.boxes().has(boxes::ARM));
                assert!(firmware.receiver().signal(), "armed without a signal");
                let low = firmware.parameters().arming.min_check_us;
                assert!(firmware.receiver().sticks().throttle_us < low, "armed with throttle");
                self.armings += 1;
                self.see("armed".to_owned());
            }
            FirmwareEvent::Disarmed(reason) => self.see(format!("disarmed {reason}")),
            FirmwareEvent::Failsafe { policy, stage: 2, procedure } => {
                self.judge_response(policy.into(), procedure.into(), firmware);
            }
            FirmwareEvent::Failsafe { .. }
            | FirmwareEvent::GpsFix { .. }
            | FirmwareEvent::GpsLost { .. }
            | FirmwareEvent::Battery { .. }
            | FirmwareEvent::HeadingDoubt { .. }
            | FirmwareEvent::TiltDoubt { .. }
            | FirmwareEvent::Mode(_)
            | FirmwareEvent::RxLoss
            | FirmwareEvent::RxRecovered
            | FirmwareEvent::Nav(_)
            | FirmwareEvent::Notice(_) => {}
        }
    }

    /// Checks the table of the failsafe: the allowed first responses and the allowed sequence.
    fn judge_response(&mut self, policy: &str, procedure: &'static str, firmware: &Firmware) {
        let configured = firmware.parameters().failsafe.procedure;
        match (self.response, procedure) {
            (None, "CONTINUE" | "LAND") => {
                assert_eq!(policy, procedure);
                assert_ne!(self.state, NavState::Idle, "{procedure} of nothing");
            }
            (None, "GPS-RESCUE") => {
                assert_eq!(configured, Procedure::GpsRescue);
                assert!(firmware.home().is_some(), "a rescue to nowhere");
            }
            (None, "AUTO-LAND") => assert_ne!(configured, Procedure::Drop),
            (None, "DROP") | (Some("CONTINUE" | "LAND" | "GPS-RESCUE"), "AUTO-LAND") => {}
            (Some("CONTINUE"), "DROP") => assert_eq!(configured, Procedure::Drop),
            (before, after) => panic!("failsafe: {before:?} is followed by {after}"),
        }
        if procedure == "DROP" {
            assert!(!firmware.is_armed(), "dropped, and armed");
        }
        match self.response {
            Some(before) => self.see(format!("failsafe {before} then {procedure}")),
            None => self.see(format!("failsafe {procedure}")),
        }
        self.response = Some(procedure);
    }

    /// Checks the firmware after every update of the navigator.
    pub(crate) fn judge_update(&mut self, firmware: &Firmware, update: u32, link: bool) {
        self.judge_failsafe(firmware);
        self.judge_navigator(firmware, update);
        self.judge_refusals(firmware, link);
    }

    fn judge_failsafe(&mut self, firmware: &Firmware) {
        let stage = firmware.craft_view().failsafe_stage.unwrap();
        let armed = firmware.is_armed();
        assert!((self.stage, stage) != (2, 1), "from a procedure back to guard time");
        if self.stage == 2 && stage == 0 {
            self.see("recovered".to_owned());
        }
        if stage == 2 {
            assert!(self.response.is_some(), "a procedure began without a word");
            assert!(firmware.modes().has(Mode::Failsafe));
        } else {
            self.response = None;
        }
        self.stage = stage;
        let landing = armed && self.response == Some("AUTO-LAND");
        self.auto_landing_for = if landing { self.auto_landing_for + 1 } else { 0 };
        let longest = (60.0 * 100.0) as u32 + LANDING_SLACK;
        assert!(self.auto_landing_for <= longest, "AUTO-LAND never ends");
    }

    fn judge_navigator(&mut self, firmware: &Firmware, update: u32) {
        let nav = firmware.nav();
        let modes = firmware.modes();
        let armed = firmware.is_armed();
        // The modes follow within an update.
        if std::mem::replace(&mut self.armed_before, armed) == armed {
            assert_eq!(modes.has(Mode::Arm), armed);
        }
        if nav.state == NavState::Idle {
            // Arming again ends the COMPLETE of a landing without a transition.
            self.state = NavState::Idle;
        }
        let Some(active) = firmware.active_plan() else {
            assert!(!modes.has(Mode::Autopilot), "AUTOPILOT flies nothing");
            return;
        };
        assert_eq!(nav.state, self.state);
        self.arrived_for = if nav.state == NavState::Arrived { self.arrived_for + 1 } else { 0 };
        assert!(self.arrived_for <= 1, "ARRIVED lasts one update");
        if !armed {
            // The craft was disarmed in this update, after the navigator ran.
            return;
        }
        assert!(usize::from(nav.wp) < active.waypoints.len());
        // Before a pattern, HOLDING lasts one update and waits for nothing.
        let at_rest = matches!(nav.state, NavState::Arrived | NavState::Complete | NavState::Holding);
        assert!(at_rest || !nav.guards.is_empty(), "{} waits for nothing", nav.state);
        let out = firmware.nav_demand().unwrap();
        let now = Limits::of(&firmware.parameters().nav);
        let limits = match self.limits {
            Some(limits) if update <= self.limits_changed_at + SETTLE => limits,
            _ => *self.limits.insert(now),
        };
        assert!((0.0..=1.0).contains(&out.throttle), "{out:?}");
        assert!((limits.low_us..=limits.high_us).contains(&out.throttle_us), "{out:?} {limits:?}");
        let tilt = out.roll_rad.hypot(out.pitch_down_rad).to_degrees();
        assert!(tilt <= limits.tilt_deg + 1e-6, "{tilt}° {limits:?}");
        assert!(out.yaw_rate_rps.is_none_or(f64::is_finite));
    }

    /// Checks that a switch has its effect or that the firmware reports a reason.
    fn judge_refusals(&mut self, firmware: &Firmware, link: bool) {
        let switches = firmware.boxes();
        let armed = firmware.is_armed();
        let listens = link && firmware.receiver().signal() && self.stage == 0;
        let ignored = listens
            && armed
            && switches.has(boxes::AUTOPILOT)
            && firmware.active_plan().is_none()
            && firmware.nav().refusal.is_none();
        self.ignored_for = if ignored { self.ignored_for + 1 } else { 0 };
        assert!(self.ignored_for < REACTION, "AUTOPILOT is on, nothing flies, and nothing says why");
        let unrescued = listens
            && armed
            && switches.has(boxes::GPS_RESCUE)
            && firmware.parameters().arming.rescue_configured
            && !firmware.craft_view().is_commanded()
            && (firmware.active_plan().is_none() && firmware.nav().refusal.is_none()
                || firmware.active_plan().is_some() && firmware.nav().source == PlanSource::Stored);
        self.unrescued_for = if unrescued { self.unrescued_for + 1 } else { 0 };
        // A rescue that was asked for without a fix begins when the fix has been back for two seconds.
        let patience = if firmware.nav().refusal.is_some() { u32::MAX } else { RESCUE_REACTION };
        assert!(self.unrescued_for < patience, "GPS RESCUE is on, and neither flown nor refused");
        let unarmed = listens && !armed && switches.has(boxes::ARM) && firmware.arming_flags().is_empty();
        self.unarmed_for = if unarmed { self.unarmed_for + 1 } else { 0 };
        assert!(self.unarmed_for < REACTION, "ARM is on, nothing blocks it, and it is not armed");
    }
}

/// Returns `true` for the transitions that a rule or a command may cause. Every other transition is illegal.
fn legal(from: NavState, to: NavState) -> bool {
    use NavState::{Approaching, Arrived, Complete, Figure8, Holding, Idle, Landing, Orbiting};
    match (from, to) {
        // Disengaging, an emergency landing, a return home and a new start are possible from any state.
        (_, Idle | Landing | Approaching) => true,
        (Idle, Complete) | (Approaching, Arrived) | (Arrived, Holding | Complete) => true,
        (Holding, Orbiting | Figure8 | Complete) => true,
        (Orbiting | Figure8 | Landing, Complete) => true,
        (_, Arrived | Holding | Orbiting | Figure8 | Complete) => false,
    }
}
