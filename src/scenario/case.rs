//! A scenario that was read: its cases, and what is expected of each.

use super::expression::{Comparison, Condition, Instant, Number};
use super::happening::Pattern;
use super::input::TimedInput;
use super::quantity::Dimension;
use crate::flight::{FlightOptions, FlightSetup};
use crate::sim::{Noise, Turbulence, Wind};
use crate::telemetry::{NavState, PlanSource};

/// The sources of command lines that stand in the scenario itself: their keys.
pub(super) const OWN_LINES: [&str; 2] = ["settings", "lines"];

#[derive(Debug, Clone)]
pub struct Scenario {
    /// The file, as its user named it.
    pub file: String,
    /// Its name: what the file says, or the file's name.
    pub name: String,
    /// What it shows, for people.
    pub description: String,
    /// Flown only when asked for.
    pub slow: bool,
    /// The flights, at least one.
    pub cases: Vec<Case>,
    /// What is expected of several flights together.
    pub compares: Vec<Compare>,
}

/// The flights of one set-up.
#[derive(Debug, Clone)]
pub struct Case {
    /// What tells it from the other cases; empty when there is only one.
    pub name: String,
    /// The name that the file gives.
    pub base: String,
    pub variant: String,
    /// The air of each seed.
    pub airs: Vec<Air>,
    /// What the flight starts from, but for the air.
    pub setup: FlightSetup,
    /// How it is flown.
    pub options: FlightOptions,
    /// The scripted pilot flies; else nobody moves the sticks but the inputs.
    pub pilot: bool,
    /// When to give up, s after the engagement.
    pub time_limit_s: f64,
    /// How long to look on after the end, s.
    pub watch_s: f64,
    /// When the scenario ends the flight.
    pub ends: Option<Instant>,
    pub sample_hz: f64,
    /// Numbers with a name.
    pub parameters: Vec<(String, f64)>,
    /// What is done to the craft.
    pub inputs: Vec<TimedInput>,
    /// Numbers taken from the flight.
    pub measures: Vec<Measure>,
    pub expectations: Vec<Expectation>,
}

/// The air and the sensors of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Seed of all randomness.
    pub seed: u64,
    pub wind: Wind,
    /// Size of random gusts, m/s.
    pub gust_mps: f64,
    pub turbulence: Turbulence,
    pub noise: Noise,
}

impl Case {
    /// The command lines that the scenario itself gives, without those of settings files.
    pub fn own_lines(&self) -> impl Iterator<Item = &str> {
        let own = self.setup.boot_lines.iter().filter(|lines| OWN_LINES.contains(&lines.source.as_str()));
        own.flat_map(|lines| lines.text.lines())
    }

    /// What the flight of an air starts from.
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

/// What is added to the bounds of expectations when sensors err.
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
    /// Where it begins; `None` = at the first engagement, or at boot when there is none.
    pub from: Option<Instant>,
    /// Where it ends; `None` = at the end of the record.
    pub until: Option<Instant>,
}

/// A number taken from a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    pub name: String,
    pub dimension: Dimension,
    /// How it is taken.
    pub measured: Measured,
}

/// How a number is taken from a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Measured {
    /// Over a part of the flight.
    Over(Window, Statistic, Number),
    At(Instant, Number),
    /// The time between two instants, s.
    Time(Instant, Instant),
    Of(Number),
}

/// One number of many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Statistic {
    Mean,
    /// Root of the mean square.
    Rms,
    Max,
    Min,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// What it is called: its name, or the text that says it.
    pub label: String,
    /// Line in the file, from 1.
    pub line: usize,
    /// The part of the flight that it is about.
    pub window: Window,
    pub expected: Expected,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// The flight ends with one of these results.
    Result(Vec<String>),
    /// The states from the engagement on, in this order.
    States(Vec<StateStep>),
    /// Something happens: as often as `count` says, else at least once.
    Event {
        pattern: Pattern,
        count: Option<usize>,
        /// The first of them, seconds after an instant.
        within: Option<(f64, f64, Instant)>,
        /// What holds then, with the numbers of the happening.
        with: Option<Condition>,
    },
    /// It does not happen.
    NoEvent(Pattern),
    /// It holds at every sample of the window, or (`true`) at none.
    Always(Condition, bool),
    /// It holds at some sample of the window.
    Eventually(Condition),
    /// It holds at this share of the samples of the window, 0…1.
    Mostly(Condition, f64),
    /// A number of all samples of the window.
    Statistic(Statistic, Comparison),
    /// It holds at an instant.
    At(Instant, Condition),
    /// It holds of measures and parameters.
    That(Condition),
}

/// A step of an expected order of states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StateStep {
    Enter {
        state: NavState,
        wp: Option<u8>,
        /// Of a plan of this origin.
        source: Option<PlanSource>,
    },
    /// Any states, or none.
    Any,
}

/// What is expected of several flights with the same seed.
#[derive(Debug, Clone, PartialEq)]
pub struct Compare {
    /// What it is called.
    pub label: String,
    /// Line in the file, from 1.
    pub line: usize,
    /// What holds of their measures, `CASE.MEASURE`.
    pub that: Condition,
}
