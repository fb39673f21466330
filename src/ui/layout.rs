//! The places of the panels for each screen size.
//!
//! ```text
//!  60x20 and zoomed    from 80x24           from 120x34           from 180x48
//!  ┌──────────────┐    ┌─────────┬─────┐    ┌─────────┬──────┐    ┌────────┬──────┬─────┐
//!  │ the focused  │    │ map or  │state│    │ map     │ state│    │ map    │ state│ RC  │
//!  │ panel        │    │ RC, CLI │     │    │         │      │    │        │      │     │
//!  │              │    ├─────────┴─────┤    ├─────────┼──────┤    ├──────┬─┴────┬─┴─────┤
//!  │              │    │ log           │    │log, CLI │ RC,  │    │ log  │ plan │ CLI   │
//!  └──────────────┘    └───────────────┘    └─────────┴ plan─┘    └──────┴──────┴───────┘
//! ```
//!
//! World and Settings take the place of RC when they are shown, Graphs the place of the log.
//!
//! While the form of the generator is open, the map fills the screen beside it and shows the result.
//!
//! Two status lines are at the top, one hint line at the bottom. The timeline is above the hints, on a tall screen or
//! while an earlier instant is shown.

mod slots;

use ratatui::layout::Rect;

use super::panel::Panel;
use super::shared::Shared;
pub use slots::Slots;

/// The smallest screen that shows anything useful.
pub const SMALLEST: (u16, u16) = (60, 20);

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Screen {
    pub status: Rect,
    /// The visible panels with their frames.
    pub panels: Vec<(Panel, Rect)>,
    /// The line of the timeline, if it is shown.
    pub timeline: Option<Rect>,
    pub hints: Rect,
    /// The place of the generator's form, beside the map.
    pub form: Option<Rect>,
}

/// The number of rows from which the timeline is always shown.
const TIMELINE_ROWS: u16 = 34;

/// The width of the generator's form, and the least width of the map beside it.
const FORM_COLUMNS: u16 = 42;
const MAP_COLUMNS: u16 = 24;

/// The height of the state above the settings.
const STATE_ROWS: u16 = 13;

impl Screen {
    /// Returns the area of a panel, if it is visible.
    pub fn panel(&self, panel: Panel) -> Option<Rect> {
        self.panels.iter().find(|(p, _)| *p == panel).map(|(_, area)| *area)
    }

    /// Returns the panel at a cell.
    pub fn at(&self, column: u16, row: u16) -> Option<(Panel, Rect)> {
        self.panels.iter().find(|(_, area)| area.contains((column, row).into())).copied()
    }
}

/// Returns the inside of a panel. It is empty, but within the area, if the frame fills the area.
pub fn inner(area: Rect) -> Rect {
    Rect::new(
        area.x.saturating_add(area.width.min(1)),
        area.y.saturating_add(area.height.min(1)),
        area.width.saturating_sub(2),
        area.height.saturating_sub(2),
    )
}

/// Divides the screen; `None` if it is too small.
pub fn screen(state: &Shared) -> Option<Screen> {
    divided(state, state.size)
}

/// Divides a screen of this many columns and rows; `None` if it is too small.
pub fn divided(state: &Shared, (width, height): (u16, u16)) -> Option<Screen> {
    if width < SMALLEST.0 || height < SMALLEST.1 {
        return None;
    }
    let has_timeline = state.view.timeline.is_some() && (state.is_rewound() || height >= TIMELINE_ROWS);
    let timeline = has_timeline.then(|| Rect::new(0, height - 2, width, 1));
    let body = Rect::new(0, 2, width, height - 3 - u16::from(has_timeline));
    let form = state.editor.is_generating().then(|| {
        let form = FORM_COLUMNS.min(width - MAP_COLUMNS);
        columns(body, [width - form, form])
    });
    let panels = if let Some([map, _]) = form {
        vec![(Panel::Map, map)]
    } else if state.zoomed || width < 80 || height < 24 {
        vec![(state.focus, body)]
    } else if width >= 180 && height >= 48 {
        large(body, state.slots)
    } else if width >= 120 && height >= 34 {
        medium(body, state.slots)
    } else {
        small(body, state.slots)
    };
    let hints = Rect::new(0, height - 1, width, 1);
    let form = form.map(|[_, form]| form);
    Some(Screen { status: Rect::new(0, 0, width, 2), panels, timeline, hints, form })
}

fn small(body: Rect, slots: Slots) -> Vec<(Panel, Rect)> {
    let side = (body.width * 29 / 100).clamp(26, 46);
    if slots.main != Panel::Map {
        let [main, state] = columns(body, [body.width - side, side]);
        return vec![(slots.main, main), (Panel::State, state)];
    }
    let log = (body.height / 4).max(5);
    let [top, bottom] = rows(body, [body.height - log, log]);
    let [map, state] = columns(top, [top.width - side, side]);
    vec![(Panel::Map, map), (Panel::State, state), (Panel::Log, bottom)]
}

fn medium(body: Rect, slots: Slots) -> Vec<(Panel, Rect)> {
    let bottom = (body.height * 32 / 100).clamp(10, 20);
    if slots.right == Panel::Settings {
        return medium_with_settings(body, bottom, slots);
    }
    let [top, bottom] = rows(body, [body.height - bottom, bottom]);
    let side = (body.width * 38 / 100).clamp(46, 60);
    let [map, state] = columns(top, [top.width - side, side]);
    let right = (body.width / 2).clamp(60, 76).min(body.width - 60);
    let [left, right] = columns(bottom, [bottom.width - right, right]);
    vec![(Panel::Map, map), (Panel::State, state), (slots.left, left), (slots.right, right)]
}

/// The settings need more rows than the other panels at the bottom right.
fn medium_with_settings(body: Rect, bottom: u16, slots: Slots) -> Vec<(Panel, Rect)> {
    let side = (body.width * 46 / 100).clamp(54, 76);
    let [left, right] = columns(body, [body.width - side, side]);
    let [map, below] = rows(left, [body.height - bottom, bottom]);
    let [state, settings] = rows(right, [STATE_ROWS, body.height - STATE_ROWS]);
    vec![(Panel::Map, map), (Panel::State, state), (slots.left, below), (Panel::Settings, settings)]
}

fn large(body: Rect, slots: Slots) -> Vec<(Panel, Rect)> {
    let bottom = body.height * 36 / 100;
    let [top, bottom] = rows(body, [body.height - bottom, bottom]);
    let [map, state, rc] = columns(top, [top.width - 96, 48, 48]);
    let third = body.width / 3;
    let [log, plan, cli] = columns(bottom, [body.width - 2 * third, third, third]);
    vec![
        (Panel::Map, map),
        (Panel::State, state),
        // These two have places of their own.
        (if slots.right == Panel::Plan { Panel::Rc } else { slots.right }, rc),
        (if slots.left == Panel::Cli { Panel::Log } else { slots.left }, log),
        (Panel::Plan, plan),
        (Panel::Cli, cli),
    ]
}

fn columns<const N: usize>(area: Rect, widths: [u16; N]) -> [Rect; N] {
    let mut x = area.x;
    widths.map(|width| {
        let column = Rect::new(x, area.y, width, area.height);
        x += width;
        column
    })
}

fn rows<const N: usize>(area: Rect, heights: [u16; N]) -> [Rect; N] {
    let mut y = area.y;
    heights.map(|height| {
        let row = Rect::new(area.x, y, area.width, height);
        y += height;
        row
    })
}
