//! What explains the failures: the inputs, by how much they tell about them.

use crate::campaign::record::{InputValue, Record, Standing};
use crate::campaign::statistics::{Correlation, Significance, Split, best_split, best_word_split, spearman};

/// The metrics whose dependence on the inputs is shown.
const METRICS: [&str; 3] = ["cross_track", "touchdown", "battery_left"];

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
        if record.standing == Standing::Skipped {
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
            self.column("wind from the north").set(row, &InputValue::Number(speed * libm::cos(from)));
            self.column("wind from the east").set(row, &InputValue::Number(speed * libm::sin(from)));
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
        let of_metrics = std::iter::zip(METRICS, &self.metrics)
            .filter_map(|(name, values)| {
                let (input, rho) = self.strongest(values)?;
                Some((name.to_owned(), input, rho))
            })
            .collect();
        Causes { flights: self.failed.len() as u64, failures, of_failures, of_metrics }
    }

    fn cause(&self, column: &Column) -> Option<Cause> {
        let rows = std::iter::zip(column.padded(self.failed.len()), self.failed.iter().copied());
        let (split, rho) = if column.words.is_empty() {
            let rows: Vec<(f64, bool)> = rows.collect();
            let fails: Vec<f64> = rows.iter().map(|&(_, failed)| f64::from(u8::from(failed))).collect();
            let values: Vec<f64> = rows.iter().map(|&(value, _)| value).collect();
            (best_split(&rows)?, spearman(&values, &fails).map(|correlation| correlation.rho))
        } else {
            let known = rows.filter(|(value, _)| value.is_finite());
            let rows: Vec<(usize, bool)> = known.map(|(value, failed)| (value as usize, failed)).collect();
            (best_word_split(&rows, &column.words)?, None)
        };
        let is_real = split.p * (self.inputs.len() as f64) < Significance::LEVEL;
        Some(Cause { input: column.name.clone(), split, rho, is_real })
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

fn number(record: &Record, name: &str) -> Option<f64> {
    record.inputs.iter().find(|(known, _)| known == name).and_then(|(_, value)| value.number())
}
