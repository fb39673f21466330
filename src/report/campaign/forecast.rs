//! The answer of a forecast: go or no-go, in one line.

use serde_json::json;

use super::shown;
use crate::campaign::{Cause, ForecastAnswer, Rule};
use crate::scenario::percent;

/// Returns the answer. `go_from` is the share of successful flights from which on it is go.
pub fn forecast_sentence(name: &str, forecast: &ForecastAnswer, go_from: f64) -> String {
    let word = if forecast.is_go(go_from) { "GO" } else { "NO-GO" };
    format!("{word} {name}: {}", forecast_reason(forecast))
}

/// Returns the answer for a screen with little room: the verdict, the share of successful flights and the advice first.
pub fn forecast_notice(name: &str, forecast: &ForecastAnswer, go_from: f64) -> String {
    let success = &forecast.answer.success;
    let Some(share) = success.share() else { return forecast_sentence(name, forecast, go_from) };
    let word = if forecast.is_go(go_from) { "GO" } else { "NO-GO" };
    let mut parts = vec![format!(
        "{word} {}: {} of {} complete with more than {} left",
        percent(share),
        success.passed,
        success.judged,
        whole(forecast.reserve)
    )];
    parts.extend(change(forecast).map(|change| format!("to change: {change}")));
    parts.extend(margins(forecast));
    parts.push(format!(
        "{} to {} with 95 % confidence; plan {name}",
        percent(success.low),
        percent(success.high)
    ));
    parts.join("; ")
}

/// Returns the reason of the answer.
pub fn forecast_reason(forecast: &ForecastAnswer) -> String {
    let answer = &forecast.answer;
    let success = &answer.success;
    let reserve = whole(forecast.reserve);
    let unflown = match (success.not_flown, answer.not_flown.first()) {
        (0, _) | (_, None) => None,
        (all, Some((reason, count))) if all == *count => Some(format!("{all} could not be flown: {reason}")),
        (all, Some((reason, count))) => {
            Some(format!("{all} could not be flown, {count} of them for this reason: {reason}"))
        }
    };
    let Some(share) = success.share() else {
        return unflown.unwrap_or_else(|| "no flight could be judged".to_owned());
    };
    let mut parts = vec![format!(
        "{} complete with more than {reserve} of the battery left ({} of {}; {} to {} with 95 % confidence)",
        percent(share),
        success.passed,
        success.judged,
        percent(success.low),
        percent(success.high)
    )];
    parts.extend(unflown);
    parts.extend(margins(forecast));
    parts.extend(change(forecast).map(|change| format!("to change: {change}")));
    parts.join("; ")
}

/// Returns the least charge and the least distance to the fence.
fn margins(forecast: &ForecastAnswer) -> impl Iterator<Item = String> {
    let left = forecast.least_left.map(|left| format!("at least {} left", whole(left)));
    let fence = fence_margin(forecast).map(|margin| {
        if margin < 0.0 {
            format!("up to {:.1} m beyond the fence", -margin)
        } else {
            format!("at least {margin:.1} m from the fence")
        }
    });
    left.into_iter().chain(fence)
}

fn whole(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// Returns the answer as one JSON object. Shares are between 0 and 1, lengths in metres.
pub fn forecast_json(name: &str, forecast: &ForecastAnswer, go_from: f64) -> String {
    let answer = &forecast.answer;
    let object = json!({
        "event": "forecast",
        "name": name,
        "go": forecast.is_go(go_from),
        "go_from": go_from,
        "flights": answer.flown,
        "flights_wanted": answer.wanted,
        "success": answer.success.share(),
        "low": answer.success.low,
        "high": answer.success.high,
        "confidence": 0.95,
        "reserve": forecast.reserve,
        "short_of_charge": forecast.short_of_charge,
        "least_left": forecast.least_left,
        "fence_margin_m": fence_margin(forecast),
        "change": change(forecast),
    });
    object.to_string()
}

fn fence_margin(forecast: &ForecastAnswer) -> Option<f64> {
    forecast.answer.distribution("fence_margin").map(|margin| margin.least)
}

/// Returns the change that would help most; `None` if no flight failed.
fn change(forecast: &ForecastAnswer) -> Option<String> {
    let answer = &forecast.answer;
    let failed = answer.success.judged - answer.success.passed;
    if failed == 0 {
        return None;
    }
    let cause = answer.causes.of_failures.iter().find(|cause| cause.is_real);
    if let Some(cause) = cause {
        return Some(format!("{} ({})", avoid(cause), shown::split(&cause.split)));
    }
    if 2 * forecast.short_of_charge > failed {
        let short = forecast.short_of_charge;
        return Some(format!(
            "a shorter plan or a larger battery ({short} flights end with too little charge)"
        ));
    }
    let worst = answer.worst.first().filter(|worst| !worst.has_passed)?;
    Some(format!("the plan, since flight {} ended so: {}", worst.number, shown::complaint(worst)))
}

/// Returns the advice that avoids a cause.
fn avoid(cause: &Cause) -> String {
    let split = &cause.split;
    let (input, rule) = (cause.input.as_str(), &split.rule);
    match (input, rule) {
        ("wind from the north", Rule::Above(limit)) if *limit > 0.0 => wait_for_wind(*limit, "north"),
        ("wind from the north", Rule::AtMost(limit)) if *limit < 0.0 => wait_for_wind(-limit, "south"),
        ("wind from the east", Rule::Above(limit)) if *limit > 0.0 => wait_for_wind(*limit, "east"),
        ("wind from the east", Rule::AtMost(limit)) if *limit < 0.0 => wait_for_wind(-limit, "west"),
        ("wind_mps", Rule::Above(limit)) => format!("wait for a wind of at most {limit:.1} m/s"),
        ("gust_mps", Rule::Above(limit)) => format!("wait for gusts of at most {limit:.1} m/s"),
        ("battery_pct", Rule::AtMost(limit)) => format!("start with more than {:.0} % charge", 100.0 + limit),
        (_, Rule::Above(_) | Rule::AtMost(_) | Rule::Is(_)) => format!("avoid {}", shown::rule(input, rule)),
    }
}

fn wait_for_wind(limit_mps: f64, from: &str) -> String {
    format!("wait until at most {limit_mps:.1} m/s of the wind come from the {from}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::{Forecast, InputValue, Record, Side, Split, Standing};
    use crate::scenario::{BuiltinFiles, Scenario, read};

    fn scenario() -> Scenario {
        read("plan.toml", "format = 1\n[plan]\nbuiltin = \"land\"\n", None, &mut BuiltinFiles).unwrap()
    }

    /// Returns a flight in a wind that it survives up to 8 m/s.
    fn flight(number: u64, wind_mps: f64, left: f64) -> Record {
        let passes = wind_mps <= 8.0;
        Record {
            number,
            side: Side::A,
            seed: number,
            inputs: vec![
                ("battery_pct".to_owned(), InputValue::Number(-50.0)),
                ("wind_mps".to_owned(), InputValue::Number(wind_mps)),
            ],
            standing: if passes { Standing::Passed } else { Standing::Failed },
            problem: None,
            result: if passes { "complete" } else { "crashed" }.to_owned(),
            reason: "the craft crashed".to_owned(),
            failures: Vec::new(),
            margin: None,
            worst_at: None,
            metrics: vec![("battery_left".to_owned(), left), ("fence_margin".to_owned(), 20.0 - wind_mps)],
            flown_s: 30.0,
            hash: number,
        }
    }

    fn forecast(flights: impl Iterator<Item = Record>) -> ForecastAnswer {
        let mut forecast = Forecast::new(&scenario(), 100, 0.2);
        flights.for_each(|flight| forecast.add(flight));
        forecast.answer()
    }

    #[test]
    fn the_reason_why_flights_could_not_be_flown_has_its_own_count() {
        let unflown = |number: u64, problem: String| {
            let flight = flight(number, 5.0, 0.4);
            let result = String::new();
            Record { standing: Standing::NotFlown, problem: Some(problem), result, ..flight }
        };
        let strong = |number: u64| unflown(number, format!("the legs are too strong: at most {number}.3"));
        let alike = forecast((1..=9).map(strong));
        assert_eq!(forecast_reason(&alike), "9 could not be flown: the legs are too strong: at most 1.3");
        let weak = |number: u64| unflown(number, "the motors are too weak".to_owned());
        let mixed = forecast((1..=9).map(strong).chain((10..=12).map(weak)));
        assert_eq!(
            forecast_reason(&mixed),
            "12 could not be flown, 9 of them for this reason: the legs are too strong: at most 1.3"
        );
    }

    #[test]
    fn calm_weather_is_go() {
        let answer = forecast((1..=100).map(|n| flight(n, 4.0, 0.9)));
        assert_eq!(
            forecast_sentence("land", &answer, 0.95),
            "GO land: 100 % complete with more than 20 % of the battery left (100 of 100; 96.3 % to 100 % with 95 % \
             confidence); at least 45 % left; at least 16.0 m from the fence"
        );
    }

    #[test]
    fn the_notice_begins_with_the_verdict_and_two_rows_hold_the_advice() {
        let answer = forecast((1..=100).map(|n| flight(n, n as f64 / 10.0, 0.9)));
        let notice = forecast_notice("a_plan_with_a_long_name_that_takes_a_row", &answer, 0.95);
        assert!(
            notice.starts_with("NO-GO 80.0 %: 80 of 100 complete with more than 20 % left; "),
            "{notice}"
        );
        let rows: String = notice.chars().take(140).collect();
        assert!(rows.contains("; to change: wait for a wind of at most 8.1 m/s ("), "{notice}");
        let calm = forecast((1..=100).map(|n| flight(n, 4.0, 0.9)));
        assert_eq!(
            forecast_notice("land", &calm, 0.95),
            "GO 100 %: 100 of 100 complete with more than 20 % left; at least 45 % left; at least 16.0 m from the \
             fence; 96.3 % to 100 % with 95 % confidence; plan land"
        );
    }

    #[test]
    fn the_planted_cause_of_failure_is_the_advice() {
        let answer = forecast((1..=100).map(|n| flight(n, n as f64 / 10.0, 0.9)));
        let sentence = forecast_sentence("land", &answer, 0.95);
        assert!(sentence.starts_with("NO-GO land: 80.0 % complete"), "{sentence}");
        assert!(sentence.contains("to change: wait for a wind of at most 8."), "{sentence}");
        let json: serde_json::Value = serde_json::from_str(&forecast_json("land", &answer, 0.95)).unwrap();
        assert_eq!((json["go"].as_bool(), json["success"].as_f64()), (Some(false), Some(0.8)));
    }

    #[test]
    fn a_component_of_the_wind_is_named_by_where_it_comes_from() {
        let split = |rule| Cause {
            input: "wind from the east".to_owned(),
            split: Split { rule, inside: (18, 20), outside: (0, 80), gain: 0.5, p: 1e-6 },
            rho: None,
            is_real: true,
            classes: Vec::new(),
        };
        assert_eq!(
            avoid(&split(Rule::AtMost(-12.19))),
            "wait until at most 12.2 m/s of the wind come from the west"
        );
        assert_eq!(
            avoid(&split(Rule::Above(7.5))),
            "wait until at most 7.5 m/s of the wind come from the east"
        );
        assert_eq!(avoid(&split(Rule::Above(-3.0))), "avoid wind from the east above -3");
    }

    #[test]
    fn a_share_of_a_half_full_battery_is_not_a_share_of_a_full_one() {
        let answer = forecast((1..=100).map(|n| flight(n, 4.0, 0.38)));
        assert_eq!(answer.short_of_charge, 100, "38 % of 50 % is 19 %");
        let sentence = forecast_sentence("land", &answer, 0.95);
        assert!(
            sentence.contains(
                "to change: a shorter plan or a larger battery (100 flights end with too little charge)"
            ),
            "{sentence}"
        );
    }

    #[test]
    fn an_answer_of_a_part_of_the_flights_is_no_go() {
        let answer = forecast((1..=40).map(|n| flight(n, 4.0, 0.9)));
        assert!(forecast_sentence("land", &answer, 0.95).starts_with("NO-GO"));
    }
}
