//! Failures along the inputs, for pictures.

/// The most classes of an input.
const CLASSES: usize = 10;
/// The least flights of a class.
const LEAST: usize = 5;
/// The most words of an input.
const WORDS: usize = 12;
/// The most flights of each kind in a scatter.
const POINTS: usize = 400;

/// Flights with similar values of an input.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureClass {
    pub values: Values,
    pub failed: u64,
    pub flights: u64,
}

/// The values of an input in a class.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// The least and the greatest number.
    Between(f64, f64),
    Word(String),
}

/// Flights by two numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Scatter {
    /// The names of the inputs or metrics: to the right and up.
    pub names: [String; 2],
    pub points: Vec<ScatterPoint>,
    /// `true` if some flights are left out.
    pub is_part: bool,
}

/// A flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScatterPoint {
    pub at: [f64; 2],
    pub failed: bool,
}

/// The flights of a scatter.
#[derive(Debug, Clone, Copy)]
pub(super) struct Flights<'a> {
    pub(super) failed: &'a [bool],
}

impl Flights<'_> {
    /// Returns the flights that have both numbers. Of many, as many at equal distances are taken of each kind.
    pub(super) fn scatter(&self, axes: [(String, Vec<f64>); 2]) -> Scatter {
        let [(x_name, x), (y_name, y)] = axes;
        let all = std::iter::zip(&x, &y).zip(self.failed);
        let points: Vec<ScatterPoint> = all
            .filter(|((x, y), _)| x.is_finite() && y.is_finite())
            .map(|((&x, &y), &failed)| ScatterPoint { at: [x, y], failed })
            .collect();
        let mut shown = Vec::new();
        for failed in [false, true] {
            let of_kind = points.iter().filter(|point| point.failed == failed);
            let step = of_kind.clone().count().div_ceil(POINTS).max(1);
            shown.extend(of_kind.step_by(step).copied());
        }
        let is_part = shown.len() < points.len();
        Scatter { names: [x_name, y_name], points: shown, is_part }
    }
}

/// Divides flights by a number into classes of about equally many flights. Flights without a number are left out.
pub(super) fn classes_of_numbers(flights: &[(f64, bool)]) -> Vec<FailureClass> {
    let mut flights: Vec<(f64, bool)> =
        flights.iter().copied().filter(|(value, _)| value.is_finite()).collect();
    flights.sort_by(|a, b| a.0.total_cmp(&b.0));
    let size = flights.len().div_ceil(CLASSES).max(LEAST);
    let mut classes = Vec::new();
    let mut rest = flights.as_slice();
    while let Some((last, _)) = rest.get(size.min(rest.len()).wrapping_sub(1)) {
        // Equal values are in the same class.
        let end = rest.partition_point(|(value, _)| value <= last);
        // The last class takes a rest that is too small for one.
        let end = if rest.len() - end < LEAST { rest.len() } else { end };
        let (class, others) = rest.split_at(end);
        let (from, to) =
            (class.first().map_or(0.0, |first| first.0), class.last().map_or(0.0, |last| last.0));
        let failed = class.iter().filter(|(_, failed)| *failed).count() as u64;
        classes.push(FailureClass { values: Values::Between(from, to), failed, flights: class.len() as u64 });
        rest = others;
    }
    classes
}

/// Divides flights by a word, the most frequent words first.
pub(super) fn classes_of_words(flights: &[(usize, bool)], words: &[String]) -> Vec<FailureClass> {
    let mut classes: Vec<FailureClass> = words
        .iter()
        .map(|word| FailureClass { values: Values::Word(word.clone()), failed: 0, flights: 0 })
        .collect();
    for &(word, failed) in flights {
        if let Some(class) = classes.get_mut(word) {
            class.flights += 1;
            class.failed += u64::from(failed);
        }
    }
    classes.sort_by_key(|class| std::cmp::Reverse(class.flights));
    classes.truncate(WORDS);
    classes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn classes_have_about_equally_many_flights_and_lose_none() {
        let flights: Vec<(f64, bool)> = (0..203).map(|n| (f64::from(n % 100), n % 100 >= 90)).collect();
        let classes = classes_of_numbers(&flights);
        assert!(classes.len() <= CLASSES && classes.len() > 5, "{}", classes.len());
        assert_eq!(classes.iter().map(|class| class.flights).sum::<u64>(), 203);
        assert_eq!(classes.iter().map(|class| class.failed).sum::<u64>(), 20);
        assert_eq!(classes[0].failed, 0);
        assert!(classes.last().is_some_and(|class| class.failed == class.flights), "{classes:?}");
        for pair in classes.windows(2) {
            let (Values::Between(_, before), Values::Between(after, _)) = (&pair[0].values, &pair[1].values)
            else {
                panic!("numbers");
            };
            assert!(before < after);
        }
    }

    #[test]
    fn few_or_equal_values_are_one_class() {
        assert_eq!(classes_of_numbers(&[]), []);
        assert_eq!(classes_of_numbers(&[(f64::NAN, true)]), []);
        for flights in [vec![(2.0, false); 100], vec![(1.0, true), (2.0, false), (3.0, false)]] {
            assert_eq!(classes_of_numbers(&flights).len(), 1);
        }
    }

    #[test]
    fn words_are_counted() {
        let words = ["none".to_owned(), "light".to_owned()];
        let classes = classes_of_words(&[(1, true), (0, false), (1, false)], &words);
        assert_eq!(
            classes[0],
            FailureClass { values: Values::Word("light".to_owned()), failed: 1, flights: 2 }
        );
    }

    #[test]
    fn a_scatter_of_many_flights_keeps_failures_among_successes() {
        let failed: Vec<bool> = (0..5000).map(|n| n % 100 == 0).collect();
        let axis = |name: &str| (name.to_owned(), (0..5000).map(f64::from).collect::<Vec<f64>>());
        let scatter = Flights { failed: &failed }.scatter([axis("a"), axis("b")]);
        assert_eq!(scatter.points.iter().filter(|point| point.failed).count(), 50);
        assert!(scatter.is_part && scatter.points.len() <= 2 * POINTS);
        let few = Flights { failed: &[true, false] }
            .scatter([("a".to_owned(), vec![1.0, 2.0]), ("b".to_owned(), vec![f64::NAN, 3.0])]);
        assert_eq!((few.points.len(), few.is_part), (1, false));
    }
}
