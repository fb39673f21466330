//! The loop iterations that are logged.

use super::finding::HeaderFinding;
use super::lines::Lines;

/// The loop iterations that are logged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in super::super) struct Interval {
    /// The distance of whole main frames.
    intra: u64,
    /// `shown` of `of` iterations are logged.
    shown: u64,
    of: u64,
}

impl Interval {
    /// Reads the intervals, and adds what is assumed of them.
    pub(super) fn of(lines: &Lines, findings: &mut Vec<HeaderFinding>) -> Self {
        let number = |name: &str| lines.number(name).and_then(positive);
        let intra = number("I interval");
        if intra.is_none() {
            let assumed = "an interval of 1 is assumed, so iterations are right in whole frames only";
            findings.push(HeaderFinding::of(lines, "I interval", assumed));
        }
        let intra_or_one = intra.unwrap_or(1);
        // Old firmwares write a fraction.
        let text = lines.value("P interval").unwrap_or_default();
        let (shown, of) = text.split_once('/').unwrap_or(("1", text));
        let [shown, of] = [shown, of].map(|part| part.trim().parse().ok().and_then(positive));
        let (shown, of) = shown.zip(of).unwrap_or_else(|| {
            let of_ratio = intra.zip(number("P ratio")).map(|(intra, ratio)| (intra / ratio).max(1));
            let source = if of_ratio.is_some() { ", from `P ratio`" } else { "" };
            let of = of_ratio.unwrap_or(1);
            let assumed = format!("an interval of {of} is assumed{source}");
            findings.push(HeaderFinding::of(lines, "P interval", &assumed));
            (1, of)
        });
        Self { intra: intra_or_one, shown, of }
    }

    /// Returns the number of iterations after `iteration` that are not logged.
    pub(in super::super) fn skipped_after(self, iteration: u32) -> u32 {
        let place = (u64::from(iteration) + 1) % self.intra;
        let phase = (place + self.shown - 1) % self.of;
        let skipped = if phase < self.shown { 0 } else { (self.of - phase).min(self.intra - place) };
        u32::try_from(skipped).unwrap_or(u32::MAX)
    }
}

fn positive(value: i32) -> Option<u64> {
    u64::try_from(value).ok().filter(|value| *value > 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(intra: u64, shown: u64, of: u64) -> Interval {
        Interval { intra, shown, of }
    }

    /// Counts one by one.
    fn counted(of: Interval, iteration: u32) -> u32 {
        let is_shown = |at: u64| (at % of.intra + of.shown - 1) % of.of < of.shown;
        (0..).find(|more| is_shown(u64::from(iteration) + 1 + u64::from(*more))).unwrap()
    }

    #[test]
    fn iterations_that_are_not_logged_are_counted() {
        for (intra, shown, of) in
            [(32, 1, 4), (32, 1, 1), (32, 2, 3), (32, 5, 3), (32, 1, 64), (1, 1, 1), (30, 1, 7)]
        {
            let interval = interval(intra, shown, of);
            for iteration in 0..200 {
                assert_eq!(
                    interval.skipped_after(iteration),
                    counted(interval, iteration),
                    "{interval:?} {iteration}"
                );
            }
        }
        assert_eq!(interval(32, 1, 4).skipped_after(u32::MAX), 0);
        assert_eq!(interval(i32::MAX as u64, 1, i32::MAX as u64).skipped_after(0), i32::MAX as u32 - 1);
    }
}
