//! The waypoint state machine as a drawing: states are words, transitions are strokes.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::telemetry::{FirmwareProfile, NavState, NavTelemetry, TransitionReason};
use crate::ui::drawing;
use crate::ui::theme::{Role, Theme};

mod drawings;

pub(crate) use drawings::{COMPACT, FULL, LOW, MASTER};

/// A state at a column and row.
struct Node(NavState, u16, u16);

/// The strokes (column, row, text) of all transitions from one of `from` to one of `to`.
struct Edge {
    from: &'static [NavState],
    to: &'static [NavState],
    strokes: &'static [(u16, u16, &'static str)],
}

/// A drawing of the machine.
pub(crate) struct Diagram {
    pub width: u16,
    pub height: u16,
    /// The profile whose names the states have.
    profile: FirmwareProfile,
    /// The place of a mission that was given up, if it has a name.
    aborted: Option<(u16, u16)>,
    nodes: &'static [Node],
    edges: &'static [Edge],
}

impl Diagram {
    /// Draws the machine at the top left of the area, with the state of `nav` and the strokes of `last` lit.
    pub(crate) fn draw(
        &self,
        theme: &Theme,
        nav: &NavTelemetry,
        last: Option<(NavState, NavState)>,
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let mut put = |column: u16, row: u16, text: &str, style: Style| {
            if row < area.height && column < area.width {
                let room = usize::from(area.width - column);
                drawing::text_within(buffer, area.x + column, area.y + row, text, room, style);
            }
        };
        let lit =
            |edge: &Edge| last.is_some_and(|(from, to)| edge.from.contains(&from) && edge.to.contains(&to));
        // Lit strokes last, because some strokes are shared.
        for pass in [false, true] {
            for edge in self.edges.iter().filter(|edge| lit(edge) == pass) {
                for &(column, row, text) in edge.strokes {
                    put(column, row, text, theme.style(if pass { Role::Warn } else { Role::Dim }));
                }
            }
        }
        let is_aborted = matches!(nav.reason, Some(TransitionReason::GivenUp(_)));
        let active = self.profile.state_word(nav.state, is_aborted);
        let states = self
            .nodes
            .iter()
            .map(|&Node(state, column, row)| (self.profile.state_word(state, false), column, row));
        let aborted =
            self.aborted.map(|(column, row)| (self.profile.state_word(NavState::Idle, true), column, row));
        for (name, column, row) in states.chain(aborted) {
            if name == active {
                // The ends mark the state on terminals without reverse video.
                let ends = Style::new().fg(theme.colour(Role::Active));
                put(column.saturating_sub(1), row, "▐", ends);
                put(column, row, name, theme.style(Role::Active));
                put(column + name.len() as u16, row, "▌", ends);
            } else {
                put(column, row, name, theme.style(Role::Text));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::NavState::{
        Approaching, Arrived, Complete, Figure8, Holding, Idle, Landing, Orbiting,
    };
    use strum::IntoEnumIterator as _;

    fn text(diagram: &Diagram, active: NavState, last: Option<(NavState, NavState)>) -> Vec<String> {
        let area = Rect::new(0, 0, diagram.width, diagram.height);
        let mut buffer = Buffer::empty(area);
        let nav = NavTelemetry { state: active, ..NavTelemetry::default() };
        diagram.draw(&Theme::default(), &nav, last, area, &mut buffer);
        (0..area.height)
            .map(|y| {
                (0..area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>().trim_end().to_owned()
            })
            .collect()
    }

    #[test]
    fn every_state_is_in_both_drawings_in_every_activity() {
        for diagram in [&FULL, &COMPACT, &LOW] {
            for active in NavState::iter() {
                let drawing = text(diagram, active, None).join("\n");
                for state in NavState::iter() {
                    assert!(drawing.contains(&state.to_string()), "{state} missing in\n{drawing}");
                }
            }
        }
    }

    #[test]
    fn every_way_of_a_mission_has_a_stroke_in_the_full_drawing() {
        let ways = [
            (Idle, Approaching),
            (Approaching, Arrived),
            (Arrived, Approaching),
            (Arrived, Holding),
            (Arrived, Landing),
            (Arrived, Complete),
            (Holding, Orbiting),
            (Holding, Figure8),
            (Holding, Landing),
            (Holding, Approaching),
            (Holding, Complete),
            (Orbiting, Approaching),
            (Orbiting, Complete),
            (Figure8, Approaching),
            (Figure8, Complete),
            (Landing, Complete),
        ];
        for (from, to) in ways {
            let drawn = FULL.edges.iter().any(|edge| edge.from.contains(&from) && edge.to.contains(&to));
            assert!(drawn, "{from} to {to}");
        }
    }

    #[test]
    fn the_full_drawing() {
        let expected = [
            "                IDLE",
            "                 ▼",
            "  ┌────────▐APPROACHING▌◄─────────┐",
            "  │              ▼                │",
            "  │           ARRIVED ────────────┤",
            "  │          ╱        ╲           │",
            "  ├──── HOLDING ──►  LANDING      │",
            "  │      ╱     ╲        │         │",
            "  │  ORBITING  FIGURE8  │         │",
            "  │     │         │     ▼         │",
            "  └─────┴─────────┴─► COMPLETE ◄──┘",
        ];
        assert_eq!(text(&FULL, Approaching, None), expected);
    }

    #[test]
    fn the_low_drawing() {
        let expected = [
            " IDLE ► APPROACHING ◄┐",
            "           ▼         │",
            "        ARRIVED ─────┤",
            "      ╱       ╲      │",
            " HOLDING ► LANDING   │",
            "▐ORBITING▌    ▼      │",
            " FIGURE8  COMPLETE ◄─┘",
        ];
        assert_eq!(text(&LOW, Orbiting, None), expected);
    }

    #[test]
    fn the_drawing_of_master() {
        let expected = [
            " IDLE ► TARGETING ◄──┐",
            "       ╱   ▼         │",
            "      │▐HOLDING▌─────┤",
            "      │    ▼         │",
            "      └►LANDING      │",
            "           ▼         │",
            " ABORTED  COMPLETE ◄─┘",
        ];
        assert_eq!(text(&MASTER, Orbiting, None), expected);
    }

    #[test]
    fn the_compact_drawing() {
        let expected = [
            " IDLE",
            "    ▼",
            " APPROACHING  ◄─────┐",
            "    ▼               │",
            " ARRIVED ───────────┤",
            "    ▼    ╲          │",
            " HOLDING ►▐LANDING▌ │",
            "    ▼         ▼     │",
            " ORBITING  COMPLETE ┘",
            " FIGURE8",
        ];
        assert_eq!(text(&COMPACT, Landing, None), expected);
    }
}
