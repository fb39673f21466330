//! What the sensors say for themselves: fix, battery, hanging samples, calibrations.

use crate::signals::BatterySample;

use super::Firmware;
use super::battery::BatteryState;
use crate::telemetry::FirmwareEvent;

impl Firmware {
    /// Tells what the sensors have to say for themselves, and keeps the results of calibrations.
    pub(super) fn sensor_pass(&mut self) {
        let frozen = self.estimator.estimate().imu_frozen;
        if frozen && !self.imu_frozen {
            self.outbox.push(FirmwareEvent::Notice("The inertial sensors repeat one sample: they hang."));
        }
        self.imu_frozen = frozen;
        if let Some(offsets) = self.estimator.take_acc_calibration() {
            self.keep_acc_calibration(offsets);
        }
        if let Some(result) = self.estimator.take_mag_calibration() {
            self.keep_mag_calibration(result);
        }
    }

    pub(super) fn follow_fix(&mut self) {
        let gps = self.estimator.estimate().gps;
        let fix = gps.fix && self.parameters.gps;
        if fix == self.fix {
            return;
        }
        self.fix = fix;
        self.fix_since = self.now;
        self.outbox.push(match fix {
            true => FirmwareEvent::GpsFix { sats: gps.sats },
            false => FirmwareEvent::GpsLost { sats: gps.sats },
        });
    }

    pub(super) fn hear_battery(&mut self, sample: BatterySample) {
        let Some(state) = self.battery.receive(&self.parameters.battery, sample) else { return };
        match state {
            BatteryState::Warning => {
                self.outbox.push(FirmwareEvent::Notice("Battery low: land soon."));
            }
            BatteryState::Critical => {
                self.outbox.push(FirmwareEvent::Notice("Battery critical: land now."));
            }
            BatteryState::Init | BatteryState::NotPresent | BatteryState::Ok => {}
        }
    }
}
