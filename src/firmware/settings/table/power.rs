//! Battery sensing.

use super::super::Role::Carry;
use super::super::Scope;
use super::super::Width::{I16, U8, U16};
use super::{Group, choice, number, switch};

#[rustfmt::skip]
pub(super) const POWER: Group = Group::new("Power monitoring", Scope::Master, &[
    number("vbat_hysteresis", U8, 0, 250, 1, Carry, "Hysteresis of the battery alarms, 0.01 V."),
    choice("current_meter", U8, &["NONE", "ADC", "VIRTUAL", "ESC", "MSP"], 2, Carry, "Source of the current measurement.").hardware(),
    choice("battery_meter", U8, &["NONE", "ADC", "ESC"], 0, Carry, "Source of the voltage measurement; the simulated battery is always measured.").hardware(),
    number("vbat_detect_cell_voltage", U16, 0, 2000, 300, Carry, "Minimum voltage at which a cell is counted, 0.01 V."),
    switch("use_vbat_alerts", U8, true, Carry, "Warn about the battery voltage."),
    switch("use_cbat_alerts", U8, false, Carry, "Warn about the capacity used."),
    number("vbat_cutoff_percent", U8, 0, 100, 100, Carry, "Throttle limit at a critical battery, percent."),
    number("vbat_display_lpf_period", U8, 1, 255, 30, Carry, "Smoothing of the shown voltage, 0.1 s."),
    number("vbat_sag_lpf_period", U8, 1, 255, 2, Carry, "Smoothing of the voltage for sag compensation, 0.1 s."),
    number("ibat_lpf_period", U8, 0, 255, 10, Carry, "Smoothing of the current, 0.1 s."),
    number("vbat_duration_for_warning", U8, 0, 150, 0, Carry, "Time of low voltage before a warning, 0.1 s."),
    number("vbat_duration_for_critical", U8, 0, 150, 0, Carry, "Time of low voltage before an alarm, 0.1 s."),
    number("vbat_scale", U8, 0, 255, 110, Carry, "Scale of the voltage divider.").hardware(),
    number("vbat_divider", U8, 1, 255, 10, Carry, "Divider of the voltage measurement."),
    number("vbat_multiplier", U8, 1, 255, 1, Carry, "Multiplier of the voltage measurement."),
    number("ibata_scale", I16, -16000, 16000, 400, Carry, "Scale of the current sensor, 0.1 mV/A.").hardware(),
    number("ibata_offset", I16, -32000, 32000, 0, Carry, "Offset of the current sensor, mA."),
    number("ibatv_scale", I16, -16000, 16000, 0, Carry, "Scale of the virtual current meter."),
    number("ibatv_offset", U16, 0, 16000, 0, Carry, "Offset of the virtual current meter, mA."),
]);
