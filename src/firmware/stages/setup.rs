//! What the craft remembers, and the typed parameters made from it.

use crate::firmware::FirmwareOptions;
use crate::firmware::cli::{BuildInfo, StorageFacts};
use crate::firmware::config::{Configuration, Feature, MixerKind, correct};
use crate::firmware::estimate::NotTurned;
use crate::firmware::outbox::Outbox;
use crate::firmware::parameters::{BootChoices, Parameters};
use crate::firmware::settings::Value;
use crate::telemetry::{BadPackets, FirmwareEvent, FirmwareNotice, LostTime};

/// The configuration in memory, what was chosen from it at boot, and the parameters in force.
#[derive(Debug, Clone)]
pub(in crate::firmware) struct Setup {
    options: FirmwareOptions,
    build: BuildInfo,
    storage: StorageFacts,
    bad_packets: BadPackets,
    lost_time: LostTime,
    rewound: bool,
    configuration: Configuration,
    boot: BootChoices,
    parameters: Parameters,
}

impl Setup {
    /// Boots with this configuration, made consistent.
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
        let (bad_packets, lost_time) = (BadPackets::default(), LostTime::default());
        let rewound = false;
        let setup = Self {
            options,
            build,
            storage,
            bad_packets,
            lost_time,
            rewound,
            configuration,
            boot,
            parameters,
        };
        setup.report_lost_gps(had_gps, outbox);
        setup
    }

    /// What `configuration` boots into on this craft: build, storage and links stay.
    pub(in crate::firmware) fn restarted(&self, configuration: Configuration, outbox: &mut Outbox) -> Self {
        let fresh = Self::new(configuration, self.options, outbox);
        Self {
            build: self.build.clone(),
            storage: self.storage.clone(),
            bad_packets: self.bad_packets,
            lost_time: self.lost_time,
            rewound: self.rewound,
            ..fresh
        }
    }

    /// How the firmware is built and helped.
    pub(in crate::firmware) fn options(&self) -> &FirmwareOptions {
        &self.options
    }

    /// Version and build that the firmware announces.
    pub(in crate::firmware) fn build(&self) -> &BuildInfo {
        &self.build
    }

    /// Sets what [`Setup::build`] tells.
    pub(in crate::firmware) fn set_build(&mut self, build: BuildInfo) {
        self.build = build;
    }

    /// What is known of the stored configuration.
    pub(in crate::firmware) fn storage(&self) -> &StorageFacts {
        &self.storage
    }

    /// Sets what [`Setup::storage`] tells.
    pub(in crate::firmware) fn set_storage(&mut self, storage: StorageFacts) {
        self.storage = storage;
    }

    /// What scripts and simulators sent in vain.
    pub(in crate::firmware) fn bad_packets(&self) -> BadPackets {
        self.bad_packets
    }

    /// Sets what [`Setup::bad_packets`] tells.
    pub(in crate::firmware) fn set_bad_packets(&mut self, bad_packets: BadPackets) {
        self.bad_packets = bad_packets;
    }

    /// Real time that the flight could not keep up with.
    pub(in crate::firmware) fn lost_time(&self) -> LostTime {
        self.lost_time
    }

    /// Sets what [`Setup::lost_time`] tells.
    pub(in crate::firmware) fn set_lost_time(&mut self, lost_time: LostTime) {
        self.lost_time = lost_time;
    }

    /// Whether an earlier instant is shown, during which clients change nothing.
    pub(in crate::firmware) fn rewound(&self) -> bool {
        self.rewound
    }

    /// Sets [`Setup::rewound`].
    pub(in crate::firmware) fn set_rewound(&mut self, rewound: bool) {
        self.rewound = rewound;
    }

    /// The configuration in memory.
    pub(in crate::firmware) fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// The configuration in memory, to be changed; [`Setup::refresh`] makes the parameters follow.
    pub(in crate::firmware) fn configuration_mut(&mut self) -> &mut Configuration {
        &mut self.configuration
    }

    /// What changes only with a restart.
    pub(in crate::firmware) fn boot(&self) -> &BootChoices {
        &self.boot
    }

    /// The typed parameters in force.
    pub(in crate::firmware) fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Makes the parameters follow the configuration.
    pub(in crate::firmware) fn refresh(&mut self) {
        self.parameters = Parameters::new(&self.configuration, &self.boot, &self.options);
    }

    /// Turns runaway take-off prevention off until the next refresh, when `allowed` is false; it cannot turn it on.
    pub(in crate::firmware) fn allow_runaway_prevention(&mut self, allowed: bool) {
        self.parameters.runaway.enabled &= allowed;
    }

    /// Makes the configuration consistent before it is stored; `had_gps` is the GPS feature before it was changed.
    pub(in crate::firmware) fn make_consistent(&mut self, had_gps: bool, outbox: &mut Outbox) {
        correct(&mut self.configuration);
        self.report_lost_gps(had_gps, outbox);
    }

    /// Says so when making the configuration consistent took the GPS away.
    fn report_lost_gps(&self, had_gps: bool, outbox: &mut Outbox) {
        if had_gps && !self.configuration.features.has(Feature::Gps) {
            outbox.push(FirmwareEvent::Notice(FirmwareNotice::GpsSwitchedOff));
        }
    }

    /// Keeps the result of an accelerometer calibration: it includes what the trims levelled.
    pub(in crate::firmware) fn keep_acc_calibration(&mut self, offsets: [i64; 3]) {
        const DONE: i64 = 1;
        let [x, y, z] = offsets;
        let settings = &mut self.configuration.settings;
        // The estimator's offsets fit the setting's type, and 0 is in every trim's range.
        let _kept = settings.set("acc_calibration", Value::Array(vec![x, y, z, DONE]));
        let _level = [settings.set_number("acc_trim_roll", 0), settings.set_number("acc_trim_pitch", 0)];
    }

    /// Keeps the result of a magnetometer calibration, and says how it went.
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
