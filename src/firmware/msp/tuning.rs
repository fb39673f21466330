//! PID, rate, filter and control-loop settings.

use super::layout::{self, Field, byte, i8, i16, u8, u16, word};
use super::{Call, Refused};

/// `PID`: P, I, D of roll, pitch, yaw, level and heading hold.
pub(super) const PID: &[Field] = &[
    u8("p_roll"),
    u8("i_roll"),
    u8("d_roll"),
    u8("p_pitch"),
    u8("i_pitch"),
    u8("d_pitch"),
    u8("p_yaw"),
    u8("i_yaw"),
    u8("d_yaw"),
    u8("angle_p_gain"),
    u8("horizon_level_strength"),
    u8("horizon_limit_sticks"),
    byte(40),
    byte(0),
    byte(0),
];

pub(super) fn pid_names(call: &mut Call<'_>) {
    call.reply.bytes(b"ROLL;PITCH;YAW;LEVEL;MAG;");
}

/// `PID_CONTROLLER`: there is only one.
pub(super) const PID_CONTROLLER: &[Field] = &[byte(1)];

/// The offset of feed-forward averaging in [`PID_ADVANCED`], bytes.
const AVERAGING_AT: usize = 50;
const AVERAGING_MAX: u8 = 3;

/// `PID_ADVANCED`.
pub(super) const PID_ADVANCED: &[Field] = &[
    word(0),
    word(0),
    word(0),
    byte(0),
    byte(0),
    u8("feedforward_transition"),
    byte(0),
    byte(0),
    byte(0),
    byte(0),
    u16("acc_limit"),
    u16("acc_limit_yaw"),
    u8("angle_limit"),
    byte(0),
    word(0),
    u16("anti_gravity_gain"),
    word(0),
    u8("iterm_rotation"),
    byte(0),
    u8("iterm_relax"),
    u8("iterm_relax_type"),
    byte(0),
    u8("throttle_boost"),
    byte(0), // acro trainer angle
    u16("f_roll"),
    u16("f_pitch"),
    u16("f_yaw"),
    byte(0),
    u8("d_max_roll"),
    u8("d_max_pitch"),
    u8("d_max_yaw"),
    u8("d_max_gain"),
    u8("d_max_advance"),
    byte(0),
    byte(0),
    u8("iterm_relax_cutoff"),
    u8("motor_output_limit"),
    i8("auto_profile_cell_count"),
    byte(0), // dynamic idle
    u8("feedforward_averaging"),
    u8("feedforward_smooth_factor"),
    u8("feedforward_boost"),
    u8("feedforward_max_rate_limit"),
    u8("feedforward_jitter_factor"),
    u8("vbat_sag_compensation"),
    u8("thrust_linear"),
    u8("tpa_mode"),
    u8("tpa_rate"),
    u16("tpa_breakpoint"),
];

pub(super) fn set_pid_advanced(call: &mut Call<'_>) -> Result<(), Refused> {
    let payload = call.request.clone().all();
    if payload.get(AVERAGING_AT).is_some_and(|&averaging| averaging > AVERAGING_MAX) {
        return Err(Refused);
    }
    layout::write(PID_ADVANCED, &mut call.configuration.settings, &mut call.request);
    Ok(())
}

/// `FILTER_CONFIG` after its first byte, which repeats the low byte of the first gyro low-pass.
const FILTERS: &[Field] = &[
    u16("dterm_lpf1_static_hz"),
    u16("yaw_lowpass_hz"),
    u16("gyro_notch1_hz"),
    u16("gyro_notch1_cutoff"),
    u16("dterm_notch_hz"),
    u16("dterm_notch_cutoff"),
    u16("gyro_notch2_hz"),
    u16("gyro_notch2_cutoff"),
    u8("dterm_lpf1_type"),
    u8("gyro_hardware_lpf"),
    byte(0),
    u16("gyro_lpf1_static_hz"),
    u16("gyro_lpf2_static_hz"),
    u8("gyro_lpf1_type"),
    u8("gyro_lpf2_type"),
    u16("dterm_lpf2_static_hz"),
    u8("dterm_lpf2_type"),
    u16("gyro_lpf1_dyn_min_hz"),
    u16("gyro_lpf1_dyn_max_hz"),
    u16("dterm_lpf1_dyn_min_hz"),
    u16("dterm_lpf1_dyn_max_hz"),
    byte(0),
    byte(0),
    word(0), // dynamic notch Q
    word(0), // its lowest frequency
    byte(0), // RPM filter harmonics
    byte(0), // its lowest frequency
    word(0), // dynamic notch's highest frequency
    u8("dterm_lpf1_dyn_expo"),
    byte(0), // number of dynamic notches
    word(0), // RPM filter fade
    word(0), // its Q
    byte(0), // its weights
    byte(0),
    byte(0),
];

pub(super) fn filters(call: &mut Call<'_>) {
    let first = call.setting("gyro_lpf1_static_hz") & 0xff;
    call.reply.u8(first);
    layout::read(FILTERS, &call.configuration.settings, &mut call.reply);
}

pub(super) fn set_filters(call: &mut Call<'_>) {
    call.request.u8();
    layout::write(FILTERS, &mut call.configuration.settings, &mut call.request);
}

/// The length of the shortest `RC_TUNING`, bytes.
pub(super) const RATES_MIN: usize = 10;

/// `RC_TUNING`.
pub(super) const RATES: &[Field] = &[
    u8("roll_rc_rate"),
    u8("roll_expo"),
    u8("roll_srate"),
    u8("pitch_srate"),
    u8("yaw_srate"),
    byte(0),
    u8("thr_mid"),
    u8("thr_expo"),
    word(0),
    u8("yaw_expo"),
    u8("yaw_rc_rate"),
    u8("pitch_rc_rate"),
    u8("pitch_expo"),
    u8("throttle_limit_type"),
    u8("throttle_limit_percent"),
    u16("roll_rate_limit"),
    u16("pitch_rate_limit"),
    u16("yaw_rate_limit"),
    u8("rates_type"),
    u8("thr_hover"),
];

/// The number of debug modes in the firmware that configurators expect. It names one fewer.
const DEBUG_MODES: u8 = 103;

/// `ADVANCED_CONFIG`, except the number of debug modes at the end of the reply.
pub(super) const ADVANCED: &[Field] = &[
    byte(1),
    u8("pid_process_denom"),
    u8("use_unsynced_pwm"),
    u8("motor_pwm_protocol"),
    u16("motor_pwm_rate"),
    u16("motor_idle"),
    byte(0),
    u8("motor_pwm_inversion"),
    byte(0),
    byte(0), // gyro high range
    u8("gyro_calib_noise_limit"),
    u16("gyro_calib_duration"),
    i16("gyro_offset_yaw"),
    u8("gyro_overflow_detect"),
    u8("debug_mode"),
];

pub(super) fn advanced(call: &mut Call<'_>) {
    layout::read(ADVANCED, &call.configuration.settings, &mut call.reply);
    call.reply.u8(DEBUG_MODES);
}
