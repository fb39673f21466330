//! Alarms of a low battery.

/// The discharge level of a battery. `Display` gives the name in events.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, serde::Serialize, serde::Deserialize)]
#[strum(serialize_all = "UPPERCASE")]
pub enum BatteryAlarm {
    /// Below `vbat_warning_cell_voltage`.
    Warning,
    /// Below `vbat_min_cell_voltage`.
    Critical,
    /// All of its charge is drawn.
    Empty,
}
