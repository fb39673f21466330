//! A mission (plan, craft, air) and its outcome.

use betadeck_core::firmware::config::Configuration;
use betadeck_core::flight::setup::BootLines;
use betadeck_core::flight::{Flight, FlightEnd, FlightOptions, FlightResult, FlightSetup};
use betadeck_core::geo::{LatLon, LocalFrame};
use betadeck_core::plan::FlightPlan;
use betadeck_core::plan::format::{Format, HomePosition, parse};
use betadeck_core::signals::SimTime;
use betadeck_core::sim::WorldConfig;
use betadeck_core::telemetry::{DisarmReason, EventKind, FirmwareEvent, NavEvent, NavState};
use nalgebra::Vector2;

/// A plan with the world, the settings and the takeoff to fly it with.
#[derive(Debug, Clone)]
pub(crate) struct Mission {
    pub(crate) world: WorldConfig,
    pub(crate) plan: FlightPlan,
    /// `set` lines, as `name = value`.
    pub(crate) settings: Vec<String>,
    pub(crate) takeoff_m: f64,
    pub(crate) timeout_s: f64,
}

/// The result of a flown mission, with its true path.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) end: FlightEnd,
    /// The greatest true altitude before the engagement, m.
    pub(crate) climbed_m: f64,
    /// `true` if the thrust limited the tilt.
    pub(crate) limited: bool,
    /// The reason of each disarm, with the true altitude, m.
    pub(crate) disarms: Vec<(DisarmReason, f64)>,
    pub(crate) is_finite: bool,
    /// The true positions of the craft, every 20 ms from the engagement on.
    pub(crate) path: Vec<Instant>,
    /// The states entered, each with the time since the engagement, s.
    pub(crate) states: Vec<(f64, NavState)>,
    /// The frame of the path.
    pub(crate) frame: LocalFrame,
}

/// A true position of the craft.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Instant {
    /// North and east of the boot position, m.
    pub(crate) ne: Vector2<f64>,
    /// The altitude above the boot position, m.
    pub(crate) alt_m: f64,
}

/// Ticks between two instants of the path.
const PATH_TICKS: u64 = 20;

impl Outcome {
    pub(crate) fn result(&self) -> FlightResult {
        self.end.verdict.result
    }
}

/// Parses a plan of CLI lines.
pub(crate) fn plan(lines: &str) -> FlightPlan {
    parse("test", lines, Format::CliText).unwrap().plan
}

impl Mission {
    pub(crate) fn new(plan: FlightPlan) -> Self {
        Self { world: WorldConfig::default(), plan, settings: Vec::new(), takeoff_m: 10.0, timeout_s: 900.0 }
    }

    pub(crate) fn set(mut self, name: &str, value: impl ToString) -> Self {
        self.settings.push(format!("{name} = {}", value.to_string()));
        self
    }

    pub(crate) fn fly(self) -> Outcome {
        let stored = Configuration { plan: self.plan, ..Configuration::default() };
        let boot_lines = vec![BootLines::settings("settings", &self.settings)];
        let at = self.world.home;
        let home = Some(HomePosition {
            position: LatLon::from_degrees(at.lat_deg, at.lon_deg),
            amsl_m: Some(at.alt_amsl_m),
        });
        let setup = FlightSetup { world: self.world, home, stored, boot_lines, ..FlightSetup::default() };
        let (vehicle, _) = setup.build().unwrap();
        let standing_m = vehicle.truth().unwrap().pos_enu.z;
        let options = FlightOptions {
            takeoff_m: self.takeoff_m,
            timeout: SimTime::from_secs_f64(self.timeout_s),
            ..FlightOptions::default()
        };
        let mut flight = Flight::new(vehicle, &options).unwrap();
        let (mut climbed_m, mut limited, mut is_finite) = (0.0_f64, false, true);
        let (mut disarms, mut path, mut states) = (Vec::new(), Vec::new(), Vec::new());
        let frame = *flight.vehicle().local_frame().unwrap();
        let mut tick = 0_u64;
        loop {
            let (mut disarmed, mut entered) = (None, None);
            let end = flight.tick(|event| match event.kind {
                EventKind::Firmware(FirmwareEvent::Disarmed(reason)) => disarmed = Some(reason),
                EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Limited { .. })) => limited = true,
                EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { to, .. })) => entered = Some(to),
                _ => {}
            });
            let truth = flight.vehicle().truth().unwrap();
            let altitude_m = truth.pos_enu.z - standing_m;
            is_finite &= truth.pos_enu.iter().chain(truth.vel_enu.iter()).all(|value| value.is_finite());
            tick += 1;
            match flight.engaged_at() {
                None => climbed_m = climbed_m.max(altitude_m),
                Some(engaged_at) => {
                    if tick.is_multiple_of(PATH_TICKS) {
                        path.push(Instant {
                            ne: Vector2::new(truth.pos_enu.y, truth.pos_enu.x),
                            alt_m: altitude_m,
                        });
                    }
                    let since_s = flight.vehicle().time().seconds_since(engaged_at);
                    states.extend(entered.map(|state| (since_s, state)));
                }
            }
            disarms.extend(disarmed.map(|reason| (reason, altitude_m)));
            if let Some(end) = end {
                return Outcome { end, climbed_m, limited, disarms, is_finite, path, states, frame };
            }
        }
    }
}

/// Panics with all complaints if there are any.
#[track_caller]
pub(crate) fn assert_none(complaints: impl IntoIterator<Item = Option<String>>) {
    let complaints: Vec<String> = complaints.into_iter().flatten().collect();
    assert!(complaints.is_empty(), "{} missions:\n{}", complaints.len(), complaints.join("\n"));
}
