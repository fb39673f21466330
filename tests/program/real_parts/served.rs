//! `betadeck serve` with a remote firmware, which runs in its own process and uses real sockets: `betadeck sitl`, and
//! the stand-in with each of its faults.

use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::lossy::LossyLink;
use super::stand_in::process::{self, Trouble, VARIABLE};
use super::stand_in::program::{End, Ports};
use super::stand_in::{StandIn, free_ports};
use crate::doors::msp;
use crate::doors::program::{PATIENCE, Program};
use crate::doors::transmitter::Script;

/// A running `betadeck serve` with its firmware.
struct Served {
    program: Program,
}

impl Served {
    /// Starts it for a firmware on these ports. `firmware` holds the options that name the firmware.
    fn start(ports: Ports, firmware: &[&str]) -> Self {
        let Ports { raw, motors, fdm, rc, tcp } = ports;
        let (udp, tcp) = (format!("{raw},{motors},{fdm},{rc}"), tcp.to_string());
        let doors = ["serve", "--json", "-", "--ws-port", "0", "--udp-ports", &udp, "--tcp-port", &tcp];
        Self { program: Program::start(&[&doors[..], firmware].concat()) }
    }

    /// Starts it with the drop-in as the child.
    fn drop_in(ports: Ports, more: &[&str]) -> Self {
        let Ports { raw, motors, fdm, rc, tcp } = ports;
        let (udp, tcp) = (format!("--udp-ports={raw},{motors},{fdm},{rc}"), format!("--tcp-port={tcp}"));
        let mut firmware = vec!["--clock=real", "--firmware", env!("CARGO_BIN_EXE_betadeck")];
        for argument in ["sitl", &udp, &tcp, "--ws-port=0"] {
            firmware.extend(["--firmware-arg", argument]);
        }
        firmware.extend(more);
        Self::start(ports, &firmware)
    }

    /// Starts it with the stand-in as the child, which starts fresh and stores nothing.
    fn stand_in(ports: Ports, trouble: Trouble) -> Self {
        Self::stand_in_kept(ports, trouble, &["--fresh"])
    }

    /// Starts it with the stand-in as the child. The options `kept` decide about its stored configuration.
    fn stand_in_kept(ports: Ports, trouble: Trouble, kept: &[&str]) -> Self {
        let (program, arguments) = process::command();
        let variable = format!("{VARIABLE}={}", process::variable(ports, trouble));
        let program = program.display().to_string();
        let mut firmware = [kept, &["--clock=real", "--firmware", "/usr/bin/env"]].concat();
        for argument in [&variable[..], &program].into_iter().chain(arguments) {
            firmware.extend(["--firmware-arg", argument]);
        }
        Self::start(ports, &firmware)
    }

    /// Waits for the next notice that contains these words and returns its text.
    fn notice(&mut self, words: &str) -> String {
        self.program.wait(words, |line| {
            let event: Value = serde_json::from_str(line).ok()?;
            let text = event["text"].as_str().filter(|_| event["event"] == "notice")?;
            text.contains(words).then(|| text.to_owned())
        })
    }

    /// Waits for the end and returns the exit code and the last lines before it.
    fn end(&mut self) -> (i32, String) {
        let code = self.program.end();
        (code, self.program.seen().join("\n"))
    }
}

fn is_running(pid: i32) -> bool {
    rustix::process::test_kill_process(rustix::process::Pid::from_raw(pid).unwrap()).is_ok()
}

#[test]
fn the_drop_in_is_a_remote_firmware_that_saves_its_settings() {
    let mut served = Served::drop_in(free_ports(), &["--fresh"]);
    served.notice(" answers: Betaflight ");
    let before = served.program.seen().join("\n");
    assert!(
        before.contains("lines of settings, and they read back as written") && !before.contains("refused"),
        "{before}"
    );
    served.program.wait("fix", |line| line.contains("\"gps_fix\"").then_some(()));
}

#[test]
fn on_the_wall_clock_a_client_and_a_script_reach_the_firmware_through_the_doors() {
    let mut served = Served::drop_in(free_ports(), &["--fresh"]);
    let doors = served.program.wait("doors", |line| {
        let event: Value = serde_json::from_str(line).ok()?;
        (event["event"] == "doors").then_some(event)
    });
    let door = |name: &str| doors[name].as_str().unwrap().parse().unwrap();
    served.notice(" answers: Betaflight ");
    let script = Script::udp(door("rc"));
    let mut client = TcpStream::connect::<SocketAddr>(door("tcp")).unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    // The script switches AUTOPILOT on with its sixth channel.
    let has_switch = |rc: &[u8]| rc[10..12] == 2000_u16.to_le_bytes();
    let deadline = Instant::now() + PATIENCE;
    while !msp::ask(&mut client, 105, &[]).is_some_and(|rc| has_switch(&rc)) {
        assert!(Instant::now() < deadline, "no frame of the script at the firmware");
        std::thread::sleep(Duration::from_millis(20));
    }
    script.end();
}

#[test]
fn a_firmware_that_crashes_is_started_again() {
    let mut served = Served::stand_in(free_ports(), Trouble::Crashes);
    for _ in 0..2 {
        served.notice(" answers: Betaflight ");
        served.notice("ended by signal 6: it is restarted");
    }
}

#[test]
fn a_firmware_that_hangs_is_reported() {
    let mut served = Served::stand_in(free_ports(), Trouble::Hangs);
    served.notice(" answers: Betaflight ");
    // On a busy machine it can have been late before, and the notice is not repeated while no motors come.
    let hangs = "has sent no motors for a second";
    if !served.program.seen().iter().any(|line| line.contains(hangs)) {
        served.notice(hangs);
    }
}

#[test]
fn a_firmware_may_start_slowly() {
    let mut served = Served::stand_in(free_ports(), Trouble::StartsSlowly);
    served.notice(" answers: Betaflight ");
}

#[test]
fn a_port_in_use_is_reported_and_ends_the_program() {
    let ports = free_ports();
    let _taken = std::net::UdpSocket::bind(("127.0.0.1", ports.fdm)).unwrap();
    let (code, said) = Served::stand_in(ports, Trouble::None).end();
    assert_eq!(code, 3, "{said}");
    assert!(said.contains(&format!("the firmware cannot use UDP port {}", ports.fdm)), "{said}");
}

#[test]
fn our_own_motor_port_in_use_is_reported_and_ends_the_program() {
    let ports = free_ports();
    let _taken = std::net::UdpSocket::bind(("127.0.0.1", ports.motors)).unwrap();
    let (code, said) = Served::stand_in(ports, Trouble::None).end();
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains("cannot receive the motors of the firmware") && said.contains("--udp-ports"),
        "{said}"
    );
}

#[test]
fn a_program_that_is_no_sitl_is_reported_and_ends_the_program() {
    let (code, said) = Served::stand_in(free_ports(), Trouble::IsNoSitl).end();
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("SITL executable of Betaflight"), "{said}");
}

#[test]
fn a_firmware_does_not_outlive_a_program_that_is_killed() {
    let mut served = Served::stand_in(free_ports(), Trouble::None);
    // The firmware has been configured and restarted by now. Its last process counts.
    served.notice(" answers: Betaflight ");
    let pid_of = |line: &String| -> Option<i32> {
        let event: Value = serde_json::from_str(line).ok()?;
        event["text"].as_str()?.split_once("process ")?.1.parse().ok()
    };
    let pid = served.program.seen().iter().rev().find_map(pid_of).unwrap();
    assert!(is_running(pid));
    // Kills the program instead of asking it to end.
    drop(served);
    let end = Instant::now() + PATIENCE;
    while is_running(pid) {
        assert!(Instant::now() < end, "{pid} is an orphan");
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn one_that_runs_already_is_taken_and_its_reboot_survived() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    let directory = tempfile::tempdir().unwrap();
    let lines = directory.path().join("lines.txt");
    std::fs::write(&lines, "set ap_max_angle = 33\n").unwrap();
    let settings = lines.to_str().unwrap();
    let firmware = ["--fresh", "--firmware", "attach", "--yes", "--settings", settings];
    let mut served = Served::start(stand_in.ports, &firmware);
    served.notice("ended or is restarting");
    served.notice("accepted 1 lines of settings, and they read back as written");
    served.notice(" answers: Betaflight ");
    let seen = stand_in.seen();
    assert_eq!(seen.before_boot, 0, "no state disturbed its boot: {seen:?}");
    assert_eq!(stand_in.stop(), [End::Reboot, End::Stopped]);
}

#[test]
fn a_hanging_program_that_runs_already_is_reported() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    let mut served = Served::start(stand_in.ports, &["--fresh", "--firmware", "attach"]);
    served.notice(" answers: Betaflight ");
    stand_in.hang(true);
    served.notice("has sent no motors for a second");
    stand_in.hang(false);
    served.notice("sends motors again");
}

#[test]
fn one_that_is_at_a_breakpoint_is_waited_for() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    // The system accepts the connection for the stand-in meanwhile.
    stand_in.hang(true);
    let mut served = Served::start(stand_in.ports, &["--fresh", "--firmware", "attach"]);
    std::thread::sleep(Duration::from_secs(5));
    stand_in.hang(false);
    served.notice(" answers: Betaflight ");
}

#[test]
fn one_that_never_goes_on_ends_the_program() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    stand_in.hang(true);
    let (code, said) = Served::start(stand_in.ports, &["--fresh", "--firmware", "attach"]).end();
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("has not answered for 10 s: is it a SITL executable of Betaflight"), "{said}");
}

#[test]
fn one_that_serves_another_client_says_why_it_is_lost_and_says_it_once() {
    let Ports { raw, motors, .. } = free_ports();
    let stand_in = StandIn::start(raw, motors);
    let other = std::net::TcpStream::connect(("127.0.0.1", stand_in.ports.tcp)).unwrap();
    std::thread::sleep(Duration::from_millis(100));
    let mut served = Served::start(stand_in.ports, &["--fresh", "--firmware", "attach"]);
    let reported = served.notice("closed the connection at once");
    assert!(reported.contains("close the other program"), "{reported}");
    // Time for several more attempts.
    std::thread::sleep(Duration::from_secs(7));
    let said = served.program.seen();
    let lost =
        |line: &&String| line.contains("closed the connection") || line.contains("ended or is restarting");
    assert_eq!(said.iter().filter(lost).count(), 1, "{said:#?}");
    drop(other);
    served.notice(" answers: Betaflight ");
}

#[test]
fn a_firmware_that_prints_without_end_does_not_stop_the_program() {
    let ports = free_ports();
    let (code, said) = Served::start(ports, &["--fresh", "--clock=real", "--firmware", "/usr/bin/yes"]).end();
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("has not answered for 10 s") && said.contains("were not shown"), "{said}");
    let lines = said.lines().filter(|line| line.contains("[firmware] y") || line.contains("\"y\"")).count();
    assert!((1..10_000).contains(&lines), "{lines} of them");
}

/// Starts a firmware with the stored configuration `kept`, and returns the program's output and the configuration
/// stored afterwards. `set_by` is the mark that the program leaves when it has configured a firmware.
fn started_with(kept: &str, set_by: Option<&str>) -> (String, String) {
    let state = tempfile::tempdir().unwrap();
    let directory = state.path().join("firmware");
    std::fs::create_dir(&directory).unwrap();
    std::fs::write(directory.join("eeprom.bin"), kept).unwrap();
    if let Some(set_by) = set_by {
        std::fs::write(directory.join("provisioned"), set_by).unwrap();
    }
    let kept = ["--state-dir", state.path().to_str().unwrap()];
    let mut served = Served::stand_in_kept(free_ports(), Trouble::None, &kept);
    served.notice(" answers: Betaflight ");
    assert!(directory.join("provisioned").exists());
    let said = served.program.seen().join("\n");
    (said, std::fs::read_to_string(directory.join("eeprom.bin")).unwrap())
}

#[test]
fn a_firmware_that_was_ended_before_it_was_set_is_set_at_its_next_start() {
    // The configuration as the first boot writes it. The mark is missing, or another build left it, which does not
    // count.
    for set_by in [None, Some("/elsewhere/betaflight_SITL.elf\n1\n")] {
        let (said, kept) = started_with("# Betaflight / SITL\nwaypoint clear\n", set_by);
        assert!(said.contains("The firmware's configuration was never changed"), "{said}");
        assert!(kept.contains("aux 0 0 0 1700 2100") && kept.contains("set trust_mag = ON"), "{kept}");
    }
}

#[test]
fn a_configuration_of_the_users_own_is_left_alone() {
    for own in ["set ap_max_angle = 33\n", "aux 3 0 4 1700 2100 0 0\n"] {
        let (said, kept) = started_with(own, None);
        assert!(!said.contains("was never changed") && !said.contains("The firmware accepted"), "{said}");
        assert_eq!(kept, own);
    }
}

#[test]
fn a_tenth_of_the_packets_may_be_lost() {
    let Ports { raw, motors, .. } = free_ports();
    let lossy = LossyLink::new(motors);
    let stand_in = StandIn::start(raw, lossy.motors_port());
    lossy.leads_to(stand_in.ports.fdm);
    let ports = Ports { fdm: lossy.fdm_port(), motors, ..stand_in.ports };
    let mut served = Served::start(ports, &["--fresh", "--firmware", "attach"]);
    served.notice(" answers: Betaflight ");
    while lossy.lost() < 500 {
        std::thread::sleep(Duration::from_millis(20));
    }
    let seen = stand_in.seen();
    assert_eq!((seen.other_stamps, seen.moved_before_answer), (0, 0), "{seen:?}");
    assert!(stand_in.clock_error_us().abs() < 50_000.0);
    let said = served.program.seen();
    assert!(said.iter().all(|line| !line.contains("no motors")), "{said:#?}");
}
