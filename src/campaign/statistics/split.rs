//! The split of the flights that separates failures from successes best: the first of a decision tree.

use crate::design::normal_cdf;

/// The least flights on each side of a split.
const LEAST: usize = 5;

/// A rule that divides the flights.
#[derive(Debug, Clone, PartialEq)]
pub enum Rule {
    /// The input is above this value, which is halfway between two that occur.
    Above(f64),
    /// The input is at most this value.
    AtMost(f64),
    /// The input is this word.
    Is(String),
}

/// The best division by one input. The rule is true for the side with the greater share of failures.
#[derive(Debug, Clone, PartialEq)]
pub struct Split {
    pub rule: Rule,
    /// The information about the failure of a flight that the rule gives, bits.
    pub gain: f64,
    /// Failures and flights for which the rule is true.
    pub inside: (u64, u64),
    /// Failures and flights for which it is false.
    pub outside: (u64, u64),
    /// The probability of such a gain, if failures have nothing to do with the input.
    pub p: f64,
}

/// A division that was tried.
#[derive(Debug, Clone, Copy)]
struct Tried {
    /// Failures and flights of the first side.
    first: (u64, u64),
    gain: f64,
}

/// Returns the best split of the flights by numbers; each flight has its number and `true` if it failed. Flights without a
/// number are left out.
pub(in crate::campaign) fn best_split(flights: &[(f64, bool)]) -> Option<Split> {
    let mut flights: Vec<(f64, bool)> =
        flights.iter().copied().filter(|(value, _)| value.is_finite()).collect();
    flights.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all = counts(&flights);
    let (mut below, mut best, mut tries) = ((0, 0), None::<(Tried, f64)>, 0);
    for pair in flights.windows(2) {
        let [(value, failed), (next, _)] = pair else { continue };
        below = (below.0 + u64::from(*failed), below.1 + 1);
        if value == next || below.1 < LEAST as u64 || all.1 - below.1 < LEAST as u64 {
            continue;
        }
        tries += 1;
        let gain = gain(below, all);
        if best.is_none_or(|(best, _)| gain > best.gain) {
            best = Some((Tried { first: below, gain }, value + (next - value) / 2.0));
        }
    }
    let (tried, threshold) = best?;
    Some(split(
        tried,
        all,
        tries,
        |is_first| {
            if is_first { Rule::AtMost(threshold) } else { Rule::Above(threshold) }
        },
    ))
}

/// Returns the best split of the flights by one of several words.
pub(in crate::campaign) fn best_word_split(flights: &[(usize, bool)], words: &[String]) -> Option<Split> {
    let all =
        flights.iter().fold((0, 0), |(failed, count), (_, fails)| (failed + u64::from(*fails), count + 1));
    let mut best: Option<(Tried, &String)> = None;
    let mut tries = 0;
    for (index, word) in words.iter().enumerate() {
        let of_word = flights.iter().filter(|(at, _)| *at == index);
        let first =
            of_word.fold((0, 0), |(failed, count), (_, fails)| (failed + u64::from(*fails), count + 1));
        if first.1 < LEAST as u64 || all.1 - first.1 < LEAST as u64 {
            continue;
        }
        tries += 1;
        // Only a word with more failures than the others is a cause.
        let is_cause = share(first) > share((all.0 - first.0, all.1 - first.1));
        let gain = if is_cause { gain(first, all) } else { 0.0 };
        if best.is_none_or(|(best, _)| gain > best.gain) {
            best = Some((Tried { first, gain }, word));
        }
    }
    let (tried, word) = best.filter(|(tried, _)| tried.gain > 0.0)?;
    Some(split(tried, all, tries, |_| Rule::Is(word.clone())))
}

fn split(tried: Tried, all: (u64, u64), tries: u32, rule: impl Fn(bool) -> Rule) -> Split {
    let Tried { first, gain } = tried;
    let second = (all.0 - first.0, all.1 - first.1);
    let is_first = share(first) > share(second);
    let (inside, outside) = if is_first { (first, second) } else { (second, first) };
    // Twice the gain in nats times the flights is χ² with one degree of freedom. The best of many tries is expected to be
    // large.
    let chi = (2.0 * std::f64::consts::LN_2 * gain * all.1 as f64).max(0.0).sqrt();
    let p = (2.0 * normal_cdf(-chi) * f64::from(tries)).min(1.0);
    Split { rule: rule(is_first), gain, inside, outside, p }
}

fn counts(flights: &[(f64, bool)]) -> (u64, u64) {
    (flights.iter().filter(|(_, failed)| *failed).count() as u64, flights.len() as u64)
}

fn share((failed, count): (u64, u64)) -> f64 {
    failed as f64 / count.max(1) as f64
}

/// Returns the entropy of the failures, bits a flight.
fn entropy(counts: (u64, u64)) -> f64 {
    let term = |p: f64| if p > 0.0 { -p * libm::log2(p) } else { 0.0 };
    let share = share(counts);
    term(share) + term(1.0 - share)
}

/// Returns the information gained by a division into a part and the rest.
fn gain(part: (u64, u64), all: (u64, u64)) -> f64 {
    let rest = (all.0 - part.0, all.1 - part.1);
    let weight = |side: (u64, u64)| side.1 as f64 / all.1.max(1) as f64;
    entropy(all) - weight(part) * entropy(part) - weight(rest) * entropy(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_perfect_split_gains_the_whole_entropy() {
        let flights: Vec<(f64, bool)> = (0..40).map(|wind| (f64::from(wind), wind >= 30)).collect();
        let split = best_split(&flights).unwrap();
        assert_eq!(split.rule, Rule::Above(29.5));
        assert_eq!((split.inside, split.outside), ((10, 10), (0, 30)));
        // −¼ log₂ ¼ − ¾ log₂ ¾
        assert!((split.gain - 0.811_278_124_459_133).abs() < 1e-12);
        assert!(split.p < 1e-8);
    }

    #[test]
    fn a_low_value_can_be_the_cause() {
        let flights: Vec<(f64, bool)> = (0..40).map(|charge| (f64::from(charge), charge < 8)).collect();
        let split = best_split(&flights).unwrap();
        assert_eq!((split.rule, split.inside), (Rule::AtMost(7.5), (8, 8)));
    }

    #[test]
    fn a_word_can_be_the_cause() {
        let words = ["open".to_owned(), "urban".to_owned(), "rtk".to_owned()];
        let flights: Vec<(usize, bool)> =
            (0..60).map(|index| (index % 3, index % 3 == 1 && index % 2 == 0)).collect();
        let split = best_word_split(&flights, &words).unwrap();
        assert_eq!((split.rule, split.inside), (Rule::Is("urban".to_owned()), (10, 20)));
        assert!(split.p < 0.001, "{}", split.p);
    }

    #[test]
    fn chance_is_not_taken_for_a_cause() {
        // Failures spread evenly over the values.
        let flights: Vec<(f64, bool)> =
            (0..200).map(|index| (f64::from(index % 97), index % 10 == 0)).collect();
        assert!(best_split(&flights).unwrap().p > 0.05);
        assert_eq!(best_split(&[(1.0, true); 50]), None, "a constant divides nothing");
        assert_eq!(best_split(&[]), None);
    }
}
