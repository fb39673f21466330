//! Flights by scripts, with RC over UDP as the usual Python script sends it, and over MSP.

use std::io::Write;
use std::net::{SocketAddr, TcpStream};
use std::time::Duration;

use super::msp;
use super::program::{PATIENCE, Serve, Sitl};
use super::serial::Terminal;
use super::simulator::Sockets;
use super::transmitter::Script;

/// The settings of the usual guide, and its plan.
const GUIDE_SETTINGS: &str = include_str!("../../vectors/guide-step5.txt");
const GUIDE_PLAN: &str = include_str!("../../../plans/guide-square.txt");

/// The switches of the usual script: ARM on the fifth channel, AUTOPILOT on the sixth.
pub(crate) const SWITCHES: &str = "
    aux 0 0 0 1700 2100 0 0
    aux 1 56 1 1700 2100 0 0";

/// A failsafe delay that lets a busy machine delay a script without a failsafe.
pub(crate) const PATIENT_FAILSAFE: &str = "set failsafe_delay = 200";

/// A plan that flies over one point and lands beside home.
pub(crate) const THERE_AND_DOWN: &str = "
    set ap_landing_descent_rate = 200
    waypoint clear
    waypoint insert 0 40.4637000 -79.5182000 2000 500 FLYOVER 0 ORBIT
    waypoint insert 1 40.4636000 -79.5182000 1500 500 LAND 0 ORBIT";

/// A plan that orbits until it is ended.
pub(crate) const FOR_EVER: &str = "
    waypoint clear
    waypoint insert 0 40.4637000 -79.5182000 2000 500 HOLD 0 ORBIT";

/// Types settings and plan over TCP and saves them. Checks that the rebooted craft has the plan, and waits
/// until the craft could arm.
fn prepare(tcp: SocketAddr, texts: &[&str]) {
    let mut terminal = Terminal::open(tcp);
    for text in texts {
        terminal.type_lines(text);
    }
    terminal.save();
    // The craft is the same after the reboot. A command line blocks arming until the next reboot.
    let mut again = Terminal::open(tcp);
    let list = again.type_lines("waypoint list");
    let lines = texts.iter().flat_map(|text| text.lines()).map(str::trim);
    for line in lines.filter(|line| line.starts_with("waypoint insert ")) {
        assert!(list.contains(line), "{line} is not in {list}");
    }
    again.save();
    msp::wait_until_ready(tcp);
}

/// Returns a served craft that is prepared and could arm.
pub(crate) fn prepared(speed: &str, texts: &[&str]) -> Serve {
    let serve = Serve::start(speed);
    prepare(serve.tcp, texts);
    serve
}

/// Checks that the craft arms, flies the plan to its end and lands.
pub(crate) fn sees_the_flight(serve: &mut Serve) {
    serve.event("armed");
    serve.wait("end of the plan", |event| event["event"] == "state" && event["to"] == "COMPLETE");
    let disarmed = serve.event("disarmed");
    assert_eq!(disarmed["reason"], "LANDING");
    assert!(!serve.has_seen("crash"));
}

#[test]
fn the_usual_script_flies_the_usual_plan() {
    // The craft flies sixteen times as fast as the script assumes. Its fifty packets a second still count as
    // a radio.
    let mut serve = prepared("16", &[SWITCHES, PATIENT_FAILSAFE, GUIDE_SETTINGS, GUIDE_PLAN]);
    let script = Script::udp(serve.rc);
    sees_the_flight(&mut serve);
    script.end();
}

#[test]
fn the_usual_script_flies_the_drop_in() {
    let sockets = Sockets::open();
    let sitl = Sitl::start(sockets.raw_port(), sockets.motors_port());
    let simulator = sockets.fly(sitl.fdm, 4.0);
    prepare(sitl.tcp, &[SWITCHES, PATIENT_FAILSAFE, THERE_AND_DOWN]);
    let mut client = TcpStream::connect(sitl.tcp).unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut status = |bit_is_set: &dyn Fn(&[u8]) -> bool| {
        while !bit_is_set(&msp::ask(&mut client, 101, &[]).unwrap()) {
            std::thread::sleep(Duration::from_millis(50));
        }
    };
    let is_armed = |status: &[u8]| status[6] & 1 != 0;
    let script = Script::udp(sitl.rc);
    status(&is_armed);
    simulator.wait("flight over the first point", |seen| seen.furthest_north_m > 20.0);
    simulator.wait("landing", |seen| seen.on_ground);
    status(&|status| !is_armed(status));
    let seen = simulator.seen();
    assert!(!seen.crashed && seen.highest_m > 10.0, "{seen:?}");
    let from_land_m = (seen.north_m - 11.1).hypot(seen.east_m);
    assert!(from_land_m < 4.0, "{seen:?}");
    script.end();
}

#[test]
fn a_script_that_speaks_msp_uploads_and_flies_a_plan() {
    let mut serve = Serve::start("4");
    let mut stream = TcpStream::connect(serve.tcp).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let steps = |us: u16| ((us - 900) / 25) as u8;
    for (slot, [box_id, channel]) in [(0, [0, 0]), (1, [56, 1])] {
        let range = [slot, box_id, channel, steps(1700), steps(2100)];
        assert_eq!(msp::ask(&mut stream, 35, &range), Some(Vec::new()));
    }
    let lines = [PATIENT_FAILSAFE, THERE_AND_DOWN].join("\n");
    for line in lines.lines().map(str::trim).filter(|line| !line.is_empty()) {
        let payload = msp::ask_v2(&mut stream, 0x3012, line.as_bytes());
        let payload = payload.unwrap_or_else(|| panic!("{line} is refused"));
        assert_eq!(payload[2], 0, "{line}: {}", String::from_utf8_lossy(&payload[3..]));
    }
    assert_eq!(msp::ask(&mut stream, 250, &[]), Some(Vec::new()));
    assert_eq!(msp::ask(&mut stream, 68, &[]), Some(vec![0]));
    msp::wait_until_ready(serve.tcp);
    let script = Script::msp(serve.tcp);
    sees_the_flight(&mut serve);
    script.end();
}

#[test]
fn a_script_that_cannot_arm_is_reported_why() {
    let mut serve = Serve::start("4");
    // A client opened a command line and left. The craft needs a reboot to arm.
    drop(Terminal::open(serve.tcp));
    let script = Script::udp(serve.rc);
    let notice = serve.wait("reason", |event| {
        event["text"].as_str().is_some_and(|text| text.contains("arming is blocked"))
    });
    assert!(notice["text"].as_str().unwrap().contains("CLI (a CLI session was opened"), "{notice}");
    script.end();
}

#[test]
fn a_craft_whose_script_ends_lands() {
    let mut serve = prepared("10", &[SWITCHES, "set ap_rx_loss_policy = LAND", PATIENT_FAILSAFE, FOR_EVER]);
    let script = Script::udp(serve.rc);
    serve.wait("holding", |event| event["event"] == "state" && event["to"] == "ORBITING");
    script.end();
    serve.event("rx_loss");
    serve.wait("landing", |event| event["event"] == "failsafe" && event["policy"] == "LAND");
    serve.wait("emergency landing", |event| event["event"] == "state" && event["to"] == "LANDING");
    serve.event("disarmed");
    assert!(!serve.has_seen("crash"));
}

/// Text that people paste. The `#` of the first line is ignored while the craft is armed.
const PASTED: &str = "#
waypoint reset
waypoint insert 0 40.4637000 -79.5182000 2000 500 FLYOVER 0 ORBIT
waypoint insert 1 40.4636000 -79.5182000 1500 500 LAND 0 ORBIT
";

#[test]
fn waypoints_pasted_over_tcp_while_armed_get_no_answer_and_the_log_says_why() {
    let mut serve = prepared("1", &[SWITCHES, PATIENT_FAILSAFE, FOR_EVER]);
    let script = Script::udp(serve.rc);
    serve.event("armed");
    let mut client = TcpStream::connect(serve.tcp).unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    let ignored = |event: &serde_json::Value| {
        event["text"].as_str().is_some_and(|text| text.contains("`waypoint`") && text.contains("armed"))
    };
    client.write_all(PASTED.as_bytes()).unwrap();
    serve.wait("reason of the silence", ignored);
    // There was no answer before the reply to this request.
    assert_eq!(msp::ask(&mut client, 2, &[]).as_deref(), Some(b"BTFL".as_slice()));
    assert_eq!(serve.notices("`waypoint`"), 1, "one notice for one paste");
    script.end();
}
