//! Holds effects that would change a real remote craft until the user permits changes, once per connection.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use super::app_state::AppState;
use super::draw::popup;
use super::event_log::Severity;
use super::message::Effect;
use super::panel::{line, row, span};
use super::popup::Popup;
use super::text_wrap::wrapped;
use super::theme::Role;
use crate::fc::{Access, Denial, Impact, RemoteView};
use crate::session::Command;

/// The width of the inside.
const WIDTH: u16 = 56;

/// Returns the remote flight controller if its craft is real.
pub(super) fn real_craft(state: &AppState) -> Option<&RemoteView> {
    state.view.remote.as_ref().filter(|remote| remote.access.is_limited())
}

/// Returns the effects that may be carried out. Effects that would change a real craft are held, and the user is asked.
pub(super) fn hold(state: &mut AppState, effects: Vec<Effect>) -> Vec<Effect> {
    let Some(remote) = real_craft(state) else { return effects };
    // The session confirms the permission only with the next picture.
    let permitted = state.permitted == Some(remote.connection);
    let (access, opens_cli) = (if permitted { Access::Changing } else { remote.access }, remote.opens_cli);
    let (held, free): (Vec<Effect>, Vec<Effect>) = effects
        .into_iter()
        .partition(|effect| access.check(impact_of(effect, opens_cli)) == Err(Denial::NotPermitted));
    if !held.is_empty() {
        state.held.extend(held);
        ask(state);
    }
    free
}

/// Asks the user to permit changes of the craft.
pub(super) fn ask(state: &mut AppState) {
    if !state.popups.contains(&Popup::Permission) {
        state.popups.push(Popup::Permission);
    }
}

/// Returns the impact of an effect on the craft.
fn impact_of(effect: &Effect, opens_cli: bool) -> Impact {
    match effect {
        Effect::Cli(line) => Impact::of_line(line).or_changes(opens_cli),
        Effect::Download(_) => Impact::Reads.or_changes(opens_cli),
        Effect::Upload { .. } | Effect::SaveToFlash => Impact::Changes,
        Effect::Send(_)
        | Effect::World(_)
        | Effect::Forecast(_)
        | Effect::Files(_)
        | Effect::WriteScenario { .. }
        | Effect::Copy(_)
        | Effect::Suspend
        | Effect::Quit => Impact::Reads,
    }
}

/// Permits changes and releases the held effects.
pub(super) fn permit(state: &mut AppState) -> Vec<Effect> {
    close(state);
    let Some(remote) = real_craft(state) else { return Vec::new() };
    let connection = remote.connection;
    let mut effects = vec![Effect::Send(Command::PermitChanges(connection))];
    effects.append(&mut state.held);
    state.permitted = Some(connection);
    if effects.len() == 1 {
        state.notify(Severity::Info, "Changes are permitted until the connection ends.");
    }
    effects
}

/// Declines changes and drops the held effects.
pub(super) fn decline(state: &mut AppState) {
    close(state);
    let held = std::mem::take(&mut state.held);
    if held.iter().any(|effect| matches!(effect, Effect::Cli(_))) {
        state.cli.not_run("not run: changes were not permitted");
    }
    state.notify(Severity::Info, "Nothing was changed.");
}

/// Drops the held effects if the question is gone: it was closed in another way, or its connection ended.
pub(super) fn follow(state: &mut AppState, connection_before: Option<u32>) {
    let connection = real_craft(state).map(|remote| remote.connection);
    let is_asked = state.popups.contains(&Popup::Permission);
    if is_asked && connection != connection_before || !is_asked && !state.held.is_empty() {
        decline(state);
    }
}

fn close(state: &mut AppState) {
    state.popups.retain(|popup| *popup != Popup::Permission);
}

pub(super) fn question(state: &AppState) -> String {
    let Some(remote) = real_craft(state) else { return String::new() };
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

pub(super) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let text = question(state);
    let lines = wrapped(&text, usize::from(WIDTH) - 4);
    let rows = lines.len() as u16;
    let inside = popup(state, area, (WIDTH, rows + 2), "Change the craft?", buffer);
    for (at, text) in (0..).zip(&lines) {
        let mark = if at == 0 { " ▲ " } else { "   " };
        row(buffer, inside, at, theme, Role::Warn, &format!("{mark}{text}"));
    }
    let answers = Line::from(vec![
        span(theme, Role::Key, " y"),
        span(theme, Role::Text, " go on   "),
        span(theme, Role::Key, "n"),
        span(theme, Role::Text, " change nothing"),
    ]);
    line(buffer, inside, rows + 1, &answers);
}
