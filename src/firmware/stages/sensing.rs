//! The estimator, the battery, and the health of the sensors: fix, frozen samples, calibrations.

use nalgebra::Vector3;

use crate::firmware::FirmwareOptions;
use crate::firmware::battery::Battery;
use crate::firmware::estimate::{DueTasks, Estimate, Estimator, EstimatorOptions, pressure_altitude_m};
use crate::firmware::outbox::Outbox;
use crate::firmware::parameters::Parameters;
use crate::msp::BatteryState;
use crate::signals::{BatterySample, SensorFrame};
use crate::telemetry::{BatteryAlarm, FirmwareEvent, FirmwareNotice};

/// The state of the craft from its sensors.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct Sensing {
    pub estimator: Estimator,
    pub battery: Battery,
    imu_frozen: bool,
    /// The newest magnetic field, body forward-left-up, as measured.
    pub mag_flu: Vector3<f64>,
    pub fix: bool,
    site_alt_m: f64,
    pressure_alt_m: Option<f64>,
    /// `true` if the magnetometer was reported as doubted.
    heading_doubted: bool,
    /// `true` if the tilt was reported as doubted.
    tilt_doubted: bool,
}

impl Sensing {
    /// Creates the state at boot, in which nothing is known yet.
    pub(in crate::firmware) fn new(firmware: &FirmwareOptions, parameters: &Parameters) -> Self {
        let options = EstimatorOptions {
            attitude: firmware.attitude,
            gps_timeout_s: firmware.gps_timeout_s,
            declination_deg: firmware.declination_deg,
        };
        Self {
            estimator: Estimator::new(options, parameters.estimator.clone()),
            battery: Battery::default(),
            imu_frozen: false,
            mag_flu: Vector3::zeros(),
            fix: false,
            site_alt_m: firmware.site_alt_m,
            pressure_alt_m: None,
            heading_doubted: false,
            tilt_doubted: false,
        }
    }

    /// Returns the altitude above the site by the newest sample of the barometer, m.
    pub(in crate::firmware) fn pressure_alt_m(&self) -> Option<f64> {
        self.pressure_alt_m
    }

    pub(in crate::firmware) fn set_tuning(&mut self, parameters: &Parameters) {
        self.estimator.set_tuning(parameters.estimator.clone());
    }

    /// Takes the samples of one step. Returns the slower loops that are due.
    pub(in crate::firmware) fn update(
        &mut self,
        frame: &SensorFrame,
        parameters: &Parameters,
        outbox: &mut Outbox,
    ) -> DueTasks {
        let due = self.estimator.update(frame);
        if let Some(sample) = frame.battery {
            self.update_battery(sample, parameters, outbox);
        }
        // A broken sample would stay in the target of a mission that begins now.
        let altitude_m = frame.pressure_pa.map(pressure_altitude_m).filter(|altitude| altitude.is_finite());
        self.pressure_alt_m = altitude_m.map(|altitude| altitude - self.site_alt_m).or(self.pressure_alt_m);
        self.mag_flu = frame.mag_flu.unwrap_or(self.mag_flu);
        due
    }

    fn update_battery(&mut self, sample: BatterySample, parameters: &Parameters, outbox: &mut Outbox) {
        let state = match self.battery.receive(&parameters.battery, sample) {
            Some(BatteryState::Warning) => BatteryAlarm::Warning,
            Some(BatteryState::Critical) => BatteryAlarm::Critical,
            Some(BatteryState::Init | BatteryState::NotPresent | BatteryState::Ok) | None => return,
        };
        outbox.push(FirmwareEvent::Battery { state, cell_v: self.battery.cell_v() });
    }

    /// Reports inertial sensors that begin to repeat the same sample.
    pub(in crate::firmware) fn watch_imu(&mut self, outbox: &mut Outbox) {
        let frozen = self.estimate().imu_frozen;
        if frozen && !self.imu_frozen {
            outbox.push(FirmwareEvent::Notice(FirmwareNotice::ImuFrozen));
        }
        self.imu_frozen = frozen;
    }

    /// Reports a magnetometer or a tilt that is doubted, or trusted again.
    pub(in crate::firmware) fn watch_doubts(&mut self, outbox: &mut Outbox) {
        let tilt = self.estimate().tilt_doubt_rad;
        if tilt.is_some() != self.tilt_doubted {
            self.tilt_doubted = tilt.is_some();
            let error_deg = tilt.unwrap_or_default().to_degrees();
            outbox.push(FirmwareEvent::TiltDoubt { on: self.tilt_doubted, error_deg });
        }
        let doubt = self.estimate().heading_doubt_rad;
        if doubt.is_some() != self.heading_doubted {
            self.heading_doubted = doubt.is_some();
            let error_deg = doubt.unwrap_or_default().to_degrees();
            outbox.push(FirmwareEvent::HeadingDoubt { on: self.heading_doubted, error_deg });
        }
    }

    /// Reports a fix that comes or goes.
    pub(in crate::firmware) fn watch_fix(&mut self, parameters: &Parameters, outbox: &mut Outbox) {
        let gps = self.estimate().gps;
        let fix = gps.fix && parameters.gps;
        if fix == self.fix {
            return;
        }
        self.fix = fix;
        outbox.push(match fix {
            true => FirmwareEvent::GpsFix { sats: gps.sats },
            false => FirmwareEvent::GpsLost { sats: gps.sats },
        });
    }

    pub(in crate::firmware) fn estimate(&self) -> &Estimate {
        self.estimator.estimate()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::config::Configuration;
    use crate::firmware::parameters::BootChoices;

    #[test]
    fn a_pressure_that_is_no_number_leaves_the_altitude_as_it_was() {
        let (configuration, options) = (Configuration::default(), FirmwareOptions::default());
        let boot = BootChoices::new(&configuration);
        let parameters = Parameters::new(&configuration, &boot, &options);
        let mut sensing = Sensing::new(&options, &parameters);
        let mut feel = |pressure_pa| {
            let frame = SensorFrame { pressure_pa: Some(pressure_pa), ..SensorFrame::default() };
            sensing.update(&frame, &parameters, &mut Outbox::default());
            sensing.pressure_alt_m()
        };
        let before = feel(97_773.0);
        assert!(before.is_some_and(|altitude| (altitude - 300.0).abs() < 1.0), "{before:?}");
        assert_eq!(feel(f64::NAN), before);
        assert_eq!(feel(-1.0), before);
    }
}
