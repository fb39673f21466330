//! A program that was stopped reports how much time that cost.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::Command;
use std::time::{Duration, Instant};

use super::program::{PATIENCE, Serve};

fn signal(name: &str, process: u32) {
    assert!(Command::new("kill").args([name, &process.to_string()]).status().unwrap().success());
}

/// Returns the answer of the command line to `status`.
fn status(serve: &Serve) -> String {
    let mut client = TcpStream::connect(serve.tcp).unwrap();
    client.set_read_timeout(Some(PATIENCE)).unwrap();
    client.write_all(b"\x02status\n\x03").unwrap();
    let mut answer = Vec::new();
    while !answer.ends_with(b"\x03") {
        let mut chunk = [0; 4096];
        let count = client.read(&mut chunk).unwrap();
        assert!(count > 0, "{}", answer.escape_ascii());
        answer.extend_from_slice(&chunk[..count]);
    }
    String::from_utf8(answer).unwrap()
}

#[test]
fn a_stopped_program_reports_the_time_that_it_lost() {
    let start = Instant::now();
    let mut serve = Serve::start("1");
    // The clock runs now. Time before its start would not be lost.
    serve.wait("fix", |event| event["event"] == "gps_fix");
    signal("-STOP", serve.id());
    std::thread::sleep(Duration::from_secs(2));
    signal("-CONT", serve.id());
    serve.wait("notice of lost time", |event| {
        event["text"]
            .as_str()
            .is_some_and(|text| text.starts_with("Real time was lost: ") && text.contains(" ran at 0."))
    });
    assert!(status(&serve).contains("\r\nReal time lost: "), "{}", status(&serve));
    // A busy machine loses more time, and needs more than a minute for this test.
    let notices = serve.notices("Real time was lost");
    let minutes = start.elapsed().as_secs() as usize / 60;
    assert!((1..=1 + minutes).contains(&notices), "{notices} in {minutes} min, once a minute at most");
}
