//! Exchanges data between the vehicle and its remote flight controller.
#![allow(clippy::disallowed_methods, reason = "answers are awaited in wall time")]

use std::task::Context;
use std::time::Instant;

use super::Session;
use crate::fc::RemoteNotice;
use crate::session::event::SessionEvent;

impl Session {
    /// Sends the vehicle's data for its flight controller and takes the data from it.
    pub(super) fn exchange_with_remote(&mut self, context: &mut Context<'_>) {
        let Some(remote) = &mut self.remote else { return };
        for notice in remote.exchange(&mut self.vehicle, Some(context), Instant::now()) {
            self.changed = true;
            if let RemoteNotice::Failed(sentence) = &notice
                && remote.is_fed()
            {
                self.failure = Some(sentence.clone());
                self.quit = true;
            }
            let restarted = matches!(notice, RemoteNotice::Restarted(_));
            self.events.report(&mut self.vehicle, SessionEvent::Remote(notice));
            if restarted {
                if let Some(endpoints) = &mut self.endpoints {
                    endpoints.handler.after_restart(true, self.vehicle.controller_mut());
                }
                self.events.report(&mut self.vehicle, SessionEvent::Restarted);
            }
        }
    }
}
