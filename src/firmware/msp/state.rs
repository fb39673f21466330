//! The present measurements and state of the craft.

use super::power::{METER_MEASURED, METER_VIRTUAL};
use super::{Call, MspFacts, modes};
use crate::firmware::config::Feature;
use crate::firmware::estimate::ACC_COUNTS_PER_G;
use crate::firmware::settings::Scope;
use crate::geo::GRAVITY;
use crate::msp::{Altitude, Attitude, BatteryReading, Channels, Motors, Status, steps};
use nalgebra::{UnitQuaternion, Vector3};

pub(super) fn status(call: &mut Call<'_>) {
    present_status(call).encode(false, &mut call.reply);
}

pub(super) fn status_ex(call: &mut Call<'_>) {
    present_status(call).encode(true, &mut call.reply);
}

fn present_status(call: &Call<'_>) -> Status {
    let (configuration, facts) = (&*call.configuration, call.facts);
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
    Status {
        cycle_time_us: facts.cycle_time_us.try_into().unwrap_or(u16::MAX),
        sensors: sensors.iter().rev().fold(0, |mask, &present| mask << 1 | u16::from(present)),
        profile: settings.active(Scope::Profile),
        profiles: Scope::Profile.instances(),
        rate_profile: settings.active(Scope::RateProfile),
        rate_profiles: Scope::RateProfile.instances(),
        battery_profile: settings.active(Scope::BatteryProfile),
        battery_profiles: Scope::BatteryProfile.instances(),
        load_percent: facts.cpu_load_percent.try_into().unwrap_or(u16::MAX),
        mode_bits: modes::mode_bits(configuration, facts).into(),
        arming_blocked_by: Some(facts.arming_blocks),
        reboot_required: Some(facts.reboot_required),
    }
}

pub(super) fn raw_imu(call: &mut Call<'_>) {
    let facts = call.facts;
    for axis in facts.specific_force_flu.iter() {
        call.reply.i16(steps(*axis, ACC_COUNTS_PER_G / GRAVITY));
    }
    for axis in facts.rate_flu.iter() {
        call.reply.i16(steps(axis.to_degrees(), 1.0));
    }
    for axis in facts.mag_flu.iter() {
        call.reply.i16(steps(*axis, 1.0));
    }
}

pub(super) fn attitude(call: &mut Call<'_>) {
    let &MspFacts { roll_deg, pitch_deg, heading_deg, .. } = call.facts;
    Attitude { roll_deg, pitch_deg, heading_deg }.encode(&mut call.reply);
}

pub(super) fn attitude_quaternion(call: &mut Call<'_>) {
    let to_nwu = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -std::f64::consts::FRAC_PI_2);
    let q = to_nwu * call.facts.attitude;
    for part in [q.w, q.i, q.j, q.k] {
        call.reply.i16(steps(part, f64::from(i16::MAX)));
    }
}

pub(super) fn altitude(call: &mut Call<'_>) {
    let &MspFacts { altitude_m, climb_mps, .. } = call.facts;
    Altitude { alt_m: altitude_m, climb_mps: Some(climb_mps) }.encode(&mut call.reply);
}

pub(super) fn sonar_altitude(call: &mut Call<'_>) {
    call.reply.i32(0);
}

fn battery(call: &Call<'_>) -> BatteryReading {
    call.facts.battery.unwrap_or_default()
}

pub(super) fn analog(call: &mut Call<'_>) {
    let battery = battery(call);
    call.reply.u8(steps(battery.voltage_v, 10.0));
    call.reply.u16(steps(battery.drawn_mah, 1.0));
    call.reply.u16(call.facts.rssi);
    call.reply.i16(steps(battery.current_a, 100.0));
    call.reply.u16(steps(battery.voltage_v, 100.0));
}

pub(super) fn battery_state(call: &mut Call<'_>) {
    let capacity_mah = call.setting("bat_capacity").try_into().unwrap_or(u16::MAX);
    BatteryReading { capacity_mah, ..battery(call) }.encode(&mut call.reply);
}

pub(super) fn voltage_meters(call: &mut Call<'_>) {
    let battery = battery(call);
    call.reply.u8(METER_MEASURED);
    call.reply.u8(steps(battery.voltage_v, 10.0));
}

pub(super) fn current_meters(call: &mut Call<'_>) {
    let battery = battery(call);
    for id in [METER_MEASURED, METER_VIRTUAL] {
        call.reply.u8(id);
        call.reply.u16(steps(battery.drawn_mah, 1.0));
        call.reply.u16(steps(battery.current_a, 1000.0));
    }
}

pub(super) fn rc(call: &mut Call<'_>) {
    Channels(call.facts.channels).encode(&mut call.reply);
}

pub(super) fn motor(call: &mut Call<'_>) {
    Motors(call.facts.motors_us).encode(&mut call.reply);
}

pub(super) fn motor_telemetry(call: &mut Call<'_>) {
    // No ESC reports anything, so rpm, errors, temperature, voltage, current and charge are 0.
    let motors = call.facts.motors_us.len();
    call.reply.u8(motors as i64);
    call.reply.zeros(13 * motors);
}

pub(super) fn debug(call: &mut Call<'_>) {
    call.reply.zeros(16);
}

pub(super) fn raw_gps(call: &mut Call<'_>) {
    call.facts.gps.encode(&mut call.reply);
}

pub(super) fn comp_gps(call: &mut Call<'_>) {
    call.facts.home.encode(&mut call.reply);
}

/// Reports zero satellites, because single satellites are not simulated.
pub(super) fn satellites(call: &mut Call<'_>) {
    call.reply.u8(0);
}

pub(super) fn rtc(call: &mut Call<'_>) {
    if let Some(clock) = call.facts.clock {
        let (year, month, day) = clock.date();
        let second = clock.unix_s % 86_400;
        call.reply.u16(year);
        for part in [month, day, second / 3600, second / 60 % 60, second % 60] {
            call.reply.u8(part);
        }
        call.reply.u16(clock.millis);
    }
}

pub(super) fn tx_info(call: &mut Call<'_>) {
    call.reply.u8(0);
    call.reply.u8(u8::from(call.facts.clock.is_some()));
}

/// Reports no card.
pub(super) fn sdcard_summary(call: &mut Call<'_>) {
    call.reply.zeros(11);
}

/// Replies with the positions in the lines of the command line's `sensor_hardware`; 255 = not built in.
pub(super) fn sensors_active(call: &mut Call<'_>) {
    call.reply.bytes(&[0x1b, 0x1a, 0x0d, 0x00, 0xff, 0xff]);
}

pub(super) fn gyros_active(call: &mut Call<'_>) {
    call.reply.bytes(&[1, 0x1b]);
}
