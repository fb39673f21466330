//! Draws the pictures of the documentation: flies the demo plan and writes the screen at that moment as SVG, or rewound
//! to an earlier one.
//!
//! ```sh
//! cargo run --release --example picture > docs/screen.svg
//! cargo run --release --example picture -- rewound > docs/rewound.svg
//! ```

#![allow(clippy::print_stdout, reason = "the picture is the output")]

use std::error::Error;
use std::sync::Arc;

use betadeck::firmware::cli::{self, Interpreter};
use betadeck::flight::FlightSetup;
use betadeck::plan::builtin::{BuiltinPlan, DEMO};
use betadeck::plan::edit::History;
use betadeck::plan::upload_lines;
use betadeck::record::sentence;
use betadeck::session::SessionView;
use betadeck::signals::SimTime;
use betadeck::sim::WorldConfig;
use betadeck::timeline::{Marks, Timeline, TimelineView};
use betadeck::ui::editor::PlanId;
use betadeck::ui::keymap::Keymap;
use betadeck::ui::{AppState, CliHelp, Msg, OpenPlan, Theme, UiConfig, Units, draw, update};
use betadeck::vehicle::Vehicle;
use ratatui::Terminal;
use ratatui::backend::TestBackend;

mod svg;

/// Size of the terminal.
const SIZE: (u16, u16) = (120, 40);
/// Simulated seconds after boot: on the ring around the third waypoint.
const MOMENT_S: f64 = 80.0;
/// Where the rewound picture goes back to, simulated seconds: on the leg before.
const REWOUND_TO_S: f64 = 41.0;
/// Ticks between two pictures that the track is made of.
const TICKS_A_VIEW: u32 = 50;

fn main() -> Result<(), Box<dyn Error>> {
    let rewound = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("rewound") => true,
        Some(other) => return Err(format!("no picture {other}").into()),
    };
    let file = BuiltinPlan::find(DEMO)
        .ok_or("no demo plan")?
        .read()
        .map_err(|errors| betadeck::plan::format::report(&errors))?;
    let world = WorldConfig { wind: "3@230".parse()?, ..WorldConfig::default() };
    let (mut vehicle, _) = FlightSetup { world, ..FlightSetup::default() }.build()?;
    let mut console = Interpreter::default();
    for line in upload_lines(&file.plan, &file.settings) {
        vehicle.embedded_mut().ok_or("no embedded firmware")?.run_cli(&mut console, &line);
    }
    vehicle.start_pilot(10.0).map_err(|mode| format!("no switch for {mode}"))?;

    let config = UiConfig {
        theme: Theme::default(),
        units: Units::default(),
        keymap: Keymap::default(),
        cli: CliHelp { complete: |line| cli::complete(line).lines(line), ..CliHelp::default() },
        sentence: |event| sentence::text(&event.kind).unwrap_or_default(),
        plan: OpenPlan::new(PlanId(1), None, History::new(file.into(), true)),
        mouse: true,
    };
    let mut state = AppState::new(config, SIZE, view(&vehicle));
    let mut timeline = Timeline::new(&mut vehicle).ok_or("a flight that cannot be recorded")?;
    let mut marks = Marks::default();
    while vehicle.time().as_secs_f64() < MOMENT_S {
        for _ in 0..TICKS_A_VIEW {
            timeline.record(&mut vehicle);
            vehicle.tick();
        }
        let mut heard = Vec::new();
        vehicle.drain_events(|event| heard.push(event));
        for event in heard {
            marks.note(&event);
            update(&mut state, Msg::Event(event.into()));
        }
        update(&mut state, Msg::View(view(&vehicle)));
    }
    if rewound {
        let head = vehicle.time();
        timeline.show(SimTime::from_secs_f64(REWOUND_TO_S), head);
        let shown = timeline.shown().ok_or("nothing earlier")?;
        let recording = TimelineView { head, rewound, marks: marks.all(), ..TimelineView::default() };
        let view = SessionView { paused: true, timeline: Some(recording), ..view(shown) };
        update(&mut state, Msg::View(view));
    }
    let mut terminal = Terminal::new(TestBackend::new(SIZE.0, SIZE.1))?;
    terminal.draw(|frame| draw(&state, frame))?;
    println!("{}", svg::svg(terminal.backend().buffer()));
    Ok(())
}

fn view(vehicle: &Vehicle) -> SessionView {
    SessionView {
        vehicle: Arc::new(vehicle.snapshot()),
        speed_wanted: 1.0,
        speed_achieved: 1.0,
        sticks: vehicle.transmitter().sticks(),
        pilot: vehicle.transmitter().pilot_doing(),
        ..SessionView::default()
    }
}
