//! The lines before the frames: fields, system, settings.

use std::fmt::{self, Write};

use super::config::disabled_mask;
use super::log::LogDefinition;
use super::schedule::Schedule;
use super::side_frames::utc;
use crate::blackbox::FIRST_LINE;
use crate::blackbox::encode::LogBuffer;
use crate::firmware::Firmware;
use crate::firmware::estimate::ACC_COUNTS_PER_G;
use crate::firmware::settings::{Kind, Role, SETTINGS, Setting, Value, find};
use crate::signals::SimTime;

/// The name of the line about the program that simulates the craft.
pub const WRITER_LINE: &str = "Log writer";

/// The data of the header.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeaderFacts<'a> {
    pub firmware: &'a Firmware,
    pub definition: &'a LogDefinition,
    pub schedule: &'a Schedule,
    pub began: SimTime,
}

/// A line of the header after its name.
type WriteValue = fn(&HeaderFacts<'_>, &mut LogBuffer) -> fmt::Result;

/// The lines about the system, by the names that decoders know.
#[rustfmt::skip]
const SYSTEM: &[(&str, WriteValue)] = &[
    ("Firmware type", |_, out| out.write_str("Betaflight")),
    ("Firmware revision", |facts, out| {
        let build = &facts.firmware.setup.build;
        write!(out, "Betaflight {} ({}) SITL", build.version, build.revision)
    }),
    ("Firmware date", |facts, out| {
        let build = &facts.firmware.setup.build;
        write!(out, "{} {}", build.date, build.time)
    }),
    ("Board information", |facts, out| {
        let configuration = facts.firmware.configuration();
        write!(out, "{} {}", configuration.manufacturer_id, configuration.board_name)
    }),
    ("Log start datetime", |facts, out| write_date(facts.began, out)),
    ("Craft name", |facts, out| out.write_str(facts.firmware.configuration().settings.text("craft_name"))),
    ("I interval", |facts, out| write!(out, "{}", facts.schedule.i_interval())),
    ("P interval", |facts, out| write!(out, "{}", facts.schedule.p_interval())),
    ("P ratio", |facts, out| write!(out, "{}", facts.schedule.i_interval() / facts.schedule.p_interval())),
    ("maxthrottle", |facts, out| write_settings(facts, &["max_throttle"], out)),
    ("gyro_scale", |_, out| write!(out, "0x{:08x}", 1.0_f32.to_bits())),
    ("motorOutput", |facts, out| {
        let high = facts.firmware.parameters().control.mixer.max_us;
        write!(out, "{},{high:.0}", facts.definition.constants.min_motor)
    }),
    ("acc_1G", |_, out| write!(out, "{ACC_COUNTS_PER_G:.0}")),
    ("vbat_scale", |facts, out| write_settings(facts, &["vbat_scale"], out)),
    ("vbatcellvoltage", |facts, out| write_settings(facts, &[
        "vbat_min_cell_voltage", "vbat_warning_cell_voltage", "vbat_max_cell_voltage",
    ], out)),
    ("vbatref", |facts, out| write!(out, "{}", facts.definition.constants.vbat_reference)),
    ("currentSensor", |facts, out| write_settings(facts, &["ibata_offset", "ibata_scale"], out)),
    ("looptime", |facts, out| write!(out, "{}", facts.firmware.setup.step_us())),
    ("gyro_sync_denom", |_, out| out.write_str("1")),
    ("pid_process_denom", |facts, out| write!(out, "{}", facts.firmware.setup.boot.pid_denominator)),
    ("rc_rates", |facts, out| write_settings(facts, &["roll_rc_rate", "pitch_rc_rate", "yaw_rc_rate"], out)),
    ("rc_expo", |facts, out| write_settings(facts, &["roll_expo", "pitch_expo", "yaw_expo"], out)),
    ("rates", |facts, out| write_settings(facts, &["roll_srate", "pitch_srate", "yaw_srate"], out)),
    ("rate_limits", |facts, out| write_settings(facts, &["roll_rate_limit", "pitch_rate_limit", "yaw_rate_limit"], out)),
    ("rollPID", |facts, out| write_settings(facts, &["p_roll", "i_roll", "d_roll"], out)),
    ("pitchPID", |facts, out| write_settings(facts, &["p_pitch", "i_pitch", "d_pitch"], out)),
    ("yawPID", |facts, out| write_settings(facts, &["p_yaw", "i_yaw", "d_yaw"], out)),
    ("levelPID", |facts, out| write_settings(facts, &["angle_p_gain", "horizon_level_strength", "horizon_limit_sticks"], out)),
    ("d_max", |facts, out| write_settings(facts, &["d_max_roll", "d_max_pitch", "d_max_yaw"], out)),
    ("ff_weight", |facts, out| write_settings(facts, &["f_roll", "f_pitch", "f_yaw"], out)),
    ("features", |facts, out| write!(out, "{}", facts.firmware.setup.boot.features.0)),
    ("motor_pwm_protocol", |facts, out| write!(out, "{}", facts.firmware.setup.boot.motor_protocol)),
    ("serialrx_provider", |_, out| out.write_str("0")),
    ("debug_mode", |facts, out| write_settings(facts, &["debug_mode"], out)),
    ("fields_disabled_mask", |facts, out| write!(out, "{}", disabled_mask(&facts.firmware.configuration().settings))),
    (WRITER_LINE, |_, out| out.write_str(concat!("betadeck ", env!("CARGO_PKG_VERSION")))),
    ("DeviceUID", |_, out| out.write_str("000000000000000100000002")),
];

/// The settings that the lines about the system hold under another name.
#[rustfmt::skip]
const IN_SYSTEM: &[&str] = &[
    "max_throttle", "vbat_min_cell_voltage", "vbat_warning_cell_voltage", "vbat_max_cell_voltage", "pid_process_denom",
    "roll_rc_rate", "pitch_rc_rate", "yaw_rc_rate", "roll_expo", "pitch_expo", "yaw_expo", "roll_srate", "pitch_srate",
    "yaw_srate", "roll_rate_limit", "pitch_rate_limit", "yaw_rate_limit", "p_roll", "i_roll", "d_roll", "p_pitch",
    "i_pitch", "d_pitch", "p_yaw", "i_yaw", "d_yaw", "angle_p_gain", "horizon_level_strength", "horizon_limit_sticks",
    "d_max_roll", "d_max_pitch", "d_max_yaw", "f_roll", "f_pitch", "f_yaw", "motor_pwm_protocol", "debug_mode",
];

/// Writes the line with this number, from 0, with its line feed. Some numbers have no line. Returns `false` after the
/// last one.
pub(super) fn write_line(number: usize, facts: &HeaderFacts<'_>, out: &mut LogBuffer) -> bool {
    // A buffer takes what fits without an error.
    let _written = match number {
        0 => writeln!(out, "{FIRST_LINE}"),
        1 => out.write_str("H Data version:2\n"),
        _ => return write_definition(number - 2, facts, out),
    };
    true
}

fn write_definition(number: usize, facts: &HeaderFacts<'_>, out: &mut LogBuffer) -> bool {
    if let Some(line) = facts.definition.layout.line(number) {
        let _written = write!(out, "{line}");
        return true;
    }
    let number = number - facts.definition.layout.lines();
    if let Some((name, value)) = SYSTEM.get(number) {
        let _written = write_named(name, out, |out| value(facts, out));
        return true;
    }
    let Some(setting) = SETTINGS.get(number - SYSTEM.len()) else { return false };
    if is_listed(setting) {
        let _written = write_named(setting.name, out, |out| write_settings(facts, &[setting.name], out));
    }
    true
}

/// Returns `true` for settings with a line of their own: those that have an effect, as numbers.
fn is_listed(setting: &Setting) -> bool {
    let is_text = matches!(setting.kind, Kind::Text { .. });
    setting.role != Role::Carry && !is_text && !IN_SYSTEM.contains(&setting.name)
}

fn write_named(
    name: &str,
    out: &mut LogBuffer,
    value: impl FnOnce(&mut LogBuffer) -> fmt::Result,
) -> fmt::Result {
    write!(out, "H {name}:")?;
    value(out)?;
    out.write_str("\n")
}

/// Writes the values of settings, with commas between them. Words and ports are numbers.
fn write_settings(facts: &HeaderFacts<'_>, names: &[&str], out: &mut LogBuffer) -> fmt::Result {
    let settings = &facts.firmware.configuration().settings;
    let mut separator = "";
    let mut put = |out: &mut LogBuffer, number: i64| {
        let written = write!(out, "{separator}{number}");
        separator = ",";
        written
    };
    for name in names {
        let value = find(name).and_then(|setting| settings.active_value(setting));
        match value {
            Some(Value::Number(number)) => put(out, *number)?,
            Some(Value::Array(numbers)) => numbers.iter().try_for_each(|number| put(out, *number))?,
            Some(Value::Text(_)) | None => {}
        }
    }
    Ok(())
}

/// Writes the date and time of an instant.
fn write_date(time: SimTime, out: &mut LogBuffer) -> fmt::Result {
    let clock = utc(time);
    let (year, month, day) = clock.date();
    let second = clock.unix_s % 86_400;
    let (hour, minute) = (second / 3600, second / 60 % 60);
    write!(
        out,
        "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{:02}.{:03}+00:00",
        second % 60,
        clock.millis
    )
}
