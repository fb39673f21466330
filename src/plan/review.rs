//! The review of a plan before a flight: reasons for which the craft refuses it, and unexpected behaviour in flight.

mod altitude;
mod clearance;
mod steep;
mod zones;

use std::fmt;

use crate::geo::{LatLon, distance_bearing};
use crate::math;

use super::estimate::{Assumptions, SettingSource, TouchdownThrottle, estimate};
use super::feature::Zone;
use super::validate::{PlanFault, check_plan};
use super::{FlightPlan, Modifier, Then, Waypoint, WaypointType};
pub use altitude::{LegAltitude, legs as leg_altitudes};
pub use clearance::{
    Before, CLEARANCE_M, Clearances, FlownPlace, LowClearance, Raise, Way, clearances, low_in_flight,
};
pub use steep::{Remedy, SteepLeg};
pub use zones::{ZonePart, zone_findings, zones_on_path};

/// A finding in a plan.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// The craft refuses the plan.
    Fault(PlanFault),
    /// The craft refuses the plan because of the fence.
    OutsideFence {
        /// Index of the waypoint.
        index: usize,
        /// Distance of the waypoint from home, m.
        distance_m: f64,
        /// The fence, m.
        limit_m: f64,
        /// Source of the limit.
        from: SettingSource,
    },
    /// The craft has the plan, but another value for one of its settings.
    CraftDiffers {
        /// The plan's line.
        setting: String,
    },
    /// Waypoints after a LAND or an endless HOLD.
    NeverFlown {
        /// The waypoint that ends the mission.
        index: usize,
        /// Type of that waypoint.
        kind: WaypointType,
    },
    /// A modifier without a place after it.
    NothingToModify {
        /// Index of the modifier.
        index: usize,
        /// Its type.
        kind: WaypointType,
    },
    /// The leg is flown slower than its speed field demands.
    SpeedLimited {
        /// Index of the waypoint to which the leg leads.
        index: usize,
        /// The demanded speed, m/s.
        speed_mps: f64,
        /// The limit, m/s.
        limit_mps: f64,
    },
    /// The mission ends in the air.
    StaysInTheAir,
    /// The battery is empty before the mission ends.
    OutlastsBattery {
        /// The least time of the mission, s.
        time_s: f64,
        /// The hover time of the battery, s.
        endurance_s: f64,
    },
    /// The leg is flown below the place at which the craft is armed.
    BelowGround {
        /// Index of the waypoint to which the leg leads.
        index: usize,
        /// Altitude of the leg above home, m.
        alt_m: f64,
    },
    /// The leg is flown above the limit that the user has set.
    AboveLimit {
        /// The waypoint that gives the altitude.
        index: usize,
        /// Altitude of the leg above home, m.
        alt_m: f64,
        /// The limit, m.
        limit_m: f64,
    },
    /// The leg is flown far above all others.
    FarAboveOthers {
        /// The waypoint that gives the altitude.
        index: usize,
        /// Altitude of the leg above home, m.
        alt_m: f64,
        /// The median altitude of the others, m.
        usual_m: f64,
    },
    /// The leg is too steep for its speed: the craft passes the waypoint at a wrong altitude.
    SteepLeg(SteepLeg),
    /// A leg or a way home comes too close to the ground of the elevation tiles.
    LowClearance(LowClearance),
    /// The throttle condition of a touchdown can never be met.
    NoTouchdownThrottle(TouchdownThrottle),
    /// A waypoint or a leg is where a zone of the map forbids it.
    AgainstZone {
        /// Index of the waypoint.
        index: usize,
        /// The part of the plan.
        part: ZonePart,
        /// The kind of zone.
        zone: Zone,
        /// The name of the zone; may be empty.
        name: String,
    },
    /// The flown estimate goes where a zone of the map forbids it.
    FlownAgainstZone {
        /// The kind of zone.
        zone: Zone,
        /// The name of the zone; may be empty.
        name: String,
        /// Distance along the plan at the border, m.
        along_m: f64,
    },
}

impl Finding {
    /// Returns `true` if the craft refuses the plan because of the finding.
    pub fn is_refusal(&self) -> bool {
        matches!(self, Self::Fault(_) | Self::OutsideFence { .. })
    }

    /// Returns the reason of a refusal. For any other finding returns the whole sentence.
    pub fn reason(&self) -> String {
        match self {
            Self::Fault(fault) => fault.to_string(),
            Self::OutsideFence { index, distance_m, limit_m, from } => {
                let fence = match from {
                    SettingSource::Unsaid => "the fence (ap_max_distance_from_home)",
                    SettingSource::Craft => "the craft's ap_max_distance_from_home",
                    SettingSource::Plan => "the plan's ap_max_distance_from_home, set at the upload,",
                };
                let decimals = math::decimals_apart(*distance_m, *limit_m, 0);
                format!(
                    "waypoint {index} is {distance_m:.decimals$} m from home, {fence} is {limit_m:.decimals$} m"
                )
            }
            _ => self.to_string(),
        }
    }

    /// Returns `true` if the craft may be damaged or fly elsewhere than planned. The pilot is warned before the flight.
    pub fn is_hazard(&self) -> bool {
        matches!(
            self,
            Self::BelowGround { .. }
                | Self::AboveLimit { .. }
                | Self::FarAboveOthers { .. }
                | Self::SteepLeg(_)
                | Self::LowClearance(_)
                | Self::NoTouchdownThrottle(_)
                | Self::AgainstZone { .. }
                | Self::FlownAgainstZone { .. }
        )
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault(_) | Self::OutsideFence { .. } => write!(f, "refused: {}", self.reason()),
            Self::CraftDiffers { setting } => write!(
                f,
                "the plan sets {setting}, the craft has another value, which applies until the next upload"
            ),
            Self::NeverFlown { index, kind } if kind.capability().then == Then::Land => {
                write!(f, "waypoint {index} lands: the waypoints after it are never flown")
            }
            Self::NeverFlown { index, .. } => {
                write!(
                    f,
                    "waypoint {index} holds forever (duration 0): the waypoints after it are never flown"
                )
            }
            Self::NothingToModify { index, kind } => {
                write!(f, "waypoint {index} ({kind}) has no effect: no place follows it")
            }
            Self::SpeedLimited { index, speed_mps, limit_mps } => write!(
                f,
                "waypoint {index} asks for {speed_mps} m/s; ap_max_velocity limits it to {limit_mps} m/s"
            ),
            Self::StaysInTheAir => {
                f.write_str("the plan does not end in LAND: the craft stays in the air at its end")
            }
            Self::OutlastsBattery { time_s, endurance_s } => write!(
                f,
                "the plan takes at least {:.0} min; hovering empties the battery in {:.0} min",
                (time_s / 60.0).ceil(),
                (endurance_s / 60.0).floor()
            ),
            Self::BelowGround { index, alt_m } => write!(
                f,
                "waypoint {index} is {:.1} m below home: where the ground is level, the craft hits it",
                -alt_m
            ),
            Self::AboveLimit { index, alt_m, limit_m } => {
                let decimals = math::decimals_apart(*alt_m, *limit_m, 0);
                write!(
                    f,
                    "waypoint {index} is {alt_m:.decimals$} m above home, the limit (max_altitude_m) is {limit_m:.decimals$} m"
                )
            }
            Self::FarAboveOthers { index, alt_m, usual_m } => write!(
                f,
                "waypoint {index} is {alt_m:.0} m above home, far above the others ({usual_m:.0} m)"
            ),
            Self::SteepLeg(leg) => leg.fmt(f),
            Self::LowClearance(low) => low.fmt(f),
            Self::NoTouchdownThrottle(TouchdownThrottle { hover_us, threshold_us, min_us }) => write!(
                f,
                "ap_landing_throttle_threshold = {threshold_us} can never be met, because ap_hover_throttle \
                 ({hover_us}) minus this is not above ap_throttle_min ({min_us}): a touchdown is detected late or not \
                 at all"
            ),
            Self::AgainstZone { index, part, zone, name } => zones::write_part(f, *index, *part, *zone, name),
            Self::FlownAgainstZone { zone, name, along_m } => zones::write_flown(f, *zone, name, *along_m),
        }
    }
}

/// Returns all findings, refusals first.
pub fn review(plan: &FlightPlan, home: LatLon, assumptions: &Assumptions) -> Vec<Finding> {
    let waypoints = &plan.waypoints;
    if let Err(fault) = check_plan(plan) {
        return vec![Finding::Fault(fault)];
    }
    let mut findings: Vec<Finding> = Vec::new();
    if let Some(limit_m) = assumptions.fence_m {
        let from = assumptions.fence_from;
        findings.extend(
            waypoints.iter().enumerate().filter(|(_, waypoint)| waypoint.kind.uses_position()).filter_map(
                |(index, waypoint)| {
                    let (distance_m, _) = distance_bearing(home, waypoint.position);
                    (distance_m > limit_m).then_some(Finding::OutsideFence {
                        index,
                        distance_m,
                        limit_m,
                        from,
                    })
                },
            ),
        );
    }
    let last_place = waypoints.iter().rposition(|waypoint| waypoint.kind.is_positional());
    let end = waypoints.iter().position(ends_the_mission);
    if let Some(index) = end.filter(|&index| last_place.is_some_and(|last| last > index)) {
        findings.push(Finding::NeverFlown { index, kind: waypoints[index].kind });
    }
    for (index, waypoint) in waypoints.iter().enumerate() {
        let modifies_a_leg = matches!(waypoint.kind.modifier(), Some(Modifier::Altitude | Modifier::Delay));
        if modifies_a_leg && last_place.is_none_or(|last| last < index) {
            findings.push(Finding::NothingToModify { index, kind: waypoint.kind });
        }
        let speed_mps = waypoint.speed.mps();
        if waypoint.kind.is_positional() && speed_mps > assumptions.max_velocity_mps {
            let limit_mps = assumptions.max_velocity_mps;
            findings.push(Finding::SpeedLimited { index, speed_mps, limit_mps });
        }
    }
    if !waypoints.iter().any(|waypoint| waypoint.kind.capability().then == Then::Land) {
        findings.push(Finding::StaysInTheAir);
    }
    let time_s = estimate(plan, home, assumptions).time_s;
    if let (Some(time_s), Some(endurance_s)) = (time_s, assumptions.endurance_s)
        && time_s > endurance_s
    {
        findings.push(Finding::OutlastsBattery { time_s, endurance_s });
    }
    findings.extend(below_ground(waypoints));
    findings.extend(altitude::too_high(waypoints, assumptions.max_alt_m));
    findings.extend(steep::steep_legs(waypoints, home, assumptions).into_iter().map(Finding::SteepLeg));
    if assumptions.touchdown_throttle.is_never_met() {
        findings.push(Finding::NoTouchdownThrottle(assumptions.touchdown_throttle));
    }
    findings
}

/// Returns the legs that are flown below home.
fn below_ground(waypoints: &[Waypoint]) -> impl Iterator<Item = Finding> {
    let below = altitude::legs(waypoints).filter(|leg| leg.alt_m < 0.0);
    below.map(|leg| Finding::BelowGround { index: leg.index, alt_m: leg.alt_m })
}

fn ends_the_mission(waypoint: &Waypoint) -> bool {
    match waypoint.kind.capability().then {
        Then::Land => true,
        Then::Hold => waypoint.duration.is_zero(),
        Then::GoOn | Then::Loiter => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Seconds;
    use crate::plan::record::WaypointRecord;

    const HOME: LatLon = LatLon::new(404_635_000, -795_182_000);

    fn say(waypoints: &[(WaypointType, u16, u16)], fence_m: Option<f64>) -> Vec<String> {
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(waypoints.iter().map(|&(kind, speed, duration_ds)| {
            Waypoint::from(WaypointRecord {
                position: LatLon::new(404_648_508, -795_182_000),
                speed,
                duration_ds,
                kind,
                ..Default::default()
            })
        }));
        let assumptions = Assumptions { fence_m, ..Assumptions::default() };
        review(&plan, HOME, &assumptions).iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_sound_plan_has_no_findings() {
        assert!(say(&[(WaypointType::Flyover, 500, 0), (WaypointType::Land, 0, 0)], None).is_empty());
    }

    #[test]
    fn a_distance_that_rounds_to_its_limit_shows_decimals() {
        let from = SettingSource::Craft;
        let finding = Finding::OutsideFence { index: 0, distance_m: 50.4, limit_m: 50.0, from };
        assert!(finding.reason().contains("50.4 m from home") && finding.reason().ends_with("is 50.0 m"));
    }

    #[test]
    fn refusals_are_named() {
        assert_eq!(say(&[], None), ["refused: the plan has no waypoints: add one"]);
        let fence = say(&[(WaypointType::Land, 0, 0)], Some(100.0));
        assert_eq!(
            fence,
            ["refused: waypoint 0 is 150 m from home, the fence (ap_max_distance_from_home) is 100 m"]
        );
        let from = SettingSource::Craft;
        let outside = Finding::OutsideFence { index: 0, distance_m: 2.0, limit_m: 1.0, from };
        assert!(outside.is_refusal() && outside.to_string().contains("the craft's ap_max"), "{outside}");
    }

    #[test]
    fn a_plan_longer_than_the_battery_lasts_is_named() {
        let mut plan = FlightPlan::default();
        for seconds in [1800.0, 60.0] {
            let kind = if seconds < 100.0 { WaypointType::Land } else { WaypointType::Hold };
            let duration = Seconds::new(seconds);
            plan.waypoints.push(Waypoint { position: HOME, duration, kind, ..Waypoint::default() });
        }
        let findings = |endurance_s| {
            let assumptions = Assumptions { endurance_s, ..Assumptions::default() };
            review(&plan, HOME, &assumptions).iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(
            findings(Some(1799.0)),
            ["the plan takes at least 32 min; hovering empties the battery in 29 min"]
        );
        assert!(findings(Some(1900.0)).is_empty() && findings(None).is_empty());
    }

    #[test]
    fn a_waypoint_below_the_ground_is_named() {
        let at = |kind, alt_cm| -> Waypoint {
            WaypointRecord { position: HOME, kind, alt_cm, ..Default::default() }.into()
        };
        let mut plan = FlightPlan::default();
        plan.waypoints.extend([
            at(WaypointType::Flyover, -500),
            at(WaypointType::AltChange, -1),
            at(WaypointType::Flyover, 2000),
            at(WaypointType::AltChange, 100),
            at(WaypointType::Land, -700),
        ]);
        let found: Vec<_> = review(&plan, HOME, &Assumptions::default());
        let hazards: Vec<_> =
            found.iter().filter(|finding| finding.is_hazard()).map(ToString::to_string).collect();
        assert_eq!(
            hazards,
            [
                "waypoint 0 is 5.0 m below home: where the ground is level, the craft hits it",
                "waypoint 2 is 0.0 m below home: where the ground is level, the craft hits it",
                "waypoint 0 is passed about 15 m too high: its leg takes 0 s, the descent to -5 m 11 s; put a HOLD at -5 m \
                 before it, which waits for the altitude",
            ]
        );
    }

    #[test]
    fn a_touchdown_throttle_that_never_comes_is_named() {
        let mut plan = FlightPlan::default();
        plan.waypoints.push(Waypoint { position: HOME, kind: WaypointType::Land, ..Waypoint::default() });
        let say = |lines: &[&str]| -> Vec<String> {
            let lines: Vec<String> = lines.iter().map(|&line| line.to_owned()).collect();
            review(&plan, HOME, &Assumptions::from_settings(&lines)).iter().map(ToString::to_string).collect()
        };
        assert_eq!(
            say(&["ap_landing_throttle_threshold = 175"]),
            [
                "ap_landing_throttle_threshold = 175 can never be met, because ap_hover_throttle (1275) minus this is not \
                 above ap_throttle_min (1100): a touchdown is detected late or not at all"
            ]
        );
        assert!(say(&["ap_landing_throttle_threshold = 174"]).is_empty());
        assert_eq!(say(&["ap_throttle_min = 1200"]).len(), 1);
        assert!(say(&["ap_throttle_min = 1200", "ap_hover_throttle = 1500"]).is_empty());
        let captured = ["ap_landing_throttle_threshold = 500", "ap_hover_throttle = 0"];
        assert!(say(&captured).is_empty(), "it is captured in flight");
    }

    #[test]
    fn surprises_are_named() {
        let all = say(
            &[
                (WaypointType::Hold, 5000, 0),
                (WaypointType::Flyover, 0, 0),
                (WaypointType::YawRate, 5000, 0),
                (WaypointType::Delay, 0, 10),
            ],
            None,
        );
        assert_eq!(
            all,
            [
                "waypoint 0 holds forever (duration 0): the waypoints after it are never flown",
                "waypoint 0 asks for 50 m/s; ap_max_velocity limits it to 5 m/s",
                "waypoint 3 (DELAY) has no effect: no place follows it",
                "the plan does not end in LAND: the craft stays in the air at its end",
            ]
        );
    }

    #[test]
    fn an_altitude_change_counts_for_the_next_place_only() {
        let at = |kind, alt_cm| -> Waypoint {
            WaypointRecord { position: HOME, kind, alt_cm, ..Default::default() }.into()
        };
        let below = |altitude_change_cm, first_cm, second_cm| -> Vec<Finding> {
            let waypoints = [
                at(WaypointType::AltChange, altitude_change_cm),
                at(WaypointType::Flyover, first_cm),
                at(WaypointType::Flyover, second_cm),
            ];
            below_ground(&waypoints).collect()
        };
        let found = |index, alt_m| [Finding::BelowGround { index, alt_m }];
        assert_eq!(below(2000, -100, -700), found(2, -7.0), "the second place has its own altitude again");
        assert_eq!(below(-500, 2000, 3000), found(1, -5.0), "the first place has the changed altitude");
        assert!(below(2000, -100, 3000).is_empty());
    }
}
