//! The place of the craft at boot.

use super::{FlightSetup, SetupNotice};
use crate::geo::{LatLon, distance_bearing};
use crate::plan::format::HomePosition;
use crate::sim;

/// The distance from home beyond which the first waypoint is far, m. A default home moves there.
const FAR_FROM_HOME_M: f64 = 10_000.0;

impl FlightSetup {
    /// Returns the place of the craft at boot: the user's home, the plan's, the default, or the first waypoint if
    /// that is far from the default. The notice says that the place is a guess or far from the plan.
    pub fn boot_home(&self) -> (sim::Home, Option<SetupNotice>) {
        let default = self.world.home;
        let at = |home: HomePosition| sim::Home {
            lat_deg: home.position.lat_deg(),
            lon_deg: home.position.lon_deg(),
            alt_amsl_m: home.amsl_m.unwrap_or(default.alt_amsl_m),
            ..default
        };
        let chosen = self.home.or(self.plan.home);
        let home = chosen.map_or(default, at);
        let place = LatLon::from_degrees(home.lat_deg, home.lon_deg);
        let Some(first) = self.plan.plan.waypoints.iter().find(|waypoint| waypoint.kind.uses_position())
        else {
            return (home, None);
        };
        let first = first.position;
        let (distance_m, _) = distance_bearing(place, first);
        if distance_m <= FAR_FROM_HOME_M {
            return (home, None);
        }
        match chosen {
            Some(_) => (home, Some(SetupNotice::PlanFarFromHome { first, home: place, distance_m })),
            None => {
                let at_first = at(HomePosition { position: first, amsl_m: None });
                (at_first, Some(SetupNotice::HomeAtFirstWaypoint { first, distance_m }))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::format::PlanFile;
    use crate::plan::{FlightPlan, Waypoint, WaypointType};

    fn plan_at(lat_e7: i32) -> PlanFile {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint { kind: WaypointType::Takeoff, ..Waypoint::default() });
        plan.waypoints.push(Waypoint { position: LatLon::new(lat_e7, -795_182_000), ..Waypoint::default() });
        PlanFile { plan, ..PlanFile::default() }
    }

    fn start(
        home: Option<HomePosition>,
        plan_home: Option<HomePosition>,
        plan: PlanFile,
    ) -> (sim::Home, Option<String>) {
        let mut setup =
            FlightSetup { home, plan: PlanFile { home: plan_home, ..plan }, ..FlightSetup::default() };
        setup.world.home.heading_deg = 90.0;
        let (home, notice) = setup.boot_home();
        (home, notice.map(|notice| notice.to_string()))
    }

    #[test]
    fn home_is_the_users_the_plans_or_the_default() {
        let plan_home: Option<HomePosition> = "10,20".parse().ok();
        let near = plan_at(404_640_000);
        let (home, notice) = start(None, None, near.clone());
        assert_eq!((home.lat_deg, home.alt_amsl_m, home.heading_deg, notice), (40.4635, 300.0, 90.0, None));
        assert!((start(None, plan_home, near.clone()).0.lat_deg - 10.0).abs() < 1e-9);
        let (home, _) = start("30,40,55".parse().ok(), plan_home, near);
        assert!((home.lat_deg - 30.0).abs() < 1e-9 && (home.alt_amsl_m - 55.0).abs() < 1e-9);
    }

    #[test]
    fn a_far_plan_moves_the_default_home_with_a_notice() {
        let (home, notice) = start(None, None, plan_at(500_000_000));
        assert!((home.lat_deg - 50.0).abs() < 1e-9);
        assert!(notice.unwrap().contains("50.0000000,-79.5182000"));
        let (home, notice) = start(None, None, plan_at(405_500_000));
        assert_eq!((home, notice), (sim::Home { heading_deg: 90.0, ..sim::Home::default() }, None));
    }

    #[test]
    fn a_chosen_home_far_from_the_plan_stays_with_a_notice() {
        let far: Option<HomePosition> = "10,10".parse().ok();
        for (typed, of_plan) in [(far, None), (None, far)] {
            let (home, notice) = start(typed, of_plan, plan_at(404_640_000));
            assert!((home.lat_deg - 10.0).abs() < 1e-9);
            let notice = notice.expect("a notice");
            assert!(
                notice.contains("40.4640000,-79.5182000, is 9631 km from home, 10.0000000,10.0000000"),
                "{notice}"
            );
        }
        assert_eq!(start(far, None, PlanFile::default()).1, None);
    }
}
