//! The line at the bottom: the keys of the moment, help and quit, and the doors.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr as _;

use crate::link::endpoint::EndpointState;
use crate::telemetry::LinkState;

use super::shared::Shared;
use super::status_bar::sides;
use super::theme::{Role, Theme};
use crate::ui::acts::availability::{enabled, is_wrecked};
use crate::ui::acts::transmitter;
use crate::ui::acts::transmitter::ThrottleMove;
use crate::ui::area::span;
use crate::ui::model::action::{Action, EditAction, PanelAction};
use crate::ui::model::panel_table::Panel;
use crate::ui::panel::Hint;

/// The width from which a door also shows its fault.
const WIDE: u16 = 120;

/// Draws the hint line: keys on the left, those of the focused panel first; help, quit and the doors on the right.
pub(super) fn draw(own: &[Hint], state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let spans = |hints: &[Shown]| -> Vec<Span<'static>> {
        hints.iter().flat_map(|shown| hint(theme, &shown.keys(), shown.label)).collect()
    };
    let (left, permanent) = (shown(own, state, area.width), permanent_hints(state));
    let right: Vec<Span<'static>> = spans(&permanent).into_iter().chain(doors(state, area.width)).collect();
    sides(buffer, area, &spans(&left), &right);
}

/// Draws the line without keys, while a popup over the whole screen has all of them.
pub(super) fn draw_doors(state: &Shared, area: Rect, buffer: &mut Buffer) {
    sides(buffer, area, &[], &doors(state, area.width));
}

/// A hint on the screen: its keys, each with the action that a click on it triggers, and its label.
struct Shown {
    keys: Vec<(String, Option<Action>)>,
    label: &'static str,
}

impl Shown {
    fn of(state: &Shared, actions: &[Action], label: &'static str) -> Self {
        let first = |&action: &Action| Some((state.keymap.shown_key_in(action, state.focus)?, Some(action)));
        Self { keys: actions.iter().filter_map(first).collect(), label }
    }

    fn keys(&self) -> String {
        self.keys.iter().map(|(key, _)| key.as_str()).collect::<Vec<_>>().join(" ")
    }

    /// Returns the width with the blanks around keys and label.
    fn width(&self) -> usize {
        self.keys().width() + self.label.width() + 3
    }

    /// Returns the action at a column of the hint: of the key there, else of the first key.
    fn action_at(&self, column: usize) -> Option<Action> {
        let mut end = 1;
        let key = self.keys.iter().find(|(key, _)| {
            end += key.width() + 1;
            column < end
        });
        key.or(self.keys.first())?.1
    }
}

/// Returns the hints on the left that fit into a bar of this width.
fn shown(own: &[Hint], state: &Shared, width: u16) -> Vec<Shown> {
    let permanent: usize = permanent_hints(state).iter().map(Shown::width).sum();
    let mut room = usize::from(width).saturating_sub(permanent + Line::from(doors(state, width)).width());
    let hints: Vec<Shown> = if state.focus == Panel::Cli {
        let own = |keys: &str, label| Shown { keys: vec![(keys.to_owned(), None)], label };
        vec![
            own("Enter", "run"),
            own("Tab", "complete"),
            Shown::of(state, &[Action::Zoom], if state.zoomed { "all panels" } else { "zoom" }),
            own("↑ ↓", "history"),
            own("PgUp PgDn", "scroll"),
        ]
    } else {
        hint_actions(own, state).iter().map(|(actions, label)| Shown::of(state, actions, label)).collect()
    };
    let fits = |shown: &Shown| {
        let is_shown = !shown.keys.is_empty() && shown.width() <= room;
        room -= if is_shown { shown.width() } else { 0 };
        is_shown
    };
    hints.into_iter().filter(fits).collect()
}

/// Returns the action of the hint at a cell.
pub(super) fn action_at(own: &[Hint], state: &Shared, area: Rect, cell: (u16, u16)) -> Option<Action> {
    if !area.contains(cell.into()) {
        return None;
    }
    let permanent = permanent_hints(state);
    let right: usize =
        permanent.iter().map(Shown::width).sum::<usize>() + Line::from(doors(state, area.width)).width();
    let column = usize::from(cell.0 - area.x);
    let sides =
        [(0, shown(own, state, area.width)), (usize::from(area.width).saturating_sub(right), permanent)];
    sides.iter().find_map(|(start, hints)| {
        let mut at = *start;
        hints.iter().find_map(|shown| {
            let from = at;
            at += shown.width();
            (from..at).contains(&column).then(|| shown.action_at(column - from))?
        })
    })
}

/// Returns the actions of the hint bar, the most useful first.
fn hint_actions(own: &[Hint], state: &Shared) -> Vec<Hint> {
    let craft = &state.view.vehicle.craft;
    let mut hints: Vec<Hint> = Vec::new();
    if state.view.replay.is_some() {
        return replay_actions(own, state);
    }
    if state.is_rewound() {
        if state.flies_again() {
            hints.push((&[Action::FlyOn], "fly on"));
        }
        hints.extend([
            (&[Action::Newest] as &[_], "end"),
            (&[Action::EventBack, Action::EventForward], "event"),
            (&[Action::Earlier, Action::Later], "10 s"),
            (&[Action::Pause], if state.view.paused { "play" } else { "stop" }),
            (&[Action::StateBack, Action::StateForward], "state"),
            (&[Action::Step], "step"),
        ]);
        return hints;
    }
    hints.extend_from_slice(own);
    let has_upload = own.iter().any(|(actions, _)| actions.contains(&Action::Upload));
    if state.real_craft().is_some() {
        if !has_upload {
            hints.push((&[Action::Upload], "upload"));
        }
        hints.extend([
            (&[Action::Edit(EditAction::Download)] as &[_], "download"),
            (&[Action::Show(Panel::Cli)], "CLI"),
            (&[Action::CommandLine], "command"),
        ]);
        hints.retain(|(actions, _)| actions.iter().all(|&action| enabled(state, action).is_ok()));
        return hints;
    }
    let wrecked = is_wrecked(state);
    if state.view.timeline.is_some() && (wrecked || state.is_disarmed_in_the_air()) {
        hints.push((&[Action::StateBack], "back in time"));
    }
    if wrecked {
        hints.push((&[Action::ResetCraft], "reset"));
    }
    if state.view.pilot.is_some() {
        hints.push((&[Action::Fly], "stop pilot"));
    }
    let engaged = state.view.vehicle.is_engaged();
    if craft.is_armed() {
        let autopilot = if engaged { "autopilot off" } else { "autopilot" };
        let home = if craft.is_commanded() { "stop return" } else { "home" };
        let rc = if state.view.rc_cut { "restore RC" } else { "cut RC" };
        if engaged {
            if vehicle_is_held(state) {
                hints.push((&[Action::Resume], "go on"));
            }
            if state.flies_older_plan() {
                hints.push((&[Action::GoTo], "fly the new plan"));
            }
            hints.extend([
                (&[Action::Autopilot] as &[_], autopilot),
                (&[Action::ReturnHome], home),
                (&[Action::CutRc], rc),
            ]);
        } else {
            hints.extend([
                (&[Action::Throttle] as &[_], throttle_label(state)),
                (&[Action::Autopilot], autopilot),
                (&[Action::Arm], "disarm"),
                (&[Action::ReturnHome], home),
                (&[Action::CutRc], rc),
            ]);
        }
    } else {
        if state.view.pilot.is_none() {
            hints.push((&[Action::Fly], "fly"));
        }
        hints.push((&[Action::Arm], "arm"));
        if !has_upload {
            hints.push((&[Action::Upload], "upload"));
        }
        if state.view.rc_cut {
            hints.push((&[Action::CutRc], "restore RC"));
        }
        if !wrecked {
            hints.push((&[Action::ResetCraft], "reset"));
        }
    }
    hints.extend([
        (&[Action::Pause] as &[_], if state.view.paused { "go on" } else { "pause" }),
        (&[Action::Slower, Action::Faster], "speed"),
    ]);
    if state.view.paused {
        hints.extend([(&[Action::EventBack] as &[_], "rewind"), (&[Action::Step], "step")]);
    }
    if craft.is_armed() && engaged {
        hints.extend([(&[Action::HoldHere] as &[_], "hold here"), (&[Action::GoTo], "go to")]);
        // Last, so that nobody presses it by mistake in the air.
        hints.push((&[Action::Arm], "disarm"));
    }
    if state.focus == Panel::Rc {
        hints.push((&[Action::Panel(PanelAction::Flip)], "flip"));
    }
    hints.push((&[Action::CommandLine], "command"));
    hints.retain(|(actions, _)| actions.iter().all(|&action| enabled(state, action).is_ok()));
    hints
}

/// Returns the actions for a recorded flight.
fn replay_actions(own: &[Hint], state: &Shared) -> Vec<Hint> {
    let play = if state.view.paused { "play" } else { "pause" };
    let mut hints: Vec<Hint> = vec![(&[Action::Pause], play)];
    hints.extend_from_slice(own);
    hints.extend([
        (&[Action::EventBack, Action::EventForward] as &[_], "event"),
        (&[Action::Earlier, Action::Later], "10 s"),
        (&[Action::Slower, Action::Faster], "speed"),
        (&[Action::Step], "step"),
        (&[Action::Newest], "end"),
    ]);
    if state.view.replay.as_ref().is_some_and(|replay| replay.count > 1) {
        hints.push((&[Action::PreviousFlight, Action::NextFlight], "flight"));
    }
    hints.push((&[Action::CommandLine], "command"));
    hints.retain(|(actions, _)| actions.iter().all(|&action| enabled(state, action).is_ok()));
    hints
}

/// Returns `true` if a hold was commanded.
fn vehicle_is_held(state: &Shared) -> bool {
    state.view.vehicle.nav.as_ref().is_some_and(|nav| nav.held_by_command)
}

/// Returns the current effect of the throttle key.
fn throttle_label(state: &Shared) -> &'static str {
    match (transmitter::throttle_move(state), transmitter::is_standing(state)) {
        (ThrottleMove::Low, _) => "throttle low",
        (ThrottleMove::Sink(_), _) => "come down",
        (ThrottleMove::Hover, true) => "throttle up",
        (ThrottleMove::Hover, false) => "hold",
    }
}

/// Returns the keys that are never left out: help and quit; in the CLI panel Esc.
fn permanent_hints(state: &Shared) -> Vec<Shown> {
    if state.focus == Panel::Cli {
        return vec![Shown { keys: vec![("Esc".to_owned(), Some(Action::Back))], label: "leave" }];
    }
    vec![Shown::of(state, &[Action::Help], "help"), Shown::of(state, &[Action::Quit], "quit")]
}

/// Returns a key and its effect as spans of the hint line.
fn hint(theme: &Theme, keys: &str, label: &str) -> [Span<'static>; 2] {
    [span(theme, Role::Key, format!(" {keys}")), span(theme, Role::Text, format!(" {label} "))]
}

/// Returns the doors: the name, a mark for a connection, the fault; then the lost real time.
fn doors(state: &Shared, width: u16) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let mut spans = Vec::new();
    for endpoint in &state.view.endpoints {
        let name = endpoint.kind.short_name();
        let (text, role) = match fault(&endpoint.state) {
            Some(fault) if width >= WIDE => (format!("✗{name} {fault}"), Role::Fault),
            Some(_) => (format!("✗{name}"), Role::Fault),
            None if endpoint.state.is_idle() => (format!("○{name}"), Role::Dim),
            None => (format!("●{name}"), Role::Ok),
        };
        spans.push(span(theme, role, text));
        spans.push(span(theme, Role::Text, " "));
    }
    let lost = state.view.lost_time;
    if lost.is_notable() {
        spans.push(span(theme, Role::Warn, format!("{:.1} s lost ", lost.sum.as_secs_f64())));
    }
    spans
}

/// Returns the fault of an endpoint, in a word or two.
fn fault(state: &EndpointState) -> Option<&'static str> {
    match state {
        EndpointState::Busy => Some("busy"),
        EndpointState::Closed => Some("closed"),
        EndpointState::Simulator(stats) if stats.link == LinkState::Silent => Some("no FDM"),
        EndpointState::Simulator(_) | EndpointState::Clients(_) | EndpointState::Packets(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::link::endpoint::{ClientStats, EndpointKind, EndpointStatus, PacketStats, SimulatorStats};
    use crate::session::SessionView;
    use crate::ui::status_bar;

    fn endpoint((kind, state): (EndpointKind, EndpointState)) -> EndpointStatus {
        EndpointStatus { kind, address: String::new(), state }
    }

    #[test]
    fn an_endpoint_whose_client_left_is_not_shown_as_connected() {
        let shown = |clients| {
            let stats = ClientStats { clients, received_bytes: 6, sent_bytes: 9, ..ClientStats::default() };
            let endpoints = vec![endpoint((EndpointKind::Tcp, EndpointState::Clients(stats)))];
            let state = Shared::bare((120, 40), SessionView { endpoints, ..SessionView::default() });
            doors(&state, 120).iter().map(|span| span.content.to_string()).collect::<String>()
        };
        assert_eq!((shown(1).trim(), shown(0).trim()), ("●tcp", "○tcp"));
    }

    /// Returns the text of the status lines and the hint line for an external simulator in this state.
    fn lines(simulator: LinkState, rate_hz: u32) -> String {
        let states = [
            (EndpointKind::Fdm, EndpointState::Packets(PacketStats { rate_hz, ..PacketStats::default() })),
            (
                EndpointKind::Motors,
                EndpointState::Simulator(SimulatorStats {
                    link: simulator,
                    dialect: None,
                    refused: 0,
                    old: 0,
                }),
            ),
        ];
        let view = SessionView {
            simulator: Some(simulator),
            speed_wanted: f64::INFINITY,
            speed_achieved: 0.5,
            endpoints: states.map(endpoint).to_vec(),
            ..SessionView::default()
        };
        let state = Shared::bare((120, 40), view);
        let area = Rect::new(0, 0, 120, 3);
        let mut buffer = Buffer::empty(area);
        status_bar::draw(&state, area, &mut buffer);
        draw(&[], &state, Rect { y: 2, height: 1, ..area }, &mut buffer);
        buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect()
    }

    #[test]
    fn what_the_simulator_does_is_beside_the_clock() {
        let text = lines(LinkState::Waiting, 0);
        assert!(text.contains(" 00:00.0 no simulator "), "{text}");
        assert!(text.contains("○fdm ○motors"), "{text}");

        let text = lines(LinkState::Flowing, 250);
        assert!(text.contains(" 00:00.0 0.5×"), "its own speed: {text}");
        assert!(text.contains("●fdm ●motors"), "{text}");
        assert!(!text.contains("pause") && !text.contains("reset"), "what it decides is no hint: {text}");

        let text = lines(LinkState::Silent, 0);
        assert!(text.contains(" 00:00.0 ‖ simulator silent "), "{text}");
        assert!(text.contains("○fdm ✗motors no FDM"), "{text}");
    }
}
