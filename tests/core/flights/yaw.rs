//! The heading of the craft in flight.

use betadeck_core::pilot::StickInput;
use betadeck_core::sim::Airframe;
use betadeck_core::telemetry::{NavState, Turbulence};
use betadeck_core::vehicle::VehicleCommand;

use crate::flights::checks::{Checks, assert_met, greatest};
use crate::flights::rig::{Rig, world};

/// The channel of the yaw stick.
const YAW: u8 = 3;

/// Returns seven rounds of a 60 m square of FLYOVERs.
fn seven_squares(speed_cms: u32) -> String {
    const CORNERS: [&str; 4] = [
        "40.4640390 -79.5182000",
        "40.4640390 -79.5174917",
        "40.4635000 -79.5174917",
        "40.4635000 -79.5182000",
    ];
    CORNERS
        .iter()
        .cycle()
        .take(28)
        .enumerate()
        .map(|(index, place)| format!("waypoint insert {index} {place} 2000 {speed_cms} FLYOVER 0 NONE\n"))
        .collect()
}

/// Returns the degrees from `to` to `from`, the short way round.
fn turned(from: f64, to: f64) -> f64 {
    (from - to + 180.0).rem_euclid(360.0) - 180.0
}

fn fixed_heading(mode: &str, tilt: u32, speed_cms: u32, air: Turbulence, bound: f64) -> Option<String> {
    let (mut world, _) = world(0);
    world.turbulence = air;
    let lines = format!(
        "{}set ap_yaw_mode = {mode}\nset ap_max_angle = {tilt}\nset ap_max_velocity = 1500\n",
        seven_squares(speed_cms)
    );
    let mut rig = Rig::new(world, &lines, 20.0);
    rig.engaged().until_state(600.0, NavState::Complete);
    let start = rig.at(0.0).heading;
    let mut checks = Checks::default();
    let off = greatest(rig.span(0.0, 1e9).map(|sample| turned(sample.heading, start).abs()));
    checks.at_most("turned by", off, bound);
    checks.verdict(&format!("{mode}, {tilt} degrees, {speed_cms} cm/s, {air}"), &rig.story())
}

part_and_search!(fixed_headings, every 3, a_fixed_heading_stays_over_seven_squares, a_fixed_heading_stays_over_seven_squares_in_every_case);

fn fixed_headings(n: usize) {
    let flights = [("FIXED", 25, 500), ("FIXED", 25, 1000), ("FIXED", 50, 1000), ("DAMPENER", 25, 500)];
    let cases = flights
        .into_iter()
        .flat_map(|flight| [(Turbulence::None, 3.0), (Turbulence::Moderate, 6.0)].map(|air| (flight, air)));
    assert_met(
        cases
            .step_by(n)
            .map(|((mode, tilt, speed_cms), (air, bound))| fixed_heading(mode, tilt, speed_cms, air, bound)),
    );
}

#[test]
fn the_yaw_stick_chooses_the_heading_that_is_kept() {
    let lines = format!("{}set ap_yaw_mode = FIXED\n", seven_squares(500));
    let mut rig = Rig::new(world(0).0, &lines, 20.0);
    rig.engaged().fly(5.0);
    let before = rig.samples.last().unwrap().heading;
    let right = StickInput { channel: YAW, value_us: 1700, at_s: 0.0, for_s: None, from_boot: true };
    rig.vehicle.apply(&VehicleCommand::HoldChannel(right));
    rig.fly(1.0);
    rig.release_channels();
    let released = rig.t();
    let chosen = rig.samples.last().unwrap().heading;
    assert!(turned(chosen, before).abs() > 30.0, "{before} to {chosen}");
    rig.fly(60.0);
    let off = greatest(rig.span(released + 5.0, 1e9).map(|sample| turned(sample.heading, chosen).abs()));
    assert!(off < 10.0, "{off}");
}

/// Checks the greatest true yaw rate over a round of the square. It may exceed the limit by 1 °/s + 5 %.
fn yaw_rate(airframe: Airframe, mode: &str, limit_dps: u32, cap_dps: Option<u32>) -> Option<String> {
    let (mut world, _) = world(0);
    let flight = format!("{}, {mode}, {limit_dps} deg/s, cap {cap_dps:?}", airframe.name);
    world.airframe = airframe;
    let settings =
        format!("set ap_yaw_mode = {mode}\nset ap_max_yaw_rate = {limit_dps}\nset ap_yaw_p = 200\n");
    let square: Vec<String> = seven_squares(500).lines().take(5).map(str::to_owned).collect();
    let cap = cap_dps.map(|cap| format!("waypoint insert 0 0 0 0 {cap} YAW_RATE 0 NONE\n"));
    let mut rig = Rig::new(world, &(settings + &square.join("\n")), 20.0);
    if let Some(line) = &cap {
        rig.cli(line);
    }
    rig.engaged().until_state(200.0, NavState::Complete);
    let most = f64::from(cap_dps.unwrap_or(limit_dps));
    // The mean over a tenth of a second, so that the shaking of a corner does not count as a turn.
    let flown: Vec<f64> = rig.span(0.0, 1e9).map(|sample| sample.heading).collect();
    let fastest = greatest(flown.windows(11).map(|span| turned(span[10], span[0]).abs() / 0.1));
    let mut checks = Checks::default();
    checks.within("true yaw rate", fastest, 0.9 * most, 1.0 + 1.05 * most);
    checks.verdict(&flight, &rig.story())
}

#[test]
fn the_craft_turns_no_faster_than_ap_max_yaw_rate() {
    let airframes = [Airframe::iris(), Airframe::five_inch()];
    assert_met(airframes.into_iter().flat_map(|airframe| {
        [
            ("VELOCITY", 10, None),
            ("VELOCITY", 20, None),
            ("VELOCITY", 30, None),
            ("VELOCITY", 60, None),
            ("BEARING", 20, None),
            ("BEARING", 30, None),
            ("VELOCITY", 90, Some(20)),
        ]
        .map(|(mode, limit, cap)| yaw_rate(airframe.clone(), mode, limit, cap))
    }));
}
