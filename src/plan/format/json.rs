//! JSON of other programs: finite numbers, no key twice, bounded depth.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Number, Value};

use super::Problems;

/// Parses a text. Adds a problem with its place and returns `None` if it is not such JSON.
pub(super) fn parse(text: &str, problems: &mut Problems<'_>) -> Option<Value> {
    let mut reader = serde_json::Deserializer::from_str(text);
    let parsed = Strict.deserialize(&mut reader).and_then(|value| reader.end().map(|()| value));
    parsed.map_err(|error| add_fault(text, &error, problems)).ok()
}

/// Adds the fault that the parser found in a text.
pub(super) fn add_fault(text: &str, error: &serde_json::Error, problems: &mut Problems<'_>) {
    let line_start = match error.line() {
        0 | 1 => 0,
        line => text.match_indices('\n').nth(line - 2).map_or(0, |(at, _)| at + 1),
    };
    let at = (line_start + error.column().saturating_sub(1)).min(text.len());
    let message = error.to_string();
    let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message);
    let hint = if error.is_data() { "" } else { "this is not valid JSON" };
    problems.add(at..at + 1, message, hint);
}

/// Reads any value, and refuses a key that is there twice.
struct Strict;

impl<'de> DeserializeSeed<'de> for Strict {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Strict {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(Value::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(Value::Number(value.into()))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(Value::Number(value.into()))
    }

    fn visit_f64<E: serde::de::Error>(self, value: f64) -> Result<Value, E> {
        Number::from_f64(value).map(Value::Number).ok_or_else(|| E::custom("the number is not finite"))
    }

    fn visit_str<E>(self, value: &str) -> Result<Value, E> {
        Ok(Value::String(value.to_owned()))
    }

    fn visit_string<E>(self, value: String) -> Result<Value, E> {
        Ok(Value::String(value))
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Value, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = seq.next_element_seed(Self)? {
            values.push(value);
        }
        Ok(Value::Array(values))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut values = Map::new();
        while let Some(key) = map.next_key::<String>()? {
            if values.contains_key(&key) {
                return Err(serde::de::Error::custom(format!("the key {key:?} is there twice")));
            }
            values.insert(key, map.next_value_seed(Self)?);
        }
        Ok(Value::Object(values))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> Vec<String> {
        let mut problems = Problems::new("x", text);
        parse(text, &mut problems);
        problems.into_errors().iter().map(super::super::PlanError::headline).collect()
    }

    #[test]
    fn strange_json_is_refused_with_its_place() {
        assert_eq!(faults("{\"a\":1,\n \"a\":2}"), ["x:2:4: the key \"a\" is there twice"]);
        assert_eq!(faults("{\"a\":1e999}"), ["x:1:10: number out of range"]);
        assert_eq!(faults("[1,\n2"), ["x:2:1: EOF while parsing a list"]);
        assert!(faults(&"[".repeat(100_000))[0].contains("recursion limit exceeded"));
        assert!(faults("{} x")[0].contains("trailing characters"));
        assert_eq!(faults("{\"a\":[null,true,-1.5,\"b\"]}"), [""; 0]);
    }
}
