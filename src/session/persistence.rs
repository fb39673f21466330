//! Saves the configuration of the flight controller and restarts it, the same for the clients of the links and for the
//! console. A remote flight controller stores its configuration itself.

use crate::storage::Store;
use crate::vehicle::FlightController;

/// Where the configuration of an embedded flight controller is kept.
#[derive(Debug)]
pub struct Persistence {
    store: Store,
    /// A craft without mode conditions gets the starter modes at every restart.
    starter_modes: bool,
}

impl Persistence {
    /// Keeps the configuration in `store`; `starter_modes` gives a craft without mode conditions the usual ones at every
    /// restart.
    #[must_use]
    pub fn new(store: Store, starter_modes: bool) -> Self {
        Self { store, starter_modes }
    }

    /// Stores what the flight controller has in memory.
    ///
    /// # Errors
    /// The sentence for the user when it could not be stored.
    pub(super) fn save(&mut self, controller: &mut FlightController) -> Result<(), String> {
        let Some(configuration) = controller.configuration() else { return Ok(()) };
        let saved = self.store.save(configuration);
        controller.set_storage_facts(self.store.facts());
        saved.map_err(|error| format!("Not saved: {error}."))
    }

    /// Restarts the flight controller on what is stored. Gives what is wrong with that, as sentences.
    pub(super) fn restart(&mut self, controller: &mut FlightController) -> Vec<String> {
        let mut findings = Vec::new();
        controller.restart(|| {
            let loaded = self.store.load();
            findings = loaded.findings;
            let mut configuration = loaded.configuration;
            if self.starter_modes {
                configuration.starter_modes();
            }
            configuration
        });
        controller.set_storage_facts(self.store.facts());
        findings
    }
}
