//! The guide's square, flown: the order of its states, the precision of its figures, and repeatability.

use crate::binary::lines::Line;
use crate::binary::support::{Flown, Sandbox, plan};

/// The metres by which `--noise real` may move the true position away from the estimated one. The simulated
/// receiver alone wanders by 0.35 m rms.
const GPS_M: f64 = 1.0;
/// The same tolerance for a speed, m/s.
const GPS_MPS: f64 = 0.15;

/// The states of a plan with a FLYOVER, a FLYBY, a HOLD on an orbit and a LAND.
const SQUARE: [&str; 12] = [
    "APPROACHING 0",
    "ARRIVED 0",
    "APPROACHING 1",
    "ARRIVED 1",
    "APPROACHING 2",
    "ARRIVED 2",
    "HOLDING 2",
    "ORBITING 2",
    "APPROACHING 3",
    "ARRIVED 3",
    "LANDING 3",
    "COMPLETE 3",
];

fn square(arguments: &[&str]) -> Flown {
    let file = plan("square.toml");
    Sandbox::new().fly(&[&[file.as_str()], arguments].concat()).ends(0, "complete")
}

/// Returns the metres north and east of a point in degrees at which `line` is, on a sphere. The error here is
/// centimetres.
fn offset(line: &Line, lat: f64, lon: f64) -> (f64, f64) {
    const METRES_PER_DEGREE: f64 = 111_319.49;
    let north = (line.number("lat") - lat) * METRES_PER_DEGREE;
    (north, (line.number("lon") - lon) * METRES_PER_DEGREE * lat.to_radians().cos())
}

fn samples(flown: &Flown, from: f64, to: f64) -> Vec<&Line> {
    flown.all("sample").filter(|line| (from..to).contains(&line.time())).collect()
}

/// Returns the time at which a state was entered first.
fn entered(flown: &Flown, state: &str) -> f64 {
    flown.all("state").find(|line| line.text("to") == state).unwrap_or_else(|| panic!("never {state}")).time()
}

#[test]
fn the_square_goes_through_its_states_and_ends_disarmed_at_the_landing_point() {
    for noise in ["real", "none"] {
        let flown = square(&["--noise", noise, "--samples", "50"]);
        assert_eq!(flown.states(), SQUARE);
        for pair in flown.all("state").collect::<Vec<_>>().windows(2) {
            assert_eq!(pair[0].text("to"), pair[1].text("from"));
        }
        assert_eq!(flown.all("disarmed").map(|line| line.text("reason")).collect::<Vec<_>>(), ["LANDING"]);
        assert!(flown.first("disarmed").time() >= entered(&flown, "COMPLETE"));
        let touchdown = flown.first("touchdown");
        assert!(touchdown.number("impact_mps") < 1.0, "{touchdown:?}");
        let rest = flown.all("sample").next_back().expect("samples");
        let (north, east) = offset(rest, 40.464, -79.519);
        assert!(north.hypot(east) < 2.0, "landed {north:.2} m north and {east:.2} m east of the waypoint");
        assert!(rest.number("alt").abs() < 0.1 && rest.number("vu").abs() < 0.05, "{rest:?}");
    }
}

#[test]
fn the_flight_waits_for_the_fix_and_climbs_before_it_engages() {
    let flown = square(&["--samples", "10", "--takeoff", "15"]);
    let (fix, armed) = (flown.first("gps_fix").time(), flown.first("armed").time());
    assert!(fix > 0.0 && armed > fix);
    let engaged = samples(&flown, flown.engaged_at(), f64::MAX)[0];
    assert!((engaged.number("alt") - 15.0).abs() < 2.0, "engaged at {} m", engaged.number("alt"));
    assert!(engaged.number("vn").hypot(engaged.number("ve")) < 0.5, "engaged from a hover");
}

#[test]
fn the_orbit_has_its_radius() {
    // The default orbit takes two minutes for a lap and 20 s to settle, so the test flies a complete lap.
    let text = std::fs::read_to_string(plan("square.toml")).expect("the square");
    let long = text.replace("duration_s = 30", "duration_s = 140");
    assert_ne!(long, text);
    let sandbox = Sandbox::new();
    sandbox.write("long.toml", &long);
    for (noise, extra_m) in [("none", 0.0), ("real", GPS_M)] {
        let flown = sandbox.fly(&["long.toml", "--noise", noise, "--samples", "20"]).ends(0, "complete");
        let orbit = entered(&flown, "ORBITING");
        let lap = samples(&flown, orbit + 20.0, orbit + 139.0);
        assert!(lap.len() > 2000);
        for line in lap {
            let (north, east) = offset(line, 40.463, -79.519);
            let radius = north.hypot(east);
            assert!((radius - 10.0).abs() <= 0.6 + extra_m, "radius {radius:.2} m at {} s", line.time());
        }
    }
}

#[test]
fn legs_are_flown_at_their_speed() {
    let sandbox = Sandbox::new();
    let text = std::fs::read_to_string(plan("square.toml")).expect("the square");
    sandbox.write("slow.toml", &text.replace("alt_m = 50", "alt_m = 50\nspeed_mps = 5"));
    // Samples start ten seconds after the start of a leg and end where the craft brakes for its end. At 10
    // m/s only the leg to the FLYBY is long enough, because the craft does not brake for it.
    for (file, mps, legs, until_m) in
        [("slow.toml", 5.0, [1.0, 2.0, 3.0].as_slice(), 20.0), ("square", 10.0, &[1.0], 0.0)]
    {
        for (noise, extra_mps) in [("none", 0.0), ("real", GPS_MPS)] {
            let flown = sandbox
                .fly(&[file, "--noise", noise, "--samples", "20", "--set", "ap_max_velocity=1000"])
                .ends(0, "complete");
            for leg in legs {
                let start = flown
                    .all("state")
                    .find(|line| line.text("to") == "APPROACHING" && line.number("wp") == *leg)
                    .expect("the leg");
                let cruise: Vec<f64> = samples(&flown, start.time() + 10.0, start.time() + 60.0)
                    .into_iter()
                    .filter(|line| line.text("state") == "APPROACHING" && line.number("wp") == *leg)
                    .filter(|line| line.number("dist_m") >= until_m)
                    .map(|line| line.number("vn").hypot(line.number("ve")))
                    .collect();
                assert!(cruise.len() > 20, "{file}, leg {leg}: {} samples", cruise.len());
                for speed in cruise {
                    assert!(
                        (speed - mps).abs() <= 0.05 * mps + extra_mps,
                        "{file}, leg {leg}: {speed:.2} m/s"
                    );
                }
            }
            let fastest = flown.all("sample").map(|line| line.number("vn").hypot(line.number("ve")));
            let fastest = fastest.fold(0.0, f64::max);
            assert!(fastest <= 1.15 * mps + extra_mps, "{file}: {fastest:.2} m/s");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_does_not() {
    let sandbox = Sandbox::new();
    let run = |seed: &str| {
        let (name, track) = (format!("{seed}.json"), format!("{seed}.gpx"));
        let arguments = [
            "fly",
            "square",
            "--seed",
            seed,
            "--samples",
            "50",
            "--json",
            &name,
            "--gpx",
            &track,
            "--wind",
            "4@200",
            "--gust",
            "1",
        ];
        sandbox.run(&arguments).exits(0);
        let text = sandbox.read(&name);
        let (head, end) = text.trim_end().rsplit_once('\n').expect("lines");
        let (kept, clock) = end.split_once(",\"wall_s\":").expect("a wall time");
        let (ratio, hash) = clock.split_once(",\"hash\":").expect("a hash");
        assert!(ratio.contains(",\"speed_ratio\":") && ratio.matches(':').count() == 1, "{clock}");
        format!("{head}\n{kept}\n{hash}\n{}", sandbox.read(&track))
    };
    let (first, again, other) = (run("1"), run("1"), run("2"));
    assert!(first.len() > 1_000_000);
    assert!(first == again, "two flights with the same seed differ");
    assert!(first != other, "another seed changes nothing");
}

#[test]
fn the_hash_is_that_of_a_scenario_with_the_same_flight() {
    let sandbox = Sandbox::new();
    for (plan, options, tables) in [
        ("square", &["--wind=4@200", "--gust=1"][..], "[air]\nwind = \"4@200\"\ngust_mps = 1"),
        (
            "hold-orbit",
            &["--set=ap_max_angle=20", "--takeoff=15"],
            "[craft]\nsettings = [\"ap_max_angle = 20\"]\ntakeoff_m = 15",
        ),
        ("flyover", &["--noise=none", "--rate=400"], "[air]\nnoise = \"none\"\n[craft]\nrate_hz = 400"),
    ] {
        let scenario = format!("format = 1\nseeds = 3\n[plan]\nbuiltin = \"{plan}\"\n{tables}\n");
        sandbox.write("same.toml", &scenario);
        let flown = sandbox.fly(&[&[plan, "--seed=3"], options].concat());
        let checked = sandbox.run(&["check", "same.toml", "--json", "-"]).exits(0);
        let line = checked.out.lines().next().expect("a flight");
        let flight: serde_json::Value = serde_json::from_str(line).expect("JSON");
        assert_eq!(flown.first("end").text("hash"), flight["hash"], "{plan}: {line}");
    }
}

#[test]
fn sampling_does_not_change_the_flight() {
    let events = |flown: &Flown| -> Vec<Line> {
        flown.lines.iter().filter(|line| !matches!(line.event(), "sample" | "end")).cloned().collect()
    };
    assert_eq!(events(&square(&[])), events(&square(&["--samples", "100", "--speed", "900"])));
}
