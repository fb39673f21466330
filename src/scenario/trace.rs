//! The record of a flight: samples, happenings, guards and plans.

use std::hash::{DefaultHasher, Hash as _, Hasher as _};

use super::happening::Happening;
use crate::geo::LocalFrame;
use crate::plan::FlightPlan;
use crate::scenario::flag::Flag;
use crate::signals::SimTime;
use crate::telemetry::signal::{Signal, SignalValues};
use crate::telemetry::{Guard, GuardName, ModeFlags, NavState, PlanSource};

/// The state of the craft at an instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Simulated time since boot.
    pub time: SimTime,
    /// The values of all signals.
    pub values: SignalValues,
    /// The flags, one bit each.
    pub flags: u16,
    /// The state of the state machine.
    pub state: NavState,
    /// Index of the current waypoint.
    pub wp: u8,
    /// Origin of the active plan.
    pub source: PlanSource,
    /// The active modes.
    pub modes: ModeFlags,
    /// The navigator's target, m north and east of the boot place; NaN = none.
    pub target_ne: [f32; 2],
}

impl Sample {
    /// Returns the value of a signal, in its unit; NaN if it is unknown.
    pub fn value(&self, signal: Signal) -> f64 {
        self.values.get(signal)
    }

    /// Returns `true` if a flag is set.
    pub fn has(&self, flag: Flag) -> bool {
        self.flags & (1 << flag as u8) != 0
    }

    /// Returns the true position north and east of the boot place, m.
    pub fn place(&self) -> [f64; 2] {
        [self.value(Signal::North), self.value(Signal::East)]
    }
}

/// The number of signals in the hash of a flight. Later signals are left out, so that a new signal does not change it.
const HASHED_SIGNALS: usize = Signal::Satellites as usize + 1;

/// The closest approach of a guard to firing during a state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearestGuard {
    /// The guard at its closest.
    pub guard: Guard,
    /// Simulated time since boot.
    pub time: SimTime,
}

/// A stay in a state, with the guards that were checked.
#[derive(Debug, Clone, PartialEq)]
pub struct Stay {
    /// Simulated time of the entry since boot.
    pub since: SimTime,
    /// The state.
    pub state: NavState,
    /// Index of the waypoint in the active plan.
    pub wp: u8,
    /// The guards at their closest.
    pub guards: Vec<NearestGuard>,
}

/// A plan of a flight.
#[derive(Debug, Clone)]
pub struct KnownPlan {
    /// The time from which it is active.
    pub since: SimTime,
    /// Its origin.
    pub source: PlanSource,
    /// The plan.
    pub plan: FlightPlan,
}

/// The record of a flight.
#[derive(Debug, Clone)]
pub struct Trace {
    /// Samples, oldest first, at equal intervals.
    pub samples: Vec<Sample>,
    /// Happenings, oldest first.
    pub happenings: Vec<Happening>,
    /// Stays in states, oldest first.
    pub stays: Vec<Stay>,
    /// Plans: the scenario's own, then those that became active.
    pub plans: Vec<KnownPlan>,
    /// The local frame, north and east from the boot place.
    pub frame: Option<LocalFrame>,
    /// Time of the first engagement since boot.
    pub engaged_at: Option<SimTime>,
}

impl Trace {
    /// Creates an empty record for a flight of this plan.
    pub fn new(plan: FlightPlan, frame: Option<LocalFrame>) -> Self {
        Self {
            samples: Vec::new(),
            happenings: Vec::new(),
            stays: Vec::new(),
            plans: vec![KnownPlan { since: SimTime::ZERO, source: PlanSource::Stored, plan }],
            frame,
            engaged_at: None,
        }
    }

    /// Creates a record of one sample with only unknown values. Comparisons of several flights are evaluated on it.
    pub(super) fn from_nothing() -> Self {
        let sample = Sample {
            time: SimTime::ZERO,
            values: SignalValues::UNKNOWN,
            flags: 0,
            state: NavState::Idle,
            wp: 0,
            source: PlanSource::Stored,
            modes: ModeFlags::NONE,
            target_ne: [f32::NAN; 2],
        };
        Self { samples: vec![sample], ..Self::new(FlightPlan::default(), None) }
    }

    /// Returns the first sample at or after a time, µs since boot.
    pub fn index_at(&self, time_us: i64) -> Option<usize> {
        let index = self.samples.partition_point(|sample| (sample.time.0 as i64) < time_us);
        (index < self.samples.len()).then_some(index)
    }

    /// Returns the end of the record.
    pub fn end(&self) -> SimTime {
        let sampled = self.samples.last().map_or(SimTime::ZERO, |sample| sample.time);
        self.happenings.last().map_or(sampled, |happening| happening.time.max(sampled))
    }

    /// Returns the plan of an origin at an instant: the newest one active by then, else the first.
    pub fn plan(&self, source: PlanSource, at: SimTime) -> Option<&FlightPlan> {
        let of_source = || self.plans.iter().filter(|known| known.source == source);
        let known = of_source().rfind(|known| known.since <= at).or_else(|| of_source().next());
        known.map(|known| &known.plan)
    }

    /// Returns the position of a waypoint of the plan of an origin at an instant, m north and east of the boot place.
    pub fn waypoint(&self, index: u8, source: PlanSource, at: SimTime) -> Option<[f64; 2]> {
        let plan = self.plan(source, at)?;
        let position = plan.waypoints.get(usize::from(index))?.position;
        let frame = self.frame?;
        let enu = frame.to_enu(position.lat_deg(), position.lon_deg(), frame.alt_amsl_m);
        Some([enu.y, enu.x])
    }

    /// Returns the seconds since the first engagement, or since boot if there was none.
    pub fn seconds(&self, time: SimTime) -> f64 {
        time.as_secs_f64() - self.engaged_at.map_or(0.0, SimTime::as_secs_f64)
    }

    /// Returns a time for people: `34.2 s`, counted as in [`Self::seconds`], with `after boot` if that applies.
    pub fn shown_time(&self, time: SimTime) -> String {
        let from = if self.engaged_at.is_some() { "" } else { " after boot" };
        format!("{:.2} s{from}", self.seconds(time))
    }

    /// Notes the closest approach of the guards of a state to firing.
    pub fn note_guards(&mut self, time: SimTime, state: NavState, wp: u8, guards: &[Guard]) {
        if self.stays.last().is_none_or(|stay| stay.state != state || stay.wp != wp) {
            self.stays.push(Stay { since: time, state, wp, guards: Vec::new() });
        }
        let Some(stay) = self.stays.last_mut() else { return };
        for guard in guards.iter().filter(|guard| guard.value.is_finite() && guard.limit.is_finite()) {
            let same = |nearest: &&mut NearestGuard| nearest.guard.name == guard.name;
            match stay.guards.iter_mut().find(same) {
                Some(nearest) if guard.margin() > nearest.guard.margin() => {
                    *nearest = NearestGuard { guard: *guard, time };
                }
                Some(_) => {}
                None => stay.guards.push(NearestGuard { guard: *guard, time }),
            }
        }
    }

    /// Returns the guard that did not fire in a stay but came closest, among those that end the state in the usual way.
    pub fn nearest_guard(stay: &Stay) -> Option<&NearestGuard> {
        /// Guards that end a mission early. It is normal that they do not fire.
        const PROTECTION: [GuardName; 5] =
            [GuardName::Fix, GuardName::Plan, GuardName::Fence, GuardName::NoProgress, GuardName::Flyaway];
        stay.guards
            .iter()
            .filter(|nearest| !PROTECTION.contains(&nearest.guard.name) && nearest.guard.margin() < 0.0)
            .max_by(|a, b| share(&a.guard).total_cmp(&share(&b.guard)))
    }

    /// Returns a number that is equal for two flights whose samples and happenings are the same to the last bit. It
    /// is compared only within one run, because processors differ.
    pub fn hash(&self) -> u64 {
        let mut hasher = TraceHasher::default();
        self.samples.iter().for_each(|sample| hasher.sample(sample));
        hasher.finish(&self.happenings)
    }
}

/// The hash of a record in progress. It needs no sample twice.
#[derive(Debug, Default)]
pub(super) struct TraceHasher(DefaultHasher);

impl TraceHasher {
    /// Adds the next sample.
    pub(super) fn sample(&mut self, sample: &Sample) {
        let hasher = &mut self.0;
        sample.time.0.hash(hasher);
        // One row of bytes is hashed faster than numbers one by one, and alike.
        let mut row = [0; 4 * (HASHED_SIGNALS + 2)];
        let values = sample.values.iter().take(HASHED_SIGNALS).chain(sample.target_ne);
        for (bytes, value) in row.as_chunks_mut().0.iter_mut().zip(values) {
            *bytes = value.to_bits().to_ne_bytes();
        }
        hasher.write(&row);
        (sample.flags, sample.state, sample.wp, sample.source, sample.modes).hash(hasher);
    }

    /// Returns the hash of the samples and of all happenings.
    pub(super) fn finish(mut self, happenings: &[Happening]) -> u64 {
        for happening in happenings {
            happening.time.0.hash(&mut self.0);
            happening.to_string().hash(&mut self.0);
        }
        self.0.finish()
    }
}

/// Returns the margin of a guard as a share of its limit.
fn share(guard: &Guard) -> f64 {
    guard.margin() / guard.limit.abs().max(1e-3)
}
