//! Distributions of one number, with their text.

use std::fmt;
use std::str::FromStr;

use super::normal::{normal_cdf, normal_quantile};

/// The least share of a distribution that may be left by its limits.
const MIN_SHARE: f64 = 1e-3;
/// The decimals of a drawn value. A short value is the same in every file.
const DECIMALS: f64 = 1e4;
/// The greatest shape of a Weibull distribution. With a greater one, all values are the same.
const MAX_SHAPE: f64 = 100.0;

/// The forms of a distribution, for messages.
const HINT: &str = "write 4..8 (uniform), 6 +- 2 (normal, with its standard deviation) or weibull(6, 2) (scale, shape), \
                    each also with limits: 6 +- 2 in 0..12";

/// A distribution of one number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    shape: Shape,
    /// The limits, both included.
    limits: Option<(f64, f64)>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Constant(f64),
    Uniform(f64, f64),
    Normal { mean: f64, deviation: f64 },
    Weibull { scale: f64, shape: f64 },
}

/// A mistake in the text of a distribution, or in its limits.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct DistributionError {
    /// The problem, as a part of a sentence.
    pub message: String,
    /// The replacement, for the message.
    pub hint: String,
}

fn error(message: impl Into<String>, hint: impl Into<String>) -> DistributionError {
    DistributionError { message: message.into(), hint: hint.into() }
}

impl Distribution {
    /// Returns the only value, if there is only one.
    pub fn value(&self) -> Option<f64> {
        match self.shape {
            Shape::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// Returns the same distribution with no values outside `low..=high`. The values inside keep their proportions.
    ///
    /// # Errors
    /// Fails if a uniform distribution exceeds the limits, or if little of another one is left.
    pub fn within(self, low: f64, high: f64) -> Result<Self, DistributionError> {
        let (least, most) = self.limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let allowed = || format!("allowed: {low} to {high}");
        match self.shape {
            Shape::Constant(value) if !(low..=high).contains(&value) => {
                Err(error(format!("{value} is out of range"), allowed()))
            }
            Shape::Uniform(from, to) if from < low || to > high => {
                Err(error(format!("{from}..{to} is out of range"), allowed()))
            }
            _ => {
                let cut = Self { limits: Some((low.max(least), high.min(most))), ..self };
                match cut.ends() {
                    (from, to) if to - from >= MIN_SHARE => Ok(cut),
                    _ => Err(error(
                        format!("hardly a value of {self} lies between {low} and {high}"),
                        allowed(),
                    )),
                }
            }
        }
    }

    /// Returns the value below which the share `unit` of all values lies, rounded to four decimals.
    pub fn quantile(&self, unit: f64) -> f64 {
        let (from, to) = self.ends();
        let unit = from + unit * (to - from);
        let value = match self.shape {
            Shape::Constant(value) => value,
            Shape::Uniform(low, high) => low + unit * (high - low),
            Shape::Normal { mean, deviation } => mean + deviation * normal_quantile(unit),
            Shape::Weibull { scale, shape } => scale * libm::pow(-libm::log1p(-unit), 1.0 / shape),
        };
        let value = (value * DECIMALS).round() / DECIMALS;
        self.limits.map_or(value, |(low, high)| value.clamp(low, high))
    }

    /// Returns the shares of all values below the limits.
    fn ends(&self) -> (f64, f64) {
        match (self.shape, self.limits) {
            (Shape::Constant(_), _) | (_, None) => (0.0, 1.0),
            (_, Some((low, high))) => (self.share_below(low), self.share_below(high)),
        }
    }

    /// Returns the share of values up to `value`, as if there were no limits.
    fn share_below(&self, value: f64) -> f64 {
        match self.shape {
            Shape::Constant(only) => f64::from(u8::from(only <= value)),
            Shape::Uniform(low, high) => ((value - low) / (high - low)).clamp(0.0, 1.0),
            Shape::Normal { mean, deviation } => normal_cdf((value - mean) / deviation),
            Shape::Weibull { scale, shape } if value > 0.0 => -libm::expm1(-libm::pow(value / scale, shape)),
            Shape::Weibull { .. } => 0.0,
        }
    }
}

impl FromStr for Distribution {
    type Err = DistributionError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let (body, limits) = match text.split_once(" in ") {
            Some((body, limits)) => (body.trim(), Some(range(limits)?)),
            None => (text.trim(), None),
        };
        let weibull = body.strip_prefix("weibull").map(str::trim);
        let shape = if let Some(inside) = weibull {
            let inside = inside.strip_prefix('(').and_then(|inside| inside.strip_suffix(')'));
            let numbers = inside.and_then(|inside| inside.split_once(','));
            let (scale, shape) = numbers.ok_or_else(|| error(format!("{body} is not understood"), HINT))?;
            let (scale, shape) = (number(scale)?, number(shape)?);
            if scale <= 0.0 || shape <= 0.0 || shape > MAX_SHAPE {
                let hint = format!("allowed: a scale above 0, and a shape above 0 and at most {MAX_SHAPE}");
                return Err(error(format!("{body} is no distribution"), hint));
            }
            Shape::Weibull { scale, shape }
        } else if let Some((mean, deviation)) = body.split_once("+-").or_else(|| body.split_once('±')) {
            let mean = if mean.trim().is_empty() { 0.0 } else { number(mean)? };
            match number(deviation)? {
                0.0 => Shape::Constant(mean),
                deviation if deviation > 0.0 => Shape::Normal { mean, deviation },
                deviation => {
                    return Err(error(format!("the standard deviation {deviation} is negative"), HINT));
                }
            }
        } else if body.contains("..") {
            match range(body)? {
                (low, high) if low < high => Shape::Uniform(low, high),
                (low, _) => Shape::Constant(low),
            }
        } else {
            Shape::Constant(number(body)?)
        };
        let read = Self { shape, limits: None };
        match limits {
            None => Ok(read),
            Some((low, high)) => read.within(low, high),
        }
    }
}

fn range(text: &str) -> Result<(f64, f64), DistributionError> {
    let (low, high) = text
        .split_once("..")
        .ok_or_else(|| error(format!("{} is not a range", text.trim()), "write 0..12"))?;
    match (number(low)?, number(high)?) {
        (low, high) if low <= high => Ok((low, high)),
        (low, high) => Err(error(format!("nothing is in {low}..{high}"), "write the smaller number first")),
    }
}

fn number(text: &str) -> Result<f64, DistributionError> {
    let text = text.trim();
    let number = text.parse().ok().filter(|number: &f64| number.abs() <= 1e9);
    number.ok_or_else(|| error(format!("{text:?} is not a number"), HINT))
}

impl fmt::Display for Distribution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.shape {
            Shape::Constant(value) => write!(f, "{value}")?,
            Shape::Uniform(low, high) => write!(f, "{low}..{high}")?,
            Shape::Normal { mean, deviation } => write!(f, "{mean} +- {deviation}")?,
            Shape::Weibull { scale, shape } => write!(f, "weibull({scale}, {shape})")?,
        }
        match self.limits {
            Some((low, high)) => write!(f, " in {low}..{high}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read(text: &str) -> Distribution {
        text.parse().unwrap_or_else(|error: DistributionError| panic!("{text}: {}", error.message))
    }

    #[test]
    fn quantiles_follow_the_closed_forms() {
        for (text, unit, expected) in [
            ("5", 0.3, 5.0),
            ("4..8", 0.25, 5.0),
            ("-8..-4", 0.25, -7.0),
            ("6 +- 2", 0.5, 6.0),
            ("6+-2", 0.975, 9.9199),
            ("+- 3", 0.025, -5.8799),
            ("± 3", 0.5, 0.0),
            // scale · (−ln(1 − u))^(1/shape)
            ("weibull(6, 2)", 0.5, 4.9953),
            ("weibull( 6 , 1 )", 0.5, 4.1589),
            ("weibull(6, 2)", 0.99, 12.8758),
            // Half of the values above the mean: the quartile of the whole.
            ("6 +- 2 in 6..1000", 0.5, 7.349),
            ("6 +- 0", 0.9, 6.0),
        ] {
            let found = read(text).quantile(unit);
            assert!((found - expected).abs() < 1e-4, "{text} at {unit}: {found}");
        }
    }

    #[test]
    fn limits_leave_no_value_outside_and_keep_the_proportions() {
        let cut = read("6 +- 2 in 4..8");
        assert!(cut.quantile(1e-9) >= 4.0 && cut.quantile(1.0 - 1e-9) <= 8.0);
        assert!((cut.quantile(0.5) - 6.0).abs() < 1e-9);
        // P(x < 5 | 4 < x < 8) = (Φ(−½) − Φ(−1)) / (Φ(1) − Φ(−1))
        let share = (0.308_537_5 - 0.158_655_3) / 0.682_689_5;
        assert!((cut.quantile(share) - 5.0).abs() < 1e-4);
    }

    #[test]
    fn mistakes_are_reported_with_a_way_out() {
        for (text, message) in [
            ("", "\"\" is not a number"),
            ("wind", "\"wind\" is not a number"),
            ("8..4", "nothing is in 8..4"),
            ("6 +- -2", "the standard deviation -2 is negative"),
            ("weibull(6)", "weibull(6) is not understood"),
            ("weibull(0, 2)", "weibull(0, 2) is no distribution"),
            ("weibull 6 2", "weibull 6 2 is not understood"),
            ("6 +- 2 in 20..30", "hardly a value of 6 +- 2 lies between 20 and 30"),
            ("NaN", "\"NaN\" is not a number"),
            ("1e300", "\"1e300\" is not a number"),
        ] {
            let error = text.parse::<Distribution>().unwrap_err();
            assert_eq!(error.message, message);
            assert!(!error.hint.is_empty(), "{text}");
        }
        assert_eq!(read("0..80").within(0.0, 60.0).unwrap_err().message, "0..80 is out of range");
        assert_eq!(read("70").within(0.0, 60.0).unwrap_err().message, "70 is out of range");
    }

    proptest! {
        #[test]
        fn what_is_written_reads_back(mean in -1e3..1e3_f64, deviation in 0.1..1e2_f64, shape in 0..4_u8) {
            let text = match shape {
                0 => format!("{mean}"),
                1 => format!("{mean}..{}", mean + deviation),
                2 => format!("{mean} +- {deviation} in {}..{}", mean - deviation, mean + deviation),
                _ => format!("weibull({deviation}, 2.5)"),
            };
            let read: Distribution = text.parse().unwrap();
            prop_assert_eq!(read.to_string().parse::<Distribution>().unwrap(), read);
        }

        #[test]
        fn greater_shares_have_greater_values(a in 1e-6..1.0_f64, b in 1e-6..1.0_f64) {
            for text in ["4..8", "6 +- 2", "weibull(6, 2)", "6 +- 2 in 5..9"] {
                let read: Distribution = text.parse().unwrap();
                let (low, high) = (a.min(b).min(1.0 - 1e-9), a.max(b).min(1.0 - 1e-9));
                prop_assert!(read.quantile(low) <= read.quantile(high));
            }
        }

        #[test]
        fn any_text_is_read_or_refused(text in "\\PC{0,40}") {
            let _ = text.parse::<Distribution>();
        }
    }
}
