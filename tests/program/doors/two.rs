//! Two programs at once that need the same directory and port.

use serde_json::Value;

use super::program::Program;

#[test]
fn the_second_of_two_is_reported_what_the_first_has() {
    let directory = tempfile::tempdir().unwrap();
    let directory = directory.path().to_str().unwrap();
    let serve = |tcp_port: &str| {
        let fixed = ["serve", "--json", "-", "--ws-port", "0", "--udp-ports", "0,0,0,0"];
        Program::start(&[&fixed[..], &["--state-dir", directory, "--tcp-port", tcp_port]].concat())
    };
    let mut first = serve("0");
    let port = first.wait("port", |line| {
        let event: Value = serde_json::from_str(line).ok()?;
        event["tcp"].as_str()?.rsplit_once(':').map(|(_, port)| port.to_owned())
    });
    let mut second = serve(&port);
    second.wait("word about the directory", |line| {
        line.contains("`save` cannot work: another betadeck uses").then_some(())
    });
    second.wait("word about the port", |line| {
        line.contains(&format!("TCP port {port} is in use")).then_some(())
    });
    assert!(first.seen().iter().all(|line| !line.contains("cannot work") && !line.contains("in use")));
}
