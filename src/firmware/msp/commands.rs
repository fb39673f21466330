//! Messages that trigger an action.

use super::{Call, MspAction, Refused};
use crate::firmware::settings::{SETTINGS, Scope};
use crate::geo::LatLon;
use crate::signals::{MOTORS, RC_CHANNELS, RcFrame};

/// The most channels of an RC message.
const RC_MAX: usize = 18;
/// The range of motor pulses on the bench, µs.
const MOTOR_RANGE_US: std::ops::RangeInclusive<u16> = 1000..=2000;
/// Selects a rate profile instead of a PID profile.
const SELECT_RATES: u8 = 0x80;
/// Selects a battery profile.
const SELECT_BATTERY: u8 = 0x40;

/// The kinds of start that a reboot request can name.
const REBOOT_FIRMWARE: u8 = 0;
const REBOOT_ROM_LOADER: u8 = 1;
const REBOOT_FLASH_LOADER: u8 = 4;

pub(super) fn reboot(call: &mut Call<'_>) -> Result<(), Refused> {
    let kind = call.request.u8();
    // The command line refuses it, too: an armed craft would fall from the sky.
    if call.facts.armed {
        return Err(Refused);
    }
    // There is no mass storage. The boot loaders of a simulator restart the firmware.
    if !matches!(kind, REBOOT_FIRMWARE | REBOOT_ROM_LOADER | REBOOT_FLASH_LOADER) {
        return Err(Refused);
    }
    call.reply.u8(kind);
    call.action = Some(MspAction::Reboot);
    Ok(())
}

/// Sets only runaway prevention. A simulator never lets a client block arming, so that the craft can fly with a
/// configurator connected.
pub(super) fn set_arming_disabled(call: &mut Call<'_>) {
    call.request.u8();
    call.action = Some(MspAction::RunawayPrevention(call.request.u8() == 0));
}

pub(super) fn set_raw_rc(call: &mut Call<'_>) -> Result<(), Refused> {
    let count = call.request.remaining() / 2;
    if count > RC_MAX {
        return Err(Refused);
    }
    if count > 0 {
        let mut channels = [0; RC_CHANNELS];
        for channel in channels.iter_mut().take(count) {
            *channel = call.request.u16();
        }
        call.action = Some(MspAction::RawRc(RcFrame { channels }));
    }
    Ok(())
}

pub(super) fn set_raw_gps(call: &mut Call<'_>) {
    let request = &mut call.request;
    call.action = Some(MspAction::RawGps {
        fix: request.u8() != 0,
        sats: request.u8(),
        position: LatLon::new(request.i32(), request.i32()),
        alt_amsl_m: request.u16(),
        speed_cms: request.u16(),
    });
}

/// Starts an accelerometer calibration. While armed, it is acknowledged and ignored.
pub(super) fn calibrate_acc(call: &mut Call<'_>) {
    call.action = (!call.facts.armed).then_some(MspAction::CalibrateAcc);
}

/// Starts a magnetometer calibration. While armed, it is acknowledged and ignored.
pub(super) fn calibrate_mag(call: &mut Call<'_>) {
    call.action = (!call.facts.armed).then_some(MspAction::CalibrateMag);
}

pub(super) fn reset_conf(call: &mut Call<'_>) {
    let possible = !call.facts.armed;
    call.reply.u8(u8::from(possible));
    if possible {
        call.configuration.reset();
        call.action = Some(MspAction::SaveAndReboot);
    }
}

pub(super) fn select_setting(call: &mut Call<'_>) {
    let wanted = call.request.u8();
    let (scope, index) = if wanted & SELECT_RATES != 0 {
        (Scope::RateProfile, wanted & !SELECT_RATES)
    } else if wanted & SELECT_BATTERY != 0 {
        (Scope::BatteryProfile, wanted & !SELECT_BATTERY)
    } else if call.facts.armed {
        return;
    } else {
        (Scope::Profile, wanted)
    };
    let index = if index < scope.instances() { index } else { 0 };
    call.configuration.settings.select(scope, index);
}

pub(super) fn copy_profile(call: &mut Call<'_>) -> Result<(), Refused> {
    let scope = match call.request.u8() {
        0 => Scope::Profile,
        1 => Scope::RateProfile,
        _ => return Err(Refused),
    };
    let (to, from) = (call.request.u8(), call.request.u8());
    if to >= scope.instances() || from >= scope.instances() {
        return Err(Refused);
    }
    let settings = &mut call.configuration.settings;
    for setting in SETTINGS.iter().filter(|setting| setting.scope == scope) {
        if let Some(value) = settings.value(setting, from).cloned() {
            settings.put(setting, to, value).map_err(|_| Refused)?;
        }
    }
    Ok(())
}

/// Resets the active PID profile to its defaults.
pub(super) fn reset_pid_profile(call: &mut Call<'_>) -> Result<(), Refused> {
    let settings = &mut call.configuration.settings;
    let profile = settings.active(Scope::Profile);
    for setting in SETTINGS.iter().filter(|setting| setting.scope == Scope::Profile) {
        settings.put(setting, profile, setting.default_value()).map_err(|_| Refused)?;
    }
    Ok(())
}

pub(super) fn set_heading(call: &mut Call<'_>) {
    call.action = Some(MspAction::HoldHeading(call.request.i16()));
}

pub(super) fn set_motor(call: &mut Call<'_>) -> Result<(), Refused> {
    let mut motors = [0; MOTORS];
    if call.request.remaining() < 2 * motors.len() {
        return Err(Refused);
    }
    motors.fill_with(|| call.request.u16().clamp(*MOTOR_RANGE_US.start(), *MOTOR_RANGE_US.end()));
    // The mixer controls the motors of an armed craft.
    call.action = (!call.facts.armed).then_some(MspAction::MotorTest(motors));
    Ok(())
}

pub(super) fn set_passthrough(call: &mut Call<'_>) {
    call.reply.u8(0);
}

pub(super) fn set_rtc(call: &mut Call<'_>) {
    call.action = Some(MspAction::SetClock { unix_s: call.request.u32(), millis: call.request.u16() });
}

pub(super) fn eeprom_write(call: &mut Call<'_>) -> Result<(), Refused> {
    if call.facts.armed {
        return Err(Refused);
    }
    call.action = Some(MspAction::Save);
    Ok(())
}
