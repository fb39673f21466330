//! The start of a flight as stored data.

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::firmware::AttitudeSource;
use crate::firmware::config::correct;
use crate::firmware::storage::{from_text, to_text};
use crate::flight::FlightSetup;
use crate::flight::setup::{BootLines, PhysicsSource};
use crate::geo::LatLon;
use crate::pilot::StickInput;
use crate::plan::format::{HomePosition, PlanFile};
use crate::plan::{FlightPlan, MAX_WAYPOINTS, Waypoint};
use crate::sim::{Airframe, Home, Noise, Switches, Wind, WorldConfig};
use crate::telemetry::Turbulence;
use crate::terrain::Square;

/// The longest text of an airframe, bytes. Its syntax tree takes a hundred times as much memory.
const MAX_AIRFRAME: usize = 16 << 10;

/// The start of a flight. A key that this version does not know would change the flight, so it is an error.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Setup {
    /// `true` if an external simulator moves the craft.
    external_physics: bool,
    /// `true` if the flight controller is remote.
    remote_controller: bool,
    /// The name of a built-in airframe, or the text of an airframe file.
    airframe: String,
    /// The place at boot unless `place` or the plan gives one, and the heading: latitude and longitude, degrees; altitude
    /// above sea level, m; heading, degrees.
    home: [f64; 4],
    /// The place that the user chose, and its altitude above sea level, m.
    place: Option<(LatLon, Option<f64>)>,
    rate_hz: u32,
    seed: u64,
    noise: String,
    /// Speed, m/s, and the direction from which it blows, degrees.
    wind: [f64; 2],
    gust_mps: f64,
    turbulence: String,
    /// The switches that differ from their defaults, `NAME=VALUE`.
    switches: Vec<String>,
    /// `NAME@T[,FOR][,VALUE]`.
    faults: Vec<String>,
    /// The names of the elevation tiles that were read.
    tiles: Vec<String>,
    plan: StoredPlan,
    /// `true` if the attitude of the simulator is used; `None` = the default of the physics.
    true_attitude: Option<bool>,
    arm_assist: bool,
    /// The records of the configuration in the memory of the craft.
    configuration: String,
    /// Sources and texts of the command lines that are applied at boot.
    boot_lines: Vec<(String, String)>,
    /// `CH=VALUE@T[,FOR]`.
    sticks: Vec<String>,
    live: bool,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredPlan {
    name: String,
    description: String,
    home: Option<(LatLon, Option<f64>)>,
    settings: Vec<String>,
    waypoints: ArrayVec<Waypoint, MAX_WAYPOINTS>,
}

fn place(home: Option<HomePosition>) -> Option<(LatLon, Option<f64>)> {
    home.map(|home| (home.position, home.amsl_m))
}

fn home_position(place: Option<(LatLon, Option<f64>)>) -> Option<HomePosition> {
    place.map(|(position, amsl_m)| HomePosition { position, amsl_m })
}

impl From<&FlightSetup> for Setup {
    fn from(setup: &FlightSetup) -> Self {
        let FlightSetup { physics, world, home, plan, remote_controller, attitude, .. } = setup;
        let airframe = &world.airframe;
        let is_built_in = airframe.name.parse::<Airframe>().as_ref() == Ok(airframe);
        let start = &world.home;
        let tiles = world.terrain.iter().flat_map(|tiles| tiles.squares());
        Self {
            external_physics: *physics == PhysicsSource::External,
            remote_controller: *remote_controller,
            airframe: if is_built_in { airframe.name.clone() } else { airframe.to_toml() },
            home: [start.lat_deg, start.lon_deg, start.alt_amsl_m, start.heading_deg],
            place: place(*home),
            rate_hz: world.rate_hz,
            seed: world.seed,
            noise: world.noise.to_string(),
            wind: [world.wind.speed_mps, world.wind.from_deg],
            gust_mps: world.gust_mps,
            turbulence: world.turbulence.to_string(),
            switches: world.switches.changed(),
            faults: world.faults.iter().map(ToString::to_string).collect(),
            tiles: tiles.map(Square::hgt_name).collect(),
            plan: StoredPlan {
                name: plan.name.clone(),
                description: plan.description.clone(),
                home: place(plan.home),
                settings: plan.settings.clone(),
                waypoints: plan.plan.waypoints.clone(),
            },
            true_attitude: attitude.map(|attitude| attitude == AttitudeSource::Truth),
            arm_assist: setup.arm_assist,
            configuration: to_text(&setup.stored),
            boot_lines: setup
                .boot_lines
                .iter()
                .map(|BootLines { source, text }| (source.clone(), text.clone()))
                .collect(),
            sticks: setup.stick_inputs.iter().map(ToString::to_string).collect(),
            live: setup.live,
        }
    }
}

impl Setup {
    /// Returns the reason why this flight cannot be flown again, the end of a sentence, if there is one.
    pub fn only_pictures(&self) -> Option<&'static str> {
        match (self.remote_controller, self.external_physics) {
            (true, _) => Some("a remote firmware flew it"),
            (_, true) => Some("an external simulator moved the craft"),
            (false, false) => None,
        }
    }

    /// Returns `true` if the ground was that of elevation tiles at the start, or may have become that.
    pub fn had_tiles(&self) -> bool {
        !self.tiles.is_empty()
    }

    /// Returns the plan with which the flight began.
    pub fn plan(&self) -> PlanFile {
        let StoredPlan { name, description, home, settings, waypoints } = self.plan.clone();
        PlanFile {
            name,
            description,
            home: home_position(home),
            settings,
            plan: FlightPlan { waypoints },
            ..PlanFile::default()
        }
    }

    /// Returns the start of the flight, without elevation tiles and the data about the build.
    ///
    /// # Errors
    /// Returns the part that cannot be used, the end of a sentence.
    pub fn flight(&self) -> Result<FlightSetup, String> {
        let [lat_deg, lon_deg, alt_amsl_m, heading_deg] = self.home;
        let [speed_mps, from_deg] = self.wind;
        let mut switches = Switches::default();
        self.switches.iter().try_for_each(|text| switches.set(text).map_err(|error| error.to_string()))?;
        let faults = self.faults.iter().map(|text| text.parse().map_err(|error| format!("{error}")));
        let world = WorldConfig {
            airframe: airframe(&self.airframe)?,
            home: Home { lat_deg, lon_deg, alt_amsl_m, heading_deg },
            rate_hz: self.rate_hz,
            seed: self.seed,
            noise: Noise::parse(&self.noise).map_err(|error| error.to_string())?,
            wind: Wind { speed_mps, from_deg },
            gust_mps: self.gust_mps,
            turbulence: Turbulence::parse(&self.turbulence).map_err(|error| error.to_string())?,
            switches,
            faults: faults.collect::<Result<_, _>>()?,
            terrain: None,
        };
        let (mut stored, unusable) =
            from_text(&self.configuration).map_err(|error| format!("the configuration: {error}"))?;
        if let Some(first) = unusable.into_iter().next() {
            return Err(first.trim_end_matches('.').to_owned());
        }
        correct(&mut stored);
        let attitude = |is_true| if is_true { AttitudeSource::Truth } else { AttitudeSource::Estimated };
        Ok(FlightSetup {
            physics: if self.external_physics { PhysicsSource::External } else { PhysicsSource::Embedded },
            world,
            home: home_position(self.place),
            plan: self.plan(),
            remote_controller: self.remote_controller,
            attitude: self.true_attitude.map(attitude),
            arm_assist: self.arm_assist,
            stored,
            boot_lines: self
                .boot_lines
                .iter()
                .map(|(source, text)| BootLines { source: source.clone(), text: text.clone() })
                .collect(),
            stick_inputs: self
                .sticks
                .iter()
                .map(|text| text.parse())
                .collect::<Result<Vec<StickInput>, _>>()?,
            live: self.live,
            ..FlightSetup::default()
        })
    }
}

fn airframe(text: &str) -> Result<Airframe, String> {
    if let Ok(airframe) = text.parse() {
        return Ok(airframe);
    }
    if text.len() > MAX_AIRFRAME {
        return Err(format!("the airframe has {} bytes, at most {MAX_AIRFRAME} are read", text.len()));
    }
    Airframe::from_toml(text).map_err(|_| "the airframe is not one that flies".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::builtin::BuiltinPlan;

    /// Returns a start in which every part differs from its default.
    fn unusual() -> FlightSetup {
        let plan = BuiltinPlan::find("square").unwrap().read().unwrap();
        let mut setup = FlightSetup {
            home: "40.4,-79.5,212.5".parse().ok(),
            attitude: Some(AttitudeSource::Truth),
            arm_assist: true,
            boot_lines: vec![BootLines {
                source: "a.txt".to_owned(),
                text: "set ap_max_angle = 25\n".to_owned(),
            }],
            stick_inputs: vec!["aux2=1000@boot+20.125,0.1".parse().unwrap()],
            live: true,
            plan: PlanFile {
                description: "Around".to_owned(),
                settings: vec!["ap_max_angle = 30".to_owned()],
                ..plan
            },
            ..FlightSetup::default()
        };
        setup.stored.plan = setup.plan.plan.clone();
        setup.stored.starter_modes();
        let world = &mut setup.world;
        world.airframe.mass_kg *= 1.0 + f64::EPSILON * 8.0;
        world.home.heading_deg = 0.1 + 0.2;
        (world.rate_hz, world.seed) = (500, u64::MAX);
        world.noise = Noise::None;
        world.wind = Wind { speed_mps: 0.1 + 0.2, from_deg: 360.0 };
        world.gust_mps = 1.0 / 3.0;
        world.turbulence = Turbulence::Light;
        world.switches.set("ground=slope,8.1,90").unwrap();
        world.switches.set("battery_capacity=0.7").unwrap();
        world.faults = vec!["motor@10.3,,2:0.83".parse().unwrap(), "gps-loss@boot+1,0.3".parse().unwrap()];
        setup
    }

    #[test]
    fn the_start_of_a_flight_is_read_as_it_was_written() {
        for setup in [FlightSetup::default(), unusual()] {
            let line = serde_json::to_string(&Setup::from(&setup)).unwrap();
            let read: Setup = serde_json::from_str(&line).unwrap();
            assert_eq!(read, Setup::from(&setup));
            let again = read.flight().unwrap();
            assert_eq!(again.world, setup.world);
            assert_eq!(again.stored, setup.stored);
            assert_eq!(again.home, setup.home);
            assert_eq!(again.boot_lines, setup.boot_lines);
            assert_eq!(again.stick_inputs, setup.stick_inputs);
            assert_eq!(
                (again.attitude, again.arm_assist, again.live),
                (setup.attitude, setup.arm_assist, setup.live)
            );
            assert_eq!(
                PlanFile { losses: setup.plan.losses.clone(), notes: setup.plan.notes.clone(), ..again.plan },
                setup.plan
            );
        }
    }

    #[test]
    fn a_start_that_makes_no_sense_is_refused_with_the_part() {
        let with = |change: &dyn Fn(&mut Setup)| {
            let mut setup = Setup::from(&FlightSetup::default());
            change(&mut setup);
            setup.flight().map(drop)
        };
        assert_eq!(with(&|_| {}), Ok(()));
        let refused = |change: &dyn Fn(&mut Setup)| with(change).unwrap_err();
        assert!(refused(&|setup| setup.noise = "loud".to_owned()).contains("allowed are real, none"));
        assert!(refused(&|setup| setup.faults.push("gps-los@1".to_owned())).contains("gps-loss"));
        assert!(refused(&|setup| setup.switches.push("ground=moon".to_owned())).contains("moon"));
        assert!(refused(&|setup| setup.airframe = "moon".to_owned()).contains("airframe"));
        assert!(refused(&|setup| setup.airframe = "#".repeat(MAX_AIRFRAME + 1)).contains("at most"));
        assert!(refused(&|setup| setup.sticks.push("aux99=1000@1".to_owned())).contains("aux99"));
        assert!(
            refused(&|setup| setup.configuration = "setting\tap_max_angle\t-1".to_owned())
                .contains("ap_max_angle")
        );
        let later = serde_json::to_string(&Setup::from(&FlightSetup::default())).unwrap();
        let later = later.replacen('{', "{\"gravity\":1.6,", 1);
        assert!(
            serde_json::from_str::<Setup>(&later).is_err(),
            "what this version does not know is not left out"
        );
    }
}
