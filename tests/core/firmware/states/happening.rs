//! Random events that change a craft between two updates.

use betadeck_core::autopilot::Params;
use betadeck_core::plan::{FlightPlan, HoldPattern, MAX_WAYPOINTS, WaypointType};
use betadeck_core::signals::RcSource;
use betadeck_core::sim::{Fault, Wind, WorldCommand};
use betadeck_core::vehicle::{Message, VehicleCommand};
use nalgebra::Vector3;
use rand::RngExt as _;
use rand_chacha::ChaCha8Rng;
use strum::IntoEnumIterator as _;

use super::{ARM, AUTOPILOT, FAILSAFE, HOLDS, PITCH, RESCUE, ROLL, Run, THROTTLE, YAW};

const FAILSAFES: [(&str, &[&str]); 6] = [
    ("ap_rx_loss_policy", &["DISABLE", "CONTINUE", "LAND"]),
    ("failsafe_procedure", &["AUTO-LAND", "DROP", "GPS-RESCUE"]),
    ("failsafe_switch_mode", &["STAGE1", "KILL", "STAGE2"]),
    ("failsafe_landing_time", &["0", "5", "60"]),
    ("failsafe_throttle_low_delay", &["0", "20", "100"]),
    ("failsafe_stick_threshold", &["0", "30", "50"]),
];

fn pick<T: Copy>(rng: &mut ChaCha8Rng, list: &[T]) -> T {
    list[rng.random_range(0..list.len())]
}

/// Sets the plan, air and settings at the start of a flight.
pub(crate) fn prepare(run: &mut Run, rng: &mut ChaCha8Rng) {
    replace_plan(run, rng);
    for _ in 0..rng.random_range(0..8) {
        set_parameter(run, rng);
    }
    for (name, values) in FAILSAFES {
        let value = pick(rng, values);
        run.cli(&format!("set {name} = {value}"));
    }
    set_wind(run, rng);
}

/// Runs a random event and returns its description.
pub(crate) fn happen(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    match rng.random_range(0..100) {
        0..8 => {
            run.link = !run.link || rng.random_bool(0.3);
            format!("link {}", run.link)
        }
        8..16 => switch(run, rng, AUTOPILOT, 0.75),
        16..22 => switch(run, rng, HOLDS, 0.6),
        22..28 => switch(run, rng, RESCUE, 0.4),
        28..32 => switch(run, rng, FAILSAFE, 0.3),
        32..36 => switch(run, rng, ARM, 0.8),
        36..44 => sticks(run, rng),
        44..50 => gps(run, rng),
        50..57 => edit_plan(run, rng),
        57..60 => replace_plan(run, rng),
        60..68 => set_parameter(run, rng),
        68..73 => {
            let (name, values) = pick(rng, &FAILSAFES);
            let line = format!("set {name} = {}", pick(rng, values));
            run.cli(&line);
            line
        }
        73..80 => {
            command(run, "home", |run| run.vehicle.apply(&VehicleCommand::ReturnHome).accepted().is_ok())
        }
        80..84 => {
            run.vehicle.apply(&VehicleCommand::CancelReturn);
            let view = run.vehicle.embedded().unwrap().craft_view();
            assert!(!view.is_commanded(), "a command that was taken back stays");
            "undo".to_owned()
        }
        84..86 => {
            let whole = rng.random_bool(0.5);
            run.restart(whole);
            format!("restart {whole}")
        }
        86..89 => {
            run.source = pick(rng, &[RcSource::Udp, RcSource::Msp, RcSource::Sticks]);
            format!("source {}", run.source)
        }
        89..92 => set_wind(run, rng),
        92 => {
            // Requests of a configurator. They may be unknown to the firmware.
            let code = rng.random_range(1..200);
            let _answer = run.vehicle.apply(&Message::of(code, Vec::new()).into());
            format!("msp {code}")
        }
        93..95 => {
            let jump = Fault::Teleport([rng.random_range(-80.0..80.0), rng.random_range(-80.0..80.0), 5.0]);
            run.vehicle.apply(&VehicleCommand::from(WorldCommand::FaultOn(jump, None))).accepted().unwrap();
            format!("jump {jump}")
        }
        _ => calm(run),
    }
}

fn command(run: &mut Run, name: &str, order: fn(&mut Run) -> bool) -> String {
    format!("{name} {}", order(run))
}

fn switch(run: &mut Run, rng: &mut ChaCha8Rng, channel: usize, share: f64) -> String {
    let on = rng.random_bool(share);
    run.switch(channel, on);
    format!("switch {channel} {on}")
}

fn sticks(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    for channel in [ROLL, PITCH, YAW] {
        run.frame.channels[channel] = pick(rng, &[1500, 1500, 1540, 1600, 1300, 2000, 1000]);
    }
    run.frame.channels[THROTTLE] = pick(rng, &[1000, 1300, 1500, 1500, 1500, 1600, 1750]);
    format!("sticks {:?}", &run.frame.channels[..4])
}

/// Ends disturbances, so that missions can continue.
fn calm(run: &mut Run) -> String {
    run.link = true;
    for channel in [ROLL, PITCH, THROTTLE, YAW] {
        run.frame.channels[channel] = 1500;
    }
    for (channel, on) in [(AUTOPILOT, true), (RESCUE, false), (FAILSAFE, false), (ARM, true)] {
        run.switch(channel, on);
    }
    run.vehicle.apply(&VehicleCommand::from(WorldCommand::ClearFaults)).accepted().unwrap();
    "calm".to_owned()
}

fn gps(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    let seconds = rng.random_bool(0.7).then(|| rng.random_range(0.1..8.0));
    let back = rng.random_bool(0.4);
    let command = match back {
        true => WorldCommand::FaultOff(Fault::GpsLoss.key()),
        false => WorldCommand::FaultOn(Fault::GpsLoss, seconds),
    };
    run.vehicle.apply(&VehicleCommand::from(command)).accepted().unwrap();
    format!("gps {back} {seconds:?}")
}

fn set_wind(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    let wind = Wind { speed_mps: rng.random_range(0.0..8.0), from_deg: rng.random_range(0.0..360.0) };
    run.vehicle.apply(&VehicleCommand::from(WorldCommand::SetWind(wind))).accepted().unwrap();
    format!("wind {wind}")
}

fn set_parameter(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    let field = &Params::FIELDS[rng.random_range(0..Params::FIELDS.len())];
    let number = rng.random_range(field.min..=field.max);
    let words = field.words;
    let value = match usize::try_from(number).ok().and_then(|index| words.get(index)) {
        Some(word) => (*word).to_owned(),
        None => number.to_string(),
    };
    let line = format!("set {} = {value}", field.name);
    run.cli(&line);
    line
}

/// Returns the words of a waypoint after its index. A coarse grid makes places coincide now and then.
fn waypoint(run: &Run, rng: &mut ChaCha8Rng) -> String {
    let mut metres = || f64::from(rng.random_range(-5..=5)) * 6.0;
    let place = Vector3::new(metres(), metres(), 0.0);
    let (lat, lon, _) = run.vehicle.local_frame().unwrap().to_geodetic(place);
    let kind = pick(rng, &WaypointType::iter().collect::<Vec<_>>());
    let pattern = pick(rng, &HoldPattern::iter().collect::<Vec<_>>());
    let alt_cm = rng.random_range(100..2500);
    let speed_cms = rng.random_range(0..900);
    let duration_ds = pick(rng, &[0, 1, 10, 30]);
    format!("{lat:.7} {lon:.7} {alt_cm} {speed_cms} {kind} {duration_ds} {pattern}")
}

fn replace_plan(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    run.cli("waypoint clear");
    let count = match rng.random_bool(0.75) {
        true => rng.random_range(1..6),
        false => rng.random_range(0..=MAX_WAYPOINTS),
    };
    for index in 0..count {
        let words = waypoint(run, rng);
        run.cli(&format!("waypoint insert {index} {words}"));
    }
    let plan = edited(run);
    assert_eq!(plan.waypoints.len(), count);
    format!("plan {count}")
}

fn edit_plan(run: &mut Run, rng: &mut ChaCha8Rng) -> String {
    let count = run.plan.waypoints.len();
    let words = waypoint(run, rng);
    let line = match (rng.random_range(0..4), count) {
        (0, 1..) => format!("waypoint remove {}", rng.random_range(0..count)),
        (1, 1..) => format!("waypoint update {} {words}", rng.random_range(0..count)),
        (2, _) => "waypoint clear".to_owned(),
        (_, MAX_WAYPOINTS..) => "waypoint list".to_owned(),
        (_, _) => format!("waypoint insert {} {words}", rng.random_range(0..=count)),
    };
    run.cli(&line);
    edited(run);
    line
}

/// Takes the stored plan as the one that flying must not change.
fn edited(run: &mut Run) -> &FlightPlan {
    run.plan = run.vehicle.embedded().unwrap().stored_plan().clone();
    &run.plan
}
