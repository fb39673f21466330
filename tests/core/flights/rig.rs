//! A vehicle, its pilot, and a record of the flight.

use betadeck_core::flight::FlightSetup;
use betadeck_core::plan::FlightPlan;
use betadeck_core::signals::{RC_CHANNELS, SimTime};
use betadeck_core::sim::{Noise, Switches, WindProfile, WorldConfig};
use betadeck_core::telemetry::{
    DisarmReason, Event, EventKind, FirmwareEvent, ModeFlags, NavEvent, NavState, PlanSource,
};
use betadeck_core::vehicle::{CliSession, Vehicle, VehicleCommand};

/// Returns the guide's configuration, Step 5, without its `save`: nothing restarts here.
pub(crate) fn guide_settings() -> impl Iterator<Item = &'static str> {
    include_str!("../../vectors/guide-step5.txt").lines().filter(|line| line.starts_with("set "))
}

/// The true state and the visible output of a flight, sampled a hundred times a second.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// Seconds since engagement (before it: negative).
    pub(crate) t: f64,
    /// The true position from the boot place, m: north, east, up.
    pub(crate) n: f64,
    pub(crate) e: f64,
    pub(crate) alt: f64,
    /// The true velocity, m/s: north, east, up.
    pub(crate) vn: f64,
    pub(crate) ve: f64,
    pub(crate) vu: f64,
    /// The true attitude, degrees: roll right, pitch nose up, heading.
    pub(crate) roll: f64,
    pub(crate) pitch: f64,
    pub(crate) heading: f64,
    pub(crate) throttle_us: f64,
    pub(crate) motors: [f64; 4],
    pub(crate) armed: bool,
    pub(crate) modes: ModeFlags,
    pub(crate) state: NavState,
    pub(crate) wp: u8,
    /// The navigator's distance to the waypoint, m.
    pub(crate) distance: f64,
    pub(crate) hold_remaining_s: f64,
}

impl Sample {
    pub(crate) fn speed(&self) -> f64 {
        self.vn.hypot(self.ve)
    }

    /// Returns the tilt from level, degrees.
    pub(crate) fn tilt(&self) -> f64 {
        (self.roll.to_radians().cos() * self.pitch.to_radians().cos()).acos().to_degrees()
    }

    /// Returns the horizontal distance from a point (north, east), m.
    pub(crate) fn from(&self, point: [f64; 2]) -> f64 {
        (self.n - point[0]).hypot(self.e - point[1])
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transition {
    /// Seconds since engagement.
    pub(crate) t: f64,
    pub(crate) to: NavState,
    pub(crate) wp: u8,
}

/// A recorded flight.
pub(crate) struct Rig {
    pub(crate) vehicle: Vehicle,
    pub(crate) events: Vec<Event>,
    pub(crate) samples: Vec<Sample>,
    standing_m: f64,
}

impl Rig {
    /// Creates a vehicle with the guide's settings and the starter modes in this world, with these additional
    /// CLI lines. The scripted pilot climbs to `takeoff_m` and engages.
    pub(crate) fn new(world: WorldConfig, lines: &str, takeoff_m: f64) -> Self {
        let (vehicle, _) = FlightSetup { world, ..FlightSetup::default() }.build().unwrap();
        let standing_m = vehicle.truth().unwrap().pos_enu.z;
        let mut rig = Self { vehicle, events: Vec::new(), samples: Vec::new(), standing_m };
        rig.cli(&guide_settings().collect::<Vec<_>>().join("\n"));
        rig.cli("set ap_geofence_action = LAND");
        rig.cli(lines);
        rig.vehicle.apply(&VehicleCommand::StartPilot(takeoff_m)).accepted().unwrap();
        rig
    }

    /// Moves a channel of the virtual sticks, from 0.
    pub(crate) fn stick(&mut self, channel: usize, value_us: u16) {
        let mut sticks = self.vehicle.transmitter().sticks();
        sticks.channels[channel] = value_us;
        self.vehicle.apply(&VehicleCommand::Sticks(sticks));
    }

    /// Gives all channels back to the virtual sticks.
    pub(crate) fn release_channels(&mut self) {
        for channel in 0..RC_CHANNELS as u8 {
            self.vehicle.apply(&VehicleCommand::ReleaseChannel(channel));
        }
    }

    /// Types CLI lines. No line may fail.
    pub(crate) fn cli(&mut self, lines: &str) {
        for line in lines.lines() {
            let reply = self.vehicle.apply(&VehicleCommand::line(CliSession::Console, line)).line().unwrap();
            assert!(!reply.failed, "{line}: {}", reply.text);
        }
    }

    /// Runs one step.
    pub(crate) fn tick(&mut self) {
        self.vehicle.tick();
        self.vehicle.drain_events(|event| self.events.push(event));
        if self.vehicle.time().0.is_multiple_of(10_000) {
            self.samples.push(self.sample());
        }
    }

    /// Continues the flight for some simulated seconds.
    pub(crate) fn fly(&mut self, seconds: f64) -> &mut Self {
        let end = self.boot_s() + seconds;
        while self.boot_s() < end {
            self.tick();
        }
        self
    }

    /// Flies until the condition holds. Fails the test if it does not hold within `limit_s` simulated
    /// seconds.
    #[track_caller]
    pub(crate) fn until(
        &mut self,
        limit_s: f64,
        what: &str,
        mut done: impl FnMut(&Self) -> bool,
    ) -> &mut Self {
        let end = self.boot_s() + limit_s;
        while !done(self) {
            assert!(self.boot_s() < end, "never came: {what}\n{}", self.story());
            self.tick();
        }
        self
    }

    /// Flies until the autopilot engages.
    #[track_caller]
    pub(crate) fn engaged(&mut self) -> &mut Self {
        self.until(60.0, "engagement", |rig| rig.vehicle.engaged_at().is_some())
    }

    /// Flies until this state is entered (again).
    #[track_caller]
    pub(crate) fn until_state(&mut self, limit_s: f64, state: NavState) -> &mut Self {
        let seen = self.transitions().len();
        self.until(limit_s, &state.to_string(), |rig| {
            rig.transitions().get(seen..).is_some_and(|new| new.iter().any(|entry| entry.to == state))
        })
    }

    /// Returns the seconds since boot.
    pub(crate) fn boot_s(&self) -> f64 {
        self.vehicle.time().as_secs_f64()
    }

    fn since_engagement(&self, boot_s: f64) -> f64 {
        boot_s - self.vehicle.engaged_at().map_or(1e6, SimTime::as_secs_f64)
    }

    /// Returns the seconds since engagement.
    pub(crate) fn t(&self) -> f64 {
        self.since_engagement(self.boot_s())
    }

    fn sample(&self) -> Sample {
        let truth = self.vehicle.truth().unwrap();
        let firmware = self.vehicle.embedded().unwrap();
        let nav = firmware.nav();
        let craft = firmware.craft_view();
        Sample {
            t: self.t(),
            n: truth.pos_enu.y,
            e: truth.pos_enu.x,
            alt: truth.pos_enu.z - self.standing_m,
            vn: truth.vel_enu.y,
            ve: truth.vel_enu.x,
            vu: truth.vel_enu.z,
            roll: truth.roll_deg(),
            pitch: truth.pitch_deg(),
            heading: truth.heading_deg(),
            throttle_us: craft.throttle_us.unwrap(),
            motors: craft.motors.expect("the embedded firmware reports it"),
            armed: craft.is_armed(),
            modes: craft.modes.unwrap(),
            state: nav.state,
            wp: nav.wp,
            distance: nav.distance_m.unwrap_or(f64::NAN),
            hold_remaining_s: nav.hold_remaining_s.expect("the embedded firmware reports it"),
        }
    }

    /// Returns all state transitions so far.
    pub(crate) fn transitions(&self) -> Vec<Transition> {
        self.events
            .iter()
            .filter_map(|event| match &event.kind {
                EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { to, wp, .. })) => {
                    Some(Transition { t: self.since_engagement(event.time.as_secs_f64()), to: *to, wp: *wp })
                }
                _ => None,
            })
            .collect()
    }

    /// Returns the transitions as words: `APPROACHING 0, ARRIVED 0, …`.
    pub(crate) fn path(&self) -> String {
        let words: Vec<_> =
            self.transitions().iter().map(|entry| format!("{} {}", entry.to, entry.wp)).collect();
        words.join(", ")
    }

    /// Returns the time at which a state was first entered with this waypoint, s since engagement.
    #[track_caller]
    pub(crate) fn entered(&self, state: NavState, wp: u8) -> f64 {
        let found = self.transitions().into_iter().find(|entry| entry.to == state && entry.wp == wp);
        found.unwrap_or_else(|| panic!("{state} {wp} never came\n{}", self.story())).t
    }

    /// Returns the samples of a span of time since engagement.
    pub(crate) fn span(&self, from: f64, to: f64) -> impl Iterator<Item = &Sample> {
        self.samples.iter().filter(move |sample| from <= sample.t && sample.t < to)
    }

    /// Returns the first sample at or after a time since engagement.
    #[track_caller]
    pub(crate) fn at(&self, t: f64) -> &Sample {
        self.samples.iter().find(|sample| sample.t >= t - 1e-9).unwrap()
    }

    /// Returns the time of the first event that `pick` accepts, s since engagement.
    pub(crate) fn event_at(&self, pick: impl Fn(&EventKind) -> bool) -> Option<f64> {
        let event = self.events.iter().find(|event| pick(&event.kind))?;
        Some(self.since_engagement(event.time.as_secs_f64()))
    }

    /// Returns the time and the reason of the disarm.
    pub(crate) fn disarmed(&self) -> Option<(f64, DisarmReason)> {
        self.events.iter().find_map(|event| match event.kind {
            EventKind::Firmware(FirmwareEvent::Disarmed(reason)) => {
                Some((self.since_engagement(event.time.as_secs_f64()), reason))
            }
            _ => None,
        })
    }

    /// Returns the plans that became active, with their sources.
    pub(crate) fn plans(&self) -> Vec<(PlanSource, FlightPlan)> {
        self.events
            .iter()
            .filter_map(|event| match &event.kind {
                EventKind::Firmware(FirmwareEvent::Nav(NavEvent::Plan { source, plan })) => {
                    Some((*source, (**plan).clone()))
                }
                _ => None,
            })
            .collect()
    }

    /// Returns the position of a plan's point from the boot place in the world's projection (north, east), m.
    pub(crate) fn place(&self, position: betadeck_core::geo::LatLon) -> [f64; 2] {
        let enu = self.vehicle.local_frame().unwrap().to_enu(position.lat_deg(), position.lon_deg(), 0.0);
        [enu.y, enu.x]
    }

    /// Returns the position of a waypoint of the stored plan.
    pub(crate) fn waypoint(&self, index: usize) -> [f64; 2] {
        self.place(self.vehicle.embedded().unwrap().stored_plan().waypoints[index].position)
    }

    /// Returns one line per event, for failure messages.
    pub(crate) fn story(&self) -> String {
        self.events
            .iter()
            .map(|event| {
                format!("{:8.3} {:?}\n", self.since_engagement(event.time.as_secs_f64()), event.kind)
            })
            .collect()
    }
}

/// The tolerance on top of the plain bounds, because sensors have errors.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Allowance {
    /// The horizontal tolerance, m.
    pub(crate) h: f64,
    /// The vertical tolerance, m.
    pub(crate) v: f64,
    /// The tolerance of speeds, m/s.
    pub(crate) speed: f64,
    /// The tolerance of angles, degrees.
    pub(crate) angle: f64,
}

/// Returns a calm world and its tolerances, with exact sensors (seed 0) or real ones of this seed.
pub(crate) fn world(seed: u64) -> (WorldConfig, Allowance) {
    let switches = Switches { wind_profile: WindProfile::Flat, ..Switches::default() };
    let plain = WorldConfig { switches, noise: Noise::None, ..WorldConfig::default() };
    match seed {
        0 => (plain, Allowance::default()),
        seed => (
            WorldConfig { noise: Noise::Real, seed, ..plain },
            Allowance { h: 1.0, v: 0.5, speed: 0.15, angle: 3.0 },
        ),
    }
}

/// The seeds of a check: 0 = exact sensors.
pub(crate) const SEEDS: [u64; 6] = [0, 1, 2, 3, 4, 5];
