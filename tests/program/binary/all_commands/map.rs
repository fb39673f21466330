//! The map and the edits on it.

use std::cmp::Ordering;

use super::seen::Seen::{Hides, Moves, Shows, Turns};
use super::walk::Group;
use super::walk::Step::{Act, Again, Close};

pub(super) const GROUP: Group = Group {
    name: "map",
    steps: &[
        Again("sim.pause", Shows("‖")),
        // Only the map: other panels show coordinates, too.
        Again("view.zoom", Hides("┌3 State")),
        Act("map.up", Moves("▼3 LAND", Ordering::Equal, Ordering::Greater)),
        Act("map.down", Moves("▼3 LAND", Ordering::Equal, Ordering::Less)),
        Act("map.left", Moves("▼3 LAND", Ordering::Greater, Ordering::Equal)),
        Act("map.right", Moves("▼3 LAND", Ordering::Less, Ordering::Equal)),
        Act("map.zoom-out", Moves("▼3 LAND", Ordering::Greater, Ordering::Greater)),
        Act("map.zoom-in", Moves("▼3 LAND", Ordering::Less, Ordering::Less)),
        Act("map.follow", Shows("1 Map — follows")),
        Act("map.fit", Hides("1 Map — follows")),
        Act("map.course-up", Shows("The course of the craft is up")),
        Again("map.course-up", Shows("North is up.")),
        Act("map.next", Shows("1 Map — 0 fits")),
        Act("map.past", Shows("will be hidden; there is none yet")),
        Again("map.past", Shows("will be shown; there is none yet")),
        Act("map.measure", Shows("Enter sets the first point")),
        Again("map.measure", Hides("Enter sets the first point")),
        Act("map.grid", Shows("40.46")),
        Again("map.grid", Hides("40.46")),
        Act("map.backdrop", Shows("Show a file under the plan")),
        Close(Some("Esc close"), Hides("Show a file under the plan")),
        Act("map.edit", Shows("1 Map — edit")),
        Act("map.previous", Turns("from WP0", "from WP3")),
        Act("map.pick", Shows("Enter put down")),
        Again("map.pick", Hides("Enter put down")),
        Act("map.insert", Shows("4 FLYOVER")),
        Act("map.delete", Hides("4 FLYOVER")),
        Again("map.edit", Hides("1 Map — edit")),
        Act("replay.previous", Shows("Only a file with recorded flights has others")),
        Act("replay.shift-earlier", Shows("There is no second flight to shift")),
    ],
};
