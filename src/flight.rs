//! A headless flight: a vehicle, the scripted pilot and a judge.
//!
//! The flight boots, waits for the fix, arms, climbs, engages and flies to the end. Like the core, it has no clock
//! and no files. The caller gets its events and decides about their use.
//!
//! ```
//! use betadeck_core::flight::{Flight, FlightOptions, FlightResult, FlightSetup};
//! use betadeck_core::plan::builtin::BuiltinPlan;
//!
//! let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
//! let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
//! setup.stored.plan = plan.plan;
//! let (vehicle, _notices) = setup.build().unwrap();
//! let mut flight = Flight::new(vehicle, &FlightOptions::default()).unwrap();
//! let end = loop {
//!     if let Some(end) = flight.tick(|event| println!("{event:?}")) {
//!         break end;
//!     }
//! };
//! assert_eq!(end.verdict.result, FlightResult::Complete);
//! ```

mod craft_at_boot;
pub mod forecast;
mod hazards;
mod judge;
mod progress;
pub mod setup;
pub mod sweep;
mod truth_check;
mod verdict;
mod waiting;

pub use craft_at_boot::craft_at_boot;
pub use hazards::hazards;
pub use judge::{Judge, JudgeFacts};
use progress::Progress;
pub use setup::FlightSetup;
pub use verdict::{Crash, FlightResult, Verdict};

use nalgebra::Vector2;
use truth_check::{CraftTruth, TruthCheck, agreement};

use crate::firmware::Firmware;
use crate::plan::{FlightPlan, WaypointType};
use crate::signals::SimTime;
use crate::telemetry::{
    CrashCause, Event, EventKind, FirmwareEvent, FlightTruth, Mode, NavEvent, NavState, NavTelemetry,
    PlanSource,
};
use crate::vehicle::{Vehicle, VehicleCommand, VehicleRefusal};

/// The time between two looks of the judge while nothing happens, µs. It is the period of the navigator.
const LOOK_US: u64 = 10_000;

/// The options of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightOptions {
    /// Altitude of the pilot's climb before engaging, m; 0 = engage on the ground.
    pub takeoff_m: f64,
    /// Time of the timeout, counted from boot.
    pub timeout: SimTime,
    /// Permitted distance of the truth beyond a waypoint's own radius, and from its altitude, m.
    pub tolerance_m: f64,
}

impl Default for FlightOptions {
    /// Returns the defaults of `fly`.
    fn default() -> Self {
        Self { takeoff_m: 10.0, timeout: SimTime::from_secs_f64(1800.0), tolerance_m: 10.0 }
    }
}

/// A flight in progress. A copy flies on by itself.
#[derive(Debug, Clone)]
pub struct Flight {
    vehicle: Vehicle,
    judge: Judge,
    touched_down: bool,
    ends_in_land: bool,
    takeoff_m: f64,
    tolerance_m: f64,
    truth_check: TruthCheck,
    /// Events of the navigator in this tick.
    nav_events: Vec<NavEvent>,
    /// True altitude at which the craft was armed, m.
    armed_alt_m: f64,
    battery_empty_at: Option<SimTime>,
    crash: Option<Crash>,
    progress: Progress,
    next_look: SimTime,
}

/// The end of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightEnd {
    /// The result, with its reason.
    pub verdict: Verdict,
    /// The flight as it was, compared with the plan.
    pub truth: FlightTruth,
    /// Simulated seconds from the engagement (or boot, if there was none) to the end.
    pub flown_s: f64,
    /// Simulated time of the end since boot.
    pub time: SimTime,
}

impl Flight {
    /// Returns a flight of the plan that `vehicle` has stored.
    ///
    /// # Errors
    /// Fails if no channel switches a mode that the pilot needs.
    pub fn new(mut vehicle: Vehicle, options: &FlightOptions) -> Result<Self, VehicleRefusal> {
        vehicle.apply(&VehicleCommand::StartPilot(options.takeoff_m)).accepted()?;
        Ok(Self::go_on(vehicle, options))
    }

    /// Continues the present flight of `vehicle`. The source of its sticks does not change.
    pub fn go_on(vehicle: Vehicle, options: &FlightOptions) -> Self {
        let controller = vehicle.controller();
        let flown = vehicle.embedded().and_then(Firmware::active_plan).or(controller.stored_plan());
        let ends_in_land = flown.is_some_and(ends_in_land);
        // The altitude of a craft in the air counts from the place of arming.
        let armed_alt_m = match (vehicle.embedded(), vehicle.truth()) {
            (Some(firmware), Some(truth)) if firmware.is_armed() => truth.pos_enu.z - firmware.altitude_m(),
            _ => 0.0,
        };
        Self {
            vehicle,
            judge: Judge::new(options.timeout),
            touched_down: false,
            ends_in_land,
            takeoff_m: options.takeoff_m,
            tolerance_m: options.tolerance_m,
            truth_check: TruthCheck::new(options.tolerance_m),
            nav_events: Vec::with_capacity(8),
            armed_alt_m,
            battery_empty_at: None,
            crash: None,
            progress: Progress::default(),
            next_look: SimTime::ZERO,
        }
    }

    /// Returns the vehicle, to read its truth, estimate and snapshot.
    pub fn vehicle(&self) -> &Vehicle {
        &self.vehicle
    }

    /// Returns the vehicle, to act on it between two ticks.
    pub fn vehicle_mut(&mut self) -> &mut Vehicle {
        &mut self.vehicle
    }

    /// Returns the vehicle in its state at the end of the flight.
    pub fn into_vehicle(self) -> Vehicle {
        self.vehicle
    }

    /// Returns the time at which the autopilot first engaged.
    pub fn engaged_at(&self) -> Option<SimTime> {
        self.judge.engaged_at()
    }

    /// Flies one tick and reports its events. Returns the end when the flight is over. The judge looks a hundred times a
    /// second, and whenever something happens.
    pub fn tick(&mut self, mut report: impl FnMut(Event)) -> Option<FlightEnd> {
        self.vehicle.tick();
        let (touched_down, nav_events) = (&mut self.touched_down, &mut self.nav_events);
        let battery_empty_at = &mut self.battery_empty_at;
        let (mut was_armed, mut happened, mut impact) = (false, false, None);
        self.vehicle.drain_events(|event| {
            happened = true;
            match &event.kind {
                EventKind::Touchdown { .. } => *touched_down = true,
                EventKind::Firmware(FirmwareEvent::Armed) => {
                    *touched_down = false;
                    was_armed = true;
                }
                EventKind::Firmware(FirmwareEvent::Nav(event)) => nav_events.push(event.clone()),
                EventKind::BatteryEmpty { .. } => *battery_empty_at = Some(event.time),
                EventKind::Crash { cause } => impact = Some(*cause),
                EventKind::Boot { .. }
                | EventKind::Firmware(_)
                | EventKind::Fault { .. }
                | EventKind::Contact { .. }
                | EventKind::Notice(_) => {}
            }
            report(event);
        });
        if was_armed {
            self.armed_alt_m = self.true_alt_m();
        }
        if impact.is_some() {
            self.crash = Some(self.crash_of(impact));
        }
        let now = self.vehicle.time();
        if !happened && now < self.next_look {
            return None;
        }
        self.next_look = SimTime((now.0 / LOOK_US + 1) * LOOK_US);
        self.check_truth();
        self.follow_progress();
        let verdict = self.judge.look(&self.facts())?;
        Some(self.end(verdict))
    }

    /// Ends the flight here and now, on request of the user.
    pub fn interrupt(&self, reason: &str) -> FlightEnd {
        self.end(Verdict::new(FlightResult::Interrupted, reason))
    }

    /// Returns the end of the flight: the verdict on the reports of the firmware, compared with the truth.
    fn end(&self, mut verdict: Verdict) -> FlightEnd {
        let truth = match self.craft_truth() {
            Some(craft) => self.truth_check.truth(&craft, self.battery_used_pct()),
            None => FlightTruth::default(),
        };
        match verdict.result {
            FlightResult::Complete => match self.truth_check.worst_miss(&truth) {
                Some(miss) => {
                    verdict = Verdict::new(
                        FlightResult::Missed,
                        format!("the autopilot says complete, but {miss}"),
                    );
                }
                None => verdict.reason = agreement(&truth).unwrap_or(verdict.reason),
            },
            FlightResult::Timeout if self.judge.engaged_at().is_none() => {
                if let Some(waiting) = waiting::sentence(&self.vehicle, self.takeoff_m) {
                    verdict.reason = format!("{}: {waiting}", verdict.reason);
                }
            }
            FlightResult::Aborted if verdict.reason == judge::UNEXPLAINED => {
                if let Some(progress) = self.progress.sentence() {
                    verdict.reason = format!("{}; {progress}", verdict.reason);
                }
            }
            _ => {}
        }
        if let Some(remark) = self.battery_remark() {
            verdict.reason = format!("{}; {remark}", verdict.reason);
        }
        let time = self.vehicle.time();
        let flown_s = time.seconds_since(self.judge.engaged_at().unwrap_or_default());
        FlightEnd { verdict, truth, flown_s, time }
    }

    /// Compares the waypoints with the truth, if there is a simulated world.
    fn check_truth(&mut self) {
        let Some(craft) = self.craft_truth() else { return };
        if !self.nav_events.is_empty() {
            let settings = self.vehicle.controller().settings_view().unwrap_or_default();
            let Some(frame) = self.vehicle.local_frame() else { return };
            for event in self.nav_events.drain(..) {
                self.truth_check.follow(&event, &craft, &settings, frame);
            }
        }
        self.truth_check.look(&craft);
    }

    /// Returns a crash at the present instant.
    fn crash_of(&self, cause: Option<CrashCause>) -> Crash {
        let nav = self.vehicle.controller().nav();
        let truth = self.vehicle.truth();
        Crash {
            cause,
            state: nav.map_or(NavState::Idle, |nav| nav.state),
            wp: nav.map_or(0, |nav| nav.wp),
            source: nav.map_or(PlanSource::Stored, |nav| nav.source),
            attitude_deg: truth.map(|truth| [truth.roll_deg(), truth.pitch_deg()]),
        }
    }

    /// Notes how the craft gets on towards its waypoint.
    fn follow_progress(&mut self) {
        let Some(nav) = self.vehicle.controller().nav() else { return };
        self.progress.follow(nav.state);
        if nav.state != NavState::Approaching {
            return;
        }
        let (Some(truth), Some(frame)) = (self.vehicle.truth(), self.vehicle.local_frame()) else { return };
        let planned =
            self.vehicle.controller().stored_plan().and_then(|plan| plan.waypoints.get(usize::from(nav.wp)));
        let Some(waypoint) = planned.filter(|_| nav.source == PlanSource::Stored) else { return };
        let target = truth_check::place(frame, waypoint.position);
        let place = Vector2::new(truth.pos_enu.y, truth.pos_enu.x);
        let course = Vector2::new(truth.vel_enu.y, truth.vel_enu.x);
        let heading_deg = truth.heading_deg();
        self.progress.look(self.vehicle.time(), nav.wp, target - place, course, heading_deg);
    }

    fn craft_truth(&self) -> Option<CraftTruth> {
        let truth = self.vehicle.truth()?;
        let nav = self.vehicle.controller().nav();
        Some(CraftTruth {
            time: self.vehicle.time(),
            ne: Vector2::new(truth.pos_enu.y, truth.pos_enu.x),
            alt_m: self.true_alt_m() - self.armed_alt_m,
            speed_mps: truth.vel_enu.xy().norm(),
            stick_override: nav.is_some_and(|nav| nav.stick_override),
            climbing: nav.is_some_and(|nav| nav.climbing),
        })
    }

    /// Returns the true altitude of the centre of mass above the ground at the boot place, m.
    fn true_alt_m(&self) -> f64 {
        self.vehicle.truth().map_or(0.0, |truth| truth.pos_enu.z)
    }

    fn battery_used_pct(&self) -> Option<f64> {
        let battery = self.vehicle.truth()?.battery;
        Some(100.0 * battery.drawn_mah / battery.capacity_mah)
    }

    /// Returns the remark of the verdict if the flight took more charge than the battery has.
    fn battery_remark(&self) -> Option<String> {
        let at = self.battery_empty_at?.as_secs_f64();
        let acts = self.vehicle.world_status().is_some_and(|world| world.switches.battery_sag);
        let pack = if acts { "the battery was" } else { "a real battery would have been" };
        Some(format!("{pack} empty {at:.1} s after boot"))
    }

    fn facts(&self) -> JudgeFacts {
        let controller = self.vehicle.controller();
        let unknown = NavTelemetry::default();
        let nav = controller.nav().unwrap_or(&unknown);
        JudgeFacts {
            time: self.vehicle.time(),
            engaged: controller.modes().has(Mode::Autopilot)
                || nav.source != PlanSource::Stored && nav.engaged,
            armed: controller.is_armed(),
            last_disarm: controller.last_disarm(),
            state: nav.state,
            entered_for: nav.reason,
            alt_m: self.true_alt_m(),
            wp: nav.wp,
            source: nav.source,
            refusal: nav.refusal,
            failsafe: controller.modes().has(Mode::Failsafe),
            ends_in_land: self.ends_in_land,
            lift_share: waiting::lift_share(&self.vehicle),
            touched_down: self.touched_down,
            crash: self.crash.or_else(|| self.vehicle.crashed().then(|| self.crash_of(None))),
            diverged: self.vehicle.diverged(),
        }
    }
}

/// Returns `true` if the last positional waypoint that is flown is a LAND (nothing after a LAND is flown).
fn ends_in_land(plan: &FlightPlan) -> bool {
    plan.waypoints.iter().any(|waypoint| waypoint.kind == WaypointType::Land)
}
