//! Frames as bytes: predictions from the frames before, and the differences from them.

use std::ops::Range;

use arrayvec::ArrayVec;

use super::LogBuffer;
use super::group::{Coding, FieldGroup, Rule};
use super::layout::{LogConstants, LogLayout, MAX_FIELDS};
use crate::blackbox::{FrameKind, Predictor};

/// The most runs of fields with the same prediction, or with the same encoding.
const MAX_RUNS: usize = 32;

/// The value of the predictor [`Predictor::Centre1500`].
const CENTRE: i32 = 1500;

/// The values of a frame in the order of its fields. Values after the last field have no effect. Unsigned values have
/// the same bits.
pub type FrameValues = [i32; MAX_FIELDS];

/// Consecutive fields with the same rule.
type Runs<T> = ArrayVec<(T, Range<usize>), MAX_RUNS>;

/// The rules of the fields of one kind of frame.
#[derive(Debug, Clone, Default)]
struct Plan {
    predictors: Runs<Predictor>,
    codings: Runs<Coding>,
}

impl Plan {
    fn new(groups: &[FieldGroup], rule: impl Fn(&FieldGroup) -> Rule) -> Self {
        let mut plan = Self::default();
        let mut next = 0;
        for group in groups {
            let Rule(predictor, coding) = rule(group);
            let fields = next..next + group.names.len();
            next = fields.end;
            extend(&mut plan.predictors, predictor, fields.clone());
            extend(&mut plan.codings, coding, fields);
        }
        plan
    }
}

/// Adds fields to the last run, or begins a new one. Neighbours with the same rule belong together, because a decoder
/// sees no border between them.
fn extend<T: Copy + PartialEq>(runs: &mut Runs<T>, rule: T, fields: Range<usize>) {
    match runs.last_mut() {
        Some((last, range)) if *last == rule => range.end = fields.end,
        // A layout has no more groups than there is room for runs.
        _ => drop(runs.try_push((rule, fields))),
    }
}

/// Writes the frames of one log.
#[derive(Debug, Clone)]
pub struct LogEncoder {
    constants: LogConstants,
    intra: Plan,
    inter: Plan,
    slow: Plan,
    home: Plan,
    gps: Plan,
    /// The positions of `motor[0]` and `time` in the main frames.
    motor_at: usize,
    time_at: usize,
    /// The values of the last two main frames.
    past: [FrameValues; 2],
    /// `true` if the newer one is the second.
    is_second_newer: bool,
    /// Latitude and longitude of the last `H` frame.
    home_place: [i32; 2],
}

impl LogEncoder {
    /// Begins a log with these fields.
    pub fn new(layout: &LogLayout, constants: LogConstants) -> Self {
        let main = layout.groups(FrameKind::Intra);
        let plan = |kind| Plan::new(layout.groups(kind), |group| group.rule);
        let names = || main.iter().flat_map(|group| group.names);
        let position = |name| names().position(|known| *known == name).unwrap_or_default();
        Self {
            constants,
            intra: Plan::new(main, |group| group.intra),
            inter: plan(FrameKind::Inter),
            slow: plan(FrameKind::Slow),
            home: plan(FrameKind::GpsHome),
            gps: plan(FrameKind::Gps),
            motor_at: position("motor[0]"),
            time_at: position("time"),
            past: [[0; MAX_FIELDS]; 2],
            is_second_newer: false,
            home_place: [0; 2],
        }
    }

    /// Writes a main frame with whole values. Later frames do not depend on those before it.
    pub fn intra(&mut self, values: &FrameValues, buffer: &mut LogBuffer) {
        self.write(FrameKind::Intra, values, buffer);
        self.past = [*values; 2];
    }

    /// Writes a main frame with the differences from those before it. The log must have an [`Self::intra`] frame, and
    /// the counter of loops must have increased by the P interval since the last main frame.
    pub fn inter(&mut self, values: &FrameValues, buffer: &mut LogBuffer) {
        self.write(FrameKind::Inter, values, buffer);
        self.is_second_newer = !self.is_second_newer;
        self.past[usize::from(self.is_second_newer)] = *values;
    }

    /// Returns the values of the last two main frames, the newer one first.
    fn past(&self) -> [&FrameValues; 2] {
        let [first, second] = &self.past;
        if self.is_second_newer { [second, first] } else { [first, second] }
    }

    /// Writes a frame of the modes and the states.
    pub fn slow(&mut self, values: &FrameValues, buffer: &mut LogBuffer) {
        self.write(FrameKind::Slow, values, buffer);
    }

    /// Writes the place of home. Its first two values are the latitude and the longitude.
    pub fn home(&mut self, values: &FrameValues, buffer: &mut LogBuffer) {
        self.write(FrameKind::GpsHome, values, buffer);
        self.home_place = [values[0], values[1]];
    }

    /// Writes a navigation solution. The log must have a [`Self::home`] frame.
    pub fn gps(&mut self, values: &FrameValues, buffer: &mut LogBuffer) {
        self.write(FrameKind::Gps, values, buffer);
    }

    fn write(&self, kind: FrameKind, values: &FrameValues, buffer: &mut LogBuffer) {
        let plan = match kind {
            FrameKind::Intra => &self.intra,
            FrameKind::Inter => &self.inter,
            FrameKind::Slow => &self.slow,
            FrameKind::GpsHome => &self.home,
            FrameKind::Gps | FrameKind::Event => &self.gps,
        };
        let differences = self.differences(plan, values);
        buffer.write(|log| {
            log.byte(kind.letter());
            for (coding, fields) in &plan.codings {
                coding.write(differences.get(fields.clone()).unwrap_or_default(), log);
            }
        });
    }

    /// Returns the values without their predictions.
    fn differences(&self, plan: &Plan, values: &FrameValues) -> FrameValues {
        let mut differences = *values;
        for (predictor, fields) in &plan.predictors {
            let Some(run) = differences.get_mut(fields.clone()) else { continue };
            let past = self.past().map(|values| values.get(fields.clone()).unwrap_or_default());
            let mut less = |value: i32| run.iter_mut().for_each(|field| *field = field.wrapping_sub(value));
            match predictor {
                Predictor::Zero => {}
                Predictor::MinThrottle => less(self.constants.min_throttle),
                Predictor::Motor0 => less(values.get(self.motor_at).copied().unwrap_or_default()),
                Predictor::Centre1500 => less(CENTRE),
                Predictor::VbatReference => less(self.constants.vbat_reference),
                Predictor::LastMainFrameTime => {
                    less(self.past()[0].get(self.time_at).copied().unwrap_or_default());
                }
                Predictor::MinMotor => less(self.constants.min_motor),
                Predictor::HomeCoordinate => {
                    for (field, place) in run.iter_mut().zip(self.home_place) {
                        *field = field.wrapping_sub(place);
                    }
                }
                Predictor::Previous => less_past(run, past, |last, _| last),
                Predictor::StraightLine => {
                    less_past(run, past, |last, before| last.wrapping_mul(2).wrapping_sub(before));
                }
                Predictor::Average2 => less_past(run, past, |last, before| last.wrapping_add(before) / 2),
                Predictor::Increment => {
                    let loops = self.constants.p_interval;
                    less_past(run, past, |last, _| last.wrapping_add_unsigned(loops));
                }
            }
        }
        differences
    }
}

/// Subtracts a prediction from each field. It depends on the values of the same field in the last two main frames, the
/// newer one first.
fn less_past(run: &mut [i32], [last, before]: [&[i32]; 2], prediction: impl Fn(i32, i32) -> i32) {
    for ((field, last), before) in run.iter_mut().zip(last).zip(before) {
        *field = field.wrapping_sub(prediction(*last, *before));
    }
}

#[cfg(test)]
mod tests;
