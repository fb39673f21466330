//! The panels as a whole, the windows, and what is written.

use super::seen::Seen::{Hides, Shows};
use super::walk::Group;
use super::walk::Step::{Act, Again, Close};

pub(super) const GROUP: Group = Group {
    name: "screen",
    steps: &[
        Again("sim.pause", Shows("‖")),
        Act("view.next", Hides("▸1 Map")),
        Act("view.previous", Shows("▸1 Map")),
        Act("view.zoom", Hides("┌3 State")),
        Again("view.zoom", Shows("┌3 State")),
        Act("view.cli", Shows("▸5 CLI")),
        Again("app.back", Hides("▸5 CLI")),
        Again("view.plan", Shows("▸2 Plan")),
        Act("view.map", Shows("▸1 Map")),
        Act("flight.scenario", Shows("The flight is written as square-flight-1.toml")),
        Act("flight.record", Shows("recorded as square-flight-1.flight")),
        Act("flight.log", Shows("No log was written: ")),
        Act("app.flights", Shows("Recorded flights")),
        Close(Some("Esc close"), Hides("Recorded flights")),
        Act("view.layout", Shows(" LAYOUT ")),
        Close(Some("Esc done"), Hides(" LAYOUT ")),
        Act("app.tutorial", Shows("▸ 1/5")),
        Again("app.tutorial", Hides("▸ 1/5")),
        Act("app.help", Shows("Keys — ")),
        Close(None, Hides("Keys — ")),
        Act("app.command", Shows("Enter runs Tab completes")),
        Close(None, Hides("Enter runs Tab completes")),
        Act("app.palette", Shows("Commands — Enter runs")),
        Close(None, Hides("Commands — Enter runs")),
        Act("forecast.where", Shows("gps-loss,6 at every second")),
        Again("forecast.where", Hides("gps-loss,6 at every second")),
        Act("forecast.go", Shows("go or no-go: ")),
        Again("app.back", Hides("go or no-go: ")),
        Act("app.redraw", Shows("The screen is drawn again.")),
        Act("app.suspend", Shows("no shell that could continue")),
        Act("app.cancel", Shows("Ctrl-C again within 2 s quits")),
    ],
};
