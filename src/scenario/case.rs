//! A scenario read from its file: the cases, and the expectations of each case.

use super::air::Air;
use super::campaign_spec::CampaignSpec;
use super::expression::{Comparison, Condition, Instant, Number};
use super::happening::Pattern;
use super::input::TimedInput;
use crate::flight::{FlightOptions, FlightSetup};
use crate::telemetry::quantity::Dimension;
use crate::telemetry::{FirmwareProfile, NavState, PlanSource};

/// The keys of the command lines that are written in the scenario itself.
pub(super) const OWN_LINES: [&str; 2] = ["settings", "lines"];

/// The default time for which the record goes on after the end, s. Consequences of the end, such as the disarm,
/// belong to the flight.
pub(super) const WATCH_S: f64 = 0.5;
/// The default number of samples a second.
pub(super) const SAMPLE_HZ: f64 = 100.0;

/// A scenario: a plan, the air, inputs and expectations.
#[derive(Debug, Clone)]
pub struct Scenario {
    /// The file, as its user named it.
    pub file: String,
    /// The name from the file's text, or else the name of the file.
    pub name: String,
    /// A description for people.
    pub description: String,
    /// `true` if the scenario is flown only on request.
    pub slow: bool,
    /// The flights, at least one.
    pub cases: Vec<Case>,
    /// Expectations that compare several flights.
    pub compares: Vec<Compare>,
    /// What a campaign varies from flight to flight; `None` if the cases and their airs are all flights.
    pub campaign: Option<CampaignSpec>,
}

/// The flights of one set-up.
#[derive(Debug, Clone)]
pub struct Case {
    /// The name that tells this case from the others; empty when there is only one.
    pub name: String,
    /// The name that the file gives.
    pub base: String,
    /// The name of the variant; empty if there is none.
    pub variant: String,
    /// The varied keys with the values of this case, for people.
    pub varied: Vec<(String, String)>,
    /// The air of each seed. Of a campaign that draws its flights, the one of the first.
    pub airs: Vec<Air>,
    /// The start of the flight, apart from the air.
    pub setup: FlightSetup,
    /// The options of the flight.
    pub options: FlightOptions,
    /// `true` if the scripted pilot flies; otherwise only inputs move the sticks.
    pub pilot: bool,
    /// The time limit of the flight, s after the engagement.
    pub time_limit_s: f64,
    /// The time for which the flight is watched after its end, s.
    pub watch_s: f64,
    /// The instant at which the scenario ends the flight.
    pub ends: Option<Instant>,
    /// Samples per second of simulated time, Hz.
    pub sample_hz: f64,
    /// Named numbers.
    pub parameters: Vec<(String, f64)>,
    /// The inputs to the craft.
    pub inputs: Vec<TimedInput>,
    /// Numbers taken from the flight.
    pub measures: Vec<Measure>,
    /// The expectations, in the order of the file.
    pub expectations: Vec<Expectation>,
}

impl Scenario {
    /// Flies every case by the laws of a profile.
    pub fn use_profile(&mut self, profile: FirmwareProfile) {
        self.cases.iter_mut().for_each(|case| case.use_profile(profile));
    }
}

impl Case {
    /// Returns the command lines that the scenario itself gives, without those of settings files.
    pub fn own_lines(&self) -> impl Iterator<Item = &str> {
        let own = self.setup.boot_lines.iter().filter(|lines| OWN_LINES.contains(&lines.source.as_str()));
        own.flat_map(|lines| lines.text.lines())
    }

    /// Flies by the laws of a profile.
    pub fn use_profile(&mut self, profile: FirmwareProfile) {
        self.setup.use_profile(profile, false);
    }

    /// Returns the start of the flight in the given air.
    pub fn setup_in(&self, air: &Air) -> FlightSetup {
        let mut setup = self.setup.clone();
        setup.world.seed = air.seed;
        setup.world.wind = air.wind;
        setup.world.gust_mps = air.gust_mps;
        setup.world.turbulence = air.turbulence;
        setup.world.noise = air.noise;
        setup
    }
}

/// The widening of the bounds of expectations when sensors err.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Allowance {
    /// Horizontal distances, m.
    pub horizontal_m: f64,
    /// Altitudes, m.
    pub vertical_m: f64,
    /// Speeds, m/s.
    pub speed_mps: f64,
    /// Angles, degrees.
    pub angle_deg: f64,
}

/// A part of a flight.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Window {
    /// The beginning; `None` = at the first engagement, or at boot if there is no engagement.
    pub from: Option<Instant>,
    /// The end; `None` = at the end of the record.
    pub until: Option<Instant>,
}

/// A number taken from a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// The name in expressions and results.
    pub name: String,
    /// The dimension of the number.
    pub dimension: Dimension,
    /// The way in which the number is taken.
    pub measured: Measured,
    /// The direction in which the number improves; `None` = neither.
    pub better: Option<Better>,
}

/// The direction in which a number of a flight improves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::EnumString)]
#[strum(serialize_all = "lowercase")]
pub enum Better {
    /// Smaller numbers are better.
    Less,
    /// Greater numbers are better.
    More,
}

/// A way to take a number from a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Measured {
    /// A statistic over a part of the flight.
    Over(Window, Statistic, Number),
    /// The value at an instant.
    At(Instant, Number),
    /// The time between two instants, s.
    Time(Instant, Instant),
    /// The value of a number of measures and parameters.
    Of(Number),
}

/// A way to make one number of many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Statistic {
    /// The mean.
    Mean,
    /// Root of the mean square.
    Rms,
    /// The greatest value.
    Max,
    /// The smallest value.
    Min,
}

/// An expectation about a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// The name of the expectation, or else its text.
    pub label: String,
    /// Line in the file, from 1.
    pub line: usize,
    /// The kind of firmware for which it holds; `None` = all.
    pub firmware: Option<FirmwareProfile>,
    /// The part of the flight in which it is judged.
    pub window: Window,
    /// The expectation itself.
    pub expected: Expected,
}

/// An expectation of a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// The flight ends with one of these results.
    Result(Vec<String>),
    /// The states from the engagement on, in this order.
    States(Vec<StateStep>),
    /// Something happens: `count` times if that is given, else at least once.
    Event {
        /// The happenings that count.
        pattern: Pattern,
        /// The number of happenings; `None` = at least one.
        count: Option<usize>,
        /// The bounds for the time of the first one, seconds after an instant.
        within: Option<(f64, f64, Instant)>,
        /// A condition that holds at that time; it may use the numbers of the happening.
        with: Option<Condition>,
    },
    /// A happening that does not come.
    NoEvent(Pattern),
    /// The condition holds at every sample of the window, or (`true`) at none.
    Always(Condition, bool),
    /// The condition holds at some sample of the window.
    Eventually(Condition),
    /// The condition holds at this share of the samples of the window, 0…1.
    Mostly(Condition, f64),
    /// A statistic of all samples of the window.
    Statistic(Statistic, Comparison),
    /// The condition holds at an instant.
    At(Instant, Condition),
    /// The condition holds for measures and parameters.
    That(Condition),
}

impl Expectation {
    /// Returns `true` if it holds for this kind of firmware. A firmware of an unknown kind must meet what holds for all.
    pub fn holds_for(&self, firmware: Option<FirmwareProfile>) -> bool {
        self.firmware.is_none_or(|own| Some(own) == firmware)
    }
}

/// A step of an expected order of states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateStep {
    /// The entry into a state.
    Enter {
        /// The state.
        state: NavState,
        /// Index of the waypoint; `None` = any.
        wp: Option<u8>,
        /// The origin of the plan.
        source: Option<PlanSource>,
    },
    /// Any states, or none.
    Any,
}

/// An expectation that compares several flights with the same seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Compare {
    /// The name of the comparison.
    pub label: String,
    /// Line in the file, from 1.
    pub line: usize,
    /// The kind of firmware for which it holds; `None` = all.
    pub firmware: Option<FirmwareProfile>,
    /// The condition on their measures, `CASE.MEASURE`.
    pub that: Condition,
}

impl Compare {
    /// Returns `true` if it holds for this kind of firmware, as [`Expectation::holds_for`] does.
    pub fn holds_for(&self, firmware: Option<FirmwareProfile>) -> bool {
        self.firmware.is_none_or(|own| Some(own) == firmware)
    }
}
