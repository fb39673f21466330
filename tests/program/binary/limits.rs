//! Limits of the system: too few open files, a reader that stops reading, input that is not text.

use std::io::Write as _;
use std::process::{Child, Stdio};

use crate::binary::plain::Dialogue;
use crate::binary::support::{PROGRAM, Sandbox};

/// A process that is killed when its test ends.
struct Guard(Child);

impl Drop for Guard {
    fn drop(&mut self) {
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

#[test]
fn too_few_open_files_are_one_sentence_and_exit_code_3() {
    let commands = [
        "fly square",
        "check guide-1",
        "serve --no-ports",
        "sitl --no-ports",
        "--plain --fresh --no-ports",
        "compare square --firmware /bin/true",
    ];
    for command in commands {
        for limit in [6, 7, 8] {
            let sandbox = Sandbox::new();
            let script = format!("ulimit -n {limit}; exec {PROGRAM} {command}");
            let mut shell = std::process::Command::new("/bin/sh");
            shell
                .env_clear()
                .envs(sandbox.environment())
                .current_dir(sandbox.path("."))
                .args(["-c", &script]);
            let output = assert_cmd::Command::from_std(shell)
                .timeout(std::time::Duration::from_secs(600))
                .write_stdin("")
                .output()
                .expect("it runs");
            let err = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(!err.contains("panicked"), "{command} with {limit}: {err}");
            assert_eq!(output.status.code(), Some(3), "{command} with {limit}: {err}");
            assert_eq!(err.lines().count(), 1, "{command} with {limit}: {err}");
            assert!(err.contains("ulimit -n"), "{command} with {limit}: {err}");
        }
    }
}

/// Returns a pipe that accepts no more bytes.
fn full_pipe() -> (std::io::PipeReader, std::io::PipeWriter) {
    let (reader, mut writer) = std::io::pipe().expect("a pipe");
    rustix::io::ioctl_fionbio(&writer, true).expect("a pipe that does not wait");
    while writer.write(&[b' '; 512]).is_ok() {}
    while writer.write(b" ").is_ok() {}
    rustix::io::ioctl_fionbio(&writer, false).expect("a pipe that waits");
    (reader, writer)
}

#[test]
fn the_first_signal_ends_a_flight_whose_reader_stopped_reading() {
    for signal in ["INT", "TERM"] {
        for (what, arguments) in [
            ("sentences", &["fly", "square", "--gpx", "track.gpx"][..]),
            ("json", &["fly", "square", "--json", "-", "--samples", "1000", "--gpx", "track.gpx"]),
            ("check", &["check", "guide-1"]),
        ] {
            let sandbox = Sandbox::new();
            // The test reads neither pipe.
            let (_out, out) = full_pipe();
            let (_err, err) = full_pipe();
            let mut command = sandbox.command(arguments);
            let child = command.stdin(Stdio::null()).stdout(out).stderr(err).spawn().expect("it runs");
            let mut child = Guard(child);
            crate::binary::streams::handles_signals(child.0.id());
            let id = child.0.id().to_string();
            let sent = std::process::Command::new("kill").args(["-s", signal, &id]).status().expect("kill");
            assert!(sent.success());
            assert_eq!(crate::binary::streams::end_of(&mut child.0), Some(130), "{what} {signal}");
            if what != "check" {
                assert!(
                    sandbox.read("track.gpx").trim_end().ends_with("</gpx>"),
                    "{what}: the track is whole"
                );
            }
        }
    }
}

#[test]
fn a_line_that_is_no_text_is_reported_and_the_next_one_is_obeyed() {
    let sandbox = Sandbox::new();
    let mut flight = Dialogue::start(&sandbox, &["--plain", "--fresh", "--no-ports", "--speed=max"]);
    flight.say_bytes(b"wind \xff\xfe\n");
    flight.hear("line 1 of the input is not UTF-8 text");
    flight.say("wind 5@270");
    flight.hear("World: wind=5@270");
    flight.say_bytes(&[b"speed ".as_slice(), &vec![b'9'; 3 << 20], b"\n"].concat());
    flight.hear("line 3 of the input is longer than");
    flight.say("quit");
    assert_eq!(flight.end(), Some(0));
}

#[test]
fn a_last_line_without_an_end_counts() {
    let sandbox = Sandbox::new();
    let ran =
        sandbox.run_with(&["--plain", "--fresh", "--no-ports", "--speed=max"], "wind 5@270\nquit").exits(0);
    assert!(ran.out.contains("World: wind=5@270"), "{}", ran.out);
}
