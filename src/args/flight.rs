//! What flies, where and in which air: the options that all flying commands share.

use std::path::PathBuf;

use crate::geo::{LatLon, distance_bearing};
use crate::plan::FlightPlan;
use crate::plan::format::Home;
use crate::sim::{self, Noise, Switches, Turbulence, Wind};

use super::help;
use super::value::{self, Attitude, OnOff, Speed};

/// Beyond this distance from home the first waypoint is far: a default home moves there, m.
const FAR_FROM_HOME_M: f64 = 10_000.0;

/// The options that all flying commands share; `None` = the command's default.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub struct FlightArgs {
    /// Where the craft stands at boot: degrees, degrees, metres above sea level [default: the plan's home, else
    /// 40.4635,-79.5182,300]
    ///
    /// When neither you nor the plan gives a home and the first waypoint is more than 10 km from the default, the craft
    /// stands at that waypoint.
    #[arg(long, value_name = "LAT,LON[,AMSL]", allow_hyphen_values = true, help_heading = "Craft")]
    pub home: Option<Home>,

    /// Heading of the nose at boot, degrees clockwise from north [default: 0]
    #[arg(long, value_name = "DEG", allow_hyphen_values = true, value_parser = value::heading, help_heading = "Craft")]
    pub heading: Option<f64>,

    /// Airframe: iris, five-inch, or a TOML file [default: iris]
    #[arg(long, value_name = "NAME|FILE", help_heading = "Craft")]
    pub airframe: Option<String>,

    /// CLI lines that are applied at boot as if typed: a `diff all`, a `dump`, a hand-written list
    ///
    /// Later wins: the stored configuration, the plan's settings, this file, --set.
    #[arg(long, value_name = "FILE", help_heading = "Craft")]
    pub settings: Option<PathBuf>,

    /// Where the craft's configuration and logs live [default: the user's state directory; fly: none, as --fresh]
    #[arg(long, value_name = "DIR", conflicts_with = "fresh", help_heading = "Craft")]
    pub state_dir: Option<PathBuf>,

    /// Starts from defaults; stores nothing but the files named on the command line
    #[arg(long, help_heading = "Craft")]
    pub fresh: bool,

    /// Where the attitude comes from: estimated, truth [default: estimated; external simulator: truth]
    #[arg(long, value_name = "SOURCE", hide_possible_values = true, help_heading = "Craft")]
    pub attitude: Option<Attitude>,

    /// Lets a script arm that holds the ARM switch on from its first packet: on, off [default: on; fly: off]
    #[arg(long, value_name = "SWITCH", hide_possible_values = true, help_heading = "Craft")]
    pub arm_assist: Option<OnOff>,

    /// Mean wind: m/s and the direction it blows from in degrees, such as 5@270 [default: calm]
    #[arg(long, value_name = "SPEED@FROM", allow_hyphen_values = true, help_heading = "Air")]
    pub wind: Option<Wind>,

    /// Strength of random gusts, m/s [default: 0]
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = value::gust, help_heading = "Air")]
    pub gust: Option<f64>,

    /// Turbulence: none, light, moderate, severe [default: none]
    #[arg(long, value_name = "LEVEL", value_parser = value::turbulence, help_heading = "Air")]
    pub turbulence: Option<Turbulence>,

    /// Sensor noise, bias and latency: real, none [default: real]
    #[arg(long, value_name = "LEVEL", value_parser = value::noise, help_heading = "Air")]
    pub noise: Option<Noise>,

    /// A rare switch of the simulated world, such as battery_sag=on; repeatable
    #[arg(long, value_name = "NAME=VALUE", value_parser = value::world_switch, long_help = help::world_switches(), help_heading = "Air")]
    pub world: Vec<String>,

    /// Seed of all randomness [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value::seed, help_heading = "Time")]
    pub seed: Option<u64>,

    /// Steps of physics and control a second: 400, 500, 1000, 2000, 4000, 8000 [default: 1000]
    #[arg(long, value_name = "HZ", allow_negative_numbers = true, value_parser = value::rate, help_heading = "Time")]
    pub rate: Option<u32>,

    /// Times real time, or max for as fast as the machine allows [default: 1; fly: max]
    #[arg(long, value_name = "X|max", allow_negative_numbers = true, help_heading = "Time")]
    pub speed: Option<Speed>,
}

impl FlightArgs {
    /// The switches of the world, the later ones winning.
    ///
    /// # Errors
    ///
    /// As [`Switches::set`]; not for values that were parsed from a command line.
    pub fn switches(&self) -> Result<Switches, sim::ParseError> {
        let mut switches = Switches::default();
        for text in &self.world {
            switches.set(text)?;
        }
        Ok(switches)
    }

    /// Steps of control a second.
    #[must_use]
    pub fn rate_hz(&self) -> u32 {
        self.rate.unwrap_or(1000)
    }

    /// Where the craft stands at boot, and a sentence for the user when that is a guess or far from the plan.
    #[must_use]
    pub fn start(&self, plan_home: Option<Home>, plan: &FlightPlan) -> (sim::Home, Option<String>) {
        let default = sim::Home { heading_deg: self.heading.unwrap_or(0.0), ..sim::Home::default() };
        let at = |home: Home| sim::Home {
            lat_deg: home.position.lat_deg(),
            lon_deg: home.position.lon_deg(),
            alt_amsl_m: home.amsl_m.unwrap_or(default.alt_amsl_m),
            ..default
        };
        let chosen = self.home.or(plan_home);
        let home = chosen.map_or(default, at);
        let place = LatLon::from_degrees(home.lat_deg, home.lon_deg);
        let first = plan.waypoints.iter().find(|waypoint| waypoint.kind.uses_position());
        let Some((first, distance_m)) = first
            .map(|first| (first.position, distance_bearing(place, first.position).0))
            .filter(|&(_, distance_m)| distance_m > FAR_FROM_HOME_M)
        else {
            return (home, None);
        };
        let kilometres = distance_m / 1000.0;
        if chosen.is_some() {
            let notice =
                format!("The plan's first waypoint, {first}, is {kilometres:.0} km from home, {place}.");
            return (home, Some(notice));
        }
        let notice = format!(
            "The plan is {kilometres:.0} km from the default home: the craft starts at its first waypoint, {first} \
             (--home chooses another place)."
        );
        (at(Home { position: first, amsl_m: None }), Some(notice))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Waypoint, WaypointType};

    fn plan_at(lat_e7: i32) -> FlightPlan {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint { kind: WaypointType::Takeoff, ..Waypoint::default() });
        plan.waypoints.push(Waypoint { position: LatLon::new(lat_e7, -795_182_000), ..Waypoint::default() });
        plan
    }

    #[test]
    fn home_is_the_users_the_plans_or_the_default() {
        let mut flight = FlightArgs { heading: Some(90.0), ..FlightArgs::default() };
        let plan_home: Home = "10,20".parse().unwrap();
        let near = plan_at(404_640_000);
        let (home, notice) = flight.start(None, &near);
        assert_eq!((home.lat_deg, home.alt_amsl_m, home.heading_deg, notice), (40.4635, 300.0, 90.0, None));
        assert!((flight.start(Some(plan_home), &near).0.lat_deg - 10.0).abs() < 1e-9);
        flight.home = "30,40,55".parse().ok();
        let (home, _) = flight.start(Some(plan_home), &near);
        assert!((home.lat_deg - 30.0).abs() < 1e-9 && (home.alt_amsl_m - 55.0).abs() < 1e-9);
    }

    #[test]
    fn a_far_plan_moves_the_default_home_with_a_notice() {
        let (home, notice) = FlightArgs::default().start(None, &plan_at(500_000_000));
        assert!((home.lat_deg - 50.0).abs() < 1e-9);
        assert!(notice.unwrap().contains("50.0000000,-79.5182000"));
        let (home, notice) = FlightArgs::default().start(None, &plan_at(405_500_000));
        assert_eq!((home, notice), (sim::Home::default(), None));
    }

    #[test]
    fn a_chosen_home_far_from_the_plan_stays_with_a_notice() {
        let far: Option<Home> = "10,10".parse().ok();
        for (typed, of_plan) in [(far, None), (None, far)] {
            let flight = FlightArgs { home: typed, ..FlightArgs::default() };
            let (home, notice) = flight.start(of_plan, &plan_at(404_640_000));
            assert!((home.lat_deg - 10.0).abs() < 1e-9);
            let notice = notice.expect("a notice");
            assert!(
                notice.contains("40.4640000,-79.5182000, is 9631 km from home, 10.0000000,10.0000000"),
                "{notice}"
            );
        }
        assert_eq!(
            FlightArgs { home: far, ..FlightArgs::default() }.start(None, &FlightPlan::default()).1,
            None
        );
    }

    #[test]
    fn later_switches_win() {
        let flight = FlightArgs {
            world: vec!["battery_sag=on".to_owned(), "battery_sag=off".to_owned()],
            ..FlightArgs::default()
        };
        assert_eq!(flight.switches(), Ok(Switches::default()));
    }
}
