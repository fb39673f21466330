//! Expressions about a flight: numbers with units, conditions, places and instants.
//!
//! `cursor` walks over the text. `number`, `place`, `condition` and `instant` read their parts of the grammar. They
//! check dimensions while they read, so every expression that was read can be judged. `evaluate` gives the values in
//! a recorded flight. `docs/scenarios.md` is the reference.

mod condition;
mod cursor;
mod evaluate;
mod instant;
mod lookup;
mod number;
mod pattern;
mod place;

use std::collections::BTreeMap;
use std::rc::Rc;

use super::happening::{Field, Pattern};
use crate::scenario::flag::Flag;
use crate::telemetry::quantity::{Dimension, Unit};
use crate::telemetry::signal::Signal;
use crate::telemetry::{Mode, NavState, PlanSource};

pub use cursor::{Cursor, MAX_TERMS, SyntaxError};
pub use evaluate::{Evaluator, Verdict};
pub use instant::read_span_from;
pub use lookup::{Lookups, Search};
pub(super) use number::bare;
pub use number::{MAX_NAME, read_quantity};
pub(super) use pattern::mode_of as read_mode;
pub use pattern::read_pattern;

/// The meaning of names while an expression is read.
#[derive(Debug, Clone, Default)]
pub struct Scope {
    /// Parameters and measures with their dimension; many expressions share them.
    pub names: Rc<BTreeMap<String, Dimension>>,
    /// The names of the inputs.
    pub inputs: Vec<String>,
    /// The number of waypoints of the plan.
    pub waypoints: usize,
    /// The numbers of the happening that the expression is about.
    pub fields: &'static [Field],
}

/// A number of a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Number {
    /// A literal, in SI units and degrees, with the unit it was written in.
    Literal(f64, Option<&'static Unit>),
    /// A signal at the instant of the sample.
    Signal(Signal),
    /// A number of the happening that the expression is about.
    Field(Field),
    /// A parameter or a measure.
    Name(String),
    /// The number with the other sign.
    Negative(Box<Number>),
    /// Two numbers and an operator between them.
    Join(Operator, Box<Number>, Box<Number>),
    /// A function of numbers.
    Call(Function, Vec<Number>),
    /// Horizontal distance of the craft from a place.
    Distance(Place),
    /// Direction from a place to the craft, degrees clockwise from north.
    Bearing(Place),
    /// Horizontal distance between two places.
    Apart(Place, Place),
    /// Distance of the craft along a line, from the beginning of the line.
    Along(Place, Place),
    /// Cross-track distance of the craft from a line, right positive.
    Across(Place, Place),
    /// Distance of the craft beyond the end of a line, negative before the end.
    Past(Place, Place),
    /// Time since an instant.
    Since(Box<Instant>),
    /// The value of a number at an instant.
    At(Box<Number>, Box<Instant>),
    /// The rate of change of a number, per second.
    Rate(Box<Number>),
}

/// An operator between two numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// Addition.
    Add,
    /// Subtraction.
    Subtract,
    /// Multiplication.
    Multiply,
    /// Division.
    Divide,
    /// The remainder of the Euclidean division, never negative.
    Remainder,
}

/// A function of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumString, strum::EnumIter, strum::IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Function {
    /// The absolute value.
    Abs,
    /// The smaller of two.
    Min,
    /// The greater of two.
    Max,
    /// Length of the hypotenuse.
    Hypot,
    /// An angle as −180…180.
    Wrap,
}

/// A place on the ground.
#[derive(Debug, Clone, PartialEq)]
pub enum Place {
    /// The boot place.
    Home,
    /// North and east of the boot place, m.
    Offset(f64, f64),
    /// A waypoint of the scenario's plan, or of the first plan of another origin.
    Waypoint(u8, PlanSource),
    /// The navigator's target.
    Target,
    /// The true position of the craft at an instant.
    CraftAt(Box<Instant>),
}

/// A yes-or-no statement about a flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// A number within its bound.
    Compare(Comparison),
    /// A flag is set.
    Flag(Flag),
    /// The state machine is in this state, optionally with this waypoint.
    State(NavState, Option<u8>),
    /// A mode is active.
    Mode(Mode),
    /// The autopilot flies a plan of this origin.
    Flying(PlanSource),
    /// The condition does not hold.
    Not(Box<Condition>),
    /// All of the conditions hold.
    All(Vec<Condition>),
    /// At least one of the conditions holds.
    Any(Vec<Condition>),
}

/// A number and its bound.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The number on the left.
    pub left: Number,
    /// The dimension of both sides.
    pub dimension: Dimension,
    /// The allowed values.
    pub bound: Bound,
}

/// The allowed values of a number.
#[derive(Debug, Clone, PartialEq)]
pub enum Bound {
    /// At most, or (`true`) below.
    AtMost(Number, bool),
    /// At least, or (`true`) above.
    AtLeast(Number, bool),
    /// Between two numbers, both included.
    Between(Number, Number),
    /// A number with a tolerance on both sides.
    Around(Number, Number),
    /// This number.
    Equal(Number),
}

/// An instant of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Instant {
    /// The event that marks it.
    pub anchor: Anchor,
    /// The choice among several of them.
    pub occurrence: Occurrence,
    /// An earlier instant; only later happenings count.
    pub after: Option<Box<Instant>>,
    /// The offset in seconds; a negative one is earlier.
    pub offset_s: f64,
}

/// The event that marks an instant.
#[derive(Debug, Clone, PartialEq)]
pub enum Anchor {
    /// The boot.
    Boot,
    /// The end of the recording.
    Last,
    /// A happening.
    Happening(Pattern),
    /// A condition becomes true.
    When(Condition),
}

/// The choice among several happenings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Occurrence {
    /// The nth, from 1.
    Nth(usize),
    /// The last.
    Last,
}

impl Condition {
    /// Returns the names of the parameters and measures in the condition.
    pub fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        self.each_number(&mut |number| {
            if let Number::Name(name) = number {
                names.push(name.clone());
            }
        });
        names
    }

    /// Calls `visit` for every number in the condition, also for those inside other numbers.
    fn each_number(&self, visit: &mut impl FnMut(&Number)) {
        match self {
            Self::Compare(comparison) => {
                comparison.left.each(visit);
                match &comparison.bound {
                    Bound::AtMost(number, _) | Bound::AtLeast(number, _) | Bound::Equal(number) => {
                        number.each(visit);
                    }
                    Bound::Between(first, second) | Bound::Around(first, second) => {
                        first.each(visit);
                        second.each(visit);
                    }
                }
            }
            Self::Not(inner) => inner.each_number(visit),
            Self::All(inner) | Self::Any(inner) => inner.iter().for_each(|one| one.each_number(visit)),
            Self::Flag(_) | Self::State(..) | Self::Mode(_) | Self::Flying(_) => {}
        }
    }
}

impl Number {
    fn each(&self, visit: &mut impl FnMut(&Self)) {
        visit(self);
        match self {
            Self::Negative(inner) | Self::At(inner, _) | Self::Rate(inner) => inner.each(visit),
            Self::Join(_, left, right) => {
                left.each(visit);
                right.each(visit);
            }
            Self::Call(_, arguments) => arguments.iter().for_each(|argument| argument.each(visit)),
            _ => {}
        }
    }
}

impl Instant {
    /// Returns `true` if the instant can come several times.
    pub(super) fn recurs(&self) -> bool {
        matches!(self.anchor, Anchor::Happening(_) | Anchor::When(_)) && self.occurrence != Occurrence::Last
    }

    /// Returns the reason why a flight cannot wait for this instant, if only a finished flight shows it; otherwise
    /// `None`.
    pub(super) fn unseen_in_flight(&self) -> Option<&'static str> {
        if self.offset_s < 0.0 {
            Some("a happening is not known before it happens")
        } else if self.anchor == Anchor::Last {
            Some("the end of the record is not known during the flight")
        } else if self.occurrence == Occurrence::Last {
            Some("the last one is not known during the flight")
        } else {
            self.after.as_deref().and_then(Self::unseen_in_flight)
        }
    }
}

#[cfg(test)]
mod tests;
