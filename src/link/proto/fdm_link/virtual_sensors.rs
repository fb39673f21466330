//! Virtual sensors that sample the simulator's state.

use nalgebra::Vector3;

use crate::geo::LatLon;
use crate::link::proto::fdm::State;
use crate::signals::{GpsSample, SensorFrame, SimTime};

/// The magnetic field, ENU, counts: 60° dip, 2° east declination.
const FIELD_ENU: Vector3<f64> = Vector3::new(71.5, 2046.8, -3547.2);
/// The number of satellites of the virtual receiver.
const SATS: u8 = 12;
/// The accuracy of the virtual receiver, m.
const ACCURACY_M: f64 = 0.5;
/// The period of the barometer, µs.
const BARO_US: u64 = 20_000;
/// The period of the magnetometer, µs.
const MAG_US: u64 = 10_000;
/// The period of the GPS, µs.
const GPS_US: u64 = 100_000;

/// A sensor that samples less often than packets arrive.
#[derive(Debug, Clone, Default)]
struct Sampler {
    left_us: u64,
}

impl Sampler {
    /// Returns `true` if a sample is due after `elapsed_us`. The first is due at once. While time does not
    /// advance, no sample is due because no tick would use it. A sample that could not be taken stays due.
    fn is_due(&mut self, elapsed_us: u64, period_us: u64, possible: bool) -> bool {
        self.left_us = self.left_us.saturating_sub(elapsed_us);
        let due = possible && elapsed_us > 0 && self.left_us == 0;
        if due {
            self.left_us = period_us;
        }
        due
    }
}

#[derive(Debug, Clone, Default)]
pub(super) struct VirtualSensors {
    baro: Sampler,
    mag: Sampler,
    gps: Sampler,
}

impl VirtualSensors {
    /// Returns the sensor frame of a state, `elapsed_us` of firmware time after the previous one.
    pub(super) fn frame(&mut self, state: &State, has_position: bool, elapsed_us: u64) -> SensorFrame {
        let baro = self.baro.is_due(elapsed_us, BARO_US, true);
        let mag = self.mag.is_due(elapsed_us, MAG_US, true);
        let gps = self.gps.is_due(elapsed_us, GPS_US, has_position);
        SensorFrame {
            time: SimTime::ZERO,
            rate_flu: state.rate_flu,
            specific_force_flu: state.specific_force_flu,
            pressure_pa: baro.then_some(state.pressure_pa),
            mag_flu: mag.then(|| state.attitude.inverse_transform_vector(&FIELD_ENU)),
            gps: gps.then(|| GpsSample {
                fix: true,
                sats: SATS,
                // Truncated, not rounded, as receivers of this resolution do.
                position: LatLon::new((state.lat_deg * 1e7) as i32, (state.lon_deg * 1e7) as i32),
                alt_amsl_cm: (state.alt_m * 100.0) as i32,
                vel_enu: state.vel_enu,
                hdop: 0.0,
                horizontal_accuracy_m: ACCURACY_M,
                vertical_accuracy_m: ACCURACY_M,
                // The velocity of the packet is exact. The original's 0.4 m/s would only reduce its weight.
                speed_accuracy_mps: 0.0,
                latency_s: 0.0,
            }),
            battery: None,
            truth_attitude: Some(state.attitude),
        }
    }
}
