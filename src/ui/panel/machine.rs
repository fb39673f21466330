//! The waypoint state machine as a drawing: states as words, transitions as strokes.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::telemetry::NavState;
use crate::telemetry::NavState::{Approaching, Arrived, Complete, Figure8, Holding, Idle, Landing, Orbiting};
use crate::ui::theme::{Role, Theme};

/// A word at a column and row.
struct Node(NavState, u16, u16);

/// Strokes (column, row, text) of the transitions from some states to some states.
struct Edge {
    from: &'static [NavState],
    to: &'static [NavState],
    strokes: &'static [(u16, u16, &'static str)],
}

/// A drawing of the machine.
pub(crate) struct Diagram {
    /// Columns it needs.
    pub width: u16,
    /// Rows it needs.
    pub height: u16,
    nodes: &'static [Node],
    edges: &'static [Edge],
}

const HOLDS: &[NavState] = &[Holding, Orbiting, Figure8];

/// All transitions drawn.
pub(crate) static FULL: Diagram = Diagram {
    width: 36,
    height: 11,
    nodes: &[
        Node(Idle, 16, 0),
        Node(Approaching, 12, 2),
        Node(Arrived, 14, 4),
        Node(Holding, 8, 6),
        Node(Landing, 21, 6),
        Node(Orbiting, 5, 8),
        Node(Figure8, 15, 8),
        Node(Complete, 22, 10),
    ],
    edges: &[
        Edge { from: &[Idle, Complete], to: &[Approaching], strokes: &[(17, 1, "▼")] },
        Edge { from: &[Approaching], to: &[Arrived], strokes: &[(17, 3, "▼")] },
        Edge { from: &[Arrived], to: &[Holding], strokes: &[(13, 5, "╱")] },
        Edge { from: &[Arrived], to: &[Landing], strokes: &[(22, 5, "╲")] },
        Edge {
            from: &[Arrived],
            to: &[Complete],
            strokes: &[
                (22, 4, "────────────┤"),
                (34, 5, "│"),
                (34, 6, "│"),
                (34, 7, "│"),
                (34, 8, "│"),
                (34, 9, "│"),
                (31, 10, "◄──┘"),
            ],
        },
        Edge {
            from: &[Arrived],
            to: &[Approaching],
            strokes: &[(22, 4, "────────────┤"), (34, 3, "│"), (24, 2, "◄─────────┐")],
        },
        Edge { from: &[Holding], to: &[Landing], strokes: &[(16, 6, "──►")] },
        Edge { from: &[Holding], to: &[Orbiting], strokes: &[(9, 7, "╱")] },
        Edge { from: &[Holding], to: &[Figure8], strokes: &[(15, 7, "╲")] },
        Edge {
            from: &[Landing], to: &[Complete], strokes: &[(24, 7, "│"), (24, 8, "│"), (24, 9, "▼")]
        },
        Edge { from: &[Orbiting], to: &[Complete, Approaching], strokes: &[(8, 9, "│")] },
        Edge { from: &[Figure8], to: &[Complete, Approaching], strokes: &[(18, 9, "│")] },
        Edge {
            from: HOLDS, to: &[Complete], strokes: &[(3, 10, "─────┴─────────┴─►")]
        },
        Edge {
            from: HOLDS,
            to: &[Approaching],
            strokes: &[
                (2, 2, "┌────────►"),
                (2, 3, "│"),
                (2, 4, "│"),
                (2, 5, "│"),
                (2, 7, "│"),
                (2, 8, "│"),
                (2, 9, "│"),
                (2, 10, "└"),
            ],
        },
        Edge { from: &[Holding], to: &[Complete, Approaching], strokes: &[(2, 6, "├────")] },
    ],
};

/// The states and the main ways, for a narrow panel.
pub(crate) static COMPACT: Diagram = Diagram {
    width: 21,
    height: 10,
    nodes: &[
        Node(Idle, 1, 0),
        Node(Approaching, 1, 2),
        Node(Arrived, 1, 4),
        Node(Holding, 1, 6),
        Node(Landing, 11, 6),
        Node(Orbiting, 1, 8),
        Node(Figure8, 1, 9),
        Node(Complete, 11, 8),
    ],
    edges: &[
        Edge { from: &[Idle, Complete], to: &[Approaching], strokes: &[(4, 1, "▼")] },
        Edge { from: &[Approaching], to: &[Arrived], strokes: &[(4, 3, "▼")] },
        Edge { from: &[Arrived], to: &[Holding], strokes: &[(4, 5, "▼")] },
        Edge { from: &[Arrived], to: &[Landing], strokes: &[(9, 5, "╲")] },
        Edge {
            from: &[Arrived, Holding, Orbiting, Figure8],
            to: &[Complete],
            strokes: &[(9, 4, "───────────┤"), (20, 5, "│"), (20, 6, "│"), (20, 7, "│"), (20, 8, "┘")],
        },
        Edge {
            from: &[Arrived, Holding, Orbiting, Figure8],
            to: &[Approaching],
            strokes: &[(9, 4, "───────────┤"), (20, 3, "│"), (14, 2, "◄─────┐")],
        },
        Edge { from: &[Holding], to: &[Landing], strokes: &[(9, 6, "►")] },
        Edge { from: &[Holding], to: &[Orbiting, Figure8], strokes: &[(4, 7, "▼")] },
        Edge { from: &[Landing], to: &[Complete], strokes: &[(14, 7, "▼")] },
    ],
};

/// The states and the main ways, for a low panel.
pub(crate) static LOW: Diagram = Diagram {
    width: 22,
    height: 7,
    nodes: &[
        Node(Idle, 1, 0),
        Node(Approaching, 8, 0),
        Node(Arrived, 8, 2),
        Node(Holding, 1, 4),
        Node(Landing, 11, 4),
        Node(Orbiting, 1, 5),
        Node(Figure8, 1, 6),
        Node(Complete, 10, 6),
    ],
    edges: &[
        Edge { from: &[Idle, Complete], to: &[Approaching], strokes: &[(6, 0, "►")] },
        Edge { from: &[Approaching], to: &[Arrived], strokes: &[(11, 1, "▼")] },
        Edge { from: &[Arrived], to: &[Holding], strokes: &[(6, 3, "╱")] },
        Edge { from: &[Arrived], to: &[Landing], strokes: &[(14, 3, "╲")] },
        Edge {
            from: &[Arrived, Holding, Orbiting, Figure8],
            to: &[Complete],
            strokes: &[(16, 2, "─────┤"), (21, 3, "│"), (21, 4, "│"), (21, 5, "│"), (19, 6, "◄─┘")],
        },
        Edge {
            from: &[Arrived, Holding, Orbiting, Figure8],
            to: &[Approaching],
            strokes: &[(16, 2, "─────┤"), (21, 1, "│"), (20, 0, "◄┐")],
        },
        Edge { from: &[Holding], to: &[Landing], strokes: &[(9, 4, "►")] },
        Edge { from: &[Landing], to: &[Complete], strokes: &[(14, 5, "▼")] },
    ],
};

impl Diagram {
    /// Draws the machine at the top left of the area: `active` lit, and the strokes of `last` if given.
    pub(crate) fn draw(
        &self,
        theme: &Theme,
        active: NavState,
        last: Option<(NavState, NavState)>,
        area: Rect,
        buffer: &mut Buffer,
    ) {
        let mut put = |column: u16, row: u16, text: &str, style: Style| {
            if row < area.height && column < area.width {
                let room = usize::from(area.width - column);
                buffer.set_stringn(area.x + column, area.y + row, text, room, style);
            }
        };
        let lit =
            |edge: &Edge| last.is_some_and(|(from, to)| edge.from.contains(&from) && edge.to.contains(&to));
        // Lit strokes last: some are shared.
        for pass in [false, true] {
            for edge in self.edges.iter().filter(|edge| lit(edge) == pass) {
                for &(column, row, text) in edge.strokes {
                    put(column, row, text, theme.style(if pass { Role::Warn } else { Role::Dim }));
                }
            }
        }
        for &Node(state, column, row) in self.nodes {
            let name: &'static str = state.into();
            if state == active {
                // The ends show the state where a terminal shows no reverse.
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
    use strum::IntoEnumIterator as _;

    fn text(diagram: &Diagram, active: NavState, last: Option<(NavState, NavState)>) -> Vec<String> {
        let area = Rect::new(0, 0, diagram.width, diagram.height);
        let mut buffer = Buffer::empty(area);
        diagram.draw(&Theme::default(), active, last, area, &mut buffer);
        (0..area.height)
            .map(|y| {
                (0..area.width).map(|x| buffer[(x, y)].symbol()).collect::<String>().trim_end().to_owned()
            })
            .collect()
    }

    #[test]
    fn every_state_stands_in_both_drawings_whoever_is_active() {
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
