//! The lines that are always there: two of status above, one of hints below.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr as _;

use crate::autopilot::io::NavState;
use crate::firmware::mode::Mode;
use crate::signals::RcSource;

use super::action::{Action, enabled, is_wrecked, spec_of};
use super::hands;
use super::keymap::shown;
use super::panel::span;
use super::quantity::{clock, clock_ms, cut, factor, fixed, signed, within};
use super::state::{AppState, Pane};
use super::theme::{Role, Theme};

/// How long a notice stays in the place of the hints.
const NOTICE_FOR: std::time::Duration = std::time::Duration::from_secs(6);
/// Empty and full cell, V.
const CELL_V: (f64, f64) = (3.3, 4.2);
/// Parts of the battery bar.
const BAR: usize = 5;

/// Draws the two status lines.
pub fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let first = Rect { height: 1, ..area };
    sides(buffer, first, &craft(state), &sensors(state));
    let second = Rect { y: area.y + 1, height: 1, ..area };
    let time = time(state);
    let room = usize::from(area.width).saturating_sub(Line::from(time.clone()).width());
    sides(buffer, second, &mission(state, room), &time);
}

/// Left and right part of a line; the right one is never cut.
fn sides(buffer: &mut Buffer, area: Rect, left: &[Span<'static>], right: &[Span<'static>]) {
    let right = Line::from(right.to_vec());
    let width = (right.width() as u16).min(area.width);
    let room = area.width - width;
    buffer.set_line(area.x, area.y, &Line::from(left.to_vec()), room);
    buffer.set_line(area.x + room, area.y, &right, width);
}

/// Armed and modes.
fn craft(state: &AppState) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let craft = &state.view.vehicle.craft;
    let mut spans = vec![if craft.armed {
        span(theme, Role::Fault, " ● ARMED ")
    } else {
        span(theme, Role::Ok, " ○ DISARMED ")
    }];
    let mut modes: Vec<Mode> = craft.modes.iter().filter(|mode| *mode != Mode::Arm).collect();
    modes.sort_by_key(|mode| match mode {
        Mode::Failsafe => 0,
        Mode::Autopilot => 1,
        Mode::GpsRescue => 2,
        _ => 3,
    });
    for mode in modes {
        let role = match mode {
            Mode::Failsafe => Role::Fault,
            Mode::Autopilot | Mode::GpsRescue => Role::Target,
            _ => Role::Text,
        };
        // One word a mode, so that the line can be read as a list.
        let name = mode.to_string().replace(' ', "");
        spans.push(span(theme, role, format!("{name} ")));
    }
    spans
}

/// GPS, battery, RC.
fn sensors(state: &AppState) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let craft = &state.view.vehicle.craft;
    let (fix, role) = if craft.gps_fix { ("3D", Role::Ok) } else { ("no", Role::Warn) };
    let mut spans =
        vec![span(theme, role, format!("⌖ {fix} {:>2} sats", craft.sats)), span(theme, Role::Text, "  ")];
    let (bar, role) = battery_bar(craft.battery_v, craft.battery_cells);
    spans.push(span(theme, role, format!("{bar} {} V", fixed(craft.battery_v, 4, 1))));
    spans.push(span(theme, Role::Text, "  "));
    let (text, role) = rc(state);
    spans.push(span(theme, role, format!("⇄ {text:<8}")));
    spans
}

fn battery_bar(volts: Option<f64>, cells: u8) -> (String, Role) {
    let Some(volts) = volts.filter(|v| v.is_finite()) else { return ("▯".repeat(BAR), Role::Dim) };
    let cells = if cells > 0 { f64::from(cells) } else { (volts / CELL_V.1).ceil().max(1.0) };
    let share = ((volts / cells - CELL_V.0) / (CELL_V.1 - CELL_V.0)).clamp(0.0, 1.0);
    let full = (share * BAR as f64).round() as usize;
    let role = match full {
        0 => Role::Fault,
        1 => Role::Warn,
        _ => Role::Ok,
    };
    ("▮".repeat(full) + &"▯".repeat(BAR - full), role)
}

/// Who drives the channels, in at most nine columns.
pub fn rc(state: &AppState) -> (String, Role) {
    let craft = &state.view.vehicle.craft;
    let ours = matches!(craft.rc_source, Some(RcSource::Sticks) | None);
    if state.view.rc_cut && ours {
        return ("RC CUT".to_owned(), Role::Fault);
    }
    match craft.rc_source {
        Some(_) if !craft.rc_link => {
            (format!("LOST{} s", fixed(craft.rc_age_s, 4, 1).trim_end()), Role::Fault)
        }
        Some(RcSource::Sticks) if state.view.pilot.is_some() => ("RC pilot".to_owned(), Role::Text),
        Some(RcSource::Sticks) => ("RC keys".to_owned(), Role::Text),
        Some(RcSource::Udp) => ("RC udp".to_owned(), Role::Text),
        Some(RcSource::Msp) => ("RC msp".to_owned(), Role::Text),
        None => ("RC —".to_owned(), Role::Dim),
    }
}

/// State, waypoint and the numbers of the leg; a part that does not fit is left out as a whole.
fn mission(state: &AppState, room: usize) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let vehicle = &state.view.vehicle;
    let nav = &vehicle.nav;
    let name = if nav.climbing { "CLIMBING".to_owned() } else { nav.state.to_string() };
    let role = match nav.state {
        NavState::Idle => Role::Dim,
        NavState::Complete => Role::Ok,
        _ => Role::Target,
    };
    let target = match nav.kind {
        Some(kind) if nav.engaged => format!("WP{} {kind}", nav.wp),
        _ => state.view.pilot.map_or_else(String::new, |doing| format!("pilot: {doing}")),
    };
    let bearing = nav.bearing_rad.map(|rad| rad.to_degrees().rem_euclid(360.0));
    let leg = if nav.hold_remaining_ds > 0 {
        let left = (nav.hold_remaining_ds != u16::MAX).then(|| f64::from(nav.hold_remaining_ds) / 10.0);
        let text = left.map_or_else(|| "∞".to_owned(), |left| fixed(Some(left), 5, 1));
        (" hold", format!("{text:>5}"), "s")
    } else {
        ("  xte", signed(nav.xte_m, 5, 1), "m")
    };
    let estimate = &vehicle.estimate;
    let parts = [
        ("", fixed(nav.distance_m, 5, 1), " m"),
        ("", fixed(bearing, 4, 0), "°"),
        leg,
        ("", fixed(Some(estimate.ground_speed_mps), 5, 1), " m/s"),
        ("", fixed(estimate.alt, 6, 1), " m"),
        ("  climb", signed(Some(estimate.climb_mps), 6, 1), " m/s"),
        ("  home", fixed(nav.home_distance_m, 6, 0), " m"),
        ("  fence", fixed(nav.fence_margin_m, 6, 0), " m left"),
    ];
    let mut spans = vec![
        span(theme, role, format!(" ◆ {name:<11} ")),
        span(theme, Role::Text, format!("{:<12}", cut(&target, 12))),
    ];
    let mut used = 27;
    for (label, value, unit) in parts {
        let width = label.width() + value.width() + unit.width();
        if used + width > room {
            break;
        }
        used += width;
        spans.push(span(theme, Role::Dim, label));
        spans.push(span(theme, Role::Text, value));
        spans.push(span(theme, Role::Dim, unit));
    }
    spans
}

/// Simulated time and speed.
fn time(state: &AppState) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let view = &state.view;
    if view.paused {
        return vec![span(theme, Role::Active, format!(" {} ‖ ", clock_ms(view.vehicle.time)))];
    }
    let keeps_up = view.speed_achieved >= 0.9 * view.speed_wanted;
    let speed = if view.speed_wanted.is_infinite() || !keeps_up {
        factor((view.speed_achieved * 10.0).round() / 10.0)
    } else {
        factor(view.speed_wanted)
    };
    let role = if keeps_up || view.speed_wanted.is_infinite() { Role::Text } else { Role::Warn };
    vec![
        span(theme, Role::Text, format!(" {}", clock(view.vehicle.time))),
        span(theme, role, format!(" {speed:>3} ")),
    ]
}

/// The actions of the hint bar, in the order of their use here and now.
fn hint_actions(state: &AppState) -> Vec<(&'static [Action], &'static str)> {
    let craft = &state.view.vehicle.craft;
    let mut hints: Vec<(&'static [Action], &'static str)> = Vec::new();
    match state.focus {
        Pane::Cli => {}
        Pane::Rc => hints.extend([
            (&[Action::ChannelUp, Action::ChannelDown] as &[_], "channel"),
            (&[Action::Lower, Action::Raise], "value"),
            (&[Action::Flip], "flip"),
        ]),
        Pane::Map if state.zoomed => hints.extend([
            (&[Action::ZoomIn, Action::ZoomOut] as &[_], "zoom"),
            (&[Action::Follow], "follow"),
            (&[Action::Fit], "fit"),
        ]),
        Pane::Map | Pane::Plan | Pane::State | Pane::Log => {}
    }
    let wrecked = is_wrecked(state);
    if wrecked {
        hints.push((&[Action::ResetCraft], "reset"));
    }
    if state.view.pilot.is_some() {
        hints.push((&[Action::Fly], "stop pilot"));
    }
    if craft.armed {
        hints.extend([
            (
                &[Action::Autopilot] as &[_],
                if craft.modes.has(Mode::Autopilot) { "autopilot off" } else { "autopilot" },
            ),
            (&[Action::Arm], "disarm"),
            (&[Action::CutRc], if state.view.rc_cut { "restore RC" } else { "cut RC" }),
            (&[Action::ReturnHome], "home"),
        ]);
    } else {
        if state.view.pilot.is_none() {
            hints.push((&[Action::Fly], "fly"));
        }
        hints.extend([(&[Action::Arm] as &[_], "arm"), (&[Action::Upload], "upload")]);
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
    if craft.armed {
        hints.insert(
            1,
            (&[Action::Throttle], if hands::throttle_is_raised(state) { "throttle low" } else { "hover" }),
        );
    }
    hints.retain(|(actions, _)| actions.iter().all(|&action| enabled(state, action).is_ok()));
    hints
}

/// The keys that are never left out: the way to all others, and the way out.
fn way_out(state: &AppState) -> Vec<(String, &'static str)> {
    if state.focus == Pane::Cli {
        return vec![("Esc".to_owned(), "leave")];
    }
    vec![(keys_of(&[Action::Help]), "help"), (keys_of(&[Action::Quit]), "quit")]
}

/// The first key of each action.
fn keys_of(actions: &[Action]) -> String {
    let keys: Vec<String> =
        actions.iter().filter_map(|&action| spec_of(action)?.keys.first().map(|key| shown(key))).collect();
    keys.join(" ")
}

/// A key and what it does, as it stands in the hint line.
fn hint(theme: &Theme, keys: &str, label: &str) -> [Span<'static>; 2] {
    [span(theme, Role::Key, format!(" {keys}")), span(theme, Role::Text, format!(" {label} "))]
}

/// Draws the hint line: the newest notice for a moment, else keys; at the right the way out and the doors.
pub fn hints(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    if let Some(notice) = state.notice.as_ref().filter(|notice| within(state.now, notice.at, NOTICE_FOR)) {
        let text = cut(&format!(" {} {}", notice.level.glyph(), notice.text), usize::from(area.width));
        buffer.set_string(area.x, area.y, text, theme.style(notice.level.role()));
        return;
    }
    let mut right: Vec<Span<'static>> =
        way_out(state).iter().flat_map(|(keys, label)| hint(theme, keys, label)).collect();
    right.extend(doors(state));
    let room = usize::from(area.width).saturating_sub(Line::from(right.clone()).width());
    let mut spans: Vec<Span<'static>> = Vec::new();
    let mut used = 0;
    let mut push = |keys: &str, label: &str| {
        let width = keys.width() + label.width() + 3;
        if used + width > room {
            return;
        }
        used += width;
        spans.extend(hint(theme, keys, label));
    };
    if state.focus == Pane::Cli {
        for (keys, label) in
            [("Enter", "run"), ("Tab", "complete"), ("↑ ↓", "history"), ("PgUp PgDn", "scroll")]
        {
            push(keys, label);
        }
    } else {
        for (actions, label) in hint_actions(state) {
            push(&keys_of(actions), label);
        }
    }
    sides(buffer, area, &spans, &right);
}

/// The doors: name, and how many are connected or what is wrong.
fn doors(state: &AppState) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let mut spans = Vec::new();
    for door in &state.view.doors {
        let (text, role) = if door.fault {
            (format!("✗{} {}", door.name, cut(&door.state, 6)), Role::Fault)
        } else if door.state == "listening" || door.state == "closed" || door.state.is_empty() {
            (format!("○{}", door.name), Role::Dim)
        } else {
            (format!("●{}", door.name), Role::Ok)
        };
        spans.push(span(theme, role, text));
        spans.push(span(theme, Role::Text, " "));
    }
    spans
}
