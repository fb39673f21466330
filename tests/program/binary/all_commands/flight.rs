//! A flight by hand.

use super::seen::Seen::{Hides, Shows};
use super::walk::Group;
use super::walk::Step::{Act, Again, Close, Wait};

pub(super) const GROUP: Group = Group {
    name: "flight",
    steps: &[
        Wait("The craft has no plan."),
        Act("flight.resume", Shows("The autopilot does not fly")),
        Act("rc.cut", Shows("RC CUT")),
        Again("rc.cut", Hides("RC CUT")),
        Again("plan.upload", Shows("Uploaded slow.toml: 2 waypoints.")),
        // The RC signal counts as recovered only after half a second of flight time.
        Wait("✓ Ready."),
        Act("flight.arm", Shows("● ARMED")),
        Act("flight.throttle", Shows("Armed, on the ground")),
        Act("flight.autopilot", Shows("ARMED AUTOPILOT")),
        Act("flight.hold", Shows("Holds here by command")),
        Again("flight.resume", Hides("Holds here by command")),
        Act("flight.go-to", Shows("Go now to")),
        Close(None, Hides("Go now to")),
        Act("forecast.look-ahead", Shows("look-ahead: ")),
        Again("forecast.look-ahead", Hides("look-ahead: ")),
        Act("forecast.what-if", Shows("What if, from this instant on")),
        Close(None, Hides("What if, from this instant on")),
        Act("flight.home", Shows("rth plan")),
        Again("flight.home", Hides("rth plan")),
        Act("app.quit", Shows("Quit?")),
        Close(Some("n stay"), Hides("Quit?")),
    ],
};
