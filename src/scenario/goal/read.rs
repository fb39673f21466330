//! Goals of a campaign: `success >= 99 % with 95 % confidence`, `p95(touchdown) <= 2 m`.

use std::collections::BTreeMap;

use strum::IntoEnumIterator as _;

use crate::scenario::expression::{Cursor, Scope, SyntaxError, bare};
use crate::scenario::goal::{Goal, GoalLimit, GoalStatistic, Quantity, Subject};
use crate::scenario::happening::RESULTS;
use crate::scenario::metric::Metric;
use crate::telemetry::quantity::Dimension;

/// The forms of the left side, for messages.
const HINT: &str =
    "write success, share(crashed), or p95, median, mean, min or max of a metric: p95(touchdown)";

/// Reads a goal. `measures` are the names of the file's measures. The line and the label are left empty.
///
/// # Errors
/// Returns the mistake in the text.
pub(in crate::scenario) fn read_goal(
    cursor: &mut Cursor<'_>,
    measures: &BTreeMap<String, Dimension>,
) -> Result<Goal, SyntaxError> {
    cursor.term()?;
    let subject = read_subject(cursor, measures)?;
    let (is_least, is_strict) = if cursor.take("<=") || cursor.take("≤") {
        (false, false)
    } else if cursor.take(">=") || cursor.take("≥") {
        (true, false)
    } else if cursor.take("<") {
        (false, true)
    } else if cursor.take(">") {
        (true, true)
    } else {
        return Err(cursor.error("a comparison is expected here", "write <=, >=, < or >"));
    };
    let value =
        if subject.is_share() { read_share(cursor)? } else { read_value(cursor, subject.dimension())? };
    let confidence = read_confidence(cursor, &subject)?;
    let limit = GoalLimit { value, is_least, is_strict };
    Ok(Goal { label: String::new(), line: 0, subject, limit, confidence })
}

fn read_subject(
    cursor: &mut Cursor<'_>,
    measures: &BTreeMap<String, Dimension>,
) -> Result<Subject, SyntaxError> {
    let Some(word) = cursor.peek_word() else {
        return Err(cursor.error("a number of the campaign is expected here", HINT));
    };
    if word == "success" {
        cursor.take_word(word);
        return Ok(Subject::Success);
    }
    if word == "share" {
        cursor.take_word(word);
        cursor.expect("(")?;
        let result = cursor.peek_word().filter(|word| RESULTS.contains(word));
        let Some(result) = result else { return Err(cursor.unknown("a result", RESULTS.into_iter())) };
        cursor.take_word(result);
        cursor.expect(")")?;
        return Ok(Subject::Share(result.to_owned()));
    }
    let Some(statistic) = statistic(word) else {
        let mut error = cursor.unknown(
            "a number of a campaign",
            ["success", "share", "median", "mean", "min", "max", "p95"].into_iter(),
        );
        error.hint = HINT.to_owned();
        return Err(error);
    };
    cursor.take_word(word);
    cursor.expect("(")?;
    let name = cursor.peek_word().unwrap_or_default();
    let dimension = measures.get(name).copied().or_else(|| Metric::find(name).map(Metric::dimension));
    let Some(dimension) = dimension else {
        let metrics: Vec<&str> = Metric::iter().map(Into::into).collect();
        let known = metrics.into_iter().chain(measures.keys().map(String::as_str));
        return Err(cursor.unknown("a metric or a measure", known));
    };
    cursor.take_word(name);
    cursor.expect(")")?;
    Ok(Subject::Statistic(statistic, Quantity { name: name.to_owned(), dimension }))
}

fn statistic(word: &str) -> Option<GoalStatistic> {
    Some(match word {
        "median" => GoalStatistic::Quantile(0.5),
        "mean" => GoalStatistic::Mean,
        "min" => GoalStatistic::Min,
        "max" => GoalStatistic::Max,
        _ => {
            let percent: f64 = word.strip_prefix('p')?.parse::<u8>().ok()?.into();
            return (0.0 < percent && percent < 100.0).then_some(GoalStatistic::Quantile(percent / 100.0));
        }
    })
}

/// Reads a share with its unit: 99 without one would be 9900 %. A number up to 1 without one is a share already.
fn read_share(cursor: &mut Cursor<'_>) -> Result<f64, SyntaxError> {
    let start = cursor.at();
    let (number, _) = Scope::default().read_number(&mut cursor.clone())?;
    if bare(&number) {
        let value = read_value(cursor, Dimension::NONE)?;
        let percent = if value.abs() <= 1.0 { (value * 1e11).round() / 1e9 } else { value };
        let hint = format!("allowed: %; write {percent} %");
        return Err(cursor.error_since(
            start,
            "a number without a unit does not fit: shares are compared",
            hint,
        ));
    }
    read_value(cursor, Dimension::NONE)
}

fn read_value(cursor: &mut Cursor<'_>, dimension: Dimension) -> Result<f64, SyntaxError> {
    let start = cursor.at();
    let (number, found) = Scope::default().read_number(cursor)?;
    if found != dimension {
        let hint = format!("allowed: {}", dimension.unit_names());
        return Err(cursor.error_since(start, format!("{found} do not fit: {dimension} are compared"), hint));
    }
    number.constant(&|_| None).filter(|value| value.is_finite()).ok_or_else(|| {
        cursor.error_since(start, "this is not known before the flights", "write a number with its unit")
    })
}

/// Reads `with 95 % confidence`.
fn read_confidence(cursor: &mut Cursor<'_>, subject: &Subject) -> Result<Option<f64>, SyntaxError> {
    let start = cursor.at();
    if !cursor.take_keyword("with") {
        return Ok(None);
    }
    // 95 % is 0.95 and not the product of 95 and a hundredth.
    let share = (read_share(cursor)? * 1e9).round() / 1e9;
    if !cursor.take_keyword("confidence") {
        return Err(cursor.error("confidence is expected here", "write with 95 % confidence"));
    }
    if !(0.5..1.0).contains(&share) {
        return Err(cursor.error_since(start, "this is no confidence", "allowed: 50 % to 99.999 %"));
    }
    match subject {
        Subject::Success | Subject::Share(_) | Subject::Statistic(GoalStatistic::Quantile(_), _) => {
            Ok(Some(share))
        }
        Subject::Statistic(..) => Err(cursor.error_since(
            start,
            "only shares, the median and p1 to p99 have an interval",
            "leave the confidence out",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Goal, SyntaxError> {
        let measures = BTreeMap::from([("lap".to_owned(), Dimension::TIME)]);
        let mut cursor = Cursor::new(text);
        let goal = read_goal(&mut cursor, &measures)?;
        cursor.finish()?;
        Ok(goal)
    }

    #[test]
    fn goals_of_every_kind_are_read() {
        let goal = read("success >= 99 % with 95 % confidence").unwrap();
        assert_eq!((goal.subject, goal.confidence), (Subject::Success, Some(0.95)));
        assert!((goal.limit.value - 0.99).abs() < 1e-12 && goal.limit.is_least);
        let goal = read("p95(touchdown) < 200 cm").unwrap();
        let Subject::Statistic(GoalStatistic::Quantile(share), quantity) = goal.subject else { panic!() };
        assert!((share - 0.95).abs() < 1e-12 && quantity.name == "touchdown");
        assert!((goal.limit.value - 2.0).abs() < 1e-12 && goal.limit.is_strict && !goal.limit.is_least);
        assert_eq!(read("share(crashed) <= 0 %").unwrap().subject, Subject::Share("crashed".to_owned()));
        assert!(read("mean(lap) <= 120 s").is_ok());
        assert!(read("max(fence_margin) >= 0 m").is_ok());
        assert!(read("min(battery_left) >= 20 %").is_ok());
    }

    #[test]
    fn mistakes_are_reported_with_a_way_out() {
        for (text, message) in [
            ("", "a number of the campaign is expected here"),
            ("sucess >= 99 %", "sucess is not a number of a campaign"),
            ("p95(touchdwn) <= 2 m", "touchdwn is not a metric or a measure"),
            ("share(lost) <= 1 %", "lost is not a result"),
            ("p95(touchdown) = 2 m", "a comparison is expected here"),
            ("p95(touchdown) <= 2 s", "seconds do not fit: metres are compared"),
            ("p100(touchdown) <= 2 m", "p100 is not a number of a campaign"),
            ("success >= 99", "a number without a unit does not fit: shares are compared"),
            ("success>=0.99", "a number without a unit does not fit: shares are compared"),
            ("share(crashed) <= 0", "a number without a unit does not fit: shares are compared"),
            ("min(battery_left) >= -20", "a number without a unit does not fit: shares are compared"),
            (
                "success >= 99 % with 95 confidence",
                "a number without a unit does not fit: shares are compared",
            ),
            ("success >= 99 % with 20 % confidence", "this is no confidence"),
            ("success >= 99 % with 95 %", "confidence is expected here"),
            (
                "max(touchdown) <= 2 m with 95 % confidence",
                "only shares, the median and p1 to p99 have an interval",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.message.starts_with(message), "{text}: {}", error.message);
            assert!(!error.hint.is_empty(), "{text}");
        }
    }

    #[test]
    fn a_share_without_a_unit_is_answered_with_the_same_share_in_per_cent() {
        for (text, way_out) in [
            ("success >= 99", "write 99 %"),
            ("success >= 0.99", "write 99 %"),
            ("success >= 0.07", "write 7 %"),
            ("success >= 1", "write 100 %"),
            ("share(crashed) <= 0", "write 0 %"),
            ("success >= 99 % with 0.95 confidence", "write 95 %"),
        ] {
            assert_eq!(read(text).unwrap_err().hint, format!("allowed: %; {way_out}"), "{text}");
        }
    }
}
