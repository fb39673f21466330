//! The values to which decoded differences are added.

use super::super::field::{Field, Predictor};
use super::constants::Constants;

/// The value of predictor 8.
const CENTRE: i32 = 1500;

/// The values that predictors refer to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Context<'a> {
    /// The frame before, and the one before that. Empty if there is none: its values count as zero.
    pub(super) previous: &'a [i32],
    pub(super) before: &'a [i32],
    /// The iterations since the frame before that were not logged.
    pub(super) skipped: u32,
    /// Latitude and longitude of home.
    pub(super) home: [i32; 2],
    /// The time of the last main frame.
    pub(super) main_time: i32,
    pub(super) constants: Constants,
}

/// Fields in a row that are predicted alike.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Prediction {
    from: usize,
    to: usize,
    by: By,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum By {
    Predictor(Predictor),
    /// The value of a field of the same frame.
    Field(usize),
    /// The latitude or the longitude of home.
    Home(usize),
}

impl Prediction {
    /// Returns the predictions of the fields, in their order. A field that is predicted by zero has none.
    pub(super) fn all(fields: &[Field]) -> Vec<Self> {
        let motor = fields.iter().position(|field| field.name == "motor[0]");
        let mut coordinates = 0;
        let mut all: Vec<Self> = Vec::new();
        for (at, field) in fields.iter().enumerate() {
            let by = match field.predictor {
                Predictor::Zero => continue,
                Predictor::Motor0 => match motor {
                    Some(motor) => By::Field(motor),
                    None => continue,
                },
                Predictor::HomeCoordinate => {
                    coordinates += 1;
                    By::Home((coordinates - 1) % 2)
                }
                other => By::Predictor(other),
            };
            match all.last_mut() {
                Some(last) if last.by == by && last.to == at => last.to += 1,
                _ => all.push(Self { from: at, to: at + 1, by }),
            }
        }
        all
    }

    /// Adds the predicted values.
    pub(super) fn add(&self, values: &mut [i32], context: &Context<'_>) {
        let constant = match self.by {
            By::Field(at) => values.get(at).copied().unwrap_or_default(),
            By::Home(coordinate) => context.home[coordinate],
            By::Predictor(predictor) => match predictor {
                Predictor::Previous => return self.add_each(values, context, |previous, _| previous),
                Predictor::StraightLine => {
                    let line = |previous: i32, before| previous.wrapping_mul(2).wrapping_sub(before);
                    return self.add_each(values, context, line);
                }
                Predictor::Average2 => {
                    return self
                        .add_each(values, context, |previous, before| previous.wrapping_add(before) / 2);
                }
                Predictor::Increment => {
                    let more = context.skipped.wrapping_add(1) as i32;
                    return self.add_each(values, context, |previous, _| previous.wrapping_add(more));
                }
                Predictor::MinThrottle => context.constants.min_throttle,
                Predictor::Centre1500 => CENTRE,
                Predictor::VbatReference => context.constants.vbat_reference,
                Predictor::LastMainFrameTime => context.main_time,
                Predictor::MinMotor => context.constants.min_motor,
                Predictor::Zero | Predictor::Motor0 | Predictor::HomeCoordinate => 0,
            },
        };
        for value in &mut values[self.from..self.to] {
            *value = value.wrapping_add(constant);
        }
    }

    fn add_each(&self, values: &mut [i32], context: &Context<'_>, predicted: impl Fn(i32, i32) -> i32) {
        let range = self.from..self.to;
        let (Some(previous), Some(before)) =
            (context.previous.get(range.clone()), context.before.get(range.clone()))
        else {
            for value in &mut values[range] {
                *value = value.wrapping_add(predicted(0, 0));
            }
            return;
        };
        for ((value, previous), before) in values[range].iter_mut().zip(previous).zip(before) {
            *value = value.wrapping_add(predicted(*previous, *before));
        }
    }
}
