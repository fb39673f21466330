//! Many flights of the open plan without a screen: the same answers as `campaign --sweep` and `forecast` give.

use crate::binary::plain::Dialogue;
use crate::binary::support::Sandbox;
#[cfg(unix)]
use crate::binary::terminal::started;

/// A plan that is flown in a quarter of a minute.
const HOP: &str = "[[waypoint]]\ntype = \"LAND\"\nlat_deg = 40.46354\nlon_deg = -79.5182\nalt_m = 4\n
[home]\nlat_deg = 40.4635\nlon_deg = -79.5182\nalt_amsl_m = 300\n";

#[test]
fn a_fault_at_every_second_has_the_fates_of_a_campaign() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    let same = ["--wind", "9@250", "--turbulence", "light", "--seed", "7"];
    let sweep = ["campaign", "hop.toml", "--sweep", "motor,,1:0", "--csv", "s.csv"];
    sandbox.run(&[&sweep[..], &same].concat()).exits(1);
    let table = sandbox.read("s.csv");
    let fates = table.lines().skip(1).map(|row| match row.split(',').nth(1) {
        Some("home") => '·',
        Some("off") => 'o',
        _ => 'X',
    });
    let of_campaign: String = fates.collect();
    assert!(of_campaign.contains('X') && of_campaign.contains('·'), "{of_campaign}");
    let plain = ["hop.toml", "--plain", "--fresh", "--no-ports"];
    let ran = sandbox.run_with(&[&plain[..], &same].concat(), "where motor,,1:0\nquit\n").exits(0);
    let of_screen = ran.out.lines().filter_map(|line| line.trim().strip_prefix("0:00  "));
    assert_eq!(of_screen.collect::<Vec<_>>(), [&of_campaign], "{}", ran.out);
    let last = ran.out.lines().last().expect("a sentence");
    assert!(
        last.starts_with("motor,,1:0 at every second: ") && last.contains("; lost between 0:0"),
        "{last}"
    );
}

#[test]
fn a_hundred_flights_report_how_far_they_are() {
    let sandbox = Sandbox::new();
    sandbox.write("hop.toml", HOP);
    let mut plain = Dialogue::start(&sandbox, &["hop.toml", "--plain", "--fresh", "--no-ports"]);
    plain.say("what-if go");
    plain.hear("go or no-go: 1 of 100 flights …");
}

#[cfg(unix)]
#[test]
fn the_screen_and_its_flight_go_on_while_a_fault_is_flown_at_every_second() {
    let mut terminal = started(120, 40, &["land"]);
    terminal.send("M");
    terminal.until_shown("gps-loss,6 at every second: ");
    terminal.send("F");
    terminal.until_shown("● ARMED");
    terminal.until_shown(" home, o ");
    terminal.send("M");
    terminal.until("a map without the sweep", |terminal| !terminal.screen().contains("at every second"));
    terminal.send("q");
    terminal.until_shown("Quit?");
    terminal.send("y");
    assert_eq!(terminal.end(), 0);
    terminal.assert_given_back();
}
