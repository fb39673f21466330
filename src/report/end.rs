//! The end of a flight, as the last event and the last lines on standard error report it.

use crate::telemetry::FlightTruth;

/// The end of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct End {
    /// The result in one word: `complete`, `missed`, `landed`, `refused`, `aborted`, `disarmed`, `crashed`, `timeout`,
    /// `diverged`, `interrupted`.
    pub result: String,
    /// The reason as a sentence; may be empty.
    pub reason: String,
    pub truth: FlightTruth,
    /// Simulated seconds from engagement (or boot, if there was none) to the end.
    pub flown_s: f64,
    /// Seconds of wall time for that part.
    pub wall_s: f64,
    /// A hash over the record of the flight, or over the motor packets of a remote firmware in simulated time. Two equal
    /// flights have the same one. `None` for an interrupted flight and on the wall clock.
    pub hash: Option<u64>,
}

impl End {
    /// Returns the speed as a multiple of real time; zero if the clock did not move.
    pub fn speed_ratio(&self) -> f64 {
        if self.wall_s > 0.0 { self.flown_s / self.wall_s } else { 0.0 }
    }

    /// Returns `complete: landed and disarmed`, the last line but one on standard error.
    pub fn result_line(&self) -> String {
        let Self { result, reason, .. } = self;
        if reason.is_empty() { result.clone() } else { format!("{result}: {reason}") }
    }

    /// Returns `flown 312.4 s in 0.21 s (1488x real time)`, the last line on standard error.
    pub fn flown_line(&self) -> String {
        let (flown, wall, ratio) = (self.flown_s, self.wall_s, self.speed_ratio());
        let decimals = if ratio < 10.0 { 1 } else { 0 };
        format!("flown {flown:.1} s in {wall:.2} s ({ratio:.decimals$}x real time)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_lines_read_as_documented() {
        let end = End {
            result: "complete".to_owned(),
            reason: "landed and disarmed".to_owned(),
            truth: FlightTruth::default(),
            flown_s: 312.4,
            wall_s: 0.21,
            hash: None,
        };
        assert_eq!(end.flown_line(), "flown 312.4 s in 0.21 s (1488x real time)");
        assert_eq!(end.result_line(), "complete: landed and disarmed");
        assert!(End { wall_s: 0.0, ..end.clone() }.speed_ratio().abs() < f64::EPSILON);
        assert!(End { wall_s: 312.0, ..end }.flown_line().ends_with("(1.0x real time)"));
    }
}
