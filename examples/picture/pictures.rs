//! The pictures of the documentation.

use std::error::Error;

use ratatui::Terminal;
use ratatui::backend::TestBackend;

use betadeck::ui::{AppState, draw};

use super::demo_flight::DemoFlight;
use super::svg;

/// The size of the terminal.
const SIZE: (u16, u16) = (120, 40);
/// The time of the picture `screen`, simulated seconds after boot: on the ring around the third waypoint.
const MOMENT_S: f64 = 110.0;
/// The time of the rewound picture, simulated seconds: on the leg before.
const REWOUND_TO_S: f64 = 75.0;

/// A picture, with its name in `docs/` without the extension.
pub(crate) struct Picture {
    pub(crate) name: &'static str,
    pub(crate) svg: String,
}

/// Draws all pictures.
///
/// # Errors
/// Returns the reason why the flight could not be flown or drawn.
pub(crate) fn pictures() -> Result<Vec<Picture>, Box<dyn Error>> {
    let mut pictures = Vec::new();
    let mut take = |name, state: &AppState| -> Result<(), Box<dyn Error>> {
        let mut terminal = Terminal::new(TestBackend::new(SIZE.0, SIZE.1))?;
        terminal.draw(|frame| draw(state, frame))?;
        pictures.push(Picture { name, svg: svg::svg(terminal.backend().buffer()) });
        Ok(())
    };
    let mut editing = DemoFlight::on_the_ground(SIZE)?;
    // Edits the altitudes of the second and the third waypoint, on the whole screen.
    editing.press("2zjlll\n\u{8}\u{8}65\nj\n\u{8}\u{8}40\n")?;
    take("plan", &editing.state)?;

    let mut flight = DemoFlight::on_the_ground(SIZE)?;
    flight.fly_to(MOMENT_S)?;
    take("screen", &flight.state)?;
    flight.rewind(REWOUND_TO_S)?;
    take("rewound", &flight.state)?;

    let mut opening = DemoFlight::on_the_ground(SIZE)?;
    opening.ask_about("theirs.plan", include_str!("../../tests/exchange/square.plan"))?;
    take("losses", &opening.state)?;

    let mut mapped = DemoFlight::on_the_ground(SIZE)?;
    mapped.put_under("field.geojson", include_str!("../../tests/exchange/field.geojson"))?;
    mapped.press("1#")?;
    take("backdrop", &mapped.state)?;
    Ok(pictures)
}
