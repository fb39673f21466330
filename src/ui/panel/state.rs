//! 3 State: the status message, the state machine, the guards of the active state, the last transitions.

mod in_words;
mod transition_list;

use std::time::Duration;

use crossterm::event::KeyEvent;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::Line;

use super::{Content, Hint, horizon};
use crate::telemetry::{FirmwareProfile, Guard, GuardName, NavState};
use crate::ui::acts::status_message;
use crate::ui::formatting::{cut, fixed, signed, within};
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::message::{NewPopup, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use crate::ui::theme::{Role, Theme};
use crate::ui::transitions::{Transition, Transitions};
use crate::ui::units::Units;

use super::content::scrolled;
use super::state_diagram::{COMPACT, Diagram, FULL, LOW, MASTER};
use crate::ui::area::{line, row, span};
use crate::ui::text_wrap::wrapped;

/// The time for which the strokes of the last transition stay lit.
const LIT_FOR: Duration = Duration::from_millis(2500);
/// The share of a limit from which a guard needs attention.
const NEAR: f64 = 0.75;
/// The margin to the flyaway limit below which it needs attention, m. The limit is 20 m or more above the least
/// distance so far, so a craft that comes nearer is never this close to it, however long the leg.
const FLYAWAY_LEFT_M: f64 = 10.0;
/// The width from which a guard is shown with its margin.
const WIDE: u16 = 36;
/// The room below the guards from which the artificial horizon is shown, too.
const HORIZON_ROOM: (u16, u16) = (42, 9);
/// The number of rows that guards need below the state diagram.
const GUARD_ROWS: u16 = 8;

/// The state of the State panel.
#[derive(Debug, Default)]
pub struct StatePanel {
    pub transitions: Transitions,
}

impl Content for StatePanel {
    /// Returns the title with the waypoint of the mission.
    fn title(&self, state: &Shared) -> String {
        let name = state.panel_title(Panel::State);
        let Some(nav) = state.view.vehicle.nav.as_ref().filter(|nav| nav.engaged && nav.count > 0) else {
            return name.to_owned();
        };
        let kind = nav.kind.map_or_else(String::new, |kind| format!(" {kind}"));
        format!("{name} WP{}/{}{kind}", nav.wp, nav.count.saturating_sub(1))
    }

    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        if self.transitions.search.is_on() {
            return transition_list::draw_search(&self.transitions, state, area, buffer);
        }
        draw(&self.transitions, state, area, buffer);
        None
    }

    fn in_words(&self, state: &Shared) -> Vec<String> {
        in_words::lines(&self.transitions, state)
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        if self.transitions.search.is_on() {
            let next =
                &[Action::Panel(PanelAction::NextTransition), Action::Panel(PanelAction::PreviousTransition)];
            return vec![(next, "next match"), (&[Action::Back], "end search")];
        }
        vec![(&[Action::Panel(PanelAction::ExplainGuards)], "explain")]
    }

    fn act(&mut self, state: &Shared, action: PanelAction) -> Vec<Request> {
        match action {
            PanelAction::ExplainGuards => return vec![Request::Open(NewPopup::Guards)],
            PanelAction::SearchTransitions => {
                self.transitions.begin_search();
                return vec![Request::Act(Action::Show(Panel::State))];
            }
            PanelAction::NextTransition => return transition_list::next(&mut self.transitions, state, 1),
            PanelAction::PreviousTransition => {
                return transition_list::next(&mut self.transitions, state, -1);
            }
            _ => {}
        }
        Vec::new()
    }

    fn key(&mut self, _: &Shared, event: KeyEvent) -> Vec<Request> {
        self.transitions.search_key(event);
        Vec::new()
    }

    fn field(&mut self) -> Option<&mut TextField> {
        let search = &mut self.transitions.search;
        search.is_typing.then_some(&mut search.field)
    }

    fn close_field(&mut self) {
        self.transitions.end_search();
    }

    fn go_back(&mut self, _: &Shared) -> Option<Vec<Request>> {
        self.transitions.search.is_on().then(|| {
            self.transitions.end_search();
            Vec::new()
        })
    }

    fn scroll(&mut self, state: &Shared, _: Rect, by: isize) -> Vec<Request> {
        let last = transition_list::found(&self.transitions, state).count().saturating_sub(1);
        scrolled(&mut self.transitions.scroll, by, last);
        Vec::new()
    }
}

fn draw(own: &Transitions, state: &Shared, area: Rect, buffer: &mut Buffer) {
    let diagram = diagram(state, area);
    let mut top = draw_status_message(state, area, diagram, buffer);
    top += draw_machine(own, state, below(area, top), diagram, buffer);
    top += draw_guards(state, below(area, top), buffer);
    let mut rest = below(area, top);
    if rest.width >= HORIZON_ROOM.0 && rest.height >= HORIZON_ROOM.1 {
        rest.height -= horizon::SIZE.1;
        let place = Rect { y: rest.bottom(), height: horizon::SIZE.1, ..rest };
        horizon::draw(state, Rect { x: place.x + 1, width: place.width - 1, ..place }, buffer);
    }
    transition_list::draw(own, state, rest, buffer);
}

/// Returns the largest state diagram that leaves room for the guards.
fn diagram(state: &Shared, area: Rect) -> &'static Diagram {
    let profile = state.view.vehicle.settings.map_or(FirmwareProfile::Guide, |settings| settings.profile);
    if profile == FirmwareProfile::Master {
        return &MASTER;
    }
    let fits = |diagram: &Diagram| area.width >= diagram.width && area.height >= diagram.height + GUARD_ROWS;
    [&FULL, &COMPACT].into_iter().find(|diagram| fits(diagram)).unwrap_or(&LOW)
}

/// Returns the area below its first rows.
fn below(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

/// Draws the status message. Returns the number of rows used.
fn draw_status_message(state: &Shared, area: Rect, diagram: &Diagram, buffer: &mut Buffer) -> u16 {
    let theme = &state.theme;
    let Some(message) = status_message::current(state) else { return 0 };
    let width = usize::from(area.width.saturating_sub(2));
    let mut used = 0;
    for (glyph, text, role) in [
        (message.severity.glyph(), &message.condition, message.severity.role()),
        ("→", &message.action, Role::Title),
    ] {
        for (at, text) in wrapped(text, width).iter().enumerate() {
            let mark = if at == 0 { glyph } else { " " };
            row(buffer, area, used, theme, role, &format!("{mark} {text}"));
            used += 1;
        }
    }
    // A blank line below, if there is room for everything.
    if area.height > used + diagram.height { used + 1 } else { used }
}

/// Draws the state machine. Returns the number of rows used.
fn draw_machine(
    own: &Transitions,
    state: &Shared,
    area: Rect,
    diagram: &Diagram,
    buffer: &mut Buffer,
) -> u16 {
    let Some(nav) = &state.view.vehicle.nav else {
        let text = match state.view.replay {
            Some(_) => " — no state of the autopilot was recorded",
            None => " — the firmware reports no state",
        };
        row(buffer, area, 0, &state.theme, Role::Dim, text);
        return 1.min(area.height);
    };
    let last = own.shown(state).next_back().filter(|last| is_lit(state, last));
    let left = (area.width.saturating_sub(diagram.width)) / 2;
    let place = Rect { x: area.x + left, width: area.width - left, ..area };
    diagram.draw(&state.theme, nav, last.map(|last| (last.from, last.to)), place, buffer);
    diagram.height.min(area.height)
}

/// Returns `true` while the strokes of a transition are lit: it has just occurred, or it is just before the earlier
/// instant on the screen.
fn is_lit(state: &Shared, last: &Transition) -> bool {
    if state.is_rewound() {
        return state.view.vehicle.time.seconds_since(last.time) < LIT_FOR.as_secs_f64();
    }
    within(state.now, last.received, LIT_FOR)
}

/// Draws the guards of the active state, the remaining time of the leg and the laps of an orbit. Returns the number of
/// rows used.
fn draw_guards(state: &Shared, area: Rect, buffer: &mut Buffer) -> u16 {
    let Some(nav) = state.view.vehicle.nav.as_ref().filter(|nav| !nav.guards.is_empty()) else { return 0 };
    if area.height == 0 {
        return 0;
    }
    let theme = &state.theme;
    let units = state.units;
    let wide = area.width >= WIDE;
    // The conditions that the mission waits for come first; those that would end it are below.
    let (watched, awaited): (Vec<&Guard>, Vec<&Guard>) = nav.guards.iter().partition(|guard| is_watch(guard));
    let mut lines: Vec<Line<'_>> = awaited
        .iter()
        .map(|guard| {
            if wide { wide_guard(theme, units, guard) } else { narrow_guard(theme, units, guard, area.width) }
        })
        .collect();
    if let Some((seconds, speed_mps)) = time_of_leg(state) {
        let speed = short(units.speed(speed_mps));
        let text = format!("  in{} s at {speed} {}", fixed(Some(seconds), 5, 0), units.speed_unit());
        lines.push(Line::from(span(theme, Role::Dim, text)));
    }
    if let Some(laps) = laps(state) {
        lines.push(Line::from(span(theme, Role::Dim, laps)));
    }
    lines.extend(watched.iter().map(|guard| {
        if wide { watch(theme, units, guard) } else { narrow_watch(theme, units, guard, area.width) }
    }));
    let mut used = u16::from(usize::from(area.height) > lines.len());
    for text in &lines {
        line(buffer, area, used, text);
        used += 1;
    }
    used.min(area.height)
}

/// Returns the share of its ring that an orbit flies in its time.
fn laps(state: &Shared) -> Option<String> {
    let vehicle = &state.view.vehicle;
    let nav = vehicle.nav.as_ref().filter(|nav| nav.state == NavState::Orbiting)?;
    let wp = vehicle.active_plan.as_ref()?.waypoints.get(usize::from(nav.wp))?;
    let laps = vehicle.settings.as_ref()?.orbit_laps(wp)?;
    let unit = if laps < 0.995 { "of a lap" } else { "laps" };
    Some(format!("  {laps:.2} {unit} in {} s", short(wp.duration.get())))
}

/// Returns the time for the rest of the leg at the speed of the leg, s, and that speed, m/s. The current speed says
/// little while the craft speeds up or turns.
fn time_of_leg(state: &Shared) -> Option<(f64, f64)> {
    let vehicle = &state.view.vehicle;
    let nav = vehicle.nav.as_ref().filter(|nav| nav.eta_s.is_some())?;
    let wp = vehicle.active_plan.as_ref()?.waypoints.get(usize::from(nav.wp))?;
    let limit_mps = vehicle.settings.as_ref()?.max_velocity_mps;
    let speed_mps = wp.speed.own_mps().map_or(limit_mps, |mps| mps.min(limit_mps));
    let seconds = nav.distance_m? / speed_mps;
    seconds.is_finite().then_some((seconds, speed_mps))
}

/// Returns `true` for a guard that ends the mission when it holds. Such a guard is good as long as it does not hold.
fn is_watch(guard: &Guard) -> bool {
    matches!(
        guard.name,
        GuardName::Fence
            | GuardName::NoProgress
            | GuardName::Flyaway
            | GuardName::Overrun
            | GuardName::Overspeed
            | GuardName::WrongHeading
    )
}

/// Returns the name of a guard without the part that the state already implies.
fn short_name(guard: &Guard) -> &'static str {
    match guard.name {
        GuardName::TouchdownAltitude => "altitude",
        GuardName::TouchdownSpeed => "speed",
        GuardName::TouchdownThrottle => "throttle",
        GuardName::TouchdownSink => "sink",
        GuardName::TouchdownTime => "time",
        GuardName::HeldOffAltitude => "held off",
        GuardName::Overspeed => "overspeed",
        other => other.into(),
    }
}

/// Returns mark and role of a guard that should not hold.
fn watch_verdict(guard: &Guard) -> (&'static str, Role) {
    let near = if guard.name == GuardName::Flyaway {
        guard.limit - guard.value < FLYAWAY_LEFT_M
    } else {
        guard.value / guard.limit > NEAR
    };
    match near {
        _ if guard.holds() => ("✗", Role::Fault),
        true => ("▲", Role::Warn),
        false => ("·", Role::Dim),
    }
}

/// Returns the used part of a limit: `· fence           56.1 of   500 m`.
fn watch(theme: &Theme, units: Units, guard: &Guard) -> Line<'static> {
    let (mark, role) = watch_verdict(guard);
    let (factor, unit) = units.of_guard(guard.unit());
    let value = fixed(Some(guard.value * factor), 7, 1);
    let limit = short(guard.limit * factor);
    let text = format!("{mark} {:<13}{value} of {limit:>4} {unit}", short_name(guard));
    Line::from(span(theme, role, text))
}

/// Returns the same in one narrow line: `· fence       56.1/500 m`.
fn narrow_watch(theme: &Theme, units: Units, guard: &Guard, width: u16) -> Line<'static> {
    let (mark, role) = watch_verdict(guard);
    Line::from(span(theme, role, narrow(units, guard, mark, "/", width)))
}

/// Returns a guard in one narrow line: `✗ turn radius 62.4≤5.5 m`.
fn narrow_guard(theme: &Theme, units: Units, guard: &Guard, width: u16) -> Line<'static> {
    let (mark, role) = verdict(guard);
    Line::from(span(theme, role, narrow(units, guard, mark, theme.operator(guard.op), width)))
}

/// Returns a guard in one narrow line: the name on the left, the numbers on the right, as many blanks between as fit.
fn narrow(units: Units, guard: &Guard, mark: &str, op: &str, width: u16) -> String {
    let (factor, unit) = units.of_guard(guard.unit());
    let value = fixed(Some(guard.value * factor), 5, 1);
    let numbers = format!("{}{op}{}", value.trim_start(), short(guard.limit * factor));
    let name = format!("{mark} {}", short_name(guard));
    let room = usize::from(width).saturating_sub(name.chars().count() + numbers.chars().count());
    let unit = if room > unit.chars().count() + 1 { format!(" {unit}") } else { unit.to_owned() };
    let room = usize::from(width).saturating_sub(numbers.chars().count() + unit.chars().count());
    format!("{:<room$}{numbers}{unit}", cut(&name, room))
}

/// Formats a number with one decimal, or with none if it is whole.
fn short(value: f64) -> String {
    if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:.1}") }
}

fn verdict(guard: &Guard) -> (&'static str, Role) {
    if guard.holds() { ("✓", Role::Ok) } else { ("✗", Role::Warn) }
}

/// Returns a guard with its margin: `✗ turn radius    62.4 ≤   5.5 m   −56.9`.
fn wide_guard(theme: &Theme, units: Units, guard: &Guard) -> Line<'static> {
    let (factor, unit) = units.of_guard(guard.unit());
    let (mark, role) = verdict(guard);
    Line::from(vec![
        span(theme, role, format!("{mark} {:<13}", cut(short_name(guard), 13))),
        span(theme, Role::Text, fixed(Some(guard.value * factor), 7, 1)),
        span(theme, Role::Dim, format!(" {} ", guard.op)),
        span(theme, Role::Text, format!("{:>5}", short(guard.limit * factor))),
        span(theme, Role::Dim, format!(" {unit:<4}")),
        span(theme, role, signed(Some(guard.margin() * factor), 7, 1)),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::GuardOp;

    #[test]
    fn flyaway_warns_only_when_the_craft_moves_away() {
        let shown = |value, limit| {
            let guard = Guard { name: GuardName::Flyaway, value, limit, op: GuardOp::Above };
            watch(&Theme::default(), Units::Metric, &guard).to_string()
        };
        assert!(shown(112.9, 139.4).starts_with('·'), "nearer than ever");
        assert!(shown(1980.0, 2080.0).starts_with('·'), "a long leg");
        assert!(shown(132.0, 139.4).starts_with('▲'), "further than before");
        assert!(shown(140.0, 139.4).starts_with('✗'));
    }
}
