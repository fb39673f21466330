//! The difference that another value of a setting makes.

use crate::flight::forecast::Forecast;
use crate::ui::units::Units;

/// Returns the difference to the flight without the change: `time −0:20, battery +2 %, worst xte 0.9 m → 1.4 m`;
/// `None` if the forecast does not change a setting.
pub(in crate::ui) fn difference(flown: &Forecast, units: Units) -> Option<String> {
    let unchanged = flown.unchanged.as_deref()?;
    let seconds = (flown.time_s - unchanged.time_s).round() as i64;
    let sign = if seconds < 0 { '−' } else { '+' };
    let (minutes, rest) = (seconds.abs() / 60, seconds.abs() % 60);
    // Rounded before the sign is taken.
    let used_pct = (10.0 * (flown.battery_used_pct - unchanged.battery_used_pct)).round() / 10.0;
    let sign_pct = if used_pct < 0.0 { '−' } else { '+' };
    let xte = |forecast: &Forecast| {
        forecast.worst_xte.map_or_else(|| "—".to_owned(), |worst| units.length_text(worst.xte_m, 1))
    };
    let end = if flown.end == unchanged.end && flown.is_complete() == unchanged.is_complete() {
        String::new()
    } else {
        format!(", without it {}", unchanged.line(|metres| units.length_text(metres, 0)))
    };
    Some(format!(
        "time {sign}{minutes}:{rest:02}, battery used {sign_pct}{:.1} %, worst xte {} → {}{end}",
        used_pct.abs(),
        xte(unchanged),
        xte(flown),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::forecast::{FlightResult, ForecastEnd, ForecastKind, WorstXte};

    fn forecast(time_s: f64, used_pct: f64, xte_m: Option<f64>) -> Forecast {
        Forecast {
            kind: ForecastKind::PlanEstimate,
            end: ForecastEnd::Flight(FlightResult::Complete),
            reason: String::new(),
            time_s,
            battery_used_pct: used_pct,
            worst_xte: xte_m.map(|xte_m| WorstXte { xte_m, wp: 1 }),
            fence_margin_m: None,
            legs: Vec::new(),
            moved_m: 0.0,
            path: Vec::new(),
            unchanged: None,
        }
    }

    #[test]
    fn time_battery_and_cross_track_are_compared() {
        let unchanged = Box::new(forecast(132.0, 40.0, Some(0.9)));
        let flown = Forecast { unchanged: Some(unchanged), ..forecast(112.4, 42.24, Some(1.4)) };
        assert_eq!(
            difference(&flown, Units::Metric).unwrap(),
            "time −0:20, battery used +2.2 %, worst xte 0.9 m → 1.4 m"
        );
        assert_eq!(difference(&forecast(1.0, 1.0, None), Units::Metric), None);
        let same =
            Forecast { unchanged: Some(Box::new(forecast(10.0, 1.01, None))), ..forecast(10.0, 1.0, None) };
        assert_eq!(
            difference(&same, Units::Metric).unwrap(),
            "time +0:00, battery used +0.0 %, worst xte — → —"
        );
    }

    #[test]
    fn another_end_is_named() {
        let grounded = Forecast {
            end: ForecastEnd::Grounded,
            reason: "the craft does not take off".to_owned(),
            ..forecast(0.0, 0.0, None)
        };
        let flown = Forecast { unchanged: Some(Box::new(grounded)), ..forecast(65.0, 1.0, None) };
        let text = difference(&flown, Units::Metric).unwrap();
        assert!(text.ends_with("worst xte — → —, without it the craft does not take off"), "{text}");
    }
}
