//! The tutorial: five steps, each of which waits for the user's action.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr as _;

use super::drawing;
use super::formatting::cut;
use super::shared::Shared;
use super::text_wrap::wrapped;
use super::theme::Role;
use crate::ui::model::action::{Action, EditAction};
use crate::ui::model::event_log::Severity;
use crate::ui::model::panel_table::Panel;

/// A tutorial in progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Tutorial {
    step: usize,
    /// The revision of the plan at the start of the step.
    revision: usize,
    /// `true` once an earlier instant was shown.
    rewound: bool,
}

/// The instruction, with `{}` in place of the keys of the actions.
struct Text {
    text: &'static str,
    actions: &'static [Action],
}

/// A step: the instruction, the instruction after its first key, and the condition for its end.
struct Step {
    first: Text,
    is_begun: fn(&Shared) -> bool,
    then: Text,
    is_done: fn(&Shared, &Tutorial) -> bool,
}

const STEPS: [Step; 5] = [
    Step {
        first: Text {
            text: "Press {}: a pilot arms the craft, climbs and engages the autopilot on the plan of the map.",
            actions: &[Action::Fly],
        },
        is_begun: |state| state.view.pilot.is_some(),
        then: Text {
            text: "The pilot arms, climbs and engages the autopilot: wait and watch; {} would stop it.",
            actions: &[Action::Fly],
        },
        is_done: |state, _| state.view.vehicle.is_engaged(),
    },
    Step {
        first: Text {
            text: "The State panel says what ends the leg. Press {} repeatedly: time goes faster; {} is real time.",
            actions: &[Action::Faster, Action::RealTime],
        },
        is_begun: |state| state.view.speed_wanted > 1.0,
        then: Text { text: "That is 2×: press {} again, for 4×.", actions: &[Action::Faster] },
        is_done: |state, _| state.view.speed_wanted >= 4.0,
    },
    Step {
        first: Text {
            text: "Press {} for the plan, to change a value.",
            actions: &[Action::Show(Panel::Plan)],
        },
        is_begun: |state| state.focus == Panel::Plan,
        then: Text {
            text: "Arrows choose a value, {} and {} nudge it, {} types it.",
            actions: &[
                Action::Edit(EditAction::Raise),
                Action::Edit(EditAction::Lower),
                Action::Edit(EditAction::Cell),
            ],
        },
        is_done: |state, tutorial| state.editor.plan().history().at() != tutorial.revision,
    },
    Step {
        first: Text {
            text: "The craft has the old plan: {} uploads yours ({} would take the edit back).",
            actions: &[Action::Upload, Action::Edit(EditAction::Undo)],
        },
        is_begun: |state| state.view.upload.is_some(),
        then: Text { text: "The upload is under way.", actions: &[] },
        is_done: |state, _| state.plan_is_on_craft(),
    },
    Step {
        first: Text {
            text: "Press {} to go back in time, event by event, and {} to come back to now.",
            actions: &[Action::EventBack, Action::Newest],
        },
        is_begun: Shared::is_rewound,
        then: Text {
            text: "Every panel shows that instant: {} goes further back, {} comes back to now.",
            actions: &[Action::EventBack, Action::Newest],
        },
        is_done: |state, tutorial| tutorial.rewound && !state.is_rewound(),
    },
];

/// Begins the tutorial, or ends it.
pub(super) fn toggle(tutorial: &mut Option<Tutorial>, state: &mut Shared) {
    if tutorial.take().is_some() {
        state.notify(Severity::Info, "The tutorial is over; `:tutorial` begins it again.");
    } else {
        *tutorial = Some(Tutorial { revision: state.editor.plan().history().at(), ..Tutorial::default() });
    }
}

/// Goes on to the next step once the user has done this one.
pub(super) fn follow(shown: &mut Option<Tutorial>, state: &mut Shared) {
    let Some(mut tutorial) = *shown else { return };
    tutorial.rewound |= state.is_rewound();
    if STEPS.get(tutorial.step).is_some_and(|step| (step.is_done)(state, &tutorial)) {
        let revision = state.editor.plan().history().at();
        tutorial = Tutorial { step: tutorial.step + 1, revision, rewound: false };
    }
    *shown = Some(tutorial);
    if tutorial.step == STEPS.len() {
        *shown = None;
        let text = format!(
            "That was the tutorial: {} shows the keys of the focused panel, {} takes every action by name.",
            state.key(Action::Help),
            state.key(Action::CommandLine)
        );
        state.notify(Severity::Good, text);
    }
}

/// Returns the current instruction with the current keys.
fn text(state: &Shared, tutorial: Tutorial) -> String {
    let Some(step) = STEPS.get(tutorial.step) else { return String::new() };
    let Text { text, actions } = if (step.is_begun)(state) { &step.then } else { &step.first };
    let keys = actions.iter().map(|&action| state.key(action));
    let text = keys.fold((*text).to_owned(), |text, key| text.replacen("{}", &key, 1));
    format!("{}/{} {text}", tutorial.step + 1, STEPS.len())
}

/// The rows of the bar of the panels, in the frame above the hints.
const BAR: u16 = 1;

/// The greatest number of rows of a step.
const ROWS: usize = 2;

/// Returns the rows of the step.
fn lines(tutorial: Option<Tutorial>, state: &Shared, hints: Rect) -> Vec<String> {
    let Some(tutorial) = tutorial else { return Vec::new() };
    let width = usize::from(hints.width.saturating_sub(6));
    let mut lines = wrapped(&text(state, tutorial), width);
    if lines.len() > ROWS {
        let rest = lines.split_off(ROWS - 1).join(" ");
        lines.push(cut(&rest, width));
    }
    lines
}

/// Returns the number of rows above the hints that the tutorial and the bar of the panels take.
pub(super) fn rows(tutorial: Option<Tutorial>, state: &Shared, hints: Rect) -> u16 {
    match lines(tutorial, state, hints).len() as u16 {
        0 => 0,
        rows => rows + BAR,
    }
}

/// Draws the step above the bar of the panels, whose keys it names, in one or two rows.
pub(super) fn draw(tutorial: Option<Tutorial>, state: &Shared, hints: Rect, buffer: &mut Buffer) {
    let lines = lines(tutorial, state, hints);
    let width = usize::from(hints.width.saturating_sub(6));
    for (at, line) in lines.iter().enumerate() {
        let above = (lines.len() - at) as u16 + BAR;
        let fill = " ".repeat(width - line.width().min(width));
        let mark = if at == 0 { "▸" } else { " " };
        let text = format!(" {mark} {line}{fill} ");
        let y = hints.y.saturating_sub(above);
        drawing::text(buffer, hints.x + 1, y, text, state.theme.style(Role::Active));
    }
}
