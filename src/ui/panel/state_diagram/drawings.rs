//! The drawings of the state machine: of the guide three, for panels of different sizes, and one of master.

use crate::telemetry::NavState::{Approaching, Arrived, Complete, Figure8, Holding, Idle, Landing, Orbiting};
use crate::telemetry::{FirmwareProfile, NavState};

use super::{Diagram, Edge, Node};

const HOLDS: &[NavState] = &[Holding, Orbiting, Figure8];
/// ARRIVED lasts for one update, and master has no name for it.
const APPROACHES: &[NavState] = &[Approaching, Arrived];

pub(crate) static FULL: Diagram = Diagram {
    width: 36,
    height: 11,
    profile: FirmwareProfile::Guide,
    aborted: None,
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

/// The states and the main transitions, for a narrow panel.
pub(crate) static COMPACT: Diagram = Diagram {
    width: 21,
    height: 10,
    profile: FirmwareProfile::Guide,
    aborted: None,
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

/// The states and the main transitions, for a low panel.
pub(crate) static LOW: Diagram = Diagram {
    width: 22,
    height: 7,
    profile: FirmwareProfile::Guide,
    aborted: None,
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

/// The states of master and the main transitions.
pub(crate) static MASTER: Diagram = Diagram {
    width: 22,
    height: 7,
    profile: FirmwareProfile::Master,
    aborted: Some((1, 6)),
    nodes: &[
        Node(Idle, 1, 0),
        Node(Approaching, 8, 0),
        Node(Holding, 8, 2),
        Node(Landing, 8, 4),
        Node(Complete, 10, 6),
    ],
    edges: &[
        Edge { from: &[Idle, Complete], to: &[Approaching], strokes: &[(6, 0, "►")] },
        Edge { from: APPROACHES, to: &[Approaching], strokes: &[(18, 0, "◄──┐"), (21, 1, "│")] },
        Edge { from: APPROACHES, to: HOLDS, strokes: &[(11, 1, "▼")] },
        Edge {
            from: APPROACHES,
            to: &[Landing],
            strokes: &[(7, 1, "╱"), (6, 2, "│"), (6, 3, "│"), (6, 4, "└►")],
        },
        Edge {
            from: APPROACHES,
            to: &[Complete],
            strokes: &[
                (18, 0, "◄──┐"),
                (21, 1, "│"),
                (21, 2, "┤"),
                (21, 3, "│"),
                (21, 4, "│"),
                (21, 5, "│"),
                (19, 6, "◄─┘"),
            ],
        },
        Edge {
            from: HOLDS,
            to: &[Approaching],
            strokes: &[(16, 2, "─────┤"), (21, 1, "│"), (18, 0, "◄──┐")],
        },
        Edge {
            from: HOLDS,
            to: &[Complete],
            strokes: &[(16, 2, "─────┤"), (21, 3, "│"), (21, 4, "│"), (21, 5, "│"), (19, 6, "◄─┘")],
        },
        Edge { from: HOLDS, to: &[Landing], strokes: &[(11, 3, "▼")] },
        Edge { from: &[Landing], to: &[Complete], strokes: &[(11, 5, "▼")] },
    ],
};
