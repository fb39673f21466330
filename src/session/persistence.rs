//! Saves the configuration of the flight controller and restarts it, the same for the clients of the links and for the
//! console. A remote flight controller stores its configuration itself.

use crate::firmware::config::Configuration;
use crate::storage::Store;
use crate::vehicle::FlightController;

/// Where the configuration of an embedded flight controller is kept.
#[derive(Debug)]
pub struct Persistence {
    store: Store,
    /// What a restart returns to until something is saved: beside what was stored, what the plan and the options gave.
    at_boot: Option<Box<Configuration>>,
    /// A craft without mode conditions gets the starter modes at every restart.
    starter_modes: bool,
}

impl Persistence {
    /// Keeps the configuration of `controller`, which has just booted, in `store`; `starter_modes` gives a craft without
    /// mode conditions the usual ones at every restart.
    #[must_use]
    pub fn new(store: Store, controller: &FlightController, starter_modes: bool) -> Self {
        let at_boot = controller.configuration().cloned().map(Box::new);
        Self { store, at_boot, starter_modes }
    }

    /// Stores what the flight controller has in memory.
    ///
    /// # Errors
    /// The sentence for the user when it could not be stored.
    pub(super) fn save(&mut self, controller: &mut FlightController) -> Result<(), String> {
        let Some(configuration) = controller.configuration() else { return Ok(()) };
        let saved = self.store.save(configuration);
        controller.set_storage_facts(self.store.facts());
        if saved.is_ok() {
            self.at_boot = None;
        }
        saved.map_err(|error| format!("Not saved: {error}."))
    }

    /// Restarts the flight controller on what was saved last, or what it booted with. Gives sentences for the user: what
    /// is wrong with the stored configuration, and that the craft got the starter modes.
    pub(super) fn restart(&mut self, controller: &mut FlightController) -> Vec<String> {
        let mut notices = Vec::new();
        controller.restart(|| {
            let loaded = self.store.load();
            notices = loaded.findings;
            let mut configuration =
                self.at_boot.as_deref().map_or(loaded.configuration, Configuration::clone);
            if self.starter_modes && configuration.starter_modes() {
                notices.push(Configuration::STARTER_MODES_NOTICE.to_owned());
            }
            configuration
        });
        controller.set_storage_facts(self.store.facts());
        notices
    }
}
