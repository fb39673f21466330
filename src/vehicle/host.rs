//! The exchange between a flight controller and the program around it: facts that its command line prints, its log, and the
//! mailbox of a remote one. Facts and the log do not change the flight, so they are not among the inputs of the vehicle.
//! A vehicle with a remote flight controller records no inputs.

use super::{LateAnswer, RemoteController, Ticket, Vehicle};
use crate::firmware::Firmware;
use crate::firmware::blackbox::FlashFacts;
use crate::firmware::cli::{BuildInfo, StorageFacts};

impl Vehicle {
    /// Sets the facts about the stored configuration that the commands of an embedded controller report.
    #[doc(hidden)]
    pub fn set_storage_facts(&mut self, facts: StorageFacts) {
        self.with_firmware(|firmware| firmware.set_storage_facts(facts));
    }

    /// Sets the facts about the flash memory for logs that an embedded controller reports.
    #[doc(hidden)]
    pub fn set_flash_facts(&mut self, facts: FlashFacts) {
        self.with_firmware(|firmware| firmware.set_flash_facts(facts));
    }

    /// Sets the flag that an earlier instant is shown instead of the present one, for the commands of an embedded
    /// controller.
    #[doc(hidden)]
    pub fn set_rewound(&mut self, rewound: bool) {
        self.with_firmware(|firmware| firmware.set_rewound(rewound));
    }

    /// Sets version and build that an embedded controller announces.
    pub fn set_build(&mut self, build: BuildInfo) {
        self.with_firmware(|firmware| firmware.set_build(build));
    }

    /// Logs the flight whatever the settings say, or ends that. Returns `false` for a remote controller, which writes its
    /// own logs.
    pub fn set_logs(&mut self, wanted: bool) -> bool {
        self.with_firmware(|firmware| firmware.set_logs(wanted)).is_some()
    }

    /// Begins a new log, if an embedded controller writes one.
    pub fn begin_new_log(&mut self) {
        self.with_firmware(Firmware::begin_new_log);
    }

    /// Returns the mailbox of a remote controller, for the code that communicates with it.
    pub fn remote_mut(&mut self) -> Option<&mut RemoteController> {
        self.controller.remote_mut()
    }

    /// Takes the oldest late answer of a remote controller that was not taken yet.
    pub fn take_answer(&mut self) -> Option<(Ticket, LateAnswer)> {
        self.controller.take_answer()
    }

    fn with_firmware<T>(&mut self, act: impl FnOnce(&mut Firmware) -> T) -> Option<T> {
        self.controller.embedded_mut().map(act)
    }
}
