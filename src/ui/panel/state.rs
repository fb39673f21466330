//! 3 State: what stands in the way, the state machine, the guards of the active state, the last transitions.

use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::Line;

use crate::autopilot::io::Guard;
use crate::ui::advice;
use crate::ui::quantity::{clock, cut, fixed, signed, within};
use crate::ui::state::AppState;
use crate::ui::theme::{Role, Theme};

use super::machine::{COMPACT, FULL};
use super::{line, row, span, wrapped};

/// How long the strokes of the last transition stay lit.
const LIT_FOR: Duration = Duration::from_millis(2500);
/// Share of a limit from which it needs attention.
const NEAR: f64 = 0.75;
/// What is left of the flyaway limit when it needs attention, m: the limit lies 20 m or more beyond the least distance
/// so far, so a craft that comes nearer is never this close to it, however long the leg.
const FLYAWAY_LEFT_M: f64 = 10.0;
/// Width from which a guard fits one line.
const WIDE: u16 = 36;

/// Draws the inside.
pub fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let mut top = draw_advice(state, area, buffer);
    top += draw_machine(state, below(area, top), buffer);
    top += draw_guards(state, below(area, top), buffer);
    draw_transitions(state, below(area, top), buffer);
}

/// What is left of the area under its first rows.
fn below(area: Rect, rows: u16) -> Rect {
    let rows = rows.min(area.height);
    Rect { y: area.y + rows, height: area.height - rows, ..area }
}

/// What the user should know; gives the rows used.
fn draw_advice(state: &AppState, area: Rect, buffer: &mut Buffer) -> u16 {
    let theme = &state.theme;
    let Some(advice) = advice::now(state) else { return 0 };
    let width = usize::from(area.width.saturating_sub(2));
    let mut used = 0;
    for (glyph, text, role) in
        [(advice.level.glyph(), &advice.what, advice.level.role()), ("→", &advice.fix, Role::Title)]
    {
        for (at, text) in wrapped(text, width).iter().enumerate() {
            let mark = if at == 0 { glyph } else { " " };
            row(buffer, area, used, theme, role, &format!("{mark} {text}"));
            used += 1;
        }
    }
    // A blank line below, where there is room for everything.
    if area.height > used + COMPACT.height { used + 1 } else { used }
}

/// The machine; gives the rows used.
fn draw_machine(state: &AppState, area: Rect, buffer: &mut Buffer) -> u16 {
    let nav = &state.view.vehicle.nav;
    let diagram = if area.width >= FULL.width && area.height >= FULL.height { &FULL } else { &COMPACT };
    let last = state.transitions.back().filter(|last| within(state.now, last.heard, LIT_FOR));
    let left = (area.width.saturating_sub(diagram.width)) / 2;
    let place = Rect { x: area.x + left, width: area.width - left, ..area };
    diagram.draw(&state.theme, nav.state, last.map(|last| (last.from, last.to)), place, buffer);
    if nav.engaged && nav.count > 0 && area.height > 0 {
        let kind = nav.kind.map_or_else(String::new, |kind| format!(" {kind}"));
        let text = format!("WP{}/{}{kind}", nav.wp, nav.count.saturating_sub(1));
        let room = area.width.saturating_sub(left + diagram.width.min(7));
        let text = cut(&text, usize::from(room));
        let x = area.x + area.width - text.chars().count() as u16;
        buffer.set_string(x, area.y, text, state.theme.style(Role::Target));
    }
    diagram.height.min(area.height)
}

/// The guards of the active state, and how fast it gets nearer; gives the rows used.
fn draw_guards(state: &AppState, area: Rect, buffer: &mut Buffer) -> u16 {
    let nav = &state.view.vehicle.nav;
    if nav.guards.is_empty() || area.height == 0 {
        return 0;
    }
    let theme = &state.theme;
    let mut used = u16::from(area.height > 4);
    // What the mission waits for comes first, what would end it below.
    let (watched, awaited): (Vec<&Guard>, Vec<&Guard>) = nav.guards.iter().partition(|guard| is_watch(guard));
    for guard in awaited {
        if area.width >= WIDE {
            line(buffer, area, used, &wide_guard(theme, guard));
            used += 1;
        } else if used + 2 <= area.height {
            let (mark, role) = verdict(guard);
            let value = fixed(Some(guard.value), 6, 1);
            let numbers = format!("{mark} {value} {} {} {}", guard.op, short(guard.limit), guard.unit);
            row(buffer, area, used, theme, Role::Title, &format!("  {}", short_name(guard)));
            row(buffer, area, used + 1, theme, role, &numbers);
            used += 2;
        }
    }
    if let Some(eta) = nav.eta_s.filter(|eta| eta.is_finite()) {
        let speed = fixed(Some(state.view.vehicle.estimate.ground_speed_mps), 6, 1);
        row(buffer, area, used, theme, Role::Dim, &format!("  {speed} m/s {} s", fixed(Some(eta), 4, 0)));
        used += 1;
    }
    if area.width >= WIDE {
        for guard in watched {
            line(buffer, area, used, &watch(theme, guard));
            used += 1;
        }
    }
    used.min(area.height)
}

/// Whether a guard ends the mission when it holds, so that it is good that it does not.
fn is_watch(guard: &Guard) -> bool {
    matches!(guard.name, "fence" | "no progress" | "flyaway" | "overrun" | "waypoints")
}

/// The name without what the state already says.
fn short_name(guard: &Guard) -> &'static str {
    guard.name.strip_prefix("touchdown ").unwrap_or(guard.name)
}

/// `· fence           56.1 of   500 m`: how much of a limit is used up.
fn watch(theme: &Theme, guard: &Guard) -> Line<'static> {
    let near = if guard.name == "flyaway" {
        guard.limit - guard.value < FLYAWAY_LEFT_M
    } else {
        guard.value / guard.limit > NEAR
    };
    let (mark, role) = match near {
        _ if guard.holds() => ("✗", Role::Fault),
        true => ("▲", Role::Warn),
        false => ("·", Role::Dim),
    };
    let value = fixed(Some(guard.value), 7, 1);
    let text = format!("{mark} {:<13}{value} of {:>4} {}", short_name(guard), short(guard.limit), guard.unit);
    Line::from(span(theme, role, text))
}

/// A number as short as it is exact to a tenth.
fn short(value: f64) -> String {
    if value.fract() == 0.0 { format!("{value:.0}") } else { format!("{value:.1}") }
}

fn verdict(guard: &Guard) -> (&'static str, Role) {
    if guard.holds() { ("✓", Role::Ok) } else { ("✗", Role::Warn) }
}

/// `✗ turn radius    62.4 ≤   5.5 m   −56.9`.
fn wide_guard(theme: &Theme, guard: &Guard) -> Line<'static> {
    let (mark, role) = verdict(guard);
    Line::from(vec![
        span(theme, role, format!("{mark} {:<13}", cut(short_name(guard), 13))),
        span(theme, Role::Text, fixed(Some(guard.value), 7, 1)),
        span(theme, Role::Dim, format!(" {} ", guard.op)),
        span(theme, Role::Text, format!("{:>5}", short(guard.limit))),
        span(theme, Role::Dim, format!(" {:<4}", guard.unit)),
        span(theme, role, signed(Some(guard.margin()), 7, 1)),
    ])
}

/// The last transitions, the newest on top.
fn draw_transitions(state: &AppState, area: Rect, buffer: &mut Buffer) {
    if area.height < 3 || state.transitions.is_empty() {
        return;
    }
    let theme = &state.theme;
    let wide = area.width >= 40;
    let rows = usize::from(area.height - 2);
    row(buffer, area, 1, theme, Role::Title, "Transitions");
    let first = state.scrolls.transitions.min(state.transitions.len().saturating_sub(rows));
    for (at, step) in state.transitions.iter().rev().skip(first).take(rows).enumerate() {
        let spans = if wide {
            vec![
                span(theme, Role::Dim, format!("{} ", clock(step.time))),
                span(theme, Role::Text, format!("{} → {} ", step.from, step.to)),
                span(theme, Role::Dim, format!("WP{} {}", step.wp, step.reason)),
            ]
        } else {
            vec![
                span(theme, Role::Dim, format!("{} ", clock(step.time))),
                span(theme, Role::Text, step.to.to_string()),
            ]
        };
        line(buffer, area, at as u16 + 2, &Line::from(spans));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::io::GuardOp;

    #[test]
    fn flyaway_warns_only_when_the_craft_moves_away() {
        let shown = |value, limit| {
            let guard = Guard { name: "flyaway", value, limit, op: GuardOp::Above, unit: "m" };
            watch(&Theme::default(), &guard).to_string()
        };
        assert!(shown(112.9, 139.4).starts_with('·'), "nearer than ever");
        assert!(shown(1980.0, 2080.0).starts_with('·'), "a long leg");
        assert!(shown(132.0, 139.4).starts_with('▲'), "further than before");
        assert!(shown(140.0, 139.4).starts_with('✗'));
    }
}
