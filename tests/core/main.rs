//! The core alone: autopilot, firmware, world, whole flights, missions, logs, scenarios.

/// Makes two tests of a law that takes every `n`-th of its cases: one with few of them, and a search with all of them.
macro_rules! part_and_search {
    ($law:ident, every $n:literal, $part:ident, $search:ident) => {
        #[test]
        fn $part() {
            $law($n);
        }

        #[test]
        #[ignore = "search: all cases of the test before it"]
        fn $search() {
            $law(1);
        }
    };
}

mod autopilot;
mod firmware;
mod flights;
mod flown;
mod kinematic_craft;
mod log_writer;
mod missions;
mod scenarios;
mod sim;
