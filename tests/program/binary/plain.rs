//! `--plain`: the same flight as sentences, with commands on standard input and no terminal.
#![allow(clippy::disallowed_methods, reason = "a deadline for a program that hangs needs the clock")]

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use crate::binary::support::Sandbox;

const PLAIN: [&str; 4] = ["--plain", "--fresh", "--no-ports", "--speed=max"];
/// The time after which a line counts as missing.
const NEVER: Duration = Duration::from_secs(600);

/// A running program that reads lines and answers them. It is killed when dropped.
pub(crate) struct Dialogue {
    child: Child,
    input: ChildStdin,
    output: Receiver<String>,
}

impl Dialogue {
    pub(crate) fn start(sandbox: &Sandbox, arguments: &[&str]) -> Self {
        let mut command = sandbox.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
        let lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        let (sender, output) = channel();
        std::thread::spawn(move || {
            for line in lines.map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        Self { input: child.stdin.take().expect("its input"), child, output }
    }

    pub(crate) fn say(&mut self, line: &str) {
        writeln!(self.input, "{line}").expect("it listens");
    }

    pub(crate) fn say_bytes(&mut self, bytes: &[u8]) {
        self.input.write_all(bytes).expect("it listens");
    }

    /// Waits for a line that contains this text. Returns the lines up to it.
    #[track_caller]
    pub(crate) fn hear(&mut self, text: &str) -> Vec<String> {
        let mut heard = Vec::new();
        loop {
            let line = self.output.recv_timeout(NEVER);
            let line = line.unwrap_or_else(|error| panic!("{error} before: {text}\n{heard:#?}"));
            let is_it = line.contains(text);
            heard.push(line);
            if is_it {
                return heard;
            }
        }
    }

    pub(crate) fn end(mut self) -> Option<i32> {
        self.child.wait().expect("an exit status").code()
    }
}

impl Drop for Dialogue {
    fn drop(&mut self) {
        // The process may have ended already.
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

#[test]
fn commands_are_read_and_answered_in_their_order() {
    let sandbox = Sandbox::new();
    let input = "wnd 5@270\nwind 5@270\nset ap_max_angle=31\nset ap_max_angle\nhome\nquit\n";
    let ran = sandbox.run_with(&PLAIN, input).exits(0);
    let mut rest = ran.out.as_str();
    for part in
        ["did you mean wind?", "World: wind=5@270", "ap_max_angle set to 31", "ap_max_angle = 31", "disarmed"]
    {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
    assert!(ran.out.lines().any(|line| line.starts_with("00:00.000 Booted: airframe iris")), "{}", ran.out);
    assert!(!ran.out.contains('\u{1b}'), "no escape sequence\n{}", ran.out);
    assert_eq!(sandbox.names(), Vec::<String>::new());
}

#[test]
fn help_lists_the_topics_explains_each_and_a_wrong_plan_is_an_input_error() {
    let sandbox = Sandbox::new();
    let ran = sandbox.run_with(&PLAIN, "help\nhelp flight\nhelp fly\nhelp wind\nhelp wnd\nquit\n").exits(0);
    let mut rest = ran.out.as_str();
    for part in [
        "flight: fly, arm, ",
        "Commands with a value: set, cli, ",
        "flight.fly — Fly the plan",
        "flight.arm — ",
        "flight.fly — Fly the plan",
        "wind SPEED@FROM or calm — ",
        "There is no command or topic wnd; did you mean wind?",
    ] {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
    assert!(ran.out.lines().count() < 60, "a list to listen to is short\n{}", ran.out);
    sandbox.run_with(&["--plain", "no-such-file.toml"], "").exits(3);
}

#[test]
fn what_a_screen_asks_in_flight_is_chosen_by_number_or_named_on_the_line() {
    let sandbox = Sandbox::new();
    let mut flight = Dialogue::start(&sandbox, &["--plain", "--fresh", "--no-ports", "--speed=8"]);
    flight.hear("GPS fix");
    flight.say("look-ahead");
    flight.hear("disarmed");
    flight.say("what-if gps-loss");
    flight.hear("What if GPS lost here, flown from home: ");
    flight.say("fly");
    flight.hear("APPROACHING (waypoint 0");
    flight.say("what-if");
    flight.hear("1 GPS lost here");
    flight.hear("A number chooses");
    flight.say("1");
    flight.hear("What if GPS lost here: ");
    flight.say("what-if wind");
    flight.hear("What if wind +8 m/s: ");
    flight.say("look-ahead");
    flight.hear("look-ahead: ");
    flight.say("go-to 7");
    flight.hear("the craft has 0, 1, 2, 3.");
    flight.say("go-to");
    flight.hear("3 LAND");
    flight.say("3");
    flight.hear("APPROACHING (waypoint 3, LAND)");
    flight.say("quit");
    flight.hear("The craft is armed and flying ends here. Quit?");
    flight.say("n");
    flight.say("quit");
    flight.hear("Quit?");
    flight.say("y");
    assert_eq!(flight.end(), Some(0));
}

#[test]
fn plans_are_generated_saved_replaced_and_opened_line_by_line() {
    let sandbox = Sandbox::new();
    let input = "plan.generate\nshape = circle\nlength = 80\ntake\nsave\nmine\nplan.generate\ntake\n\
                 save mine.toml\nquit\nquit\n";
    let ran = sandbox.run_with(&PLAIN, input).exits(0);
    let mut rest = ran.out.as_str();
    for part in [
        "Generate a pattern.",
        "1 shape = square (square, circle, zig-zag, survey)",
        "`take` takes them all",
        "shape = circle: ",
        "length = 80: ",
        " waypoints.",
        "Save as which file in ",
        "Saved mine.toml.",
        "Saved mine.toml.",
    ] {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
    assert_eq!(sandbox.names(), ["mine.toml"]);

    // The answer `n` keeps that file. The edits of another plan are discarded at the end.
    let input = "plan.generate\ntake\nsave mine.toml\nn\nopen\n1\nplan.generate\nshape = survey\ntake\nquit\nwhat\nd\nd\nd\n";
    let before = sandbox.read("mine.toml");
    let ran = sandbox.run_with(&PLAIN, input).exits(0);
    for part in
        ["mine.toml exists. Answer y replace it", "Open which plan of ", "1 mine.toml", "Opened mine.toml."]
    {
        assert!(ran.out.contains(part), "no {part}\n{}", ran.out);
    }
    assert!(
        ran.out.contains(
            "has edits that no file holds, and they cannot be kept for later. Answer s save, d discard, n stay"
        ),
        "{}",
        ran.out
    );
    assert!(ran.out.contains("\nAnswer s save, d discard, n stay.\n"), "{}", ran.out);
    assert_eq!(sandbox.read("mine.toml"), before);
}

#[test]
fn every_panel_is_written_by_its_name() {
    let sandbox = Sandbox::new();
    let names = ["map", "state", "plan", "rc", "world", "graphs", "log", "settings"];
    let input: String =
        names.iter().map(|name| format!("view.{name}\n")).chain(["quit\n".to_owned()]).collect();
    let arguments = [&["square"], &PLAIN[..]].concat();
    let ran = sandbox.run_with(&arguments, &input).exits(0);
    let mut rest = ran.out.as_str();
    for part in [
        "Map\n",
        "Fence: 500 m around home, the craft is 500 m inside.",
        "WP2 HOLD: ",
        "State\n",
        "State: IDLE.",
        "Plan — square",
        "40.4640000  -79.5175000     50.0",
        "RC — ",
        "THROTTLE: ",
        "World — airframe iris",
        "wind speed        0.0 m/s",
        "Graphs — ",
        "altitude m, estimate: ",
        "Log\n",
        "Booted: airframe iris",
        "Settings — reading …\n",
        "gyro_lpf1_type ",
    ] {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
}

#[test]
fn a_plan_is_edited_line_by_line() {
    let sandbox = Sandbox::new();
    let input = "plan.right\nright\nright\nedit\nhigh\n62\nundo\nplan.insert\nquit\nd\n";
    let arguments = [&["square"], &PLAIN[..]].concat();
    let ran = sandbox.run_with(&arguments, input).exits(0);
    let mut rest = ran.out.as_str();
    for part in [
        "[40.4640000]",
        "[-79.5175000]",
        "[50.0]",
        "altitude (metres above home). Now 50. A line sets it, an empty line leaves it.",
        "high is no altitude",
        "[62.0]",
        "[50.0]",
        "Undone: altitude of WP0.",
        "  4  LAND ",
    ] {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
}

#[test]
fn the_plan_is_compared_with_the_craft_its_file_and_its_revisions_line_by_line() {
    let sandbox = Sandbox::new();
    let text = "waypoint insert 0 40.4640000 -79.5175000 1000 0 FLYOVER 0 NONE\n\
                waypoint insert 1 40.4636 -79.5182 1000 0 LAND 0 NONE\n";
    sandbox.write("two.txt", text);
    let mut flight =
        Dialogue::start(&sandbox, &["--plain", "--fresh", "--no-ports", "--speed=max", "two.txt"]);
    flight.hear("GPS fix");
    // The craft and the file keep the first altitude.
    for line in ["upload", "plan.right", "right", "right", "edit", "25"] {
        flight.say(line);
    }
    flight.hear("[25.0]");
    flight.say("plan.compare");
    let answers = "Compare with: craft, file, revision NUMBER, settings (defaults, plan or saved)";
    let mut heard = flight.hear(answers);
    while !heard.iter().any(|line| line.starts_with("craft | ")) {
        // The picture with the uploaded plan may come after the answer.
        for line in ["", "plan.compare"] {
            flight.say(line);
        }
        heard = flight.hear(answers);
    }
    let has = |heard: &[String], text: &str| heard.iter().any(|line| line.contains(text));
    assert!(has(&heard, "craft | this plan: ≠ 1 changed   = 1 the same"), "{heard:#?}");
    assert!(
        has(&heard, "≠ WP0 FLYOVER: 40.4640000 -79.5175000 10 m | 40.4640000 -79.5175000 25 m"),
        "{heard:#?}"
    );
    assert!(has(&heard, "  ≠ altitude: 10 m | 25 m"), "{heard:#?}");
    flight.say("file");
    flight.hear("file | this plan: ≠ 1 changed");
    flight.hear("  ≠ altitude: 10 m | 25 m");
    flight.say("revision 0");
    flight.hear("revision 0 (as opened) | this plan: ≠ 1 changed");
    flight.hear("  ≠ altitude: 10 m | 25 m");
    flight.say("revision 9");
    flight.hear("Compare with: craft, file, revision NUMBER");
    flight.say("");
    // Another program writes the file.
    sandbox.write("two.txt", &text.replace(" 1000 ", " 3000 "));
    flight.hear("changed on disk");
    flight.say("plan.compare");
    flight.hear("  ≠ altitude: 30 m | 25 m");
    flight.say("");
    flight.say("quit");
    flight.say("d");
    assert_eq!(flight.end(), Some(0));
}

#[test]
fn settings_and_signals_are_found_by_a_line() {
    let sandbox = Sandbox::new();
    let mut flight = Dialogue::start(&sandbox, &["--plain", "--fresh", "--no-ports"]);
    flight.say("settings");
    flight.hear("gyro_hardware_lpf");
    flight.hear("ap_position_p");
    flight.say("settings.search");
    flight.hear("A line sets it");
    flight.say("ap_position_p");
    flight.say("settings");
    let listed = flight.hear("ap_position_p ");
    assert!(!listed.iter().any(|line| line.contains("ap_position_i")), "{listed:#?}");
    flight.say("raise");
    flight.hear("ap_position_p                    31");
    flight.say("graphs.series");
    flight.hear("Signals shown by name: none.");
    flight.say("altit");
    flight.hear("Signals with altit: ");
    flight.say("est_altitude");
    flight.hear("Signals shown by name: est_altitude.");
    flight.say("");
    flight.say("graphs");
    flight.hear("est_altitude m, now: ");
    flight.say("quit");
    assert_eq!(flight.end(), Some(0));
}

#[test]
fn an_opened_flight_names_commands_rather_than_keys_without_a_screen() {
    let sandbox = Sandbox::new();
    sandbox.write("near.txt", "waypoint insert 0 40.4635 -79.5182 500 0 LAND 0 NONE\n");
    sandbox.write("near.toml", "format = 1\n[plan]\nfile = \"near.txt\"\n[craft]\ntakeoff_m = 5\n");
    sandbox.run(&["fly", "near.txt", "--record", "near.flight"]).exits(0);
    for file in ["near.toml", "near.flight"] {
        let said = sandbox.run_with(&["open", file, "--plain"], "quit\n").exits(0).out;
        assert!(
            said.contains("`time.event-back` and `time.earlier` go back, `sim.pause` plays it"),
            "{said}"
        );
        assert!(!said.contains("`<`"), "{said}");
    }
}

#[test]
fn an_instant_of_a_scenario_is_read_without_a_screen() {
    let sandbox = Sandbox::new();
    let arguments = ["open", "guide-1", "--at", "30", "--plain"];
    let mut flight = Dialogue::start(&sandbox, &arguments);
    flight.hear("Booted: ");
    flight.say("view.state");
    flight.hear("Rewound by ");
    flight.hear("State: APPROACHING.");
    flight.say("view.map");
    flight.hear("flown now.");
    flight.say("time.state");
    flight.say("view.state");
    flight.hear("State: ");
    flight.say("quit");
    flight.hear("The craft is armed and flying ends here. Quit?");
    flight.say("y");
    assert_eq!(flight.end(), Some(0));
}

fn ask(flight: &mut Dialogue, line: &str, answer: &str) -> Vec<String> {
    flight.say(line);
    flight.hear(answer)
}

#[test]
fn without_a_screen_sentences_name_commands_and_nothing_is_drawn_for_the_eye() {
    let sandbox = Sandbox::new();
    let mut flight = Dialogue::start(&sandbox, &["--plain", "--fresh", "--no-ports", "--speed=max"]);
    let mut said = flight.hear("Booted: ");
    said.extend(ask(&mut flight, "F", "F is a key of the screen; its command is flight.fly."));
    // The craft answers with another advice during the grace time after its boot.
    while said.iter().all(|line| !line.contains("flight.fly ")) {
        flight.say("view.state");
        said.extend(flight.hear("State: "));
    }
    said.extend(ask(&mut flight, "view.rc", "; AUTOPILOT off, on from 1700 to 2100."));
    said.extend(ask(&mut flight, "view.rc", "AUX12: "));
    said.extend(ask(&mut flight, "flight.fly", "Disarmed: landed."));
    said.extend(ask(&mut flight, "view.log", "Touchdown"));
    // The picture follows the events.
    while said.last().is_none_or(|line| line != "State: COMPLETE.") {
        flight.say("view.state");
        said.extend(flight.hear("State: "));
    }
    said.extend(ask(&mut flight, "view.state", "flight.fly flies again."));
    said.extend(ask(&mut flight, "qwertyuiop", "`app.palette` lists all."));
    let drawn = |c: char| "─█░┼▮▯⊕⇄○●◆·✓▲✗".contains(c);
    for line in &said {
        assert!(!line.contains(drawn), "{line}");
        for key in ["`F`", " F ", " R ", "`]`", "Ctrl-P", "Esc"] {
            assert!(!line.contains(key) || line.contains("is a key of the screen"), "{key}: {line}");
        }
    }
    // Events and the log have the same clock.
    let stamp = |line: &String| line.split(' ').next().map(str::to_owned);
    let touchdowns: Vec<_> = said.iter().filter(|line| line.contains(" Touchdown")).map(stamp).collect();
    assert_eq!(touchdowns.len(), 2, "{said:#?}");
    assert_eq!(touchdowns[0], touchdowns[1]);
    flight.say("quit");
    assert_eq!(flight.end(), Some(0));
}

#[test]
fn once_the_firmware_s_command_line_is_named_lines_go_to_it() {
    let sandbox = Sandbox::new();
    let input = "view.cli\nget ap_max_angle\nfoo\nspeed max\n:help wind\nsave\nview.state\nfoo\nquit\n";
    let ran = sandbox.run_with(&PLAIN, input).exits(0);
    let mut rest = ran.out.as_str();
    for part in [
        "until another panel is named",
        "ap_max_angle = ",
        "UNKNOWN COMMAND",
        "wind SPEED@FROM or calm — ",
        "Rebooting",
        "There is no command foo",
    ] {
        let at = rest.find(part).unwrap_or_else(|| panic!("no {part} in its place\n{}", ran.out));
        rest = &rest[at + part.len()..];
    }
}

#[test]
fn a_terminal_that_is_dumb_is_refused_with_the_option_that_helps() {
    let sandbox = Sandbox::new();
    let mut command = sandbox.command(&["--fresh", "--no-ports"]);
    let ran = command.env("TERM", "dumb").stdin(Stdio::null()).output().expect("it runs");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(
        ran.status.code() == Some(3) && said.contains("TERM=dumb") && said.contains("`--plain`"),
        "{said}"
    );
    let doctor = sandbox.command(&["doctor"]).env("TERM", "dumb").output().expect("it runs");
    assert!(String::from_utf8_lossy(&doctor.stdout).contains("betadeck needs --plain here"), "{doctor:?}");
}
