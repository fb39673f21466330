//! One flight of a rescue: where it begins, what is wrong, and how it ends.

use super::settings::PilotSettings;
use crate::args::RescueArgs;
use crate::geo::{LatLon, offset_to_latlon};
use crate::scenario;
use crate::sim::Home;
use nalgebra::Vector2;
use std::fmt::Write as _;

/// The wind that the user does not state, m/s. It blows from the north.
pub(super) const WIND_MPS: f64 = 8.0;
/// The usual distances from home, m, and directions; the heights, m.
const DISTANCES_M: [u16; 4] = [40, 150, 400, 800];
const DIRECTIONS: u16 = 8;
const HEIGHTS_M: [u16; 3] = [10, 30, 60];
const COMPASS_DEG: [u16; 3] = [0, 30, 90];
/// The plan leads this far beyond the place where the rescue begins, m, at this speed, cm/s.
const BEYOND_M: f64 = 80.0;
const OUT_CMPS: u16 = 1200;

/// The begin of a rescue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, serde::Serialize)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub(super) enum Begin {
    /// The GPS RESCUE switch.
    Switch,
    /// The link is lost for good.
    LinkLost,
    /// The link is lost and comes back after 12 s.
    LinkBack,
}

/// A further fault of a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display, serde::Serialize)]
#[strum(serialize_all = "kebab-case")]
#[serde(rename_all = "kebab-case")]
pub(super) enum Trouble {
    Nothing,
    /// The solutions of the GPS come half a second late.
    GpsLate,
    /// The battery has lost a volt.
    BatteryLow,
}

/// One flight.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub(super) struct Trial {
    pub(super) direction_deg: u16,
    pub(super) distance_m: u16,
    pub(super) height_m: u16,
    pub(super) is_windy: bool,
    pub(super) compass_deg: u16,
    pub(super) begin: Begin,
    pub(super) trouble: Trouble,
}

/// Returns all flights: from each place by switch and by a lost link, in calm and in wind, with each error of the compass;
/// and in calm with the link back, with a late GPS and with a low battery.
pub(super) fn all(args: &RescueArgs) -> Vec<Trial> {
    let mut trials = Vec::new();
    let directions = args.directions.unwrap_or(DIRECTIONS).max(1);
    let distances_m = if args.distance.is_empty() { &DISTANCES_M[..] } else { &args.distance };
    for &distance_m in distances_m {
        for height_m in HEIGHTS_M {
            for direction in 0..directions {
                let usual = Trial {
                    direction_deg: (u32::from(direction) * 360 / u32::from(directions)) as u16,
                    distance_m,
                    height_m,
                    is_windy: false,
                    compass_deg: 0,
                    begin: Begin::Switch,
                    trouble: Trouble::Nothing,
                };
                for is_windy in [false, true] {
                    for compass_deg in COMPASS_DEG {
                        for begin in [Begin::Switch, Begin::LinkLost] {
                            trials.push(Trial { is_windy, compass_deg, begin, ..usual });
                        }
                    }
                }
                trials.push(Trial { begin: Begin::LinkBack, ..usual });
                for trouble in [Trouble::GpsLate, Trouble::BatteryLow] {
                    trials.push(Trial { trouble, ..usual });
                }
            }
        }
    }
    trials
}

impl Trial {
    /// Returns the name of the flight as a case of a scenario.
    pub(super) fn name(&self) -> String {
        let mut name = format!("{} m {} deg {} m high", self.distance_m, self.direction_deg, self.height_m);
        if self.is_windy {
            name.push_str(" wind");
        }
        if self.compass_deg > 0 {
            _ = write!(name, " compass {}", self.compass_deg);
        }
        _ = write!(name, " {}", self.begin);
        if self.trouble != Trouble::Nothing {
            _ = write!(name, " {}", self.trouble);
        }
        name
    }
}

/// The craft and its air.
#[derive(Debug, Clone)]
pub(super) struct Craft {
    settings: Vec<String>,
    profile: &'static str,
    pub(super) wind_mps: f64,
    airframe: Option<String>,
}

impl Craft {
    pub(super) fn new(settings: &PilotSettings, wind_mps: f64, airframe: Option<String>) -> Self {
        Self { settings: settings.lines.clone(), profile: settings.profile.into(), wind_mps, airframe }
    }

    /// Returns the craft with more settings, which replace those of before.
    pub(super) fn with(&self, settings: &[&str]) -> Self {
        let mut craft = self.clone();
        craft.settings.extend(settings.iter().map(|&setting| setting.to_owned()));
        craft
    }

    /// Returns a scenario with a case for each flight.
    pub(super) fn scenario(&self, trials: &[Trial]) -> String {
        let settings: Vec<String> = self.settings.iter().map(|setting| format!("{setting:?}")).collect();
        let airframe =
            self.airframe.as_ref().map_or_else(String::new, |name| format!("airframe = {name:?}\n"));
        let mut text = format!(
            "# GPS RESCUE and the loss of the link with a pilot's settings.\n\
             format = 1\nname = \"rescue\"\ndescription = \"The craft comes home and lands\"\nseeds = [1]\n\
             timeout_s = 600\nwatch_s = 2\n\n\
             [craft]\nprofile = {:?}\n{airframe}settings = [{}]\n\
             lines = [\n  \"aux 0 0 0 1700 2100 0 0\",\n  \"aux 1 56 1 1700 2100 0 0\",\n  \
             \"aux 2 1 2 1700 2100 0 0\",\n  \"aux 3 3 2 1700 2100 0 0\",\n  \"aux 4 11 2 1700 2100 0 0\",\n  \
             \"aux 5 46 3 1700 2100 0 0\",\n]\n\n[air]\nnoise = \"real\"\n",
            self.profile,
            settings.join(", "),
        );
        for trial in trials {
            self.case(trial, &mut text);
        }
        text.push_str(
            "\n[[measure]]\nname = \"seconds\"\ntime = \"input rescue -> contact after input rescue\"\n\
             \n[[measure]]\nname = \"impact\"\nat = \"0.02 s before contact after input rescue\"\nvalue = \"-climb\"\n\
             \n[[measure]]\nname = \"from_home\"\nat = \"contact after input rescue\"\nvalue = \"distance(home)\"\n\
             \n[[measure]]\nname = \"nearest\"\nfrom = \"input rescue\"\nmin = \"distance(home)\"\n\
             \n[[expect]]\nresult = \"landed\"\n",
        );
        text
    }

    fn case(&self, trial: &Trial, text: &mut String) {
        let home = Home::default();
        let bearing = f64::from(trial.direction_deg).to_radians();
        let (sin, cos) = bearing.sin_cos();
        let far = Vector2::new(cos, sin) * (f64::from(trial.distance_m) + BEYOND_M);
        let place = offset_to_latlon(LatLon::from_degrees(home.lat_deg, home.lon_deg), far);
        let name = trial.name();
        let wind = if trial.is_windy { format!("wind = \"{}@0\"\n", self.wind_mps) } else { String::new() };
        let battery = trial.trouble == Trouble::BatteryLow;
        let faults =
            if battery { "faults = [\"battery@0,,-1\"]\nworld = [\"battery_sag=on\"]\n" } else { "" };
        _ = write!(
            text,
            "\n[[case]]\nname = {name:?}\n[case.plan]\nwaypoints = [\"{:.7} {:.7} {} {OUT_CMPS} FLYOVER 0 NONE\"]\n\
             [case.craft]\ntakeoff_m = {}\n[case.air]\n{wind}{faults}",
            place.lat_deg(),
            place.lon_deg(),
            u32::from(trial.height_m) * 100,
            trial.height_m.min(10),
        );
        let mut input = |key: &str, at: &str, what: &str| {
            _ = write!(text, "\n[[case.input]]\n{key}at = {at:?}\ndo = {what:?}\n");
        };
        let begin = match trial.begin {
            Begin::Switch => "stick aux4 2000",
            Begin::LinkLost => "rc cut",
            Begin::LinkBack => "rc cut for 12 s",
        };
        let there = format!("when distance(home) > {} m", trial.distance_m);
        input("name = \"rescue\"\n", &there, begin);
        if trial.begin == Begin::Switch {
            input("", "input rescue", "switch AUTOPILOT off");
        }
        if trial.compass_deg > 0 {
            input("", "input rescue", &format!("fault mag-bias,,{}", trial.compass_deg));
        }
        if trial.trouble == Trouble::GpsLate {
            input("", "input rescue", "fault gps-delay,,0.5");
        }
    }
}

/// The end of a flight.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub(super) struct Flown {
    #[serde(flatten)]
    pub(super) trial: Trial,
    /// `true` if it landed within 20 m of home without a crash.
    pub(super) is_home: bool,
    pub(super) result: String,
    pub(super) reason: String,
    pub(super) seconds: Option<f64>,
    pub(super) impact_mps: Option<f64>,
    pub(super) from_home_m: Option<f64>,
    pub(super) nearest_m: Option<f64>,
}

/// The largest distance of a landing from home, m.
const AT_HOME_M: f64 = 20.0;

impl Flown {
    pub(super) fn new(trial: Trial, flown: &scenario::Flown, measures: &[(String, f64)]) -> Self {
        // A flight whose rescue never began or never ended has no such numbers.
        let measure = |name: &str| {
            let found = measures.iter().find(|(measured, _)| measured == name);
            found.map(|(_, value)| *value).filter(|value| value.is_finite())
        };
        let from_home_m = measure("from_home");
        let has_landed = matches!(flown.result.as_str(), "landed" | "complete");
        Self {
            trial,
            is_home: has_landed && from_home_m.is_some_and(|distance| distance <= AT_HOME_M),
            result: flown.result.clone(),
            reason: flown.reason.clone(),
            seconds: measure("seconds"),
            impact_mps: measure("impact"),
            from_home_m,
            nearest_m: measure("nearest"),
        }
    }
}
