//! The present measurements and state of the craft.

use super::wire::steps;
use super::{BatteryReading, BatteryState, Call, Refused, UtcTime, modes};
use crate::firmware::config::Feature;
use crate::firmware::settings::Scope;
use crate::geo::GRAVITY;
use nalgebra::{UnitQuaternion, Vector3};

/// The accelerometer counts of 1 g.
const COUNTS_PER_G: f64 = 256.0;
/// The number of arming disable flags.
const ARMING_FLAGS: u8 = 30;
/// The number of boxes whose state is in the fixed part of a status.
const FIXED_MODE_BITS: u32 = 32;
/// The number of motors that a message has room for.
const MOTOR_SLOTS: usize = 8;
/// The meters of the battery: the measured one and the computed one.
const METER_MEASURED: u8 = 10;
const METER_VIRTUAL: u8 = 80;
/// The code for a fix in `RAW_GPS`.
const FIX: u8 = 2;
/// The dilution reported for a source that reports none.
const UNREPORTED_DOP: f64 = 0.1;

pub(super) fn status(call: &mut Call<'_>) -> Result<(), Refused> {
    write_status(call, false);
    Ok(())
}

pub(super) fn status_ex(call: &mut Call<'_>) -> Result<(), Refused> {
    write_status(call, true);
    Ok(())
}

fn write_status(call: &mut Call<'_>, extended: bool) {
    let (configuration, facts) = (&*call.configuration, call.facts);
    let bits = modes::mode_bits(configuration, facts);
    let settings = &configuration.settings;
    let sensors = [
        true, // accelerometer
        true, // barometer
        facts.has_mag,
        configuration.features.has(Feature::Gps),
        false, // rangefinder
        true,  // gyro
        false, // optical flow
    ];
    let mask = sensors.iter().rev().fold(0_u16, |mask, &present| mask << 1 | u16::from(present));
    let reply = &mut call.reply;
    reply.u16(facts.cycle_time_us);
    reply.u16(0); // I2C errors
    reply.u16(mask);
    reply.u32(bits as u32);
    reply.u8(settings.active(Scope::Profile));
    reply.u16(facts.cpu_load_percent);
    if extended {
        reply.u8(Scope::Profile.instances());
        reply.u8(settings.active(Scope::RateProfile));
    } else {
        reply.u16(0);
    }
    let more = (bits >> FIXED_MODE_BITS).to_le_bytes();
    let used = more.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    reply.u8(used as i64);
    reply.bytes(&more[..used]);
    reply.u8(ARMING_FLAGS);
    reply.u32(facts.arming_blocks.bits());
    reply.u8(u8::from(facts.reboot_required));
    reply.u16(0); // temperature unknown
    reply.u8(Scope::RateProfile.instances());
    reply.u8(Scope::BatteryProfile.instances());
    reply.u8(settings.active(Scope::BatteryProfile));
}

pub(super) fn raw_imu(call: &mut Call<'_>) -> Result<(), Refused> {
    let facts = call.facts;
    for axis in facts.specific_force_flu.iter() {
        call.reply.i16(steps(*axis, COUNTS_PER_G / GRAVITY));
    }
    for axis in facts.rate_flu.iter() {
        call.reply.i16(steps(axis.to_degrees(), 1.0));
    }
    for axis in facts.mag_flu.iter() {
        call.reply.i16(steps(*axis, 1.0));
    }
    Ok(())
}

pub(super) fn attitude(call: &mut Call<'_>) -> Result<(), Refused> {
    let facts = call.facts;
    call.reply.i16(steps(facts.roll_deg, 10.0));
    // Nose down is positive on the wire.
    call.reply.i16(steps(-facts.pitch_deg, 10.0));
    call.reply.i16(steps(facts.heading_deg, 1.0).rem_euclid(360));
    Ok(())
}

pub(super) fn attitude_quaternion(call: &mut Call<'_>) -> Result<(), Refused> {
    let to_nwu = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -std::f64::consts::FRAC_PI_2);
    let q = to_nwu * call.facts.attitude;
    for part in [q.w, q.i, q.j, q.k] {
        call.reply.i16(steps(part, f64::from(i16::MAX)));
    }
    Ok(())
}

pub(super) fn altitude(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.i32(steps(call.facts.altitude_m, 100.0));
    call.reply.i16(steps(call.facts.climb_mps, 100.0));
    Ok(())
}

pub(super) fn sonar_altitude(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.i32(0);
    Ok(())
}

fn battery(call: &Call<'_>) -> BatteryReading {
    call.facts.battery.unwrap_or_default()
}

pub(super) fn analog(call: &mut Call<'_>) -> Result<(), Refused> {
    let battery = battery(call);
    call.reply.u8(steps(battery.voltage_v, 10.0));
    call.reply.u16(steps(battery.drawn_mah, 1.0));
    call.reply.u16(call.facts.rssi);
    call.reply.i16(steps(battery.current_a, 100.0));
    call.reply.u16(steps(battery.voltage_v, 100.0));
    Ok(())
}

pub(super) fn battery_state(call: &mut Call<'_>) -> Result<(), Refused> {
    let battery = battery(call);
    let capacity = call.setting("bat_capacity");
    let state = if call.facts.battery.is_some() { battery.state } else { BatteryState::NotPresent };
    call.reply.u8(battery.cells);
    call.reply.u16(capacity);
    call.reply.u8(steps(battery.voltage_v, 10.0));
    call.reply.u16(steps(battery.drawn_mah, 1.0));
    call.reply.i16(steps(battery.current_a, 100.0));
    call.reply.u8(state as u8);
    call.reply.u16(steps(battery.voltage_v, 100.0));
    Ok(())
}

pub(super) fn voltage_meters(call: &mut Call<'_>) -> Result<(), Refused> {
    let battery = battery(call);
    call.reply.u8(METER_MEASURED);
    call.reply.u8(steps(battery.voltage_v, 10.0));
    Ok(())
}

pub(super) fn current_meters(call: &mut Call<'_>) -> Result<(), Refused> {
    let battery = battery(call);
    for id in [METER_MEASURED, METER_VIRTUAL] {
        call.reply.u8(id);
        call.reply.u16(steps(battery.drawn_mah, 1.0));
        call.reply.u16(steps(battery.current_a, 1000.0));
    }
    Ok(())
}

pub(super) fn rc(call: &mut Call<'_>) -> Result<(), Refused> {
    for channel in call.facts.channels {
        call.reply.u16(channel);
    }
    Ok(())
}

pub(super) fn motor(call: &mut Call<'_>) -> Result<(), Refused> {
    for motor in call.facts.motors_us {
        call.reply.u16(motor);
    }
    call.reply.zeros(2 * (MOTOR_SLOTS - call.facts.motors_us.len()));
    Ok(())
}

pub(super) fn motor_telemetry(call: &mut Call<'_>) -> Result<(), Refused> {
    // No ESC reports anything, so rpm, errors, temperature, voltage, current and charge are 0.
    let motors = call.facts.motors_us.len();
    call.reply.u8(motors as i64);
    call.reply.zeros(13 * motors);
    Ok(())
}

pub(super) fn debug(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.zeros(16);
    Ok(())
}

pub(super) fn raw_gps(call: &mut Call<'_>) -> Result<(), Refused> {
    let gps = call.facts.gps;
    let dop = if gps.dop > 0.0 { gps.dop } else { UNREPORTED_DOP };
    call.reply.u8(if gps.fix { FIX } else { 0 });
    call.reply.u8(gps.sats);
    call.reply.i32(gps.position.lat_e7);
    call.reply.i32(gps.position.lon_e7);
    call.reply.u16(steps(gps.alt_amsl_m, 1.0));
    call.reply.u16(steps(gps.ground_speed_mps, 100.0));
    call.reply.u16(steps(gps.course_deg, 10.0).rem_euclid(3600));
    call.reply.u16(steps(dop, 100.0));
    Ok(())
}

pub(super) fn comp_gps(call: &mut Call<'_>) -> Result<(), Refused> {
    let home = call.facts.home.unwrap_or_default();
    call.reply.u16(steps(home.distance_m, 1.0));
    call.reply.i16(steps(home.bearing_deg, 1.0));
    call.reply.u8(call.facts.gps.solution & 1);
    Ok(())
}

/// Reports zero satellites, because single satellites are not simulated.
pub(super) fn satellites(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.u8(0);
    Ok(())
}

pub(super) fn rtc(call: &mut Call<'_>) -> Result<(), Refused> {
    if let Some(clock) = call.facts.clock {
        let (year, month, day) = civil_date(clock);
        let second = clock.unix_s % 86_400;
        call.reply.u16(year);
        for part in [month, day, second / 3600, second / 60 % 60, second % 60] {
            call.reply.u8(part);
        }
        call.reply.u16(clock.millis);
    }
    Ok(())
}

/// Returns year, month and day in the Gregorian calendar, by years that begin in March (Hinnant, "chrono-compatible
/// low-level date algorithms").
fn civil_date(clock: UtcTime) -> (u32, u32, u32) {
    // The days since 0000-03-01.
    let days = clock.unix_s / 86_400 + 719_468;
    let era = days / 146_097;
    let day_of_era = days % 146_097;
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month_from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
    let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
    (era * 400 + year_of_era + u32::from(month <= 2), month, day)
}

pub(super) fn tx_info(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.u8(0);
    call.reply.u8(u8::from(call.facts.clock.is_some()));
    Ok(())
}

/// Reports neither flash nor card.
pub(super) fn dataflash_summary(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.zeros(13);
    Ok(())
}

pub(super) fn sdcard_summary(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.zeros(11);
    Ok(())
}

/// Replies with the positions in the lines of the command line's `sensor_hardware`; 255 = not built in.
pub(super) fn sensors_active(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.bytes(&[0x1b, 0x1a, 0x0d, 0x00, 0xff, 0xff]);
    Ok(())
}

pub(super) fn gyros_active(call: &mut Call<'_>) -> Result<(), Refused> {
    call.reply.bytes(&[1, 0x1b]);
    Ok(())
}
