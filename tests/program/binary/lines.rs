//! JSON lines, checked strictly: the keys of an event, their order, and the kind of each value.

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::Value;

/// One line, with its keys in printed order.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Line(Vec<(String, Value)>);

impl<'de> Deserialize<'de> for Line {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;
        impl<'de> Visitor<'de> for Pairs {
            type Value = Line;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Line, A::Error> {
                let mut pairs = Vec::new();
                while let Some(pair) = map.next_entry()? {
                    pairs.push(pair);
                }
                Ok(Line(pairs))
            }
        }
        deserializer.deserialize_map(Pairs)
    }
}

impl Line {
    /// Reads and checks all lines of a flight.
    #[track_caller]
    pub(crate) fn read_all(text: &str) -> Vec<Self> {
        assert!(text.ends_with('\n'), "the last line is not ended: {text:?}");
        let lines: Vec<Self> = text.lines().map(Self::read).collect();
        assert_eq!(lines.first().map(Self::event), Some("boot"));
        assert_eq!(lines.iter().position(|line| line.event() == "end"), Some(lines.len() - 1));
        assert!(lines.windows(2).all(|pair| pair[0].time() <= pair[1].time()), "time runs backwards");
        lines
    }

    #[track_caller]
    fn read(text: &str) -> Self {
        let line: Self = serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"));
        check(&line.0, &format!("t:num event:text {}", fields(line.event())), text);
        line
    }

    /// Returns the value of a key that must exist.
    #[track_caller]
    pub(crate) fn value(&self, key: &str) -> &Value {
        let found = self.0.iter().find(|(name, _)| name == key);
        found.map_or_else(|| panic!("no {key} in {self:?}"), |(_, value)| value)
    }

    /// Returns the simulated seconds since boot.
    pub(crate) fn time(&self) -> f64 {
        self.number("t")
    }

    /// Returns the name of the event.
    pub(crate) fn event(&self) -> &str {
        self.text("event")
    }

    #[track_caller]
    pub(crate) fn number(&self, key: &str) -> f64 {
        self.value(key).as_f64().unwrap_or_else(|| panic!("{key} is no number in {self:?}"))
    }

    /// Returns a text. `null` reads as the empty text.
    #[track_caller]
    pub(crate) fn text(&self, key: &str) -> &str {
        match self.value(key) {
            Value::Null => "",
            value => value.as_str().unwrap_or_else(|| panic!("{key} is no text in {self:?}")),
        }
    }
}

/// Returns the documented fields of an event with their kinds; `?` marks a field that may be `null`. An
/// unknown event is an error.
fn fields(event: &str) -> &'static str {
    match event {
        "boot" => "version:text seed:num rate:num airframe:text live:flag",
        "gps_fix" | "gps_lost" => "sats:num",
        "armed" => "",
        "disarmed" => "reason:word",
        "mode" => "active:list",
        "plan" => "source:source count:num waypoints:list",
        "engage_refused" => "reason:word wp:num? cause:word? text:text",
        "state" => {
            "from:state to:state wp:num type:word? reason:text guard:map? target_lat:num target_lon:num target_alt:num"
        }
        "climbing" => "on:flag",
        "limited" => "by:text lean_deg:num",
        "cannot_hold" => "on:flag distance_m:num vertical_m:num limit:text",
        "geofence" => "distance_m:num limit_m:num action:word",
        "rx_loss" | "rx_recovered" | "failsafe" => "policy:text? stage:num procedure:text?",
        "fault" => "name:text on:flag value:text?",
        "contact" => "impact_mps:num",
        "touchdown" => "impact_mps:num peak_mps2:num",
        "crash" => "cause:text",
        "heading_doubt" => "on:flag error_deg:num",
        "battery" => "state:word cell_v:num",
        "notice" => "text:text",
        "sample" => {
            "lat:num lon:num alt:num n:num e:num vn:num ve:num vu:num roll:num pitch:num heading:num est_n:num? \
             est_e:num? est_alt:num? throttle_us:num motors:motors battery_v:num battery_a:num battery_mah:num \
             state:state wp:num? wp_type:word? dist_m:num? bearing:num? xte_m:num? l1_mode:l1 target_n:num? \
             target_e:num? target_alt:num? hold_remaining_ds:num wind_n:num wind_e:num"
        }
        "end" => {
            "result:result reason:text battery_used_pct:num waypoints:list parked_m:num? parked_mps:num? flown_s:num wall_s:num speed_ratio:num hash:hash"
        }
        _ => panic!("{event} is not a documented event"),
    }
}

/// Checks the keys, their order and the kind of each value.
#[track_caller]
fn check(pairs: &[(String, Value)], fields: &str, text: &str) {
    let names: Vec<&str> = pairs.iter().map(|(name, _)| name.as_str()).collect();
    // A flight that did not reach its end has no hash.
    let interrupted = pairs.iter().any(|(name, value)| name == "result" && value == "interrupted");
    let expected: Vec<(&str, &str)> = fields
        .split_whitespace()
        .map(|field| field.split_once(':').expect("name:kind"))
        .filter(|(_, kind)| *kind != "hash" || !interrupted)
        .collect();
    assert_eq!(names, expected.iter().map(|(name, _)| *name).collect::<Vec<_>>(), "{text}");
    for ((name, value), (_, kind)) in pairs.iter().zip(expected) {
        let nullable = kind.ends_with('?');
        assert!(
            nullable && value.is_null() || is(value, kind.trim_end_matches('?')),
            "{name} is no {kind}: {text}"
        );
    }
    if let Some((_, guard)) = pairs.iter().find(|(name, value)| name == "guard" && !value.is_null()) {
        let keys = ["name", "value", "limit", "unit", "margin", "op"];
        assert_eq!(guard.as_object().map(serde_json::Map::len), Some(keys.len()), "{text}");
        assert!(keys.iter().all(|key| guard.get(key).is_some()), "{text}");
    }
    if let Some((_, Value::Array(waypoints))) = pairs.iter().find(|(name, _)| name == "waypoints") {
        for waypoint in waypoints {
            let map = waypoint.as_object().expect("a waypoint");
            let keys: &[&str] = if names.contains(&"result") {
                &["wp", "type", "miss_m", "miss_alt_m", "hold_max_m", "at", "source"]
            } else {
                &["type", "lat", "lon", "alt"]
            };
            assert_eq!(map.len(), keys.len(), "{text}");
            assert!(keys.iter().all(|key| map.contains_key(*key)), "{text}");
        }
    }
}

fn is(value: &Value, kind: &str) -> bool {
    let one_of = |words: &[&str]| value.as_str().is_some_and(|word| words.contains(&word));
    match kind {
        "num" => value.as_f64().is_some_and(f64::is_finite),
        "text" => value.as_str().is_some_and(|text| !text.is_empty()),
        "flag" => value.is_boolean(),
        "hash" => value
            .as_str()
            .is_some_and(|text| text.len() == 16 && text.bytes().all(|byte| byte.is_ascii_hexdigit())),
        "list" => value.is_array(),
        "map" => value.is_object(),
        "word" => value.as_str().is_some_and(|word| {
            !word.is_empty()
                && word.bytes().all(|b| b.is_ascii_uppercase() || b.is_ascii_digit() || b == b'_')
        }),
        "motors" => value.as_array().is_some_and(|motors| {
            let share = |motor: &Value| motor.as_f64().is_some_and(|share| (0.0..=1.0).contains(&share));
            motors.len() == 4 && motors.iter().all(share)
        }),
        "state" => one_of(&[
            "IDLE",
            "APPROACHING",
            "ARRIVED",
            "HOLDING",
            "ORBITING",
            "FIGURE8",
            "LANDING",
            "COMPLETE",
        ]),
        "source" => one_of(&["stored", "rth", "emergency"]),
        "l1" => one_of(&["TRACK", "DIRECT", "OFF"]),
        "result" => one_of(&[
            "complete",
            "missed",
            "landed",
            "refused",
            "aborted",
            "disarmed",
            "crashed",
            "timeout",
            "diverged",
            "interrupted",
        ]),
        _ => panic!("{kind} is not a kind"),
    }
}
