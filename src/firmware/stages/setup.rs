//! The configuration of the craft and the typed parameters computed from it.

use crate::firmware::FirmwareOptions;
use crate::firmware::blackbox::FlashFacts;
use crate::firmware::cli::{BuildInfo, StorageFacts};
use crate::firmware::config::{Configuration, Feature, MixerKind, correct};
use crate::firmware::estimate::NotTurned;
use crate::firmware::outbox::Outbox;
use crate::firmware::parameters::{BootChoices, Parameters};
use crate::firmware::settings::Value;
use crate::telemetry::{FirmwareEvent, FirmwareNotice};

/// The configuration in memory, the choices made from it at boot, and the parameters in force.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct Setup {
    pub options: FirmwareOptions,
    pub build: BuildInfo,
    pub storage: StorageFacts,
    pub flash: FlashFacts,
    pub rewound: bool,
    pub configuration: Configuration,
    pub boot: BootChoices,
    pub parameters: Parameters,
}

impl Setup {
    /// Boots with this configuration after making it consistent.
    pub(in crate::firmware) fn new(
        mut configuration: Configuration,
        options: FirmwareOptions,
        outbox: &mut Outbox,
    ) -> Self {
        let had_gps = configuration.features.has(Feature::Gps);
        correct(&mut configuration);
        let boot = BootChoices::new(&configuration);
        let parameters = Parameters::new(&configuration, &boot, &options);
        if configuration.mixer.rows().is_none() && configuration.mixer != MixerKind::Custom {
            outbox.push(FirmwareEvent::Notice(FirmwareNotice::MixerNotFlown));
        }
        let (build, storage) = (BuildInfo::default(), StorageFacts::default());
        let (flash, rewound) = (FlashFacts::default(), false);
        let setup = Self { options, build, storage, flash, rewound, configuration, boot, parameters };
        setup.report_lost_gps(had_gps, outbox);
        setup
    }

    /// Returns the state after a restart with `configuration`. Facts about build and storage stay.
    pub(in crate::firmware) fn restarted(&self, configuration: Configuration, outbox: &mut Outbox) -> Self {
        let fresh = Self::new(configuration, self.options, outbox);
        Self {
            build: self.build.clone(),
            storage: self.storage.clone(),
            flash: self.flash,
            rewound: self.rewound,
            ..fresh
        }
    }

    /// Returns the length of a step, µs.
    pub(in crate::firmware) fn step_us(&self) -> u32 {
        1_000_000 / self.options.rate_hz.max(1)
    }

    /// Returns the time between two runs of the rate loop, µs.
    pub(in crate::firmware) fn loop_us(&self) -> u32 {
        self.step_us() * u32::from(self.boot.pid_denominator.max(1))
    }

    /// Updates the parameters from the configuration.
    pub(in crate::firmware) fn refresh(&mut self) {
        self.parameters = Parameters::new(&self.configuration, &self.boot, &self.options);
    }

    /// Turns runaway take-off prevention off until the next refresh if `allowed` is `false`. It cannot turn it on.
    pub(in crate::firmware) fn allow_runaway_prevention(&mut self, allowed: bool) {
        self.parameters.runaway.enabled &= allowed;
    }

    /// Makes the configuration consistent before it is stored. `had_gps` is the state of the GPS feature before the
    /// change.
    pub(in crate::firmware) fn make_consistent(&mut self, had_gps: bool, outbox: &mut Outbox) {
        correct(&mut self.configuration);
        self.report_lost_gps(had_gps, outbox);
    }

    /// Reports that making the configuration consistent turned the GPS off.
    fn report_lost_gps(&self, had_gps: bool, outbox: &mut Outbox) {
        if had_gps && !self.configuration.features.has(Feature::Gps) {
            outbox.push(FirmwareEvent::Notice(FirmwareNotice::GpsSwitchedOff));
        }
    }

    /// Stores the result of an accelerometer calibration and clears the trims, because the calibration includes them.
    pub(in crate::firmware) fn keep_acc_calibration(&mut self, offsets: [i64; 3]) {
        const DONE: i64 = 1;
        let [x, y, z] = offsets;
        let settings = &mut self.configuration.settings;
        // The estimator's offsets fit the setting's type, and 0 is in the range of every trim.
        let _kept = settings.set("acc_calibration", Value::Array(vec![x, y, z, DONE]));
        let _level = [settings.set_number("acc_trim_roll", 0), settings.set_number("acc_trim_pitch", 0)];
    }

    /// Stores the result of a magnetometer calibration. Returns the notice about it.
    pub(in crate::firmware) fn keep_mag_calibration(
        &mut self,
        result: Result<[i64; 3], NotTurned>,
    ) -> FirmwareEvent {
        FirmwareEvent::Notice(match result {
            Err(NotTurned) => FirmwareNotice::MagNotTurned,
            Ok(offsets) => {
                match self.configuration.settings.set("mag_calibration", Value::Array(offsets.to_vec())) {
                    Ok(()) => FirmwareNotice::MagCalibrated,
                    Err(_) => FirmwareNotice::MagOutOfRange,
                }
            }
        })
    }
}
