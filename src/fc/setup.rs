//! The configuration of the flight controller at the other end, if one was requested.

use std::path::PathBuf;

use super::client::{Answer, Ask};
use super::{Provision, RemoteNotice, Unset};

#[derive(Debug, Clone, Default)]
pub(super) struct Setup {
    running: Option<Provision>,
    unset: Option<Unset>,
}

/// The result of a configuration.
#[derive(Debug)]
pub(super) struct Finished {
    pub(super) notices: Vec<RemoteNotice>,
    /// A file to be written, with its contents.
    pub(super) note: Option<(PathBuf, String)>,
    /// `true` if something was written without a restart, so that the known settings are outdated.
    pub(super) is_changed_without_restart: bool,
}

impl Setup {
    /// Configures the flight controller once it is identified.
    pub(super) fn begin(&mut self, provision: Provision) {
        self.running = Some(provision);
    }

    pub(super) fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Returns the settings that were not applied as requested.
    pub(super) fn unset(&self) -> Option<&Unset> {
        self.unset.as_ref()
    }

    /// Continues after the flight controller was identified, perhaps after a restart.
    pub(super) fn reconnected(&mut self) {
        if let Some(provision) = &mut self.running {
            provision.reconnected();
        }
    }

    /// Returns the next request.
    pub(super) fn next(&mut self, is_master: bool) -> Option<Ask> {
        let provision = self.running.as_mut()?;
        if is_master {
            provision.replace_settings();
        }
        provision.next()
    }

    /// Takes the answer to the last request.
    pub(super) fn take(&mut self, answer: &Answer) {
        if let Some(provision) = &mut self.running {
            provision.take(answer);
        }
    }

    /// Returns the result once the configuration is finished.
    pub(super) fn finish(&mut self) -> Option<Finished> {
        let provision = self.running.take_if(|provision| provision.result().is_some())?;
        let (mut notices, mut is_done) = (Vec::new(), false);
        match provision.result()? {
            Ok(report) => {
                is_done = true;
                self.unset = report.unset();
                let notice = if report.is_as_wanted() { RemoteNotice::Reported } else { RemoteNotice::Lost };
                notices.extend(report.sentences().into_iter().map(notice));
            }
            Err(why) => {
                let sentence = format!("The firmware could not be configured: {why}.");
                self.unset = Some(Unset::Everything(sentence.clone()));
                notices.push(RemoteNotice::Lost(sentence));
            }
        }
        let is_changed_without_restart = provision.is_changed_without_restart();
        Some(Finished { notices, note: provision.note.filter(|_| is_done), is_changed_without_restart })
    }
}
