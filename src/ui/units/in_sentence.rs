//! Lengths and speeds in sentences that the rest of the program writes in metric units.

use super::Units;

/// The metric units that are converted, the longer one first.
const METRIC: [&str; 2] = [" m/s", " m"];

impl Units {
    /// Returns a sentence with its lengths and speeds in the shown units, with as many decimals. Text in backquotes is for
    /// the craft, and stays as it is.
    pub(in crate::ui) fn in_sentence(self, text: String) -> String {
        if self == Self::Metric || !text.contains(METRIC[1]) {
            return text;
        }
        let mut shown = String::with_capacity(text.len());
        let mut is_quoted = false;
        let mut rest = text.as_str();
        while let Some(at) = rest.find(|c: char| c == '`' || c.is_ascii_digit()) {
            let (before, from) = rest.split_at(at);
            shown.push_str(before);
            let is_number = |c: char| c.is_ascii_digit() || c == '.';
            let end = from.find(|c| !is_number(c)).unwrap_or(from.len()).max(1);
            let (number, after) = from.split_at(end);
            let is_word = shown.ends_with(|c: char| c.is_alphanumeric() || c == '_');
            is_quoted ^= number == "`";
            match self.quantity(number, after).filter(|_| !is_quoted && !is_word) {
                Some((quantity, unit)) => {
                    shown.push_str(&quantity);
                    rest = &after[unit..];
                }
                None => {
                    shown.push_str(number);
                    rest = after;
                }
            }
        }
        shown + rest
    }

    /// Returns a metric quantity in the shown unit, and the length of its metric unit; `None` for any other number.
    fn quantity(self, number: &str, after: &str) -> Option<(String, usize)> {
        let value: f64 = number.parse().ok()?;
        let decimals = number.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let unit = METRIC.iter().find(|unit| {
            let beyond = after.strip_prefix(**unit).map(|beyond| beyond.chars().next());
            beyond.is_some_and(|next| next.is_none_or(|c| !c.is_alphanumeric() && !"/²³·".contains(c)))
        })?;
        let quantity = if *unit == METRIC[0] {
            self.speed_text(value, decimals)
        } else {
            self.length_text(value, decimals)
        };
        Some((quantity, unit.len()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_name_lengths_and_speeds_in_the_shown_units() {
        for (metric, imperial) in [
            ("reached (arrival 2.0 m ≤ 2.0 m).", "reached (arrival 6.6 ft ≤ 6.6 ft)."),
            (
                "Geofence: 174.0 m from home, the fence is 150 m: landing",
                "Geofence: 570.9 ft from home, the fence is 492 ft: landing",
            ),
            ("came down at 0.53 m/s, peak 58.9 m/s².", "came down at 1.19 mph, peak 58.9 m/s²."),
            ("-0.4 m, +3.0 m/s", "-1.3 ft, +6.7 mph"),
            (
                "`set x = 5 m` stays; 2 minutes, 3 ms, WP1 m, 5 km, 12 m",
                "`set x = 5 m` stays; 2 minutes, 3 ms, WP1 m, 5 km, 39 ft",
            ),
            ("at 1.2.3 m, 7.", "at 1.2.3 m, 7."),
        ] {
            assert_eq!(Units::Imperial.in_sentence(metric.to_owned()), imperial);
            assert_eq!(Units::Metric.in_sentence(metric.to_owned()), metric);
        }
    }
}
