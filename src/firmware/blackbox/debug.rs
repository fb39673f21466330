//! The values of the fields `debug`, by the setting `debug_mode`.

use crate::firmware::Firmware;
use crate::firmware::estimate::ACC_COUNTS_PER_G;
use crate::geo::GRAVITY;

/// The number of debug values.
pub(super) const DEBUG_VALUES: usize = 8;

/// The source of the debug values. The meaning of each value is that of the real firmware. Values that are not listed
/// are 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum DebugSource {
    /// A mode without values here: all are 0.
    #[default]
    Silent,
    /// Filtered rates of roll, pitch and yaw, °/s.
    GyroFiltered,
    /// Unfiltered rates of roll, pitch and yaw, °/s.
    GyroRaw,
    /// Unfiltered acceleration forward, its magnitude in thousandths of 1 g at \[2\].
    Accelerometer,
    /// \[1\] voltage, 0.1 V.
    Battery,
    /// Altitudes in cm: \[1\] barometer, \[2\] GPS above home, \[3\] estimate. \[4\], \[5\] climb rate of GPS and
    /// estimate, cm/s.
    Altitude,
    /// \[3\] altitude of the barometer, cm.
    Baro,
    /// Roll and pitch, 0.1°.
    Attitude,
    /// Roll, its target, pitch, its target, 0.1°.
    AngleMode,
    /// Targets of roll and pitch, 0.1°.
    AngleTarget,
    /// Roll and pitch, 0.1°, and heading, °.
    CurrentAngle,
    /// \[0\] satellites, \[2\] horizontal dilution, hundredths.
    GpsDop,
    /// \[1\] state of the failsafe, \[2\] signal received, \[3\] channels valid.
    Failsafe,
    /// \[0\] throttle, µs, \[1\] target altitude and \[2\] altitude, cm, \[4\] integral, µs.
    AutopilotAltitude,
    /// \[0\] ground speed, cm/s, \[1\] distance from the target, cm, \[7\] state of the navigator.
    AutopilotPid,
    /// \[4\], \[5\] demanded roll and pitch, 0.1°, \[6\] state of the navigator.
    AutopilotStop,
}

impl DebugSource {
    /// Returns the source of a `debug_mode`; `None` for the mode without debug fields.
    pub(super) fn new(mode: &str) -> Option<Self> {
        Some(match mode {
            "NONE" => return None,
            "GYRO_FILTERED" => Self::GyroFiltered,
            "GYRO_RAW" => Self::GyroRaw,
            "ACCELEROMETER" => Self::Accelerometer,
            "BATTERY" => Self::Battery,
            "ALTITUDE" => Self::Altitude,
            "BARO" => Self::Baro,
            "ATTITUDE" => Self::Attitude,
            "ANGLE_MODE" => Self::AngleMode,
            "ANGLE_TARGET" => Self::AngleTarget,
            "CURRENT_ANGLE" => Self::CurrentAngle,
            "GPS_DOP" => Self::GpsDop,
            "FAILSAFE" => Self::Failsafe,
            "AUTOPILOT_ALTITUDE" => Self::AutopilotAltitude,
            "AUTOPILOT_PID" => Self::AutopilotPid,
            "AUTOPILOT_STOP" => Self::AutopilotStop,
            _ => Self::Silent,
        })
    }
}

/// Rounds to the 16 bits of a debug value.
fn short(value: f64) -> i32 {
    i32::from(value.round() as i16)
}

/// Converts to hundredths: of a metre to centimetres.
fn hundredths(value: f64) -> i32 {
    short(100.0 * value)
}

/// Converts an angle to tenths of a degree.
fn angle(angle_rad: f64) -> i32 {
    short(10.0 * angle_rad.to_degrees())
}

/// Returns the present debug values.
pub(super) fn debug_values(source: DebugSource, firmware: &Firmware) -> [i32; DEBUG_VALUES] {
    let mut values = [0; DEBUG_VALUES];
    let mut set = |index: usize, value: i32| {
        if let Some(place) = values.get_mut(index) {
            *place = value;
        }
    };
    let (control, estimate) = (firmware.control(), firmware.estimate());
    let [roll_demand, pitch_demand] = control.angle_demand_rad.unwrap_or_default();
    match source {
        DebugSource::Silent => {}
        DebugSource::GyroFiltered => {
            let [roll, pitch, yaw] = control.gyro_dps;
            (0..).zip([roll, pitch, -yaw]).for_each(|(index, rate)| set(index, short(rate)));
        }
        DebugSource::GyroRaw => {
            let rates = &estimate.rates;
            let axes = [rates.roll, rates.pitch_down, -rates.yaw];
            (0..).zip(axes).for_each(|(index, rate)| set(index, short(rate.to_degrees())));
        }
        DebugSource::Accelerometer => {
            set(0, short(estimate.force_flu.x * (ACC_COUNTS_PER_G / GRAVITY)));
            set(2, short(1000.0 * estimate.force_flu.norm() / GRAVITY));
        }
        DebugSource::Battery => {
            set(1, short(firmware.battery().sample().map_or(0.0, |sample| 10.0 * sample.voltage_v)));
        }
        DebugSource::Altitude => {
            let solution = estimate.gps.solution.unwrap_or_default();
            let home_cm = firmware.safety.home_alt_amsl_cm.unwrap_or(solution.alt_amsl_cm);
            set(1, hundredths(estimate.baro_alt_m));
            set(2, short(f64::from(solution.alt_amsl_cm) - f64::from(home_cm)));
            set(3, hundredths(estimate.alt_m));
            set(4, hundredths(solution.vel_enu.z));
            set(5, hundredths(estimate.climb_mps));
        }
        DebugSource::Baro => set(3, hundredths(estimate.baro_alt_m)),
        DebugSource::Attitude => {
            set(0, angle(estimate.roll_rad));
            set(1, angle(estimate.pitch_down_rad));
        }
        DebugSource::AngleMode => {
            let angles = [estimate.roll_rad, roll_demand, estimate.pitch_down_rad, pitch_demand];
            (0..).zip(angles).for_each(|(index, value)| set(index, angle(value)));
        }
        DebugSource::AngleTarget => {
            set(0, angle(roll_demand));
            set(1, angle(pitch_demand));
        }
        DebugSource::CurrentAngle => {
            set(0, angle(estimate.roll_rad));
            set(1, angle(estimate.pitch_down_rad));
            set(2, short(estimate.heading_rad.to_degrees()));
        }
        DebugSource::GpsDop => {
            set(0, estimate.gps.sats.into());
            set(2, hundredths(estimate.gps.hdop));
        }
        DebugSource::Failsafe => {
            let receiver = firmware.receiver();
            set(1, firmware.navigation.failsafe.stage().into());
            set(2, receiver.signal().into());
            set(3, receiver.has_valid_channels().into());
        }
        DebugSource::AutopilotAltitude => {
            let altitude = firmware.navigation.altitude_controller();
            set(0, short(altitude.throttle_us()));
            set(1, hundredths(altitude.setpoint_m()));
            set(2, hundredths(estimate.alt_m));
            set(4, short(altitude.integral_us()));
        }
        DebugSource::AutopilotPid => {
            let nav = firmware.nav();
            let error = nav.target_ne.map_or(0.0, |target| (target - estimate.pos_ne).norm());
            set(0, hundredths(estimate.vel_ne.norm()));
            set(1, hundredths(error));
            set(7, nav.state as i32);
        }
        DebugSource::AutopilotStop => {
            set(4, angle(roll_demand));
            set(5, angle(pitch_demand));
            set(6, firmware.nav().state as i32);
        }
    }
    values
}
