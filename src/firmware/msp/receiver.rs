//! Receiver, failsafe and sticks.

use super::layout::{Field, byte, long, u8, u16, word};
use super::{Call, Refused};
use crate::firmware::config::{ChannelMap, RX_FAIL_CHANNELS, RxFail, RxFailMode};
use crate::firmware::settings::Width;
use crate::signals::RC_CHANNELS;

/// The index of the throttle in the order roll, pitch, yaw, throttle.
const THROTTLE: usize = 3;
/// The number of stick channels. Only these may use the automatic loss rule.
const STICKS: usize = 4;

/// `RX_CONFIG`.
pub(super) const RX: &[Field] = &[
    byte(0), // serial provider
    u16("max_check"),
    u16("mid_rc"),
    u16("min_check"),
    byte(0),
    u16("rx_min_usec"),
    u16("rx_max_usec"),
    byte(0),
    byte(0),
    Field::Scaled { width: Width::U16, name: "airmode_start_throttle_percent", factor: 10, offset: 1000 },
    byte(0), // SPI protocol
    long(0), // SPI id
    byte(0), // SPI channels
    u8("fpv_mix_degrees"),
    byte(0),
    byte(0),
    u8("rc_smoothing_setpoint_cutoff"),
    u8("rc_smoothing_throttle_cutoff"),
    u8("rc_smoothing_auto_factor_throttle"),
    byte(0),
    byte(0), // USB HID
    u8("rc_smoothing_auto_factor"),
    u8("rc_smoothing"),
    long(0), // ExpressLRS uid
    word(0),
    byte(0), // ExpressLRS model
];

/// `FAILSAFE_CONFIG`.
pub(super) const FAILSAFE: &[Field] = &[
    u8("failsafe_delay"),
    u8("failsafe_landing_time"),
    u16("failsafe_throttle"),
    u8("failsafe_switch_mode"),
    u16("failsafe_throttle_low_delay"),
    u8("failsafe_procedure"),
];

/// `RC_DEADBAND`.
pub(super) const DEADBAND: &[Field] =
    &[u8("deadband"), u8("yaw_deadband"), u8("pos_hold_deadband"), u16("3d_deadband_throttle")];

pub(super) fn rx_map(call: &mut Call<'_>) {
    call.reply.bytes(&call.configuration.channel_map.0);
}

/// Sets the channel map. Refused while armed, as on the command line: the sticks would change places in flight.
pub(super) fn set_rx_map(call: &mut Call<'_>) -> Result<(), Refused> {
    let mut map = [0; 8];
    map.fill_with(|| call.request.u8());
    let is_permutation = (0..8).all(|channel| map.contains(&channel));
    if !is_permutation || call.facts.armed {
        return Err(Refused);
    }
    call.configuration.channel_map = ChannelMap(map);
    Ok(())
}

pub(super) fn rxfail(call: &mut Call<'_>) {
    let lowest = call.setting("rx_min_usec");
    let rules = call.configuration.rx_fail.0;
    for (channel, rule) in rules.iter().enumerate().take(RC_CHANNELS) {
        let pulse = match rule.mode {
            RxFailMode::Auto if channel == THROTTLE => RxFail::set_to(lowest).value_us,
            RxFailMode::Auto | RxFailMode::Hold | RxFailMode::Set => rule.value_us,
        };
        call.reply.u8(rule.mode as u8);
        call.reply.u16(pulse);
    }
}

pub(super) fn set_rxfail(call: &mut Call<'_>) -> Result<(), Refused> {
    let channel = usize::from(call.request.u8());
    let mode = RxFailMode::from_repr(call.request.u8()).ok_or(Refused)?;
    let pulse_us = i64::from(call.request.u16());
    if channel >= RX_FAIL_CHANNELS || (mode == RxFailMode::Auto && channel >= STICKS) {
        return Err(Refused);
    }
    call.configuration.rx_fail.0[channel] = match mode {
        RxFailMode::Set => RxFail::set_to(pulse_us),
        RxFailMode::Auto | RxFailMode::Hold => RxFail::without_value(mode),
    };
    Ok(())
}
