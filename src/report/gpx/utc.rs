//! UTC calendar time from a count of seconds.

use std::fmt;

use crate::signals::SIMULATED_BOOT_UNIX_S;

/// Seconds since 1970-01-01T00:00:00Z without leap seconds. `Display` gives `2026-01-01T00:00:00Z`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct UtcSeconds(pub u64);

impl UtcSeconds {
    /// The instant of boot in simulated flights, 2026-01-01T00:00:00Z.
    pub const SIMULATED_BOOT: Self = Self(SIMULATED_BOOT_UNIX_S);

    /// Returns the date and the time in the form of a version line: `Jan 01 2026`, `00:00:00`.
    pub fn build_stamp(self) -> (String, String) {
        const MONTHS: [&str; 12] =
            ["Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"];
        let (year, month, day) = civil(self.0 / 86_400);
        let month = usize::try_from(month).ok().and_then(|month| MONTHS.get(month - 1)).unwrap_or(&"???");
        let second = self.0 % 86_400;
        let (hour, minute) = (second / 3600, second / 60 % 60);
        (format!("{month} {day:02} {year}"), format!("{hour:02}:{minute:02}:{:02}", second % 60))
    }

    /// Returns the instant `seconds` later.
    pub fn plus(self, seconds: u64) -> Self {
        Self(self.0.saturating_add(seconds))
    }
}

impl fmt::Display for UtcSeconds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (year, month, day) = civil(self.0 / 86_400);
        let second = self.0 % 86_400;
        let (hour, minute) = (second / 3600, second / 60 % 60);
        write!(f, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{:02}Z", second % 60)
    }
}

/// Returns the Gregorian year, month and day for a count of days since 1970-01-01. Its years begin in March, so that
/// the leap day is the last day of a year.
fn civil(days: u64) -> (u64, u64, u64) {
    const DAYS_PER_ERA: u64 = 146_097;
    // 1970-01-01 is day 719 468 after 0000-03-01.
    let days = days + 719_468;
    let (era, day_of_era) = (days / DAYS_PER_ERA, days % DAYS_PER_ERA);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (era * 400 + year_of_era + u64::from(month <= 2), month, day)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_instants() {
        for (seconds, text) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (951_868_800, "2000-03-01T00:00:00Z"),
            (1_767_225_600, "2026-01-01T00:00:00Z"),
            (4_107_542_399, "2100-02-28T23:59:59Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
        ] {
            assert_eq!(UtcSeconds(seconds).to_string(), text);
        }
        assert_eq!(UtcSeconds::SIMULATED_BOOT.plus(61).to_string(), "2026-01-01T00:01:01Z");
    }
}
