//! `betadeck serve` with the stand-in in simulated time: its doors lead to the stand-in.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{TcpStream, UdpSocket};
use std::time::Duration;

use serde_json::Value;

use super::serial_port::answer_at_prompt;
use super::stand_in::{ARGUMENT, OWN_THREADS_FILE, PORTS_FILE};
use crate::doors::msp;
use crate::doors::program::Program;
use test_support::free_port;

/// `MSP_RC` and a message that no part of the stand-in knows.
const RC: u8 = 105;
const UNKNOWN: u8 = 199;
/// The sticks at rest in the order of `MSP_RC`, µs.
const AT_REST: [u16; 5] = [1500, 1500, 1500, 1000, 1000];

struct Served {
    program: Program,
    tcp: TcpStream,
    rc: u16,
    _state: tempfile::TempDir,
}

impl Served {
    fn start() -> Self {
        Self::start_with(&[])
    }

    /// Starts a stand-in that finds these files in its folder.
    fn start_with(files: &[&str]) -> Self {
        let state = tempfile::tempdir().unwrap();
        let [raw, motors, fdm, rc, tcp] = std::array::from_fn(|_| free_port());
        let folder = state.path().join("firmware");
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join(PORTS_FILE), format!("{fdm},{rc},{motors},{tcp}")).unwrap();
        files.iter().for_each(|file| std::fs::write(folder.join(file), "").unwrap());
        let executable = std::env::current_exe().unwrap();
        let mut program = Program::start(&[
            "serve",
            "--json",
            "-",
            "--ws-port",
            "0",
            "--tcp-port",
            &tcp.to_string(),
            "--udp-ports",
            &format!("{raw},{motors},{fdm},{rc}"),
            "--state-dir",
            state.path().to_str().unwrap(),
            "--firmware",
            executable.to_str().unwrap(),
            "--firmware-arg",
            ARGUMENT,
        ]);
        notice(&mut program, " answers: Betaflight ");
        let tcp = TcpStream::connect(("127.0.0.1", tcp)).unwrap();
        Self { program, tcp, rc, _state: state }
    }

    /// Returns roll, pitch, yaw, throttle and AUX1 as the stand-in received them, µs.
    fn channels(&mut self) -> [u16; 5] {
        let payload = msp::ask(&mut self.tcp, RC, &[]).unwrap();
        assert_eq!(payload.len(), 32);
        std::array::from_fn(|at| u16::from_le_bytes([payload[2 * at], payload[2 * at + 1]]))
    }

    /// Reads until the text ends in this.
    fn read_until(&mut self, end: &str) -> String {
        let (mut text, mut byte) = (String::new(), [0]);
        while !text.ends_with(end) {
            match self.tcp.read(&mut byte) {
                Ok(0) => panic!("closed after {text:?}"),
                Ok(_) => text.push(char::from(byte[0])),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => panic!("{error} after {text:?}"),
            }
        }
        text
    }
}

/// Waits for a notice that contains these words, and returns its text.
fn notice(program: &mut Program, words: &str) -> String {
    program.wait(words, |line| {
        let event: Value = serde_json::from_str(line).ok()?;
        let text = event["text"].as_str()?;
        assert!(!text.contains("wall clock"), "{text}");
        text.contains(words).then(|| text.to_owned())
    })
}

#[test]
fn a_script_flies_the_child_and_hears_why_it_does_not_arm() {
    let mut served = Served::start();
    assert_eq!(served.channels(), AT_REST, "without a script the sticks rest");
    let script = UdpSocket::bind("127.0.0.1:0").unwrap();
    let mut channels = [1500_u16; 16];
    (channels[0], channels[2], channels[4]) = (1600, 1200, 2000);
    let packet = [&0_f64.to_le_bytes()[..], &channels.map(u16::to_le_bytes).concat()].concat();
    let rc = served.rc;
    let (stop, stopped) = std::sync::mpsc::channel::<()>();
    let sender = std::thread::spawn(move || {
        while stopped
            .recv_timeout(Duration::from_millis(20))
            .is_err_and(|end| end == std::sync::mpsc::RecvTimeoutError::Timeout)
        {
            script.send_to(&packet, ("127.0.0.1", rc)).unwrap();
        }
    });
    notice(&mut served.program, "RC now comes from another program");
    let why = notice(&mut served.program, "arming is blocked");
    assert!(why.contains("THROTTLE (lower the throttle)"), "{why}");
    assert_eq!(served.channels(), [1600, 1500, 1500, 1200, 2000]);
    drop(stop);
    sender.join().unwrap();
}

#[test]
fn a_client_of_the_doors_is_answered_by_the_child() {
    let mut served = Served::start();
    assert_eq!(msp::ask(&mut served.tcp, 2, &[]).unwrap(), b"BTFL");
    assert_eq!(msp::ask(&mut served.tcp, UNKNOWN, &[]), None, "its error");
    std::thread::sleep(Duration::from_millis(150));
    served.tcp.write_all(b"#").unwrap();
    served.read_until("\r\n# ");
    served.tcp.write_all(b"nonsense\r").unwrap();
    let answer = served.read_until("\r\n# ");
    assert_eq!(answer, format!("nonsense\r\n{}\r\n# ", answer_at_prompt("nonsense")));
    served.tcp.write_all(b"exit noreboot\r").unwrap();
    served.read_until("no reboot\r\n");
    assert_eq!(msp::ask(&mut served.tcp, 2, &[]).unwrap(), b"BTFL", "MSP goes on");
}

#[test]
fn an_executable_whose_threads_must_run_on_their_own_flies_in_simulated_time_as_well() {
    let mut served = Served::start_with(&[OWN_THREADS_FILE]);
    assert_eq!(served.channels(), AT_REST);
}
