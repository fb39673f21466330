//! Tasks that people do with the App: connect, look around, save a plan, reboot, reconnect. Also many clients
//! in flight.

use std::thread;
use std::time::{Duration, Instant};

use super::app::App;
use super::msp;
use super::program::Serve;
use super::scripts::{FOR_EVER, PATIENT_FAILSAFE, SWITCHES};
use super::transmitter::Script;

const PLAN: [&str; 4] = [
    "waypoint insert 0 40.4640000 -79.5175000 5000 0 FLYOVER 0 ORBIT",
    "waypoint insert 1 40.4630000 -79.5175000 5000 0 FLYBY 0 ORBIT",
    "waypoint insert 2 40.4630000 -79.5190000 5000 0 HOLD 300 ORBIT",
    "waypoint insert 3 40.4640000 -79.5190000 5000 0 LAND 0 ORBIT",
];

/// The number of clients that poll at the same time. Each sends `REQUESTS` requests, one every `PERIOD`.
const CLIENTS: usize = 8;
const REQUESTS: u32 = 150;
const PERIOD: Duration = Duration::from_millis(20);

#[test]
fn the_app_connects_saves_a_plan_and_comes_back() {
    let mut serve = Serve::start("4");
    serve.event("gps_fix");
    let mut app = App::connect(serve.websocket);
    assert!((0..4).all(|_| app.poll()), "a GPS is reported in every round");
    app.plan();
    assert_eq!(app.line("waypoint clear"), ["Waypoints cleared"]);
    for line in PLAN {
        assert!(app.line(line)[0].starts_with("waypoint insert "));
    }
    assert!(app.line("save").concat().contains("saving"));
    assert_eq!(app.plan(), PLAN, "the link is kept");
    app.poll();

    // The button of a tab saves and then reboots.
    assert_eq!(app.ask(250, &[]), Some(Vec::new()));
    assert_eq!(app.ask(68, &[]), Some(vec![0]));
    app.wait_for_close();
    let mut again = App::connect(serve.websocket);
    again.poll();
    assert_eq!(again.plan(), PLAN);
    assert_eq!(again.ask(99, &[0, 0]), Some(Vec::new()));
    again.close();
}

#[test]
fn the_app_and_eight_clients_get_every_answer_in_flight() {
    let mut serve = Serve::start("1");
    let mut app = App::connect(serve.websocket);
    for line in [SWITCHES, PATIENT_FAILSAFE, FOR_EVER].iter().flat_map(|text| text.lines()) {
        app.line(line.trim());
    }
    assert!(app.line("save").concat().contains("saving"));
    assert_eq!(app.ask(68, &[]), Some(vec![0]));
    app.wait_for_close();
    let mut app = App::connect(serve.websocket);
    msp::wait_until_ready(serve.tcp);
    let script = Script::udp(serve.rc);
    serve.wait("start of the mission", |event| event["event"] == "state" && event["to"] == "APPROACHING");

    let door = serve.websocket;
    let poll = |client: usize| {
        let mut app = App::open(door);
        let start = Instant::now();
        let ask = |k: u32| {
            thread::sleep((start + PERIOD * k).saturating_duration_since(Instant::now()));
            let asked = Instant::now();
            let (code, size) = [(108, 6), (105, 32), (150, 27)][(client + k as usize) % 3];
            let answer = app.expect(code);
            assert_eq!(answer.len(), size, "{code}");
            assert!(code != 150 || answer[6] & 1 != 0, "armed");
            asked.elapsed()
        };
        (0..REQUESTS).map(ask).collect::<Vec<Duration>>()
    };
    let mut delays: Vec<Duration> = thread::scope(|scope| {
        let clients: Vec<_> = (0..CLIENTS).map(|client| scope.spawn(move || poll(client))).collect();
        while !clients.iter().all(thread::ScopedJoinHandle::is_finished) {
            assert!(app.poll(), "a GPS is reported");
        }
        clients.into_iter().flat_map(|client| client.join().unwrap()).collect()
    });
    assert_eq!(delays.len(), CLIENTS * REQUESTS as usize, "one answer a question");
    delays.sort_unstable();
    let (middle, late) = (delays[delays.len() / 2], delays[delays.len() * 99 / 100]);
    println!("{} answers: median {middle:?}, 99 of 100 within {late:?}", delays.len());

    // No command line opens in flight, neither framed nor for people, and nothing ends the flight.
    app.send(b"\x02waypoint clear\n\x03#".to_vec());
    assert_eq!(app.ask(250, &[]), None, "nothing is saved in flight");
    assert_eq!(app.ask(68, &[]), None, "no reboot in flight");
    assert_eq!(app.ask(208, &[]), Some(vec![0]), "no return to defaults in flight");
    app.send(b"#".to_vec());
    app.send(b"\x04".to_vec());
    assert!(app.expect(150)[6] & 1 != 0, "still armed");
    app.close();
    for event in ["disarmed", "crash"] {
        assert!(!serve.has_seen(event), "{event}");
    }
    script.end();
}
