//! The lines that are always there: two of status above, one of hints below, and for a moment the newest notice.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr as _;

use crate::signals::RcSource;
use crate::telemetry::{LinkState, Mode, NavState};

use super::action::{Action, enabled, is_wrecked, spec_of};
use super::hands::{self, ThrottleMove};
use super::keymap::shown;
use super::panel::{span, wrapped};
use super::quantity::{clock, clock_ms, cut, factor, fixed, signed, within};
use super::state::{AppState, Pane};
use super::theme::{Role, Theme};

/// How long a notice stays.
const NOTICE_FOR: std::time::Duration = std::time::Duration::from_secs(8);
/// Rows a notice takes at most.
const NOTICE_ROWS: usize = 2;
/// Width from which a door says what is wrong with it.
const WIDE: u16 = 120;
/// Empty and full cell, V.
const CELL_V: (f64, f64) = (3.3, 4.2);
/// Parts of the battery bar.
const BAR: usize = 5;

/// Draws the two status lines.
pub(super) fn draw(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let first = Rect { height: 1, ..area };
    sides(buffer, first, &craft(state), &sensors(state));
    let second = Rect { y: area.y + 1, height: 1, ..area };
    let time = time(state);
    let room = usize::from(area.width).saturating_sub(Line::from(time.clone()).width());
    sides(buffer, second, &mission(state, room), &time);
}

/// Left and right part of a line; the right one is never cut, the left one ends in an ellipsis where it must.
fn sides(buffer: &mut Buffer, area: Rect, left: &[Span<'static>], right: &[Span<'static>]) {
    let right = Line::from(right.to_vec());
    let width = (right.width() as u16).min(area.width);
    let room = area.width - width;
    let mut left = Line::from(left.to_vec());
    if left.width() > usize::from(room) {
        while left.width() + 2 > usize::from(room) && left.spans.pop().is_some() {}
        left.push_span("…");
    }
    buffer.set_line(area.x, area.y, &left, room);
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
pub(super) fn rc(state: &AppState) -> (String, Role) {
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

/// State, waypoint and the numbers of the leg; without a mission those of the craft alone. A part that does not fit is
/// left out as a whole, the least important first.
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
    let (target, columns) = match nav.kind {
        Some(kind) if nav.engaged => (format!("WP{} {kind}", nav.wp), 12),
        _ => (state.view.pilot.unwrap_or_default().to_owned(), 15),
    };
    let estimate = &vehicle.estimate;
    let leg = if nav.engaged { leg(state) } else { Vec::new() };
    // How important, label, value, unit.
    let craft = [
        (2, "", fixed(Some(estimate.ground_speed_mps), 5, 1), " m/s"),
        (1, "", fixed(estimate.alt, 6, 1), " m"),
        (5, "  climb", signed(Some(estimate.climb_mps), 6, 1), " m/s"),
        (6, "  home", fixed(nav.home_distance_m, 6, 0), " m"),
        (7, "  fence", fixed(nav.fence_margin_m, 6, 0), " m left"),
    ];
    let mut spans = vec![
        span(theme, role, format!(" ◆ {name:<11} ")),
        span(theme, Role::Text, format!("{:<columns$}", cut(&target, columns))),
    ];
    let parts: Vec<_> = leg.into_iter().chain(craft).collect();
    let width =
        |(_, label, value, unit): &(u8, &str, String, &str)| label.width() + value.width() + unit.width();
    let fits = |most: u8| parts.iter().filter(|part| part.0 <= most).map(width).sum::<usize>();
    let left = room.saturating_sub(15 + columns);
    let most = (0..=7).rev().find(|&most| fits(most) <= left).unwrap_or(0);
    for (_, label, value, unit) in parts.into_iter().filter(|part| part.0 <= most) {
        spans.push(span(theme, Role::Dim, label));
        spans.push(span(theme, Role::Text, value));
        spans.push(span(theme, Role::Dim, unit));
    }
    spans
}

/// The numbers of the leg: how important, label, value, unit.
fn leg(state: &AppState) -> Vec<(u8, &'static str, String, &'static str)> {
    let nav = &state.view.vehicle.nav;
    let bearing = nav.bearing_rad.map(|rad| rad.to_degrees().rem_euclid(360.0));
    let last = if nav.hold_remaining_ds > 0 {
        let left = (nav.hold_remaining_ds != u16::MAX).then(|| f64::from(nav.hold_remaining_ds) / 10.0);
        let text = left.map_or_else(|| "∞".to_owned(), |left| fixed(Some(left), 4, 0));
        (4, " hold", format!("{text:>4}"), " s")
    } else {
        (4, " xte", signed(nav.xte_m, 5, 1), " m")
    };
    vec![(0, "", fixed(nav.distance_m, 5, 1), " m"), (3, "", fixed(bearing, 4, 0), "°"), last]
}

/// Simulated time and speed.
fn time(state: &AppState) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let view = &state.view;
    let halted = match view.simulator {
        Some(LinkState::Waiting) => Some((" no simulator ", Role::Warn)),
        Some(LinkState::Silent) => Some((" ‖ simulator silent ", Role::Fault)),
        Some(LinkState::Flowing) | None => None,
    };
    if let Some((why, role)) = halted {
        return vec![
            span(theme, Role::Text, format!(" {}", clock(view.vehicle.time))),
            span(theme, role, why),
        ];
    }
    if view.paused {
        return vec![span(theme, Role::Active, format!(" {} ‖ ", clock_ms(view.vehicle.time)))];
    }
    // In the first second after a start or a pause there is no figure yet.
    let measured = view.speed_achieved > 0.0;
    let keeps_up = !measured || view.speed_achieved >= 0.9 * view.speed_wanted;
    let speed = if measured && (view.speed_wanted.is_infinite() || !keeps_up) {
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
    let engaged = state.view.vehicle.nav.engaged;
    if craft.armed {
        let autopilot = if engaged { "autopilot off" } else { "autopilot" };
        let home = if craft.commanded { "stop return" } else { "home" };
        let rc = if state.view.rc_cut { "restore RC" } else { "cut RC" };
        if engaged {
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
    if craft.armed && engaged {
        // Last: in the air nobody should press it by mistake.
        hints.push((&[Action::Arm], "disarm"));
    }
    if state.focus == Pane::Rc {
        hints.push((&[Action::Flip], "flip"));
    }
    hints.retain(|(actions, _)| actions.iter().all(|&action| enabled(state, action).is_ok()));
    hints
}

/// What the throttle key does here and now.
fn throttle_label(state: &AppState) -> &'static str {
    match (hands::throttle_move(state), hands::is_standing(state)) {
        (ThrottleMove::Low, _) => "throttle low",
        (ThrottleMove::Sink(_), _) => "come down",
        (ThrottleMove::Hover, true) => "throttle up",
        (ThrottleMove::Hover, false) => "hold",
    }
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

/// Draws the newest notice for a moment: in the frame of the lowest panels, and in the row above it when it is long.
pub(super) fn notice(state: &AppState, hints: Rect, buffer: &mut Buffer) {
    let Some(notice) = state.notice.as_ref().filter(|notice| within(state.now, notice.at, NOTICE_FOR)) else {
        return;
    };
    let style = state.theme.style(notice.level.role());
    let width = usize::from(hints.width.saturating_sub(6));
    let mut lines = wrapped(&format!("{} {}", notice.level.glyph(), notice.text), width);
    if lines.len() > NOTICE_ROWS {
        let rest = lines.split_off(NOTICE_ROWS - 1).join(" ");
        lines.push(cut(&rest, width));
    }
    let widest = lines.iter().map(|line| line.width()).max().unwrap_or(0);
    for (above, line) in (1..).zip(lines.iter().rev()) {
        let fill = " ".repeat(widest - line.width());
        buffer.set_string(hints.x + 2, hints.y.saturating_sub(above), format!(" {line}{fill} "), style);
    }
}

/// Draws the hint line: keys at the left; at the right the way out and the doors.
pub(super) fn hints(state: &AppState, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let mut right: Vec<Span<'static>> =
        way_out(state).iter().flat_map(|(keys, label)| hint(theme, keys, label)).collect();
    right.extend(doors(state, area.width));
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

/// The doors: name, whether somebody is connected, and what is wrong.
fn doors(state: &AppState, width: u16) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let mut spans = Vec::new();
    for door in &state.view.doors {
        let name = door.name.strip_prefix("udp ").unwrap_or(door.name);
        let (text, role) = if door.fault && width >= WIDE {
            (format!("✗{name} {}", cut(&door.state, 6)), Role::Fault)
        } else if door.fault {
            (format!("✗{name}"), Role::Fault)
        } else if is_idle(&door.state) {
            (format!("○{name}"), Role::Dim)
        } else {
            (format!("●{name}"), Role::Ok)
        };
        spans.push(span(theme, role, text));
        spans.push(span(theme, Role::Text, " "));
    }
    spans
}

/// Whether nobody uses a door, going by the words about it.
fn is_idle(words: &str) -> bool {
    // A rate of zero is told once packets stay away.
    matches!(words, "listening" | "closed" | "") || words.starts_with("waiting") || words.starts_with("0 Hz")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::session::SessionView;
    use crate::session::command::DoorView;

    /// The clock's line and the hint line while a simulator outside is in this state.
    fn lines(simulator: LinkState, doors: &[(&'static str, &str, bool)]) -> String {
        let door = |&(name, state, fault): &(&'static str, &str, bool)| DoorView {
            name,
            state: state.to_owned(),
            fault,
            ..DoorView::default()
        };
        let view = SessionView {
            simulator: Some(simulator),
            speed_wanted: f64::INFINITY,
            speed_achieved: 0.5,
            doors: doors.iter().map(door).collect(),
            ..SessionView::default()
        };
        let state = AppState::bare((120, 40), view);
        let area = Rect::new(0, 0, 120, 3);
        let mut buffer = Buffer::empty(area);
        draw(&state, area, &mut buffer);
        hints(&state, Rect { y: 2, height: 1, ..area }, &mut buffer);
        buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect()
    }

    #[test]
    fn what_the_simulator_does_stands_at_the_clock() {
        let waiting = [("udp fdm", "listening", false), ("udp motors", "waiting for a simulator", false)];
        let text = lines(LinkState::Waiting, &waiting);
        assert!(text.contains(" 00:00.0 no simulator "), "{text}");
        assert!(text.contains("○fdm ○motors"), "{text}");

        let flying = [("udp fdm", "250 Hz, 9 packets, 1 ms ago", false), ("udp motors", "flying", false)];
        let text = lines(LinkState::Flowing, &flying);
        assert!(text.contains(" 00:00.0 0.5×"), "its own speed: {text}");
        assert!(text.contains("●fdm ●motors"), "{text}");
        assert!(!text.contains("pause") && !text.contains("reset"), "what it decides is no hint: {text}");

        let silent = [("udp fdm", "0 Hz, 9 packets, 3 s ago", false), ("udp motors", "no FDM", true)];
        let text = lines(LinkState::Silent, &silent);
        assert!(text.contains(" 00:00.0 ‖ simulator silent "), "{text}");
        assert!(text.contains("○fdm ✗motors no FDM"), "{text}");
    }
}
