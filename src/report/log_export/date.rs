//! The date of a log.

use time::OffsetDateTime;
use time::format_description::well_known::Rfc3339;

use crate::flight_log::LogFlight;
use crate::report::UtcSeconds;

/// The line of the header with the date.
const LINE: &str = "Log start datetime";
/// A craft without a clock writes an earlier date, 2000-01-01.
const EARLIEST: u64 = 946_684_800;

/// Returns the instant at which the craft booted, to half a second: before the date of the header by the time of the first
/// frame. Returns `None` if the log has no date.
pub(super) fn boot(flight: &LogFlight) -> Option<UtcSeconds> {
    let start = OffsetDateTime::parse(flight.header().value(LINE)?, &Rfc3339).ok()?;
    let start = u64::try_from(start.unix_timestamp()).ok().filter(|seconds| *seconds > EARLIEST)?;
    Some(UtcSeconds(start.saturating_sub((flight.first().0 + 500_000) / 1_000_000)))
}
