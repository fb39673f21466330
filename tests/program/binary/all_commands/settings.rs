//! The settings of the craft.

use super::seen::Seen::{Hides, Shows, Turns};
use super::walk::Group;
use super::walk::Step::{Act, Again, Close, Type};

pub(super) const GROUP: Group = Group {
    name: "settings",
    steps: &[
        Again("sim.pause", Shows("‖")),
        Act("view.settings", Shows("─ gyro_hardware_lpf ─")),
        Act("list.down", Turns("─ gyro_hardware_lpf ─", "─ gyro_lpf1_type ─")),
        Act("list.up", Turns("─ gyro_lpf1_type ─", "─ gyro_hardware_lpf ─")),
        Act("list.page-down", Hides("─ gyro_hardware_lpf ─")),
        Act("list.page-up", Shows("─ gyro_hardware_lpf ─")),
        Act("list.bottom", Hides("─ gyro_hardware_lpf ─")),
        Act("list.top", Shows("─ gyro_hardware_lpf ─")),
        Act("settings.next-group", Turns("─ gyro_hardware_lpf ─", "─ acc_hardware ─")),
        Act("settings.previous-group", Turns("─ acc_hardware ─", "─ gyro_hardware_lpf ─")),
        Act("settings.copy", Shows("No setting is changed, so there is nothing to copy.")),
        Act("settings.search", Shows("│/ ")),
        Type("max_a\r", Shows("9 Settings — /max_a")),
        Act("settings.next", Turns("─ max_aux_channels ─", "─ d_max_advance")),
        Act("settings.previous", Turns("─ d_max_advance", "─ max_aux_channels ─")),
        Again("settings.next", Shows("─ d_max_advance")),
        Again("settings.next", Shows("─ ap_max_angle ─")),
        Act("settings.raise", Turns("ap_max_angle 50", "ap_max_angle 51")),
        Act("settings.lower", Turns("ap_max_angle 51", "ap_max_angle 50")),
        Act("settings.raise-much", Turns("ap_max_angle 50", "ap_max_angle 60")),
        Act("settings.lower-much", Turns("ap_max_angle 60", "ap_max_angle 50")),
        Act("settings.undo", Turns("ap_max_angle 50", "ap_max_angle 60")),
        Act("settings.redo", Turns("ap_max_angle 60", "ap_max_angle 50")),
        Again("settings.raise", Shows("ap_max_angle 51")),
        Act("settings.default", Turns("ap_max_angle 51", "ap_max_angle 50")),
        Act("settings.edit", Shows("Enter sets it, ↑ ↓ change it")),
        Again("app.back", Hides("Enter sets it, ↑ ↓ change it")),
        Act("settings.type", Shows("Enter sets it, ↑ ↓ change it")),
        Again("app.back", Hides("Enter sets it, ↑ ↓ change it")),
        Act("settings.try", Shows("Enter flies")),
        Again("app.back", Hides("Enter flies")),
        Again("app.back", Hides("9 Settings — /max_a")),
        Act("settings.compare", Shows("9 Settings — changed from the defaults")),
        Again("app.back", Hides("9 Settings — changed from the defaults")),
        Act("settings.beside", Shows("Differences — ")),
        Close(Some("Esc closes"), Hides("Differences — ")),
        Act("settings.into-plan", Shows("at its upload.")),
        Act("settings.all-into-plan", Shows("No setting is chosen, so the plan stays as it is.")),
        Act("settings.save", Shows(":settings-file")),
        Close(None, Hides(":settings-file")),
        Act("settings.read", Shows("settings of the craft were read.")),
        // No setting differs from its default any more.
        Act("settings.default-all", Shows("there is nothing to reset")),
    ],
};
