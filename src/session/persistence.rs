//! Saves the configuration of the flight controller and restarts it, for the clients of the links and for the
//! console alike, and keeps its logs. A remote flight controller stores both itself.

use super::flight_logs::FlightLogs;
use crate::events::Notice;
use crate::firmware::cli::{CliAction, CliReply};
use crate::firmware::config::Configuration;
use crate::storage::Store;
use crate::vehicle::{Vehicle, VehicleCommand};

/// The storage for the configuration of an embedded flight controller.
#[derive(Debug)]
pub struct Persistence {
    store: Store,
    /// The configuration that a restart returns to until something is saved: the stored one, plus the
    /// settings from the plan and the options.
    at_boot: Option<Box<Configuration>>,
    /// The configuration that was saved last by this program.
    saved: Option<Box<Configuration>>,
    /// `true` if a craft without mode conditions gets the starter modes at every restart.
    starter_modes: bool,
    logs: FlightLogs,
}

/// The effects of saving and restarting for a line of the command line.
#[derive(Debug, Default)]
pub(super) struct CarriedOut {
    /// `Some` if the flight controller restarted, with `true` if the clients' links are closed.
    pub restarted: Option<bool>,
    /// Sentences for the user.
    pub notices: Vec<Notice>,
}

impl Persistence {
    /// Keeps the configuration of `vehicle`, which has just booted, in `store`. With `starter_modes`, a
    /// craft without mode conditions gets the usual ones at every restart.
    pub fn new(store: Store, vehicle: &mut Vehicle, starter_modes: bool) -> Self {
        vehicle.set_storage_facts(store.facts());
        let at_boot = vehicle.controller().configuration().cloned().map(Box::new);
        let logs = FlightLogs::new(store.log_folder());
        Self { store, at_boot, saved: None, starter_modes, logs }
    }

    /// Returns the blackbox logs of the craft.
    pub(super) fn logs(&mut self) -> &mut FlightLogs {
        &mut self.logs
    }

    /// Stores the configuration in the flight controller's memory.
    ///
    /// # Errors
    /// Returns the sentence for the user if it could not be stored.
    pub(super) fn save(&mut self, vehicle: &mut Vehicle) -> Result<(), String> {
        let Some(configuration) = vehicle.controller().configuration() else { return Ok(()) };
        let saved = self.store.save(configuration);
        if saved.is_ok() {
            self.at_boot = None;
            self.saved = Some(Box::new(configuration.clone()));
        }
        vehicle.set_storage_facts(self.store.facts());
        saved.map_err(|error| format!("Not saved: {error}."))
    }

    /// Returns the configuration to which a restart returns; `None` for a remote flight controller.
    pub(super) fn after_restart(&self) -> Option<&Configuration> {
        self.saved.as_deref().or(self.at_boot.as_deref())
    }

    /// Updates the storage facts of `vehicle`, which was restored from an earlier instant.
    pub(super) fn report_facts(&self, vehicle: &mut Vehicle) {
        vehicle.set_storage_facts(self.store.facts());
    }

    /// Saves and restarts as the answer to a line requires, with the restart last. If saving fails, the
    /// answer becomes a refusal, and nothing restarts.
    pub(super) fn carry_out(&mut self, reply: &mut CliReply, vehicle: &mut Vehicle) -> CarriedOut {
        let mut done = CarriedOut::default();
        if reply.actions.contains(&CliAction::Save)
            && let Err(notice) = self.save(vehicle)
        {
            reply.refuse_save(&notice);
            done.notices.push(Notice::warning(notice));
        }
        let restart = reply.actions.iter().find_map(|action| match action {
            CliAction::Restart { close_links } => Some(*close_links),
            _ => None,
        });
        if restart.is_some() {
            done.notices.extend(self.restart(vehicle));
        }
        done.restarted = restart;
        done
    }

    /// Restarts the flight controller on the configuration that was saved last, or the one at boot. Returns
    /// sentences for the user: the faults of the stored configuration, and that the craft got the starter
    /// modes.
    pub(super) fn restart(&mut self, vehicle: &mut Vehicle) -> Vec<Notice> {
        if vehicle.embedded().is_none() {
            // It restarts on its own stored configuration.
            vehicle.apply(&VehicleCommand::Restart(Box::default()));
            return Vec::new();
        }
        let loaded = self.store.load();
        let mut notices: Vec<Notice> = loaded.findings.into_iter().map(Notice::warning).collect();
        let mut configuration = self.at_boot.as_deref().map_or(loaded.configuration, Configuration::clone);
        if self.starter_modes && configuration.starter_modes() {
            notices.push(Configuration::STARTER_MODES_NOTICE.into());
        }
        vehicle.apply(&VehicleCommand::Restart(Box::new(configuration)));
        vehicle.set_storage_facts(self.store.facts());
        notices
    }
}
