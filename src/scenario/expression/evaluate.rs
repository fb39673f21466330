//! Values of numbers, conditions and instants in a recorded flight.

use super::lookup::Lookups;
use super::{Bound, Comparison, Condition, Function, Instant, Number, Place};
use crate::math;
use crate::scenario::flag::Flag;
use crate::scenario::happening::Happening;
use crate::scenario::trace::{Sample, Trace};
use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;

/// The interval for a rate of change, µs.
const RATE_US: u64 = 100_000;

/// A value, its bounds, and its distance from them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Verdict {
    /// The number, in SI units and degrees.
    pub value: f64,
    /// The smallest allowed value.
    pub low: f64,
    /// The greatest allowed value.
    pub high: f64,
    /// The dimension of the number.
    pub dimension: Dimension,
    /// `true` if the bounds themselves are not allowed.
    pub strict: bool,
}

impl Verdict {
    /// Returns the distance to the nearer bound, negative outside.
    pub fn margin(&self) -> f64 {
        (self.value - self.low).min(self.high - self.value)
    }

    /// Returns `true` if the value is allowed.
    pub fn holds(&self) -> bool {
        if self.strict { self.margin() > 0.0 } else { self.margin() >= 0.0 }
    }

    /// Returns the margin as a share of the half width of the range, or of the limit if there is only one. For a
    /// number that must be exact, the share is 1 or −1.
    pub fn share(&self) -> f64 {
        if self.low >= self.high {
            return if self.holds() { 1.0 } else { -1.0 };
        }
        let room = match (self.low.is_finite(), self.high.is_finite()) {
            (true, true) => (self.high - self.low) / 2.0,
            (true, false) => self.low.abs(),
            (false, _) => self.high.abs(),
        };
        let margin = self.margin();
        if room > 1e-9 { margin / room } else { margin.clamp(-1.0, 1.0) }
    }
}

/// Evaluates expressions over a flight.
#[derive(Debug)]
pub struct Evaluator<'a> {
    trace: &'a Trace,
    names: &'a [(String, f64)],
    /// The instants looked up so far, if they are not those of a flight in progress.
    own: Lookups,
    in_flight: Option<&'a Lookups>,
    /// The number of conditions judged.
    #[cfg(test)]
    pub(super) judged: std::cell::Cell<usize>,
}

impl<'a> Evaluator<'a> {
    /// Creates an evaluator for a flight with these parameters and measures.
    pub fn new(trace: &'a Trace, names: &'a [(String, f64)]) -> Self {
        Self {
            trace,
            names,
            own: Lookups::default(),
            in_flight: None,
            #[cfg(test)]
            judged: std::cell::Cell::default(),
        }
    }

    /// Creates an evaluator for a flight in progress, which goes on with its lookups.
    pub fn in_flight(trace: &'a Trace, names: &'a [(String, f64)], lookups: &'a Lookups) -> Self {
        Self { in_flight: Some(lookups), ..Self::new(trace, names) }
    }

    /// Returns the record of the flight.
    pub fn trace(&self) -> &'a Trace {
        self.trace
    }

    /// Returns the time of an instant, µs since boot; `None` if it did not come.
    pub fn instant(&self, instant: &Instant) -> Option<i64> {
        self.in_flight.unwrap_or(&self.own).find(instant, self)
    }

    /// Returns a number at a sample; NaN = unknown.
    pub fn number(&self, number: &Number, index: usize) -> f64 {
        self.number_of(number, index, None)
    }

    /// Returns a number at a sample; it may use the numbers of a happening.
    pub fn number_of(&self, number: &Number, index: usize, happening: Option<&Happening>) -> f64 {
        let Some(sample) = self.trace.samples.get(index) else { return f64::NAN };
        let at = |number| self.number_of(number, index, happening);
        match number {
            Number::Literal(value, _) => *value,
            Number::Signal(signal) => sample.value(*signal),
            Number::Field(field) => {
                happening.and_then(|happening| happening.field(*field)).unwrap_or(f64::NAN)
            }
            Number::Name(name) => {
                self.names.iter().find(|(known, _)| known == name).map_or(f64::NAN, |&(_, value)| value)
            }
            Number::Negative(inner) => -at(inner),
            Number::Join(operator, left, right) => operator.apply(at(left), at(right)),
            Number::Call(function, arguments) => {
                let first = arguments.first().map_or(f64::NAN, at);
                let second = arguments.get(1).map_or(f64::NAN, at);
                function.apply(first, second)
            }
            Number::Distance(place) => {
                self.offset(place, sample).map_or(f64::NAN, |[n, e]| math::hypot(n, e))
            }
            Number::Bearing(place) => self
                .offset(place, sample)
                .map_or(f64::NAN, |[n, e]| math::atan2(e, n).to_degrees().rem_euclid(360.0)),
            Number::Apart(from, to) => match (self.place(from, sample), self.place(to, sample)) {
                (Some(from), Some(to)) => math::hypot(to[0] - from[0], to[1] - from[1]),
                _ => f64::NAN,
            },
            Number::Along(from, to) => self.on_line(from, to, sample).map_or(f64::NAN, |line| line.along),
            Number::Across(from, to) => self.on_line(from, to, sample).map_or(f64::NAN, |line| line.across),
            Number::Past(from, to) => {
                self.on_line(from, to, sample).map_or(f64::NAN, |line| line.along - line.length)
            }
            Number::Since(instant) => {
                self.instant(instant).map_or(f64::NAN, |us| (sample.time.0 as i64 - us) as f64 * 1e-6)
            }
            Number::At(inner, instant) => {
                let index = self.instant(instant).and_then(|us| self.trace.index_at(us));
                index.map_or(f64::NAN, |index| self.number_of(inner, index, happening))
            }
            Number::Rate(inner) => self.rate(inner, index, happening),
        }
    }

    fn rate(&self, inner: &Number, index: usize, happening: Option<&Happening>) -> f64 {
        let samples = &self.trace.samples;
        let now = samples[index].time.0;
        let Some(before) = now.checked_sub(RATE_US).and_then(|time| self.trace.index_at(time as i64)) else {
            return f64::NAN;
        };
        let before = before.min(index.saturating_sub(1));
        let seconds = (now - samples[before].time.0) as f64 * 1e-6;
        let value = |index| self.number_of(inner, index, happening);
        let difference = value(index) - value(before);
        // A bearing that passes north has not turned by a full circle.
        let is_direction = matches!(inner, Number::Bearing(_))
            || matches!(inner, Number::Signal(Signal::Heading | Signal::Course));
        if is_direction { wrap(difference) / seconds } else { difference / seconds }
    }

    /// Returns a place at a sample, m north and east of the boot place.
    fn place(&self, place: &Place, sample: &Sample) -> Option<[f64; 2]> {
        match place {
            Place::Home => Some([0.0, 0.0]),
            Place::Offset(north, east) => Some([*north, *east]),
            Place::Waypoint(index, source) => self.trace.waypoint(*index, *source, sample.time),
            Place::Target => {
                let [north, east] = sample.target_ne.map(f64::from);
                (north.is_finite() && east.is_finite()).then_some([north, east])
            }
            Place::CraftAt(instant) => {
                let index = self.instant(instant).and_then(|us| self.trace.index_at(us))?;
                Some(self.trace.samples[index].place())
            }
        }
    }

    /// Returns the offset of the craft from a place, m north and east.
    fn offset(&self, place: &Place, sample: &Sample) -> Option<[f64; 2]> {
        let [north, east] = self.place(place, sample)?;
        let craft = sample.place();
        Some([craft[0] - north, craft[1] - east])
    }

    fn on_line(&self, from: &Place, to: &Place, sample: &Sample) -> Option<OnLine> {
        let (from, to) = (self.place(from, sample)?, self.place(to, sample)?);
        let (north, east) = (to[0] - from[0], to[1] - from[1]);
        let length = math::hypot(north, east);
        if length < 1e-6 {
            return None;
        }
        let craft = sample.place();
        let (n, e) = (craft[0] - from[0], craft[1] - from[1]);
        Some(OnLine {
            along: (n * north + e * east) / length,
            // Right of the line is clockwise from its direction.
            across: (e * north - n * east) / length,
            length,
        })
    }

    /// Returns the measures in a condition that have no value, because an instant that they wait for did not come.
    pub fn unknown_names(&self, condition: &Condition) -> Vec<&'a str> {
        let mut used = Vec::new();
        condition.each_number(&mut |number| {
            if let Number::Name(name) = number {
                used.push(name.clone());
            }
        });
        let is_unknown = |(name, value): &&(String, f64)| value.is_nan() && used.contains(name);
        self.names.iter().filter(is_unknown).map(|(name, _)| name.as_str()).collect()
    }

    /// Returns `true` if a condition holds at a sample; `None` if that is unknown.
    pub fn holds(&self, condition: &Condition, index: usize) -> Option<bool> {
        self.holds_of(condition, index, None)
    }

    /// Returns `true` if a condition holds at a sample; the condition may use the numbers of a happening.
    pub fn holds_of(
        &self,
        condition: &Condition,
        index: usize,
        happening: Option<&Happening>,
    ) -> Option<bool> {
        let sample = self.trace.samples.get(index)?;
        #[cfg(test)]
        self.judged.update(|judged| judged + 1);
        Some(match condition {
            Condition::Compare(comparison) => self.compare(comparison, index, happening)?.holds(),
            Condition::Flag(flag) => sample.has(*flag),
            Condition::State(state, wp) => sample.state == *state && wp.is_none_or(|wp| wp == sample.wp),
            Condition::Mode(mode) => sample.modes.has(*mode),
            Condition::Flying(source) => sample.has(Flag::Engaged) && sample.source == *source,
            Condition::Not(inner) => !self.holds_of(inner, index, happening)?,
            Condition::All(all) => {
                let mut unknown = false;
                for inner in all {
                    match self.holds_of(inner, index, happening) {
                        Some(false) => return Some(false),
                        Some(true) => {}
                        None => unknown = true,
                    }
                }
                return (!unknown).then_some(true);
            }
            Condition::Any(any) => {
                let mut unknown = false;
                for inner in any {
                    match self.holds_of(inner, index, happening) {
                        Some(true) => return Some(true),
                        Some(false) => {}
                        None => unknown = true,
                    }
                }
                return (!unknown).then_some(false);
            }
        })
    }

    /// Returns the comparison that decides a condition at a sample: the tightest one if all must hold, the widest one
    /// of alternatives. Returns `None` if no comparison is known.
    pub fn deciding(
        &self,
        condition: &Condition,
        index: usize,
        happening: Option<&Happening>,
    ) -> Option<Verdict> {
        let tighter = |a: &Verdict, b: &Verdict| a.share().total_cmp(&b.share());
        match condition {
            Condition::Compare(comparison) => self.compare(comparison, index, happening),
            Condition::All(all) => {
                all.iter().filter_map(|inner| self.deciding(inner, index, happening)).min_by(tighter)
            }
            Condition::Any(any) => {
                any.iter().filter_map(|inner| self.deciding(inner, index, happening)).max_by(tighter)
            }
            Condition::Flag(_)
            | Condition::State(..)
            | Condition::Mode(_)
            | Condition::Flying(_)
            | Condition::Not(_) => None,
        }
    }

    /// Evaluates a comparison at a sample; `None` if a number is unknown.
    pub fn compare(
        &self,
        comparison: &Comparison,
        index: usize,
        happening: Option<&Happening>,
    ) -> Option<Verdict> {
        let value = self.number_of(&comparison.left, index, happening);
        self.bound(comparison, value, index, happening)
    }

    /// Compares a value with the bound of a comparison.
    pub fn bound(
        &self,
        comparison: &Comparison,
        value: f64,
        index: usize,
        happening: Option<&Happening>,
    ) -> Option<Verdict> {
        let at = |number| self.number_of(number, index, happening);
        let (low, high, strict) = match &comparison.bound {
            Bound::AtMost(limit, strict) => (f64::NEG_INFINITY, at(limit), *strict),
            Bound::AtLeast(limit, strict) => (at(limit), f64::INFINITY, *strict),
            Bound::Between(low, high) => (at(low), at(high), false),
            Bound::Around(middle, tolerance) => {
                let (middle, tolerance) = (at(middle), at(tolerance));
                (middle - tolerance, middle + tolerance, false)
            }
            Bound::Equal(number) => (at(number), at(number), false),
        };
        let known = !(value.is_nan() || low.is_nan() || high.is_nan());
        known.then_some(Verdict { value, low, high, dimension: comparison.dimension, strict })
    }
}

/// The position of the craft relative to a line, m.
struct OnLine {
    along: f64,
    across: f64,
    length: f64,
}

/// Returns an angle in −180…180.
fn wrap(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

impl Function {
    fn apply(self, first: f64, second: f64) -> f64 {
        match self {
            Self::Abs => first.abs(),
            // The smaller or greater of two numbers is unknown if one of them is unknown.
            Self::Min if second < first => second,
            Self::Max if second > first => second,
            Self::Min | Self::Max if second.is_nan() => second,
            Self::Min | Self::Max => first,
            Self::Hypot => math::hypot(first, second),
            Self::Wrap => wrap(first),
        }
    }
}
