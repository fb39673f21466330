//! The two status lines at the top: modes, GPS, battery, RC; mission and simulated time.

use crate::ui::acts::{ground_under, past_flight};
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr as _;

use crate::session::SessionView;
use crate::signals::RcSource;
use crate::telemetry::snapshot::CraftView;
use crate::telemetry::{LinkState, Mode, NavState, NavTelemetry};

use super::drawing;
use super::formatting::{clock, clock_ms, compass, cut, factor, fixed, signed};
use super::shared::Shared;
use super::theme::Role;
use super::units::Units;
use crate::ui::area::span;

pub(super) mod in_words;

/// The voltage of an empty and a full cell, V.
const CELL_V: (f64, f64) = (3.3, 4.2);
/// The highest voltage of a charged cell, V. It gives the number of cells where nobody counts them.
const MAX_CELL_V: f64 = 4.3;
/// The number of parts of the battery bar.
const BAR: usize = 5;

/// Draws the two status lines.
pub(super) fn draw(state: &Shared, area: Rect, buffer: &mut Buffer) {
    let first = Rect { height: 1, ..area };
    sides(buffer, first, &craft(state), &sensors(state));
    let second = Rect { y: area.y + 1, height: 1, ..area };
    let time = time(state);
    let room = usize::from(area.width).saturating_sub(Line::from(time.clone()).width());
    sides(buffer, second, &mission(state, room), &time);
}

/// Draws the left and right part of a line. The right one is never shortened; the left one ends in an ellipsis if there
/// is no room.
pub(super) fn sides(buffer: &mut Buffer, area: Rect, left: &[Span<'static>], right: &[Span<'static>]) {
    let right = Line::from(right.to_vec());
    let width = (right.width() as u16).min(area.width);
    let room = area.width - width;
    let mut left = Line::from(left.to_vec());
    if left.width() > usize::from(room) {
        while left.width() + 2 > usize::from(room) && left.spans.pop().is_some() {}
        left.push_span("…");
    }
    drawing::line(buffer, area.x, area.y, &left, room);
    drawing::line(buffer, area.x + room, area.y, &right, width);
}

fn craft(state: &Shared) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let craft = &state.view.vehicle.craft;
    let mut spans = vec![match craft.armed {
        Some(true) => span(theme, Role::Fault, " ● ARMED "),
        Some(false) => span(theme, Role::Ok, " ○ DISARMED "),
        None => span(theme, Role::Dim, " ○ — "),
    }];
    if let Some(name) = &craft.mode_name {
        spans.push(span(theme, Role::Target, format!("{name} ")));
    }
    for mode in modes(craft) {
        let role = match mode {
            Mode::Failsafe => Role::Fault,
            Mode::Autopilot | Mode::GpsRescue => Role::Target,
            _ => Role::Text,
        };
        // One word per mode, so that the line can be read as a list.
        let name = mode.to_string().replace(' ', "");
        spans.push(span(theme, role, format!("{name} ")));
    }
    spans
}

/// Returns the modes beside ARM, the most important first.
fn modes(craft: &CraftView) -> Vec<Mode> {
    let mut modes: Vec<Mode> =
        craft.modes.unwrap_or_default().iter().filter(|mode| *mode != Mode::Arm).collect();
    modes.sort_by_key(|mode| match mode {
        Mode::Failsafe => 0,
        Mode::Autopilot => 1,
        Mode::GpsRescue => 2,
        _ => 3,
    });
    modes
}

/// Returns GPS, battery and RC.
fn sensors(state: &Shared) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let craft = &state.view.vehicle.craft;
    let (fix, role) = match craft.gps_fix {
        Some(true) => ("3D", Role::Ok),
        Some(false) => ("no", Role::Warn),
        None => ("—", Role::Dim),
    };
    let sats = craft.sats.map_or_else(|| "—".to_owned(), |sats| sats.to_string());
    let mut spans =
        vec![span(theme, role, format!("⊕ {fix:<2} {sats:>2} sats")), span(theme, Role::Text, "  ")];
    let (bar, role) = battery_bar(craft.battery_v, craft.battery_cells);
    spans.push(span(theme, role, format!("{bar} {} V", fixed(craft.battery_v, 4, 1))));
    spans.push(span(theme, Role::Text, "  "));
    let (text, role) = rc(state);
    spans.push(span(theme, role, format!("⇄ {text:<8}")));
    spans
}

fn battery_bar(volts: Option<f64>, cells: Option<u8>) -> (String, Role) {
    let Some(volts) = volts.filter(|v| v.is_finite()) else { return ("▯".repeat(BAR), Role::Dim) };
    let cells = cells.map_or_else(|| (volts / MAX_CELL_V).ceil().max(1.0), f64::from);
    let share = ((volts / cells - CELL_V.0) / (CELL_V.1 - CELL_V.0)).clamp(0.0, 1.0);
    let full = (share * BAR as f64).round() as usize;
    let role = match full {
        0 => Role::Fault,
        1 => Role::Warn,
        _ => Role::Ok,
    };
    ("▮".repeat(full) + &"▯".repeat(BAR - full), role)
}

/// Returns the source of the channels, in at most ten columns.
pub(super) fn rc(state: &Shared) -> (String, Role) {
    let craft = &state.view.vehicle.craft;
    if state.view.replay.is_some() {
        return match craft.rc_link {
            Some(true) => ("RC ok".to_owned(), Role::Text),
            Some(false) => ("RC LOST".to_owned(), Role::Fault),
            None => ("RC —".to_owned(), Role::Dim),
        };
    }
    let ours = matches!(craft.rc_source, Some(RcSource::Sticks) | None);
    if state.view.rc_cut && ours {
        return ("RC CUT".to_owned(), Role::Fault);
    }
    match craft.rc_source {
        Some(_) if craft.rc_link == Some(false) => {
            (format!("LOST{} s", fixed(craft.rc_age_s, 4, 1).trim_end()), Role::Fault)
        }
        Some(RcSource::Sticks) if state.view.pilot.is_some() => ("RC pilot".to_owned(), Role::Text),
        Some(RcSource::Sticks) => ("RC keys".to_owned(), Role::Text),
        Some(RcSource::Udp) => ("RC udp".to_owned(), Role::Text),
        Some(RcSource::Msp) => ("RC msp".to_owned(), Role::Text),
        None => ("RC —".to_owned(), Role::Dim),
    }
}

/// Returns state, waypoint and the numbers of the leg; without a mission those of the craft alone. A part that does not
/// fit is left out as a whole, the least important first.
fn mission(state: &Shared, room: usize) -> Vec<Span<'static>> {
    let theme = &state.theme;
    let vehicle = &state.view.vehicle;
    let nav = vehicle.nav.as_ref();
    let name = state_name(nav);
    let role = match nav.map(|nav| nav.state) {
        None | Some(NavState::Idle) => Role::Dim,
        Some(NavState::Complete) => Role::Ok,
        Some(_) => Role::Target,
    };
    let engaged = nav.filter(|nav| nav.engaged);
    let (target, columns) = match engaged.and_then(|nav| nav.kind.map(|kind| (nav.wp, kind))) {
        Some((wp, kind)) => (format!("WP{wp} {kind}"), 12),
        None => (state.view.pilot.unwrap_or_default().to_owned(), 15),
    };
    let units = state.units;
    let (m, mps) = (units.length_unit(), units.speed_unit());
    let length = |value: Option<f64>| value.map(|metres| units.length(metres));
    let speed = |value: Option<f64>| value.map(|speed| units.speed(speed));
    let estimate = &vehicle.estimate;
    let leg = engaged.map_or_else(Vec::new, |nav| leg(nav, units));
    let home_m = home_m(state);
    let agl = ground_under::agl_m(state)
        .map(|agl_m| (3, "  agl", fixed(Some(units.length(agl_m)), 6, 1), format!(" {m}")));
    // Rank (a low one is kept longest), label, value, unit.
    let craft = [
        (2, "", fixed(speed(estimate.ground_speed_mps), 5, 1), format!(" {mps}")),
        (1, "", fixed(length(estimate.alt), 6, 1), format!(" {m}")),
        (5, "  climb", signed(speed(estimate.climb_mps), 6, 1), format!(" {mps}")),
        (6, "  home", fixed(length(home_m), 6, 0), format!(" {m}")),
        (7, "  fence", fixed(length(nav.and_then(|nav| nav.fence_margin_m)), 6, 0), format!(" {m} left")),
    ];
    let mut spans = vec![
        span(theme, role, format!(" ◆ {name:<11} ")),
        span(theme, Role::Text, format!("{:<columns$}", cut(&target, columns))),
    ];
    let parts: Vec<_> = leg.into_iter().chain(craft).chain(agl).collect();
    let width =
        |(_, label, value, unit): &(u8, &str, String, String)| label.width() + value.width() + unit.width();
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

/// Returns the state of the autopilot; a dash if it is not known.
fn state_name(nav: Option<&NavTelemetry>) -> String {
    match nav {
        None => "—".to_owned(),
        Some(nav) if nav.climbing => "CLIMBING".to_owned(),
        Some(nav) => nav.state.to_string(),
    }
}

/// Returns the distance to home, m.
fn home_m(state: &Shared) -> Option<f64> {
    let vehicle = &state.view.vehicle;
    // Places in a recorded flight count from home.
    let recorded_m = || {
        let estimate = &vehicle.estimate;
        let (n, e) = estimate.n.zip(estimate.e).filter(|_| state.view.replay.is_some())?;
        Some(n.hypot(e))
    };
    vehicle.nav.as_ref().and_then(|nav| nav.home_distance_m).or_else(recorded_m)
}

/// The numbers of the leg that is flown.
struct LegNumbers {
    distance_m: Option<f64>,
    bearing_deg: Option<f64>,
    /// The rest of a hold.
    hold_left_s: Option<f64>,
    xte_m: Option<f64>,
}

fn leg_numbers(nav: &NavTelemetry) -> LegNumbers {
    LegNumbers {
        distance_m: nav.distance_m,
        bearing_deg: nav.bearing_rad.map(|rad| rad.to_degrees().rem_euclid(360.0)),
        hold_left_s: nav.hold_remaining_s.filter(|left_s| *left_s > 0.0),
        xte_m: nav.xte_m,
    }
}

/// Returns the numbers of the leg: rank, label, value, unit.
fn leg(nav: &NavTelemetry, units: Units) -> Vec<(u8, &'static str, String, String)> {
    let m = || format!(" {}", units.length_unit());
    let length = |value: Option<f64>| value.map(|metres| units.length(metres));
    let numbers = leg_numbers(nav);
    let last = if let Some(left_s) = numbers.hold_left_s {
        let text = if left_s.is_finite() {
            fixed(Some(left_s), 4, 0).trim_start().to_owned()
        } else {
            "∞".to_owned()
        };
        (4, " hold ", format!("{text:>3}"), " s".to_owned())
    } else {
        let xte = signed(length(numbers.xte_m), 5, 1);
        (4, " xte ", format!("{:>4}", xte.trim_start()), m())
    };
    vec![
        (0, "", fixed(length(numbers.distance_m), 5, 1), m()),
        (3, "", fixed(numbers.bearing_deg.map(compass), 4, 0), "°".to_owned()),
        last,
    ]
}

/// Returns the instant of a recorded flight, and the speed while it plays.
fn replay_time(state: &Shared, label: &str) -> String {
    let view = &state.view;
    let time = clock_ms(view.vehicle.time);
    if view.paused {
        return format!(" {time} ‖ {label} ");
    }
    format!(" {time} ▸ {label} {} ", factor(view.speed_wanted))
}

/// Returns simulated time and speed.
fn time(state: &Shared) -> Vec<Span<'static>> {
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
    if let Some(label) = past_flight::label(state) {
        return vec![span(theme, Role::Active, replay_time(state, &label))];
    }
    if let Some(rewound_s) = state.rewound_s() {
        let mark = if view.paused { "◂" } else { "▸" };
        let text = format!(" {} {mark} REWOUND −{rewound_s:.1} s ", clock_ms(view.vehicle.time));
        return vec![span(theme, Role::Active, text)];
    }
    if view.paused {
        return vec![span(theme, Role::Active, format!(" {} ‖ ", clock_ms(view.vehicle.time)))];
    }
    let (speed, keeps_up) = speed(view);
    let role = if keeps_up || view.speed_wanted.is_infinite() { Role::Text } else { Role::Warn };
    vec![
        span(theme, Role::Text, format!(" {}", clock(view.vehicle.time))),
        span(theme, role, format!(" {speed:>3} ")),
    ]
}

/// Returns the speed of time, and `true` if the flight keeps up with the wanted one.
fn speed(view: &SessionView) -> (String, bool) {
    // There is no measured speed in the first second after a start or a pause.
    let measured = view.speed_achieved > 0.0;
    let keeps_up = !measured || view.speed_achieved >= 0.9 * view.speed_wanted;
    let speed = if measured && (view.speed_wanted.is_infinite() || !keeps_up) {
        factor((view.speed_achieved * 10.0).round() / 10.0)
    } else {
        factor(view.speed_wanted)
    };
    (speed, keeps_up)
}
