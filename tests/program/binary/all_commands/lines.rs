//! The commands with a value.

use super::seen::Seen::{Hides, Paints, Shows};
use super::walk::Group;
use super::walk::Step::{Again, Line};

pub(super) const GROUP: Group = Group {
    name: "lines",
    steps: &[
        Again("sim.pause", Shows("‖")),
        Line("set", "ap_max_angle=33", Shows("ap_max_angle set to 33")),
        Line("profile", "master", Shows("ap_profile set to MASTER")),
        Line("cli", "version", Shows("Betaflight")),
        Again("app.back", Hides("▸5 CLI")),
        Line("save", "mine.toml", Shows("Saved mine.toml")),
        Line("open", "slow.toml", Shows("slow")),
        Again("view.settings", Shows("─ Changed")),
        Line("settings-file", "craft.txt", Shows("in craft.txt")),
        Again("view.map", Shows("▸1 Map")),
        Line("scenario", "mine-flight.toml", Shows("mine-flight.toml")),
        Line("record", "mine.bdrec", Shows("mine.bdrec")),
        Line("log", "mine.bbl", Shows("No log was written: ")),
        Line("backdrop", "off", Shows("Nothing is under the plan.")),
        Line("go-to", "1", Shows("The autopilot does not fly")),
        Line("what-if", "gps-loss", Shows("GPS lost here, flown from home: ")),
        Line("where", "rx-loss,3", Shows("rx-loss,3 at every second")),
        Again("forecast.where", Hides("rx-loss,3 at every second")),
        Line("speed", "4", Shows("goes on at 4×")),
        Line("world", "battery_sag=off", Shows("World: battery_sag=off.")),
        Line("layout", "editing", Shows("▸2 Plan")),
        Line("units", "imperial", Shows(" ft ")),
        Line("wind", "5@270", Shows("World: wind=5@270.")),
        Line("gust", "3", Shows("World: gust=3.")),
        Line("gust-now", "5@90", Shows("World: gust-now=5@90.")),
        Line("turbulence", "light", Shows("World: turbulence=light.")),
        Line("noise", "none", Shows("World: noise=none.")),
        Line("gps-rate", "5", Shows("World: gps-rate=5.")),
        Line("fault", "gps-loss", Shows("World: fault=gps-loss.")),
        Line("end", "all", Shows("World: end=all.")),
        Line("theme", "light", Paints(250, 250, 247)),
        Line("charset", "ascii", Hides("│")),
    ],
};
