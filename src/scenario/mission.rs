//! Random missions, as the texts of scenarios.
//!
//! A mission is drawn by its number, the same for every firmware. Each one varies a random subset of all that can vary,
//! because features that are off leave more room to those that are on.

use std::fmt::Write as _;

use crate::design::Stream;
use crate::math;

/// The beginning of the name of a mission, before its number.
pub const MISSION: &str = "lab-mission-";

/// The home of all missions, degrees.
const HOME: [f64; 2] = [40.4635, -79.5182];
/// The length of a degree of latitude, m.
const METRES: f64 = 111_195.0;

/// Settings with the range from which missions draw them.
const SETTINGS: &[(&str, i64, i64)] = &[
    ("ap_max_angle", 20, 45),
    ("ap_waypoint_arrival_radius", 200, 800),
    ("ap_waypoint_hold_radius", 200, 800),
    ("ap_position_p", 20, 45),
    ("ap_position_d", 20, 45),
    ("ap_altitude_i", 20, 45),
    ("ap_max_yaw_rate", 20, 120),
    ("ap_yaw_p", 30, 90),
    ("ap_landing_descent_rate", 30, 100),
    ("ap_landing_detection_time", 8, 20),
    ("ap_nav_corner_speed", 150, 400),
    ("ap_nav_decel", 150, 350),
    ("ap_nav_accel", 150, 350),
    ("ap_nav_carrot_lead_time", 8, 20),
];

/// Returns the number of the mission with this name.
pub fn mission_number(name: &str) -> Option<u64> {
    let number = name.strip_prefix(MISSION)?;
    // Other texts of the same number are no names.
    number.parse().ok().filter(|parsed: &u64| parsed.to_string() == number)
}

/// Returns the scenario of a mission.
pub fn mission(number: u64) -> String {
    let mut draw = Draw { stream: Stream::new(number, "mission"), next: 0 };
    let mut text = format!(
        "format = 1\nname = \"{MISSION}{number}\"\ndescription = \"Random mission {number}\"\nseeds = [{}]\n\
         time_limit_s = 120\n\n[plan]\nwaypoints = [\n",
        number % 1_000_000
    );
    waypoints(&mut draw).iter().for_each(|line| _ = writeln!(text, "  \"{line}\","));
    let takeoff_m = draw.between(6, 12);
    let heading_deg = if draw.is(1, 2) { draw.between(0, 359) } else { 0 };
    _ = write!(text, "]\n\n[craft]\ntakeoff_m = {takeoff_m}\nheading_deg = {heading_deg}\nsettings = [\n");
    for (name, least, most) in SETTINGS {
        if draw.is(1, 4) {
            _ = writeln!(text, "  \"{name} = {}\",", draw.between(*least, *most));
        }
    }
    text.push_str("]\n\n[air]\nnoise = \"real\"\n");
    if draw.is(2, 3) {
        _ = writeln!(text, "wind = \"{}@{}\"", draw.between(1, 8), draw.between(0, 359));
    }
    if draw.is(1, 3) {
        _ = writeln!(text, "gust_mps = {}", draw.between(1, 4));
    }
    if draw.is(1, 3) {
        let level = ["light", "moderate"][usize::from(draw.is(1, 3))];
        _ = writeln!(text, "turbulence = \"{level}\"");
    }
    text.push_str("\n[[expect]]\nno_event = \"crash\"\nfrom = \"boot\"\n");
    text
}

/// Returns the lines of the waypoints: legs, holds and modifiers, with a LAND at the end of half the missions.
fn waypoints(draw: &mut Draw) -> Vec<String> {
    let mut lines = Vec::new();
    let (mut north, mut east) = (0.0, 0.0);
    let mut course_deg = draw.between(0, 359) as f64;
    let mut alt_m = draw.between(8, 18);
    let has = [(); 6].map(|()| draw.is(1, 2));
    let [climbs, has_speeds, has_flybys, has_hold, has_modifiers, lands] = has;
    let count = draw.between(2, 3);
    for leg in 0..count {
        let length_m = draw.between(20, 55) as f64;
        let (sine, cosine) = math::sin_cos(course_deg.to_radians());
        (north, east) = (north + length_m * cosine, east + length_m * sine);
        course_deg += draw.between(-140, 140) as f64;
        if climbs {
            alt_m = (alt_m + draw.between(-6, 8)).clamp(7, 25);
        }
        if has_modifiers && draw.is(1, 3) {
            let modifier = match draw.between(0, 2) {
                0 => format!("ALT_CHANGE {}", 100 * draw.between(8, 20)),
                1 => format!("DELAY {}", draw.between(60, 150)),
                _ => format!("YAW_RATE {}", draw.between(15, 60)),
            };
            let (kind, value) = modifier.split_once(' ').unwrap_or_default();
            // YAW_RATE has its rate in the place of the speed.
            let (alt_cm, speed, duration) = match kind {
                "ALT_CHANGE" => (value, "0", "0"),
                "YAW_RATE" => ("0", value, "0"),
                _ => ("0", "0", value),
            };
            lines.push(line([north, east], alt_cm, speed, kind, duration, "ORBIT"));
        }
        let speed = if has_speeds { 100 * draw.between(3, 9) } else { 500 };
        let is_hold = has_hold && leg + 1 == count;
        let kind = match has_flybys && draw.is(1, 2) {
            _ if is_hold => "HOLD",
            true => "FLYBY",
            false => "FLYOVER",
        };
        let duration = if is_hold { 10 * draw.between(4, 15) } else { 0 };
        let pattern = ["ORBIT", "FIGURE8"][usize::from(draw.is(1, 2))];
        let texts = [100 * alt_m, speed, duration].map(|number| number.to_string());
        let [alt_cm, speed, duration] = &texts;
        lines.push(line([north, east], alt_cm, speed, kind, duration, pattern));
    }
    if lands {
        let place = [north + draw.between(-15, 15) as f64, east + draw.between(-15, 15) as f64];
        lines.push(line(place, &(100 * alt_m.min(10)).to_string(), "0", "LAND", "0", "ORBIT"));
    }
    lines
}

/// Returns the line of a waypoint at a place north and east of home, m.
fn line(
    [north, east]: [f64; 2],
    alt_cm: &str,
    speed: &str,
    kind: &str,
    duration: &str,
    pattern: &str,
) -> String {
    let lat = HOME[0] + north / METRES;
    let lon = HOME[1] + east / (METRES * math::cos(HOME[0].to_radians()));
    format!("{lat:.7} {lon:.7} {alt_cm} {speed} {kind} {duration} {pattern}")
}

/// The random numbers of a mission, one after the other.
struct Draw {
    stream: Stream,
    next: u64,
}

impl Draw {
    /// Returns a number from `least` to `most`, all as likely.
    fn between(&mut self, least: i64, most: i64) -> i64 {
        let bits = self.stream.bits(self.next);
        self.next += 1;
        // The bias of the remainder is far below what flights show.
        least + (bits % (most - least + 1) as u64) as i64
    }

    /// Returns `true` in so many of so many cases.
    fn is(&mut self, of: i64, all: i64) -> bool {
        self.between(1, all) <= of
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::format::report;
    use crate::scenario::{BuiltinFiles, read};

    #[test]
    fn every_mission_is_a_scenario_and_stays_the_same() {
        for number in 0..300 {
            let text = mission(number);
            assert_eq!(text, mission(number));
            let name = format!("{MISSION}{number}");
            let scenario = read(&name, &text, None, &mut BuiltinFiles)
                .unwrap_or_else(|errors| panic!("{text}\n{}", report(&errors)));
            assert_eq!((scenario.name.as_str(), mission_number(&name)), (name.as_str(), Some(number)));
        }
        assert_eq!(mission_number("lab-mission-"), None);
        assert_eq!(mission_number("lab-mission-01"), None);
        assert_eq!(mission_number("square"), None);
    }

    #[test]
    fn a_yaw_rate_of_a_mission_limits_the_rate() {
        let texts: Vec<String> = (0..200).map(mission).collect();
        let lines: Vec<&str> =
            texts.iter().flat_map(|text| text.lines()).filter(|line| line.contains("YAW_RATE")).collect();
        let rates = lines.iter().filter_map(|line| line.split_whitespace().nth(3)?.parse().ok());
        assert!(!lines.is_empty() && rates.filter(|rate| (15..=60).contains(rate)).count() == lines.len());
    }

    #[test]
    fn missions_vary_in_all_that_can_vary() {
        let texts: Vec<String> = (0..200).map(mission).collect();
        let words = [
            "FLYBY",
            "HOLD",
            "LAND",
            "FIGURE8",
            "DELAY",
            "ALT_CHANGE",
            "YAW_RATE",
            "wind",
            "gust",
            "turbulence",
        ];
        for word in words.iter().chain(SETTINGS.iter().map(|(name, ..)| name)) {
            let with = texts.iter().filter(|text| text.contains(word)).count();
            assert!((10..190).contains(&with), "{word}: {with} of 200");
        }
    }
}
