//! 4 RC: the sixteen channels as bars, with the ranges that switch modes on.

use crossterm::event::MouseEvent;
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{Content, Hint};
use crate::signals::{RC_CHANNELS, RcSource};
use crate::telemetry::snapshot::{CraftView, ModeRange};
use crate::ui::acts::transmitter;
use crate::ui::drawing;
use crate::ui::formatting::cut;
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::message::{Change, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::shared::Shared;
use crate::ui::theme::Role;

use crate::ui::area::row;

/// The width of name and value before the bar.
const LABEL: u16 = 17;
/// The channels of the sticks.
const STICKS: [&str; 4] = ["ROLL", "PITCH", "THROTTLE", "YAW"];
/// The ends of the bars, µs.
const SPAN_US: (f64, f64) = (900.0, 2100.0);

/// The state of the RC panel.
#[derive(Debug, Default)]
pub struct RcPanel {
    /// The selected channel.
    pub channel: usize,
}

impl Content for RcPanel {
    /// Returns the title with the source of the channels and the age of the newest frame.
    fn title(&self, state: &Shared) -> String {
        let now_s = state.view.vehicle.time.as_secs_f64();
        let recording = state.stick_recording.shown(now_s);
        let name = recording.map_or_else(
            || state.panel_title(Panel::Rc).to_owned(),
            |doing| format!("{} {doing}", state.panel_title(Panel::Rc)),
        );
        if state.view.replay.is_some() {
            return format!("{name} — recorded");
        }
        let craft = &state.view.vehicle.craft;
        let ours = !matches!(craft.rc_source, Some(RcSource::Udp | RcSource::Msp));
        if state.view.rc_cut && ours {
            return format!("{name} — CUT, {} restores it", state.key(Action::CutRc));
        }
        let age = match craft.rc_age_s {
            Some(age) if age < 1.0 => format!("{:.0} ms", age * 1000.0),
            Some(age) => format!("{age:.1} s"),
            None => "—".to_owned(),
        };
        let source = match craft.rc_source {
            None => return format!("{name} — no frames"),
            Some(_) if craft.rc_link == Some(false) => return format!("{name} — LOST {age}"),
            Some(RcSource::Sticks) if state.view.pilot.is_some() => "pilot",
            Some(RcSource::Sticks) => "keys",
            Some(RcSource::Udp) => "udp",
            Some(RcSource::Msp) => "msp",
        };
        format!("{name} — {source}, {age}")
    }

    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(self.channel, state, area, buffer);
        None
    }

    fn in_words(&self, state: &Shared) -> Vec<String> {
        (0..RC_CHANNELS).map(|channel| channel_in_words(self.channel, state, channel)).collect()
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        vec![
            (&[Action::Panel(PanelAction::ChannelUp), Action::Panel(PanelAction::ChannelDown)], "channel"),
            (&[Action::Panel(PanelAction::Lower), Action::Panel(PanelAction::Raise)], "value"),
        ]
    }

    fn act(&mut self, state: &Shared, action: PanelAction) -> Vec<Request> {
        let nudged = |by_us| Change::Channel(self.channel, transmitter::nudged(state, self.channel, by_us));
        let change = match action {
            PanelAction::Lower => nudged(-10),
            PanelAction::Raise => nudged(10),
            PanelAction::LowerMuch => nudged(-100),
            PanelAction::RaiseMuch => nudged(100),
            PanelAction::Flip => Change::Channel(self.channel, transmitter::flipped(state, self.channel)),
            PanelAction::Record => Change::Record,
            PanelAction::Play => Change::Play,
            PanelAction::ChannelUp => {
                self.channel = self.channel.saturating_sub(1);
                return Vec::new();
            }
            PanelAction::ChannelDown => {
                self.channel = (self.channel + 1).min(RC_CHANNELS - 1);
                return Vec::new();
            }
            _ => return Vec::new(),
        };
        vec![change.into()]
    }

    fn press(&mut self, _: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        let Some((channel, us)) = channel_at(area, self.channel, (event.column, event.row)) else {
            return Vec::new();
        };
        self.channel = channel;
        us.map(|us| Change::Channel(channel, us).into()).into_iter().collect()
    }

    /// Moves the pressed slider, even if the mouse slips to the one below.
    fn drag(&mut self, _: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        let us = value_at(area, self.channel, event.column);
        us.map(|us| Change::Channel(self.channel, us).into()).into_iter().collect()
    }
}

/// Returns the area of each visible channel: one column, or two if the panel is low and wide, else scrolled so that the
/// selected one is visible.
fn grid(area: Rect, selected: usize) -> Vec<(usize, Rect)> {
    let rows = usize::from(area.height);
    if rows == 0 {
        return Vec::new();
    }
    let half = area.width / 2;
    if (RC_CHANNELS / 2..RC_CHANNELS).contains(&rows) && half > LABEL + 8 {
        let per = RC_CHANNELS.div_ceil(2);
        return (0..RC_CHANNELS)
            .map(|channel| {
                let x = area.x + (channel / per) as u16 * half;
                (channel, Rect::new(x, area.y + (channel % per) as u16, half - 1, 1))
            })
            .collect();
    }
    let first = (selected + 1).saturating_sub(rows).min(RC_CHANNELS.saturating_sub(rows));
    (first..RC_CHANNELS)
        .take(rows)
        .enumerate()
        .map(|(at, channel)| (channel, Rect::new(area.x, area.y + at as u16, area.width, 1)))
        .collect()
}

/// Returns the bar of a channel's row.
fn bar(row: Rect) -> Rect {
    let label = LABEL.min(row.width);
    Rect { x: row.x + label, width: row.width - label, ..row }
}

/// Returns the channel at a screen cell, and the value there if the cell is on the bar.
fn channel_at(area: Rect, selected: usize, (column, line): (u16, u16)) -> Option<(usize, Option<u16>)> {
    let hit = |(_, place): &(usize, Rect)| place.contains((column, line).into());
    let (channel, place) = grid(area, selected).into_iter().find(hit)?;
    let on_bar = column >= bar(place).x;
    Some((channel, value_on(bar(place), column).filter(|_| on_bar)))
}

/// Returns the value of a channel's slider at a screen column, limited to the ends of the bar; `None` if the channel is
/// not visible.
fn value_at(area: Rect, channel: usize, column: u16) -> Option<u16> {
    let (_, place) = grid(area, channel).into_iter().find(|(there, _)| *there == channel)?;
    value_on(bar(place), column)
}

fn value_on(bar: Rect, column: u16) -> Option<u16> {
    let last = bar.width.checked_sub(1).filter(|last| *last > 0)?;
    let share = f64::from(column.saturating_sub(bar.x).min(last)) / f64::from(last);
    let us = SPAN_US.0 + share * (SPAN_US.1 - SPAN_US.0);
    Some((us / 10.0).round() as u16 * 10)
}

/// Returns the column of a value on a bar.
fn column_of(bar: Rect, us: u16) -> u16 {
    let share = ((f64::from(us) - SPAN_US.0) / (SPAN_US.1 - SPAN_US.0)).clamp(0.0, 1.0);
    bar.x + (share * f64::from(bar.width.saturating_sub(1))).round() as u16
}

/// Returns the mode ranges on a channel.
fn ranges(craft: &CraftView, channel: usize) -> impl Iterator<Item = &ModeRange> {
    craft
        .mode_ranges()
        .iter()
        .filter(move |range| usize::from(range.channel) == channel && range.start_us < range.end_us)
}

/// Returns the name of a channel without its modes.
fn plain_name(channel: usize) -> String {
    match STICKS.get(channel) {
        Some(stick) => (*stick).to_owned(),
        None => format!("AUX{}", channel + 1 - STICKS.len()),
    }
}

/// Returns the name of a channel: the stick, or its first mode and the number of further ones.
fn name(craft: &CraftView, channel: usize) -> String {
    let mut names = ranges(craft, channel).map(|range| <&'static str>::from(range.mode_box));
    match (names.next(), names.count()) {
        _ if channel < STICKS.len() => plain_name(channel),
        (None, _) => plain_name(channel),
        (Some(first), 0) => first.to_owned(),
        (Some(first), more) => format!("{} +{more}", cut(first, 7)),
    }
}

/// Returns a channel with its value, and its modes with the values that switch them on.
fn channel_in_words(selected_channel: usize, state: &Shared, channel: usize) -> String {
    let craft = &state.view.vehicle.craft;
    let mark = if state.focus == Panel::Rc && channel == selected_channel { "▸ " } else { "" };
    let us = craft.channels.and_then(|channels| channels.get(channel).copied()).filter(|us| *us > 0);
    let value = us.map_or_else(|| "not known".to_owned(), |us| us.to_string());
    let modes = ranges(craft, channel).map(|range| {
        let is_on = us.is_some_and(|us| (range.start_us..range.end_us).contains(&us));
        let name: &'static str = range.mode_box.into();
        format!(
            "; {name} {}, on from {} to {}",
            if is_on { "on" } else { "off" },
            range.start_us,
            range.end_us
        )
    });
    format!("{mark}{}: {value}{}.", plain_name(channel), modes.collect::<String>())
}

fn draw(selected_channel: usize, state: &Shared, area: Rect, buffer: &mut Buffer) {
    let theme = &state.theme;
    let craft = &state.view.vehicle.craft;
    let focused = state.focus == Panel::Rc;
    for (channel, place) in grid(area, selected_channel) {
        let us = craft.channels.and_then(|channels| channels.get(channel).copied()).unwrap_or_default();
        let known = us > 0;
        let selected = focused && channel == selected_channel;
        let value = if known { format!("{us:>4}") } else { "   —".to_owned() };
        let mark = if selected { '▸' } else { ' ' };
        let on = ranges(craft, channel).any(|range| (range.start_us..range.end_us).contains(&us));
        let role = match (selected, on) {
            (true, _) => Role::Focus,
            (false, true) => Role::Ok,
            (false, false) => Role::Text,
        };
        row(buffer, place, 0, theme, role, &format!("{mark}{:<10}{value} ", cut(&name(craft, channel), 10)));
        let bar = bar(place);
        if bar.width < 4 {
            continue;
        }
        row(buffer, bar, 0, theme, Role::Dim, &"─".repeat(usize::from(bar.width)));
        let put = |buffer: &mut Buffer, column: u16, symbol: &str, role: Role| {
            if let Some(cell) = buffer.cell_mut((column, bar.y)) {
                cell.set_symbol(symbol).set_style(theme.style(role));
            }
        };
        put(buffer, column_of(bar, 1500), "┼", Role::Dim);
        let several = ranges(craft, channel).count() > 1;
        for range in ranges(craft, channel) {
            let active = (range.start_us..range.end_us).contains(&us);
            let role = if active { Role::Ok } else { Role::Title };
            let (from, to) = (column_of(bar, range.start_us), column_of(bar, range.end_us));
            for column in from..=to {
                put(buffer, column, "░", role);
            }
            let name: &'static str = range.mode_box.into();
            if several && usize::from(to - from) > name.len() {
                drawing::text(buffer, from + 1, bar.y, name, theme.style(role));
            }
        }
        if known {
            put(buffer, column_of(bar, us), "█", if selected { Role::Focus } else { Role::Text });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_click_on_the_bar_gives_the_value_drawn_there() {
        let area = Rect::new(5, 2, 60, 16);
        for us in [1000, 1500, 2000] {
            let place = grid(area, 0)[7].1;
            let column = column_of(bar(place), us);
            let (channel, value) = channel_at(area, 0, (column, place.y)).expect("on the bar");
            assert_eq!(channel, 7);
            assert!(value.is_some_and(|value| value.abs_diff(us) <= 20), "{us}: {value:?}");
        }
        assert_eq!(channel_at(area, 0, (6, 3)), Some((1, None)));
        assert_eq!(channel_at(area, 0, (0, 0)), None);
    }

    #[test]
    fn the_selected_channel_is_always_visible() {
        for height in 0..20 {
            for selected in 0..RC_CHANNELS {
                let grid = grid(Rect::new(0, 0, 40, height), selected);
                assert!(height == 0 || grid.iter().any(|(channel, _)| *channel == selected));
            }
        }
    }
}
