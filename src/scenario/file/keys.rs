//! The keys of a scenario's tables.

/// Keys of the whole file.
pub(super) const FILE_KEYS: &[&str] = &[
    "format",
    "name",
    "description",
    "slow",
    "seeds",
    "time_limit_s",
    "timeout_s",
    "watch_s",
    "ends",
    "sample_hz",
    "plan",
    "craft",
    "air",
    "parameters",
    "allow",
    "vary",
    "campaign",
    "input",
    "measure",
    "expect",
    "case",
    "compare",
];

/// Keys of `[[case]]`.
pub(super) const CASE_KEYS: &[&str] = &[
    "name",
    "seeds",
    "time_limit_s",
    "timeout_s",
    "watch_s",
    "ends",
    "sample_hz",
    "plan",
    "craft",
    "air",
    "parameters",
    "allow",
    "input",
    "measure",
    "expect",
];

/// Keys of `[plan]`.
pub(super) const PLAN_KEYS: &[&str] = &["builtin", "file", "waypoints"];

/// Keys of `[craft]`.
pub(super) const CRAFT_KEYS: &[&str] = &[
    "home",
    "heading_deg",
    "airframe",
    "takeoff_m",
    "tolerance_m",
    "pilot",
    "profile",
    "settings",
    "settings_file",
    "lines",
    "attitude",
    "rate_hz",
    "mass_pct",
    "thrust_pct",
    "drag_pct",
    "inertia_pct",
    "battery_pct",
    "sticks",
];

/// The key of faults in `[air]` and `[vary]`.
pub(super) const OF_FAULTS: &str = "faults";

/// Keys of `[air]`.
pub(super) const AIR_KEYS: &[&str] = &["wind", "gust_mps", "turbulence", "noise", "world", OF_FAULTS];

/// Keys of `[vary]`.
pub(super) const VARY_KEYS: &[&str] = &[
    "wind",
    "gust_mps",
    "turbulence",
    "noise",
    "world",
    "airframe",
    "takeoff_m",
    "heading_deg",
    "rate_hz",
    "mass_pct",
    "thrust_pct",
    "drag_pct",
    "inertia_pct",
    "battery_pct",
    "settings",
    OF_FAULTS,
];

/// Keys of `[campaign]`.
pub(super) const CAMPAIGN_KEYS: &[&str] = &["design", "flights", "seed", "levels", "expect"];

/// Keys of `[allow]`.
pub(super) const ALLOW_KEYS: &[&str] = &["horizontal_m", "vertical_m", "speed_mps", "angle_deg"];

/// Keys of `[[input]]`.
pub(super) const INPUT_KEYS: &[&str] = &["name", "cases", "at", "each", "do"];

/// Keys of `[[measure]]`.
pub(super) const MEASURE_KEYS: &[&str] =
    &["name", "cases", "from", "until", "mean", "rms", "max", "min", "at", "value", "time", "better"];

/// Keys of `[[expect]]`.
pub(super) const EXPECT_KEYS: &[&str] = &[
    "name",
    "cases",
    "firmware",
    "exact",
    "from",
    "until",
    "result",
    "states",
    "event",
    "count",
    "within",
    "with",
    "no_event",
    "always",
    "never",
    "eventually",
    "mostly",
    "share",
    "mean",
    "rms",
    "max",
    "min",
    "at",
    "that",
];

/// Keys of `[[compare]]`.
pub(super) const COMPARE_KEYS: &[&str] = &["name", "firmware", "that"];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_reference_has_a_row_for_each_table_of_a_file() {
        let tables = [
            ("the file", FILE_KEYS),
            ("[plan]", PLAN_KEYS),
            ("[craft]", CRAFT_KEYS),
            ("[air]", AIR_KEYS),
            ("[vary]", VARY_KEYS),
            ("[campaign]", CAMPAIGN_KEYS),
            ("[allow]", ALLOW_KEYS),
            ("[[input]]", INPUT_KEYS),
            ("[[measure]]", MEASURE_KEYS),
            ("[[expect]]", EXPECT_KEYS),
            ("[[case]]", CASE_KEYS),
            ("[[compare]]", COMPARE_KEYS),
        ];
        let rows: String =
            tables.iter().map(|(table, keys)| format!("| {table} | `{}` |\n", keys.join("` `"))).collect();
        let marked = format!("<!-- KEYS -->\n| table | keys |\n| --- | --- |\n{rows}<!-- end -->");
        let page = include_str!("../../../docs/scenarios.md");
        assert!(page.contains(&marked), "replace this table in docs/scenarios.md by this one:\n{marked}");
    }
}
