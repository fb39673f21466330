//! Bounds that are widened when sensors err.

use super::case::{Allowance, Expected};
use super::expression::{Bound, Comparison, Condition, Number, Operator};
use crate::telemetry::quantity::Dimension;
use crate::telemetry::signal::Signal;

impl Expected {
    /// Returns the same expectation with wider bounds.
    pub(super) fn widened(self, allowance: &Allowance) -> Self {
        let wide = |condition: Condition| condition.widened(allowance);
        match self {
            Self::Event { pattern, count, within, with } => {
                Self::Event { pattern, count, within, with: with.map(wide) }
            }
            Self::Always(condition, false) => Self::Always(wide(condition), false),
            Self::Eventually(condition) => Self::Eventually(wide(condition)),
            Self::Mostly(condition, share) => Self::Mostly(wide(condition), share),
            Self::Statistic(statistic, comparison) => {
                Self::Statistic(statistic, comparison.widened(allowance))
            }
            Self::At(instant, condition) => Self::At(instant, wide(condition)),
            Self::That(condition) => Self::That(wide(condition)),
            // The bound of a `never` condition is not widened.
            Self::Always(_, true) | Self::Result(_) | Self::States(_) | Self::NoEvent(_) => self,
        }
    }
}

impl Condition {
    fn widened(self, allowance: &Allowance) -> Self {
        let all = |inner: Vec<Self>| inner.into_iter().map(|one| one.widened(allowance)).collect();
        match self {
            Self::Compare(comparison) => Self::Compare(comparison.widened(allowance)),
            Self::All(inner) => Self::All(all(inner)),
            Self::Any(inner) => Self::Any(all(inner)),
            Self::Flag(_) | Self::State(..) | Self::Mode(_) | Self::Flying(_) | Self::Not(_) => self,
        }
    }
}

impl Comparison {
    fn widened(self, allowance: &Allowance) -> Self {
        let more = match self.dimension {
            Dimension::LENGTH if self.left.is_vertical() => allowance.vertical_m,
            Dimension::LENGTH => allowance.horizontal_m,
            Dimension::SPEED => allowance.speed_mps,
            Dimension::ANGLE => allowance.angle_deg,
            _ => 0.0,
        };
        if more <= 0.0 {
            return self;
        }
        let add = |number: Number, sign: f64| {
            Number::Join(Operator::Add, Box::new(number), Box::new(Number::Literal(sign * more, None)))
        };
        let bound = match self.bound {
            Bound::AtMost(limit, strict) => Bound::AtMost(add(limit, 1.0), strict),
            Bound::AtLeast(limit, strict) => Bound::AtLeast(add(limit, -1.0), strict),
            Bound::Between(low, high) => Bound::Between(add(low, -1.0), add(high, 1.0)),
            Bound::Around(middle, tolerance) => Bound::Around(middle, add(tolerance, 1.0)),
            Bound::Equal(number) => Bound::Equal(number),
        };
        Self { bound, ..self }
    }
}

impl Number {
    /// Returns `true` if the number is a height.
    fn is_vertical(&self) -> bool {
        match self {
            Self::Signal(signal) => {
                matches!(signal, Signal::Altitude | Signal::EstAltitude | Signal::TargetAltitude)
            }
            Self::Negative(inner) | Self::At(inner, _) | Self::Rate(inner) => inner.is_vertical(),
            Self::Join(_, left, right) => left.is_vertical() || right.is_vertical(),
            Self::Call(_, arguments) => arguments.iter().any(Self::is_vertical),
            _ => false,
        }
    }
}
