//! The lines of a run's file, one for each flight.

use serde_json::{Map, Value, json};

use super::RunHeader;
use crate::campaign::{InputValue, Instant, Record, Side};

/// The reason why a line is not that of a flight of the campaign.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LineError {
    #[error("it is not the line of a flight")]
    NotAFlight,
    #[error("it belongs to another campaign")]
    Foreign,
}

/// Returns the line of a flight.
pub fn record_line(record: &Record, header: &RunHeader) -> String {
    let inputs: Map<String, Value> = record
        .inputs
        .iter()
        .map(|(name, value)| {
            let value = match value {
                InputValue::Number(number) => json!(number),
                InputValue::Word(word) => json!(word),
            };
            (name.clone(), value)
        })
        .collect();
    let metrics: Map<String, Value> =
        record.metrics.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    let mut line = json!({
        "event": "flight",
        "flight": record.number,
        "campaign": header.id,
        "version": header.version,
        "seed": record.seed,
        "inputs": inputs,
        "outcome": record.standing.to_string(),
        "problem": record.problem,
        "result": record.result,
        "reason": record.reason,
        "failures": record.failures,
        "margin": record.margin,
        "worst_s": record.worst_at.map(|at| at.seconds),
        "worst_from_boot": record.worst_at.is_some_and(|at| at.is_from_boot),
        "metrics": metrics,
        "flown_s": record.flown_s,
        "hash": format!("{:016x}", record.hash),
    });
    if header.sides() > 1
        && let Some(line) = line.as_object_mut()
    {
        line.insert("side".to_owned(), json!(record.side.to_string()));
    }
    line.to_string()
}

/// Reads the line of a flight.
///
/// # Errors
/// Fails if it is not one of this campaign.
pub fn read_record(line: &str, header: &RunHeader) -> Result<Record, LineError> {
    let value: Value = serde_json::from_str(line).map_err(|_| LineError::NotAFlight)?;
    if value["event"] != "flight" {
        return Err(LineError::NotAFlight);
    }
    if value["campaign"] != header.id.as_str() || value["version"] != header.version.as_str() {
        return Err(LineError::Foreign);
    }
    record(&value).ok_or(LineError::NotAFlight)
}

fn record(line: &Value) -> Option<Record> {
    let text = |key: &str| Some(line.get(key)?.as_str()?.to_owned());
    let numbers = |key: &str| {
        let object = line.get(key)?.as_object()?;
        object.iter().map(|(name, value)| Some((name.clone(), value.as_f64()?))).collect::<Option<Vec<_>>>()
    };
    let inputs = line.get("inputs")?.as_object()?.iter().map(|(name, value)| {
        let value = match value {
            Value::Number(number) => InputValue::Number(number.as_f64()?),
            Value::String(word) => InputValue::Word(word.clone()),
            _ => return None,
        };
        Some((name.clone(), value))
    });
    let side = match line.get("side") {
        None => Side::A,
        Some(side) => side.as_str()?.parse().ok()?,
    };
    let is_from_boot = line.get("worst_from_boot")?.as_bool()?;
    Some(Record {
        number: line.get("flight")?.as_u64().filter(|&number| number > 0)?,
        side,
        seed: line.get("seed")?.as_u64()?,
        inputs: inputs.collect::<Option<Vec<_>>>()?,
        standing: text("outcome")?.parse().ok()?,
        problem: text("problem"),
        result: text("result")?,
        reason: text("reason")?,
        failures: line
            .get("failures")?
            .as_array()?
            .iter()
            .map(|failure| failure.as_str().map(str::to_owned))
            .collect::<Option<Vec<_>>>()?,
        margin: line.get("margin")?.as_f64(),
        worst_at: line.get("worst_s")?.as_f64().map(|seconds| Instant { seconds, is_from_boot }),
        metrics: numbers("metrics")?,
        flown_s: line.get("flown_s")?.as_f64()?,
        hash: u64::from_str_radix(line.get("hash")?.as_str()?, 16).ok()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::Standing;
    use crate::report::campaign::{Definition, OtherSide};

    fn record(side: Side) -> Record {
        Record {
            number: 17,
            side,
            seed: 17,
            inputs: vec![
                ("airframe".to_owned(), InputValue::Word("iris".to_owned())),
                ("wind_mps".to_owned(), InputValue::Number(5.1324)),
            ],
            standing: Standing::Failed,
            problem: None,
            result: "missed".to_owned(),
            reason: "the \"autopilot\"\nsays complete".to_owned(),
            failures: vec!["result complete: no".to_owned()],
            margin: Some(-0.25),
            worst_at: Some(Instant { seconds: 88.32, is_from_boot: false }),
            metrics: vec![("cross_track".to_owned(), 1.25), ("touchdown".to_owned(), 0.0)],
            flown_s: 120.5,
            hash: 0x0123_4567_89ab_cdef,
        }
    }

    fn header(versus: bool) -> RunHeader {
        let versus = versus.then(OtherSide::default);
        RunHeader::new(Definition { versus, ..Definition::default() }, "0.1.0 abc", "x", 1000)
    }

    #[test]
    fn a_line_reads_back_and_has_nothing_of_the_wall_clock() {
        for (has_sides, side) in [(false, Side::A), (true, Side::A), (true, Side::B)] {
            let (record, header) = (record(side), header(has_sides));
            let line = record_line(&record, &header);
            assert_eq!(read_record(&line, &header), Ok(record));
            assert!(!line.contains('\n') && !line.contains("wall"), "{line}");
        }
    }

    #[test]
    fn lines_of_other_campaigns_and_other_lines_are_refused() {
        let line = record_line(&record(Side::A), &header(false));
        assert_eq!(read_record(&line, &header(true)), Err(LineError::Foreign));
        for wrong in
            ["", "{}", &line[..line.len() - 3], "[]", &line.replace("\"flight\":17", "\"flight\":-1")]
        {
            assert_eq!(read_record(wrong, &header(false)), Err(LineError::NotAFlight), "{wrong}");
        }
    }
}
