//! The time: its speed, its steps, and the instants of the flight so far.

use std::cmp::Ordering;

use super::seen::Seen::{Clock, Hides, Shows};
use super::walk::Group;
use super::walk::Step::{Act, Again, Wait};

pub(super) const GROUP: Group = Group {
    name: "time",
    steps: &[
        Wait("The craft has no plan."),
        Act("sim.faster", Shows("2×")),
        Act("sim.slower", Hides("2×")),
        Again("sim.faster", Shows("2×")),
        Act("sim.real-time", Hides("2×")),
        Act("flight.fly", Shows("● ARMED")),
        // The climb takes a while.
        Again("sim.faster", Shows("2×")),
        Again("sim.faster", Shows("4×")),
        Again("sim.faster", Shows("8×")),
        Wait("◆ APPROACHING"),
        Act("sim.pause", Shows("‖")),
        Act("sim.step", Clock(Ordering::Greater)),
        Act("sim.tick", Clock(Ordering::Greater)),
        Act("time.earlier", Shows("REWOUND")),
        Act("time.later", Clock(Ordering::Greater)),
        Act("time.state-back", Clock(Ordering::Less)),
        Act("time.state", Clock(Ordering::Greater)),
        Act("time.event-back", Clock(Ordering::Less)),
        Act("time.event", Clock(Ordering::Greater)),
        Again("time.state-back", Clock(Ordering::Less)),
        Act("time.end", Hides("REWOUND")),
        Again("time.state-back", Shows("REWOUND")),
        Act("time.fly-on", Hides("REWOUND")),
        Act("craft.reset", Shows("The flight would end")),
        Act("craft.allow-changes", Shows("changes need no permission")),
    ],
};
