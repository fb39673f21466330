//! The permission to change a real remote craft, once per connection.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::popup::frame::{key_line, popup};
use super::shared::Shared;
use super::text_wrap::wrapped;
use super::theme::Role;
use crate::fc::{Access, Denial, Impact};
use crate::session::SessionView;
use crate::session::policy::{self, Facts, Intent, Refusal};
use crate::ui::area::{line, row};
use crate::ui::model::effect::Effect;

/// The width of the inside.
const WIDTH: u16 = 56;

/// The permission to change a real craft.
#[derive(Debug, Default)]
pub struct Permission {
    /// Effects that wait until the user permits changes of the remote craft.
    pub held: Vec<Effect>,
    /// The connection for which the user has permitted changes.
    pub(super) permitted: Option<u32>,
}

impl Permission {
    /// Returns the effects that may be carried out, and holds those that would change the craft.
    pub(super) fn hold(&mut self, view: &SessionView, effects: Vec<Effect>) -> Vec<Effect> {
        let mut facts = Facts::from(view);
        // The session confirms the permission only with the next picture.
        if self.permitted.is_some() && self.permitted == view.remote.as_ref().map(|remote| remote.connection)
        {
            facts.access = Access::Changing;
        }
        let is_held = |effect: &Effect| {
            policy::check(&facts, intent_of(effect)) == Err(Refusal::Access(Denial::NotPermitted))
        };
        let (held, free): (Vec<Effect>, Vec<Effect>) = effects.into_iter().partition(is_held);
        self.held.extend(held);
        free
    }
}

fn intent_of(effect: &Effect) -> Intent {
    match effect {
        Effect::Send(command) => Intent::of(command),
        Effect::Cli(line) | Effect::Set(line) => Intent::Line(Impact::from_line(line)),
        Effect::ReadSettings => Intent::Line(Impact::Reads),
        Effect::Download(_) => Intent::Download,
        Effect::Upload { .. } => Intent::Upload,
        Effect::SaveToFlash => Intent::Save,
        Effect::World(_) => Intent::World,
        Effect::Forecast(job) if job.request.continues() => Intent::FlyAhead,
        Effect::Forecast(_) | Effect::Survey(_) => Intent::Forecast,
        Effect::Files(_)
        | Effect::EndSurvey(_)
        | Effect::Curves(_)
        | Effect::WriteFlight { .. }
        | Effect::WriteRecording { .. }
        | Effect::ListFlights { .. }
        | Effect::DeleteFlight(_)
        | Effect::ShowFlights { .. }
        | Effect::Copy(_)
        | Effect::Redraw
        | Effect::Suspend
        | Effect::Quit => Intent::Read,
    }
}

pub(super) fn question(state: &Shared) -> String {
    let Some(remote) = state.real_craft() else { return String::new() };
    let name = &remote.name;
    if remote.opens_cli {
        format!(
            "This opens the command line of the flight controller at {name}: it does not arm then, and leaving the \
             command line (exit) restarts it. Go on?"
        )
    } else {
        format!("This changes the flight controller at {name}. Go on? Asked once per connection.")
    }
}

pub(super) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let text = question(state);
    let lines = wrapped(&text, usize::from(WIDTH) - 4);
    let rows = lines.len() as u16;
    let inside = popup(theme, area, (WIDTH, rows + 2), "Change the craft?", buffer);
    for (at, text) in (0..).zip(&lines) {
        let mark = if at == 0 { " ▲ " } else { "   " };
        row(buffer, inside, at, theme, Role::Warn, &format!("{mark}{text}"));
    }
    let answers = [(" y", " go on   "), ("n", " change nothing")];
    line(buffer, inside, rows + 1, &key_line(theme, &answers));
}
