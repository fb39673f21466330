//! What explains the failures: the inputs, by how much they tell about them.

use super::failures::{FailureClass, Flights, Scatter, classes_of_numbers, classes_of_words};
use crate::campaign::record::{InputValue, Record, Standing};
use crate::campaign::statistics::{Correlation, Significance, Split, best_split, best_word_split, spearman};

/// The metrics whose dependence on the inputs is shown.
const METRICS: [&str; 3] = ["cross_track", "touchdown", "battery_left"];
/// The components of the wind.
const COMPONENTS: [&str; 2] = ["wind from the north", "wind from the east"];

/// An input that explains failures.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    pub input: String,
    /// The best division of the flights by it.
    pub split: Split,
    /// The rank correlation of its number with the failure; `None` for words.
    pub rho: Option<f64>,
    /// `true` if chance hardly explains the split, with as many inputs as there are.
    pub is_real: bool,
    /// The failures along the values of the input.
    pub classes: Vec<FailureClass>,
}

/// What explains the failures, and the metrics.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Causes {
    /// The number of flights that were looked at, and of failures among them.
    pub flights: u64,
    pub failures: u64,
    /// The inputs, those that tell most about the failures first.
    pub of_failures: Vec<Cause>,
    /// For a metric, the input on which it depends most, and the rank correlation.
    pub of_metrics: Vec<(String, String, f64)>,
    /// Flights by two numbers: by the two inputs that tell most about the failures, and each metric of `of_metrics` over
    /// its input.
    pub scatters: Vec<Scatter>,
}

/// The inputs and the outcomes of flights, in columns.
#[derive(Debug, Clone, Default)]
pub(super) struct CauseTable {
    failed: Vec<bool>,
    inputs: Vec<Column>,
    metrics: [Vec<f64>; METRICS.len()],
}

/// The values of an input.
#[derive(Debug, Clone)]
struct Column {
    name: String,
    /// The numbers, or the indices of words. NaN = a flight has none.
    values: Vec<f64>,
    words: Vec<String>,
}

impl CauseTable {
    pub(super) fn add(&mut self, record: &Record) {
        if matches!(record.standing, Standing::Skipped | Standing::NotFlown) {
            return;
        }
        let row = self.failed.len();
        self.failed.push(record.standing == Standing::Failed);
        for (name, value) in &record.inputs {
            self.column(name).set(row, value);
        }
        // Directions are explained better by their components.
        if let [Some(speed), Some(from)] = ["wind_mps", "wind_from_deg"].map(|name| number(record, name)) {
            let from = from.to_radians();
            let components = [libm::cos(from), libm::sin(from)];
            for (name, share) in std::iter::zip(COMPONENTS, components) {
                self.column(name).set(row, &InputValue::Number(speed * share));
            }
        }
        for (metric, name) in self.metrics.iter_mut().zip(METRICS) {
            metric.push(record.metric(name).unwrap_or(f64::NAN));
        }
    }

    fn column(&mut self, name: &str) -> &mut Column {
        let at = match self.inputs.iter().position(|column| column.name == name) {
            Some(at) => at,
            None => {
                let column = Column { name: name.to_owned(), values: Vec::new(), words: Vec::new() };
                self.inputs.push(column);
                self.inputs.len() - 1
            }
        };
        &mut self.inputs[at]
    }

    /// Returns what the flights so far say.
    pub(super) fn causes(&self) -> Causes {
        let failures = self.failed.iter().filter(|failed| **failed).count() as u64;
        let mut of_failures: Vec<Cause> =
            self.inputs.iter().filter_map(|column| self.cause(column)).collect();
        of_failures.sort_by(|a, b| b.split.gain.total_cmp(&a.split.gain));
        let of_metrics: Vec<(String, String, f64)> = std::iter::zip(METRICS, &self.metrics)
            .filter_map(|(name, values)| {
                let (input, rho) = self.strongest(values)?;
                Some((name.to_owned(), input, rho))
            })
            .collect();
        let scatters = self.scatters(&of_failures, &of_metrics);
        Causes { flights: self.failed.len() as u64, failures, of_failures, of_metrics, scatters }
    }

    fn scatters(&self, of_failures: &[Cause], of_metrics: &[(String, String, f64)]) -> Vec<Scatter> {
        let flights = Flights { failed: &self.failed };
        let of_input = |name: &str| {
            let column = self.inputs.iter().find(|column| column.name == name && column.words.is_empty())?;
            Some((column.name.clone(), column.padded(self.failed.len()).collect::<Vec<f64>>()))
        };
        let pair = of_failures.iter().find(|cause| of_input(&cause.input).is_some()).and_then(|first| {
            let others = of_failures.iter().map(|cause| cause.input.as_str());
            Some([of_input(&first.input)?, of_input(partner(&first.input, others)?)?])
        });
        let pair = pair.filter(|_| self.failed.contains(&true));
        let of_metrics = of_metrics.iter().filter_map(|(metric, input, _)| {
            let (_, values) = std::iter::zip(METRICS, &self.metrics).find(|(name, _)| name == metric)?;
            Some([of_input(input)?, (metric.clone(), values.clone())])
        });
        pair.into_iter().chain(of_metrics).map(|axes| flights.scatter(axes)).collect()
    }

    fn cause(&self, column: &Column) -> Option<Cause> {
        let rows = std::iter::zip(column.padded(self.failed.len()), self.failed.iter().copied());
        let (split, rho, classes) = if column.words.is_empty() {
            let rows: Vec<(f64, bool)> = rows.collect();
            let fails: Vec<f64> = rows.iter().map(|&(_, failed)| f64::from(u8::from(failed))).collect();
            let values: Vec<f64> = rows.iter().map(|&(value, _)| value).collect();
            let rho = spearman(&values, &fails).map(|correlation| correlation.rho);
            (best_split(&rows)?, rho, classes_of_numbers(&rows))
        } else {
            let known = rows.filter(|(value, _)| value.is_finite());
            let rows: Vec<(usize, bool)> = known.map(|(value, failed)| (value as usize, failed)).collect();
            (best_word_split(&rows, &column.words)?, None, classes_of_words(&rows, &column.words))
        };
        let is_real = split.p * (self.inputs.len() as f64) < Significance::LEVEL;
        Some(Cause { input: column.name.clone(), split, rho, is_real, classes })
    }

    /// Returns the numeric input with the strongest rank correlation, if it is significant.
    fn strongest(&self, metric: &[f64]) -> Option<(String, f64)> {
        let numbers: Vec<&Column> = self.inputs.iter().filter(|column| column.words.is_empty()).collect();
        let count = numbers.len() as f64;
        numbers
            .into_iter()
            .filter_map(|column| {
                let values: Vec<f64> = column.padded(metric.len()).collect();
                let Correlation { rho, p } = spearman(&values, metric)?;
                (p * count < Significance::LEVEL).then(|| (column.name.clone(), rho))
            })
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }
}

impl Column {
    fn set(&mut self, row: usize, value: &InputValue) {
        // A campaign whose inputs differ from flight to flight has gaps.
        self.values.resize(row, f64::NAN);
        let value = match value {
            InputValue::Number(number) if self.words.is_empty() => *number,
            other => {
                let word = other.to_string();
                let index = match self.words.iter().position(|known| *known == word) {
                    Some(index) => index,
                    None => {
                        self.words.push(word);
                        self.words.len() - 1
                    }
                };
                index as f64
            }
        };
        self.values.push(value);
    }

    /// Returns the values, with gaps at the end for so many flights.
    fn padded(&self, count: usize) -> impl Iterator<Item = f64> {
        self.values.iter().copied().chain(std::iter::repeat(f64::NAN)).take(count)
    }
}

/// Returns the input that is shown beside one of the wind or another: the other component of the wind, or the next one that
/// is not the same wind again.
fn partner<'a>(input: &str, mut others: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let is_wind = |name: &str| COMPONENTS.contains(&name) || name.starts_with("wind_");
    let is_component = COMPONENTS.contains(&input);
    others.find(|other| {
        *other != input
            && (COMPONENTS.contains(other) == is_component)
            && (is_component || !(is_wind(input) && is_wind(other)))
    })
}

fn number(record: &Record, name: &str) -> Option<f64> {
    record.inputs.iter().find(|(known, _)| known == name).and_then(|(_, value)| value.number())
}
