//! Saving the configuration of a firmware and starting it anew, the same for the clients of the links and for the console.

use crate::firmware::Firmware;
use crate::storage::Store;

/// Stores what the firmware has in memory.
///
/// # Errors
/// The sentence for the user when it could not be stored.
pub(super) fn save(firmware: &mut Firmware, store: &mut Store) -> Result<(), String> {
    let saved = store.save(firmware.configuration());
    firmware.set_storage_facts(store.facts());
    saved.map_err(|error| format!("Not saved: {error}."))
}

/// Starts the firmware anew on what is stored; `starter_modes` gives a craft without mode conditions the usual ones.
/// Gives what is wrong with the stored configuration, as sentences.
pub(super) fn restart(firmware: &mut Firmware, store: &mut Store, starter_modes: bool) -> Vec<String> {
    let loaded = store.load();
    let mut configuration = loaded.configuration;
    if starter_modes {
        configuration.starter_modes();
    }
    firmware.restart(configuration);
    firmware.set_storage_facts(store.facts());
    loaded.findings
}
