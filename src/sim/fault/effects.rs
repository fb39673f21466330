//! The combined effects of the active faults on the plant, the sensors and the links.

use nalgebra::Vector3;

use crate::math;
use crate::sim::airframe::ROTORS;
use crate::sim::battery::BatteryFaults;
use crate::sim::wind::Wind;

use super::{BatteryFault, Fault};

/// The sum of all active faults.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::sim) struct Effects {
    pub rx_loss: bool,
    pub rx_jitter: f64,
    pub gps: GpsFaults,
    pub baro_drift_pa_per_s: f64,
    pub baro_spike_pa: f64,
    /// `true` to repeat the last pressure.
    pub baro_freeze: bool,
    pub mag_off: bool,
    pub mag_bias_rad: f64,
    pub gyro_bias: Vector3<f64>,
    pub acc_bias: Vector3<f64>,
    pub imu_freeze: bool,
    pub efficiency: [f64; ROTORS],
    pub stuck: [Option<f64>; ROTORS],
    pub imbalance_mps2: [f64; ROTORS],
    pub vibration_mps2: f64,
    pub battery: BatteryFaults,
    pub wind: Option<Wind>,
    pub payload_kg: f64,
    pub link: LinkFaults,
}

/// The faults of the GPS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct GpsFaults {
    pub loss: bool,
    /// Shift of the position, ENU, m.
    pub shift_enu: Vector3<f64>,
    /// `true` to repeat the last solution.
    pub freeze: bool,
    /// The additional age of each solution, s.
    pub delay_s: f64,
    pub noise_factor: f64,
}

/// The faults of the link to an external simulator.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinkFaults {
    /// `true` while nothing arrives.
    pub stall: bool,
    /// Fraction of packets that are lost.
    pub loss: f64,
    /// Delay of every packet, ms.
    pub late_ms: f64,
    /// Fraction of packets that come twice.
    pub duplicated: f64,
    /// Maximum additional random delay, ms.
    pub jitter_ms: f64,
}

impl Effects {
    pub(crate) const NONE: Self = Self {
        rx_loss: false,
        rx_jitter: 0.0,
        gps: GpsFaults {
            loss: false,
            shift_enu: Vector3::new(0.0, 0.0, 0.0),
            freeze: false,
            delay_s: 0.0,
            noise_factor: 1.0,
        },
        baro_drift_pa_per_s: 0.0,
        baro_spike_pa: 0.0,
        baro_freeze: false,
        mag_off: false,
        mag_bias_rad: 0.0,
        gyro_bias: Vector3::new(0.0, 0.0, 0.0),
        acc_bias: Vector3::new(0.0, 0.0, 0.0),
        imu_freeze: false,
        efficiency: [1.0; ROTORS],
        stuck: [None; ROTORS],
        imbalance_mps2: [0.0; ROTORS],
        vibration_mps2: 0.0,
        battery: BatteryFaults { offset_v: 0.0, dead_cells: 0 },
        wind: None,
        payload_kg: 0.0,
        link: LinkFaults { stall: false, loss: 0.0, late_ms: 0.0, duplicated: 0.0, jitter_ms: 0.0 },
    };

    /// Adds one active fault. Instant faults and gusts have already acted.
    pub(crate) fn add(&mut self, fault: &Fault) {
        match *fault {
            Fault::RxLoss => self.rx_loss = true,
            Fault::RxJitter(fraction) => self.rx_jitter = fraction,
            Fault::GpsLoss => self.gps.loss = true,
            Fault::GpsGlitch(metres, bearing_deg) => {
                let (east, north) = math::sin_cos(bearing_deg.to_radians());
                self.gps.shift_enu = Vector3::new(metres * east, metres * north, 0.0);
            }
            Fault::GpsFreeze => self.gps.freeze = true,
            Fault::GpsDelay(delay_s) => self.gps.delay_s = delay_s,
            Fault::GpsNoise(factor) => self.gps.noise_factor = factor,
            Fault::BaroDrift(rate) => self.baro_drift_pa_per_s = rate,
            Fault::BaroSpike(size) => self.baro_spike_pa = size,
            Fault::BaroFreeze => self.baro_freeze = true,
            Fault::MagOff => self.mag_off = true,
            Fault::MagBias(degrees) => self.mag_bias_rad = degrees.to_radians(),
            Fault::GyroBias(degrees) => self.gyro_bias.x = degrees.to_radians(),
            Fault::AccBias(bias) => self.acc_bias.x = bias,
            Fault::ImuFreeze => self.imu_freeze = true,
            Fault::Motor(motor, efficiency) => self.efficiency[motor.index()] = efficiency,
            Fault::MotorStuck(motor, command) => self.stuck[motor.index()] = Some(command),
            Fault::PropImbalance(motor, shake) => self.imbalance_mps2[motor.index()] = shake,
            Fault::Vibration(rms) => self.vibration_mps2 = rms,
            Fault::Battery(BatteryFault::Offset(volts)) => self.battery.offset_v = volts,
            Fault::Battery(BatteryFault::CellOut) => self.battery.dead_cells = 1,
            Fault::Wind(wind) => self.wind = Some(wind),
            Fault::Payload(mass) => self.payload_kg = mass,
            Fault::Stall => self.link.stall = true,
            Fault::FdmLoss(fraction) => self.link.loss = fraction,
            Fault::FdmLate(delay) => self.link.late_ms = delay,
            Fault::FdmDup(fraction) => self.link.duplicated = fraction,
            Fault::FdmJitter(delay) => self.link.jitter_ms = delay,
            Fault::Gust(_) | Fault::Push(..) | Fault::Teleport(_) => {}
        }
    }
}
