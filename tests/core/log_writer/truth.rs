//! The values of a step, in the units of a log but not rounded.

use betadeck_core::firmware::Firmware;
use betadeck_core::firmware::control::ControlState;
use betadeck_core::firmware::estimate::Estimate;
use betadeck_core::firmware::rx::Sticks;
use betadeck_core::signals::BatterySample;
use nalgebra::{UnitQuaternion, Vector3};

/// The counts of the accelerometer for 1 m/s².
const ACC_COUNTS: f64 = 256.0 / 9.806_65;

/// The state after a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Step {
    control: ControlState,
    estimate: Estimate,
    sticks: Sticks,
    battery: BatterySample,
    mag_flu: Vector3<f64>,
    rssi: u16,
    /// The throttle pulse at which the mixer's range begins, µs.
    zero_us: f64,
    /// The units of a degree per second.
    scale: f64,
}

impl Step {
    pub(crate) fn of(firmware: &Firmware) -> Self {
        let is_fine = firmware.configuration().settings.flag("blackbox_high_resolution");
        let facts = firmware.msp_facts(None);
        Self {
            control: *firmware.control(),
            estimate: *firmware.estimate(),
            sticks: *firmware.receiver().sticks(),
            battery: firmware.battery().sample().copied().unwrap_or_default(),
            mag_flu: facts.mag_flu,
            rssi: facts.rssi,
            zero_us: firmware.parameters().control.throttle.zero_us,
            scale: if is_fine { 10.0 } else { 1.0 },
        }
    }

    /// Returns the value of a field, or `None` for a name that no log has.
    pub(crate) fn value(&self, field: &str) -> Option<f64> {
        let (name, index) = match field.split_once('[') {
            Some((name, rest)) => (name, rest.strip_suffix(']')?.parse().ok()?),
            None => (field, 0),
        };
        let Self { control, estimate, sticks, scale, .. } = self;
        let anticlockwise = |[roll, pitch, yaw]: [f64; 3]| [roll, pitch, -yaw].get(index).copied();
        let vector = |vector: Vector3<f64>| vector.iter().nth(index).copied();
        let scaled = |value: Option<f64>| value.map(|value| scale * value);
        match (name, index) {
            ("axisP", _) => anticlockwise(control.terms.p),
            ("axisI", _) => anticlockwise(control.terms.i),
            ("axisD", _) => anticlockwise(control.terms.d),
            ("axisF", _) => anticlockwise(control.terms.f),
            ("rcCommand", 3) => Some(scale * sticks.throttle_us),
            ("rcCommand", _) => scaled(anticlockwise([sticks.roll, sticks.pitch, sticks.yaw])),
            ("setpoint", 3) => {
                Some((1000.0 * (control.throttle_us - self.zero_us) / (2000.0 - self.zero_us)).max(0.0))
            }
            ("setpoint", _) => scaled(anticlockwise(control.setpoint_dps)),
            ("vbatLatest", _) => Some(100.0 * self.battery.voltage_v),
            ("amperageLatest", _) => Some(100.0 * self.battery.current_a),
            ("magADC", _) => vector(self.mag_flu),
            ("baroAlt", _) => Some(100.0 * estimate.baro_alt_m),
            ("rssi", _) => Some(f64::from(self.rssi)),
            ("gyroADC", _) => scaled(anticlockwise(control.gyro_dps)),
            ("gyroUnfilt", _) => {
                let rates = &estimate.rates;
                scaled(anticlockwise([rates.roll, rates.pitch_down, rates.yaw].map(f64::to_degrees)))
            }
            ("accSmooth", _) => vector(ACC_COUNTS * estimate.force_flu),
            ("imuQuaternion", _) => {
                let to_nwu =
                    UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -std::f64::consts::FRAC_PI_2);
                let nwu = to_nwu * estimate.attitude;
                vector((32_767.0 * nwu.w.signum()) * nwu.imag())
            }
            ("motor", _) => control.motors_us.get(index).copied(),
            _ => self.gps_value(name, index),
        }
    }

    fn gps_value(&self, name: &str, index: usize) -> Option<f64> {
        let gps = &self.estimate.gps;
        let solution = gps.solution?;
        let (east, north, up) = (solution.vel_enu.x, solution.vel_enu.y, solution.vel_enu.z);
        Some(match (name, index) {
            ("GPS_numSat", _) => f64::from(gps.sats),
            ("GPS_coord", 0) => f64::from(solution.position.lat_e7),
            ("GPS_coord", _) => f64::from(solution.position.lon_e7),
            ("GPS_altitude", _) => f64::from(solution.alt_amsl_cm) / 10.0,
            ("GPS_speed", _) => 100.0 * east.hypot(north),
            ("GPS_ground_course", _) => 10.0 * east.atan2(north).to_degrees().rem_euclid(360.0),
            ("GPS_velned", _) => 100.0 * [north, east, -up].get(index)?,
            _ => return None,
        })
    }
}
