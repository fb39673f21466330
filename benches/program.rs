//! The built program in a pseudo-terminal: the time to its first frame, the response time to a key and its share of a
//! core. Also the time from an edit to the flown estimate, and that to the list of a large library.
//!
//! `cargo bench --bench program`. Goals: first frame within 50 ms of process start, key to frame below 25 ms, below 6 %
//! of a core at real time, the estimate of the guide's square within 0.3 s of the last edit, 1000 recordings listed
//! within 0.5 s.

#![allow(
    dead_code,
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench looks at the clock and prints; it shares its terminal with the tests"
)]

#[path = "../tests/screen/ui/fixture.rs"]
mod fixture;
#[path = "../tests/program/binary/lines.rs"]
mod lines;
#[path = "../tests/program/binary/pty.rs"]
mod pty;
#[path = "../tests/program/binary/support.rs"]
mod support;

use std::time::{Duration, Instant};

use betadeck::flight::FlightSetup;
use betadeck::lookahead::{ForecastJob, ForecastReply, Forecaster};
use betadeck::session::{Command, Handle, ReplyTo, SessionConfig, start};
use betadeck::storage::Store;
use betadeck::ui::{AppState, Effect, Msg, update};
use crossterm::event::{KeyCode, KeyEvent, KeyModifiers};
use pty::Terminal;
use support::Sandbox;
use tokio::sync::mpsc;

const RUNS: usize = 30;
/// The recordings of a large library. Each hundredth was cut short.
const RECORDINGS: usize = 1000;
const PROGRAM: [&str; 2] = ["--no-ports", "--fresh"];
/// The time for which the use of the core is measured.
const WATCHED: Duration = Duration::from_secs(10);
/// The time after the engagement in which the forecasts of the flight are flown.
const FORECASTS: Duration = Duration::from_secs(5);
/// Ticks of the kernel's accounting per second.
const ACCOUNTED_HZ: f64 = 100.0;

fn main() {
    for (columns, rows) in [(80, 24), (200, 60)] {
        println!("at {columns}x{rows}");
        tell("  first frame after process start", (0..RUNS).map(|_| first_frame(columns, rows)).collect());
        let mut terminal = Terminal::betadeck(columns, rows, &PROGRAM);
        terminal.until_shown("1 Map");
        tell("  key to frame", (0..RUNS).map(|_| key_to_frame(&mut terminal)).collect());
        println!("  standing at 1x: {:.1} % of a core", core_share(&mut terminal) * 100.0);
        terminal.send("F");
        terminal.until_shown("APPROACHING");
        // The forecasts of the start are flown once.
        let began = Instant::now();
        terminal.watch("a while", |_| began.elapsed() >= FORECASTS);
        println!("  flying at 1x:   {:.1} % of a core", core_share(&mut terminal) * 100.0);
    }
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    tell("edit of the square to its flown estimate", runtime.block_on(estimates()));
    list_library();
}

fn tell(what: &str, mut times: Vec<Duration>) {
    times.sort();
    let ms = |at: usize| times[at.min(times.len() - 1)].as_secs_f64() * 1e3;
    println!(
        "{what}: median {:.1} ms, worst of {} {:.1} ms",
        ms(times.len() / 2),
        times.len(),
        ms(times.len())
    );
}

/// Returns the time from the start of the process to the last cell of the first frame.
fn first_frame(columns: u16, rows: u16) -> Duration {
    let started = Instant::now();
    let mut terminal = Terminal::betadeck(columns, rows, &PROGRAM);
    terminal.until("the hint bar", |terminal| terminal.row(usize::from(rows) - 1).contains("? help"));
    started.elapsed()
}

/// Returns the time from a key written to the terminal to the help that it opens.
fn key_to_frame(terminal: &mut Terminal) -> Duration {
    let is_open = |terminal: &Terminal| terminal.screen().contains("Keys");
    let asked = Instant::now();
    terminal.send("?");
    terminal.until("help", is_open);
    let took = asked.elapsed();
    terminal.send("?");
    terminal.until("no help", |terminal| !is_open(terminal));
    took
}

/// Returns the share of one core that the program takes while its terminal is read.
fn core_share(terminal: &mut Terminal) -> f64 {
    let (began, before) = (Instant::now(), core_seconds(terminal.id()));
    terminal.watch("the end", |_| began.elapsed() >= WATCHED);
    (core_seconds(terminal.id()) - before) / began.elapsed().as_secs_f64()
}

/// Returns the time that a process has used on all cores, s.
fn core_seconds(process: u32) -> f64 {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).unwrap();
    let (_, fields) = stat.rsplit_once(") ").unwrap();
    let ticks = fields.split(' ').skip(11).take(2).map(|field| field.parse::<f64>().unwrap());
    ticks.sum::<f64>() / ACCOUNTED_HZ
}

/// Lists a large library by the command, and on the screen from the key to the list.
fn list_library() {
    let home = Sandbox::new();
    home.run(&["fly", "square", "--record", "whole.flight"]).exits(0);
    let whole = std::fs::read(home.path("whole.flight")).unwrap();
    let folder = home.path("library/flights");
    std::fs::create_dir_all(&folder).unwrap();
    for number in 0..RECORDINGS {
        let length = if number % 100 == 0 { whole.len() * 9 / 10 } else { whole.len() };
        let name = format!("2026-05-09T07-29-33-square-{number}.flight");
        std::fs::write(folder.join(name), &whole[..length]).unwrap();
    }
    let listed = |_| {
        let asked = Instant::now();
        home.run(&["flights", "--state-dir", "library"]).exits(0);
        asked.elapsed()
    };
    tell("a library of 1000 flights, as text", (0..RUNS / 3).map(listed).collect());
    let arguments = ["--no-ports", "--state-dir", "library"];
    let mut terminal = Terminal::start_in(home, 120, 40, support::PROGRAM, &arguments);
    terminal.until_shown("1 Map");
    let asked = Instant::now();
    terminal.send("\x06");
    terminal.until_shown("Recorded flights — 1000");
    tell("  on the screen for the first time", vec![asked.elapsed()]);
}

/// Edits the guide's square in a session at real time. Returns the times from the key to the estimate in the user
/// interface.
async fn estimates() -> Vec<Duration> {
    let mut session = session();
    let (answers, mut answered) = mpsc::unbounded_channel();
    let forecaster = Forecaster::start(move |reply| drop(answers.send(reply))).unwrap();
    let mut state = fixture::state((120, 40), fixture::colour());
    session.view.wait_for(|view| view.vehicle.craft.gps_fix == Some(true)).await.unwrap();
    let view = session.view.borrow().clone();
    // The plan that is open at the start is estimated at once.
    let first = update(&mut state, Msg::View(view));
    fly(first, &mut state, &session, &forecaster, &mut answered).await;
    press(&mut state, '2');
    let mut times = Vec::new();
    for run in 0..RUNS {
        let asked = Instant::now();
        // Inserts a waypoint, then removes it again.
        let effects = press(&mut state, if run % 2 == 0 { 'i' } else { 'u' });
        fly(effects, &mut state, &session, &forecaster, &mut answered).await;
        times.push(asked.elapsed());
        assert!(!state.shared.forecast.is_estimating() && state.shared.forecast.estimate().is_some());
    }
    times
}

fn press(state: &mut AppState, key: char) -> Vec<Effect> {
    update(state, Msg::Key(KeyEvent::new(KeyCode::Char(key), KeyModifiers::NONE)))
}

/// Flies the requested estimate, as the user interface's loop does.
async fn fly(
    effects: Vec<Effect>,
    state: &mut AppState,
    session: &Handle,
    forecaster: &Forecaster,
    answered: &mut mpsc::UnboundedReceiver<ForecastReply>,
) {
    let job = effects.into_iter().find_map(estimate).expect("an estimate is asked for");
    let (reply, copy) = ReplyTo::channel();
    session.commands.send(Command::CopyVehicle { continues: false, reply }).await.unwrap();
    forecaster.order(job, copy.await.unwrap().unwrap());
    let reply = answered.recv().await.unwrap();
    update(state, Msg::Forecast(reply));
}

fn estimate(effect: Effect) -> Option<ForecastJob> {
    if let Effect::Forecast(job) = effect { Some(job) } else { None }
}

fn session() -> Handle {
    let (vehicle, _) = FlightSetup::default().build().expect("the default world is sound");
    start(SessionConfig {
        vehicle,
        store: Store::in_memory(),
        starter_modes: true,
        speed: 1.0,
        takeoff_m: 10.0,
        is_recorded: true,
        endpoints: None,
        remote: None,
        first_events: Vec::new(),
    })
    .unwrap()
}
