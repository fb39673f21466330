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
//! The user can move the borders and swap panels: `model::layout`.
//!
//! World and Settings take the place of RC when they are shown, Graphs the place of the log.
//!
//! While the form of the generator is open, the map fills the screen beside it and shows the result.
//!
//! Two status lines are at the top, one hint line at the bottom. The timeline is above the hints, on a tall screen or
//! while an earlier instant is shown.

use ratatui::layout::Rect;

use crate::ui::model::layout::{Arrangement, Slots, Split};
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;

/// The smallest screen that shows anything useful.
pub const SMALLEST: (u16, u16) = (60, 20);

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Screen {
    pub status: Rect,
    /// The visible panels with their frames.
    pub panels: Vec<(Panel, Rect)>,
    /// The borders between the panels, which the user can move.
    pub borders: Vec<Border>,
    /// The line of the timeline, if it is shown.
    pub timeline: Option<Rect>,
    /// The line of the sweep, if one is shown.
    pub sweep: Option<Rect>,
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

/// A border between panels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Border {
    pub(in crate::ui) split: Split,
    /// The cells of the two frames at the border.
    pub(in crate::ui) cells: Rect,
    /// The column or the row after the part whose size the border sets.
    pub(in crate::ui) end: u16,
    /// The columns or the rows of the whole.
    pub(in crate::ui) whole: u16,
    /// `true` for a border between a left and a right part.
    pub(in crate::ui) is_upright: bool,
}

impl Border {
    /// Returns the columns or rows of the part whose size the border sets.
    pub(in crate::ui) fn size(&self) -> u16 {
        let start = if self.is_upright { self.cells.x } else { self.cells.y };
        self.end.saturating_sub(start + 1)
    }
}

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
    let has_sweep = state.survey.sweep().is_some();
    let sweep = has_sweep.then(|| Rect::new(0, height - 2 - u16::from(has_timeline), width, 1));
    let body = Rect::new(0, 2, width, height - 3 - u16::from(has_timeline) - u16::from(has_sweep));
    let form = state.editor.is_generating().then(|| {
        let form = FORM_COLUMNS.min(width - MAP_COLUMNS);
        columns(body, [width - form, form])
    });
    let sizes = &state.arrangement;
    let mut places = if let Some([map, _]) = form {
        Places::of([(Panel::Map, map)])
    } else if state.zoomed || width < 80 || height < 24 {
        Places::of([(state.focus, body)])
    } else if width >= 180 && height >= 48 {
        large(body, state.slots, sizes)
    } else if width >= 120 && height >= 34 {
        medium(body, state.slots, sizes)
    } else {
        small(body, state.slots, sizes)
    };
    if !places.borders.is_empty() {
        for (panel, _) in &mut places.panels {
            *panel = sizes.shown_at(*panel);
        }
    }
    let Places { panels, borders } = places;
    let hints = Rect::new(0, height - 1, width, 1);
    let form = form.map(|[_, form]| form);
    Some(Screen { status: Rect::new(0, 0, width, 2), panels, borders, timeline, sweep, hints, form })
}

/// The least width and height of a panel with its frame.
const LEAST: (u16, u16) = (20, 5);

/// The panels at their usual places, and the borders between them.
#[derive(Default)]
struct Places {
    panels: Vec<(Panel, Rect)>,
    borders: Vec<Border>,
}

impl Places {
    fn of(panels: impl IntoIterator<Item = (Panel, Rect)>) -> Self {
        Self { panels: panels.into_iter().collect(), borders: Vec::new() }
    }

    /// Divides an area of `body` into a left and a right part, whose width the user can change.
    fn columns(&mut self, area: Rect, body: Rect, split: Split, width: u16) -> [Rect; 2] {
        let [left, right] = columns(area, [area.width.saturating_sub(width), width.min(area.width)]);
        let cells = Rect { x: right.x.saturating_sub(1), width: 2, ..area };
        self.borders.push(Border { split, cells, end: right.right(), whole: body.width, is_upright: true });
        [left, right]
    }

    /// Divides an area of `body` into an upper and a lower part, whose height the user can change.
    fn rows(&mut self, area: Rect, body: Rect, split: Split, height: u16) -> [Rect; 2] {
        let [top, bottom] = rows(area, [area.height.saturating_sub(height), height.min(area.height)]);
        let cells = Rect { y: bottom.y.saturating_sub(1), height: 2, ..area };
        let border = Border { split, cells, end: bottom.bottom(), whole: body.height, is_upright: false };
        self.borders.push(border);
        [top, bottom]
    }
}

fn small(body: Rect, slots: Slots, sizes: &Arrangement) -> Places {
    let side = (body.width * 29 / 100).clamp(26, 46);
    let side = sizes.size(Split::State, body.width, side, (LEAST.0, MAP_COLUMNS));
    let mut places = Places::default();
    if slots.main != Panel::Map {
        let [main, state] = places.columns(body, body, Split::State, side);
        places.panels.extend([(slots.main, main), (Panel::State, state)]);
        return places;
    }
    let log = sizes.size(Split::Bottom, body.height, (body.height / 4).max(5), (LEAST.1, LEAST.1));
    let [top, bottom] = places.rows(body, body, Split::Bottom, log);
    let [map, state] = places.columns(top, body, Split::State, side);
    places.panels.extend([(Panel::Map, map), (Panel::State, state), (Panel::Log, bottom)]);
    places
}

fn medium(body: Rect, slots: Slots, sizes: &Arrangement) -> Places {
    let mut places = Places::default();
    let bottom = (body.height * 32 / 100).clamp(10, 20);
    let bottom = sizes.size(Split::Bottom, body.height, bottom, (LEAST.1, LEAST.1));
    if slots.right == Panel::Settings {
        return medium_with_settings(body, bottom, slots, sizes);
    }
    let [top, bottom] = places.rows(body, body, Split::Bottom, bottom);
    let side = (body.width * 38 / 100).clamp(46, 60);
    let side = sizes.size(Split::State, body.width, side, (LEAST.0, MAP_COLUMNS));
    let [map, state] = places.columns(top, body, Split::State, side);
    let right = (body.width / 2).clamp(60, 76).min(body.width - 60);
    let right = sizes.size(Split::Right, body.width, right, (LEAST.0, LEAST.0));
    let [left, right] = places.columns(bottom, body, Split::Right, right);
    places.panels.extend([
        (Panel::Map, map),
        (Panel::State, state),
        (slots.left, left),
        (slots.right, right),
    ]);
    places
}

/// The settings need more rows than the other panels at the bottom right.
fn medium_with_settings(body: Rect, bottom: u16, slots: Slots, sizes: &Arrangement) -> Places {
    let mut places = Places::default();
    let side = (body.width * 46 / 100).clamp(54, 76);
    let side = sizes.size(Split::Right, body.width, side, (LEAST.0, MAP_COLUMNS));
    let [left, right] = places.columns(body, body, Split::Right, side);
    let [map, below] = places.rows(left, body, Split::Bottom, bottom);
    let list = sizes.size(Split::Settings, body.height, body.height - STATE_ROWS, (LEAST.1, LEAST.1));
    let [state, settings] = places.rows(right, body, Split::Settings, list);
    places.panels.extend([
        (Panel::Map, map),
        (Panel::State, state),
        (slots.left, below),
        (Panel::Settings, settings),
    ]);
    places
}

fn large(body: Rect, slots: Slots, sizes: &Arrangement) -> Places {
    let mut places = Places::default();
    let bottom = sizes.size(Split::Bottom, body.height, body.height * 36 / 100, (LEAST.1, LEAST.1));
    let [top, bottom] = places.rows(body, body, Split::Bottom, bottom);
    let width = |split, default, rest| sizes.size(split, body.width, default, (LEAST.0, rest));
    let side = width(Split::Side, 48, LEAST.0 + MAP_COLUMNS);
    let [top, rc] = places.columns(top, body, Split::Side, side);
    let state = width(Split::State, 48, MAP_COLUMNS + rc.width);
    let [map, state] = places.columns(top, body, Split::State, state);
    let third = body.width / 3;
    let cli = width(Split::Right, third, 2 * LEAST.0);
    let [bottom, cli] = places.columns(bottom, body, Split::Right, cli);
    let plan = width(Split::Left, third, LEAST.0 + cli.width);
    let [log, plan] = places.columns(bottom, body, Split::Left, plan);
    places.panels.extend([
        (Panel::Map, map),
        (Panel::State, state),
        // These two have places of their own.
        (if slots.right == Panel::Plan { Panel::Rc } else { slots.right }, rc),
        (if slots.left == Panel::Cli { Panel::Log } else { slots.left }, log),
        (Panel::Plan, plan),
        (Panel::Cli, cli),
    ]);
    places
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
