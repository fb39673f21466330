//! Draws the pictures of the documentation and writes them into `docs/`: the screen while the demo plan is flown, the plan
//! editor while one of its altitudes is changed, the flight rewound to an earlier leg, the question before a plan of
//! another program is opened, and a map under the plan.
//!
//! ```sh
//! cargo run --release --example picture
//! ```

use std::error::Error;
use std::path::Path;

use ratatui::Terminal;
use ratatui::backend::TestBackend;

use betadeck::ui::{AppState, draw};
use demo_flight::DemoFlight;

mod demo_flight;
mod svg;

/// The size of the terminal.
const SIZE: (u16, u16) = (120, 40);
/// The time of the picture `screen`, simulated seconds after boot: on the ring around the third waypoint.
const MOMENT_S: f64 = 110.0;
/// The time of the rewound picture, simulated seconds: on the leg before.
const REWOUND_TO_S: f64 = 75.0;

fn main() -> Result<(), Box<dyn Error>> {
    let mut editing = DemoFlight::on_the_ground(SIZE)?;
    // Edits the altitudes of the second and the third waypoint, on the whole screen.
    editing.press("2zjlll\n\u{8}\u{8}65\nj\n\u{8}\u{8}40\n")?;
    write("plan", &editing.state)?;

    let mut flight = DemoFlight::on_the_ground(SIZE)?;
    flight.fly_to(MOMENT_S)?;
    write("screen", &flight.state)?;
    flight.rewind(REWOUND_TO_S)?;
    write("rewound", &flight.state)?;

    let mut opening = DemoFlight::on_the_ground(SIZE)?;
    opening.ask_about("theirs.plan", include_str!("../../tests/exchange/square.plan"))?;
    write("losses", &opening.state)?;

    let mut mapped = DemoFlight::on_the_ground(SIZE)?;
    mapped.put_under("field.geojson", include_str!("../../tests/exchange/field.geojson"))?;
    mapped.press("1#")?;
    write("backdrop", &mapped.state)
}

/// Writes the screen as `docs/NAME.svg`.
fn write(name: &str, state: &AppState) -> Result<(), Box<dyn Error>> {
    let mut terminal = Terminal::new(TestBackend::new(SIZE.0, SIZE.1))?;
    terminal.draw(|frame| draw(state, frame))?;
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs").join(name).with_extension("svg");
    std::fs::write(file, svg::svg(terminal.backend().buffer()))?;
    Ok(())
}
