//! `--connect`: the user interface over a serial cable and over TCP, connected to the embedded firmware.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::process::{Child, Stdio};
use std::time::Duration;

use test_support::Bridge;

use crate::binary::plain::Dialogue;
use crate::binary::pty::Terminal;
use crate::binary::support::Sandbox;

/// The time after which an answer counts as missing.
const NEVER: Duration = Duration::from_secs(600);

/// The embedded firmware at a TCP door. It is killed when dropped.
pub(crate) struct Craft {
    child: Child,
    pub(crate) address: SocketAddr,
    _home: Sandbox,
}

impl Craft {
    pub(crate) fn start() -> Self {
        let home = Sandbox::new();
        let ports = ["--tcp-port=0", "--ws-port=0", "--udp-ports=0,0,0,0"];
        let mut command = home.command(&[&["serve", "--fresh"][..], &ports].concat());
        let mut child = command.stdout(Stdio::piped()).spawn().expect("it runs");
        let mut lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        let opened = lines.find_map(|line| line.ok()?.split_once("tcp ").map(|(_, rest)| rest.to_owned()));
        let opened = opened.expect("a door");
        let address = opened.split(',').next().and_then(|text| text.parse().ok()).expect("an address");
        // The process keeps writing and must not block.
        std::thread::spawn(move || lines.for_each(drop));
        Self { child, address, _home: home }
    }

    /// Returns the output of a command line, requested directly from the craft and not through the program
    /// under test.
    fn line(&self, line: &str) -> String {
        framed_line(self.address, line)
    }
}

impl Drop for Craft {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

fn connect(address: SocketAddr) -> TcpStream {
    let stream = TcpStream::connect(address).expect("a door");
    stream.set_read_timeout(Some(NEVER)).expect("a timeout");
    stream
}

/// Returns the output of a line between the marks of the framed command line.
fn framed_line(address: SocketAddr, line: &str) -> String {
    let mut stream = connect(address);
    stream.write_all(format!("\x02{line}\n\x03").as_bytes()).expect("sent");
    let mut text = Vec::new();
    while text.last() != Some(&0x03) {
        let mut byte = [0];
        stream.read_exact(&mut byte).expect("an answer");
        text.push(byte[0]);
    }
    String::from_utf8_lossy(&text[1..text.len() - 1]).into_owned()
}

/// Sends an MSP message and returns its reply: `true` for an error, and the payload.
fn msp(stream: &mut TcpStream, code: u8, payload: &[u8]) -> (bool, Vec<u8>) {
    let body = [&[payload.len() as u8, code], payload].concat();
    let sum = body.iter().fold(0, |sum, byte| sum ^ byte);
    stream.write_all(&[b"$M<", &body[..], &[sum]].concat()).expect("sent");
    let mut head = [0; 5];
    stream.read_exact(&mut head).expect("a reply");
    let mut rest = vec![0; usize::from(head[3]) + 1];
    stream.read_exact(&mut rest).expect("a reply");
    rest.pop();
    (head[2] == b'!', rest)
}

#[test]
fn a_board_on_a_cable_is_read_asked_about_once_and_comes_back_after_the_cable_was_pulled() {
    let craft = Craft::start();
    let mut bridge = Bridge::new(craft.address);
    let place = format!("serial:{}", bridge.device().display());
    let mut terminal = Terminal::betadeck(100, 30, &["--connect", &place, "--fresh"]);
    terminal.until_shown("there is no");
    terminal.until_shown("No connection to");

    bridge.plug_in();
    terminal.until_shown("DISARMED");
    terminal.until_shown("answers: Betaflight");
    terminal.until("a fix", |terminal| terminal.row(0).contains("3D") && !terminal.row(0).contains("— V"));
    terminal.send("F");
    terminal.until_shown("This craft is real");

    terminal.send("5get ap_max_angle\r");
    terminal.until_shown("ap_max_angle = 50");
    terminal.send("set ap_max_angle = 33\r");
    terminal.until_shown("Change the craft?");
    assert!(craft.line("get ap_max_angle").contains("= 50"), "nothing is changed before the answer");
    terminal.send("y");
    terminal.until_shown("ap_max_angle set to 33");
    terminal.send("set ap_max_angle = 34\r");
    terminal.watch("ap_max_angle set to 34", |terminal| {
        assert!(!terminal.screen().contains("Change the craft?"), "asked twice:\n{}", terminal.screen());
        terminal.screen().contains("ap_max_angle set to 34")
    });
    terminal.send("motor 1 1500\r");
    terminal.until_shown("This craft is real: its own transmitter");

    bridge.pull();
    terminal.until_shown("is lost");
    terminal.until("unknown", |terminal| terminal.row(0).starts_with(" ○ —"));
    bridge.plug_in();
    terminal.until_shown("DISARMED");
    terminal.send("set ap_max_angle = 35\r");
    terminal.until_shown("Change the craft?");
    terminal.send("n");
    terminal.until_shown("not run: changes were not permitted");
    assert!(craft.line("get ap_max_angle").contains("= 34"));

    terminal.send("\x1b");
    terminal.until("the panel left", |terminal| !terminal.screen().contains("Esc leave"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn all_settings_of_a_remote_firmware_are_read_and_changed_in_the_same_panel() {
    let craft = Craft::start();
    craft.line("set p_roll = 60");
    // A moment after boot the RC link counts as lost. The notice about it would cover the answer to a key.
    assert!((0..100_000).any(|_| craft.line("status").contains("RXLOSS")));
    let place = format!("tcp:{}", craft.address);
    let mut terminal = Terminal::betadeck(80, 24, &["--connect", &place, "--fresh"]);
    terminal.until_shown("answers: Betaflight");
    terminal.send("9");
    terminal.until_shown("─ Changed");
    let row = |terminal: &Terminal, name: &str| {
        let screen = terminal.screen();
        let is_row = |line: &&str| line.contains(&format!("{name} ")) && !line.contains('─');
        screen.lines().find(is_row).unwrap_or_default().to_owned()
    };
    let p_roll = row(&terminal, "p_roll");
    assert!(p_roll.contains('●') && p_roll.contains("60"), "{p_roll}");
    terminal.send("/tilt of the auto\r");
    terminal.until("the setting", |terminal| row(terminal, "ap_max_angle").contains("50"));
    terminal.send("+");
    terminal.until_shown("Change the craft?");
    assert!(craft.line("get ap_max_angle").contains("= 50"), "nothing is changed before the answer");
    terminal.send("y");
    terminal.until_shown("ap_max_angle = 51.");
    assert!(craft.line("get ap_max_angle").contains("= 51"));
    terminal.send("u");
    terminal.until_shown("ap_max_angle = 50.");
    assert!(craft.line("get ap_max_angle").contains("= 50"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);
}

#[test]
fn a_plan_goes_to_the_craft_and_back_over_tcp() {
    let craft = Craft::start();
    let place = format!("tcp:{}", craft.address);
    let sandbox = Sandbox::new();
    let mut dialogue = Dialogue::start(&sandbox, &["square", "--plain", "--fresh", "--connect", &place]);
    dialogue.hear("answers: Betaflight");
    dialogue.say("upload");
    dialogue.hear("This changes the flight controller at tcp:");
    dialogue.say("later");
    dialogue.hear("Answer y to go on, n to change nothing.");
    dialogue.say("n");
    dialogue.hear("Nothing was changed.");
    assert!(!craft.line("waypoint list").contains("insert"), "{}", craft.line("waypoint list"));

    dialogue.say("upload");
    dialogue.hear("Go on?");
    dialogue.say("y");
    dialogue.hear("Uploaded square: 4 waypoints.");
    assert!(craft.line("waypoint list").contains("insert 3"), "{}", craft.line("waypoint list"));
    dialogue.say("download");
    dialogue.hear("The craft has the same plan.");
    dialogue.say("flash");
    dialogue.hear("Saved in the craft's flash");

    for (line, reported) in [
        ("arm", "This craft is real"),
        ("flight.fly", "This craft is real"),
        ("reset", "Nothing is simulated here"),
        ("wind 5@270", "Nothing is simulated here"),
        ("speed 2", "runs on the wall clock"),
        ("allow-changes", "permitted already"),
        ("cli motor 1 1500", "This craft is real"),
        ("cli bl", "in another program"),
    ] {
        dialogue.say(line);
        dialogue.hear(reported);
    }
    dialogue.say("quit");
    assert_eq!(dialogue.end(), Some(0));
}

#[test]
fn programs_at_a_door_read_but_change_only_what_is_permitted() {
    let craft = Craft::start();
    let place = format!("tcp:{}", craft.address);
    let sandbox = Sandbox::new();
    let arguments = ["--plain", "--fresh", "--connect", &place, "--tcp-port=0"];
    let mut dialogue = Dialogue::start(&sandbox, &arguments);
    let opened = dialogue.hear("Doors open: ").pop().unwrap_or_default();
    assert!(!opened.contains("ws ") && !opened.contains("rc "), "only what was asked for: {opened}");
    let door = opened.split_once("tcp ").map(|(_, rest)| rest.trim_end_matches('.')).expect("a door");
    let door: SocketAddr = door.parse().expect("an address");
    dialogue.hear("answers: Betaflight");

    let mut client = connect(door);
    assert_eq!(msp(&mut client, 2, &[]), (false, b"BTFL".to_vec()));
    assert!(framed_line(door, "get ap_max_angle").contains("ap_max_angle = 50"));
    assert!(msp(&mut client, 250, &[]).0, "EEPROM_WRITE");
    dialogue.hear("A program at a door was refused: Changes are not permitted");
    assert!(framed_line(door, "set ap_max_angle = 40").contains("###ERROR"));
    assert!(craft.line("get ap_max_angle").contains("= 50"));

    dialogue.say("allow-changes");
    dialogue.hear("Go on?");
    dialogue.say("yes");
    dialogue.hear("Changes are permitted until the connection ends.");
    let said = framed_line(door, "set ap_max_angle = 40");
    assert!(said.contains("set to 40"), "{said}");
    let channels: Vec<u8> = [1500_u16; 8].iter().flat_map(|us| us.to_le_bytes()).collect();
    for moving in [200, 211, 214] {
        assert!(msp(&mut client, moving, &channels).0, "{moving}");
    }
    // The App sends this when it connects, and continues when it is refused.
    assert!(msp(&mut client, 99, &[1, 0]).0, "SET_ARMING_DISABLED");
    for (line, reported) in
        [("mo\u{200b}tor 1 1500", "###ERROR: This craft is real"), ("bl\u{e9} rom", "in another program")]
    {
        assert!(framed_line(door, line).contains(reported), "{line}");
    }
    assert_eq!(msp(&mut client, 2, &[]), (false, b"BTFL".to_vec()));
    dialogue.say("quit");
    assert_eq!(dialogue.end(), Some(0));
}

#[test]
fn another_program_than_betaflight_is_reported_in_a_sentence() {
    for (variant, reported) in [
        (Some(b"INAV"), "reports INAV, not BTFL: only Betaflight is supported"),
        (None, "nothing there answers MSP"),
    ] {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let place = format!("tcp:{}", listener.local_addr().expect("an address"));
        std::thread::spawn(move || {
            for stream in listener.incoming().map_while(Result::ok) {
                answer_as(stream, variant);
            }
        });
        let sandbox = Sandbox::new();
        let mut dialogue = Dialogue::start(&sandbox, &["--plain", "--fresh", "--connect", &place]);
        dialogue.hear(reported);
        dialogue.say("quit");
        assert_eq!(dialogue.end(), Some(0));
    }
}

/// Answers as a flight controller of another kind, or stays silent if `variant` is `None`.
fn answer_as(mut stream: TcpStream, variant: Option<&[u8; 4]>) {
    let mut request = [0; 6];
    while stream.read_exact(&mut request).is_ok() {
        let Some(variant) = variant else { continue };
        let payload = if request[4] == 1 { &[0, 1, 46][..] } else { variant };
        let body = [&[payload.len() as u8, request[4]], payload].concat();
        let sum = body.iter().fold(0, |sum, byte| sum ^ byte);
        if stream.write_all(&[b"$M>", &body[..], &[sum]].concat()).is_err() {
            return;
        }
    }
}

/// A craft that speaks MAVLink: the embedded firmware behind its door for ground stations.
struct MavlinkCraft {
    /// It is killed when dropped.
    _program: crate::doors::program::Program,
    place: String,
}

impl MavlinkCraft {
    fn start() -> Self {
        let options = "serve --fresh --ws-port 0 --tcp-port 0 --udp-ports 0,0,0,0 --mavlink tcp:0 --mavlink-as ardupilot";
        let mut program = crate::doors::program::Program::start(&options.split(' ').collect::<Vec<_>>());
        let place = program.wait("address of the door", |line| {
            let address = line.split("MAVLink: listens on ").nth(1)?.split(',').next()?;
            Some(format!("mavlink:tcp:{address}"))
        });
        Self { _program: program, place }
    }
}

#[test]
fn a_craft_that_speaks_mavlink_is_read_planned_and_recorded() {
    let craft = MavlinkCraft::start();
    let options = ["square", "--connect", &craft.place, "--fresh", "--tlog", "a.tlog"];
    let mut terminal = Terminal::betadeck(120, 40, &options);
    terminal.until_shown("ArduPilot quadcopter");
    terminal.until("its mode, fix and battery", |terminal| {
        let row = terminal.row(0);
        row.contains("DISARMED Acro") && row.contains("3D") && !row.contains("— V")
    });
    terminal.send("F");
    terminal.until_shown("This craft is real");
    terminal.send("U");
    terminal.until_shown("Change the craft?");
    terminal.send("y");
    terminal.until_shown("✓ on the craft");
    terminal.send("5mode Stabilize\r");
    terminal.until_shown("the craft refused");
    terminal.send("mode Loiter\r");
    terminal.until_shown("accepted");
    // The switches move; on the ground the craft levels only.
    terminal.until("its new mode", |terminal| terminal.row(0).contains("DISARMED Stabilize"));
    terminal.send("arm\r");
    terminal.until_shown("has no line arm");
    drop(craft);
    terminal.until("a lost craft", |terminal| terminal.row(0).starts_with(" ○ —"));
    terminal.send("\x1b");
    terminal.until("the panel left", |terminal| !terminal.screen().contains("Esc leave"));
    terminal.send("q");
    assert_eq!(terminal.end(), 0);

    let mut replay = Terminal::start_in(
        terminal.into_home(),
        120,
        40,
        crate::binary::support::PROGRAM,
        &["replay", "a.tlog", "--at", "boot+9999"],
    );
    replay.until_shown("REPLAY");
    replay.until("the plan of the craft on the map", |terminal| terminal.screen().contains("◆0 FLYOVER"));
    replay.send("q");
    assert_eq!(replay.end(), 0);
}

#[test]
fn telemetry_logs_of_other_autopilots_are_shown_with_their_own_modes() {
    // INAV reports no item of its mission.
    for (name, mode, state, text) in [
        ("arducopter", "AUTO", "▐APPROACHING▌", "Mode RTL."),
        ("px4", "Mission", "▐APPROACHING▌", "Low battery level"),
        ("inav", "AUTO", "▐IDLE▌", "Mode RTL."),
    ] {
        for (columns, rows) in [(80, 24), (120, 40)] {
            let file = format!("{}/tests/exchange/mavlink/{name}.tlog", env!("CARGO_MANIFEST_DIR"));
            let mut terminal = Terminal::betadeck(columns, rows, &["replay", &file, "--at", "28"]);
            terminal.until("the craft on its way", |terminal| {
                let (bar, screen) = (terminal.row(0), terminal.screen());
                let is_flying = [&format!("● ARMED {mode} "), "3D 14 sats", "15.7 V"];
                is_flying.iter().all(|text| bar.contains(text))
                    && ["◇0 FLYBY", "◇1 FLYBY", state, text, "7.5 m/s  20.0 m"]
                        .iter()
                        .all(|text| screen.contains(text))
            });
            terminal.send("q");
            assert_eq!(terminal.end(), 0);
        }
    }
}
