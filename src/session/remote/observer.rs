//! What a remote flight controller has told of itself.

use super::identify::Question;
use crate::firmware::cli::{CliReply, Interpreter};
use crate::firmware::config::Configuration;
use crate::firmware::{Firmware, FirmwareOptions};
use crate::link::proto::fc_client::Answer;
use crate::plan::FlightPlan;
use crate::session::upload::plan_of_list;
use crate::telemetry::snapshot::SettingsView;
use crate::vehicle::{RemoteController, RemoteTelemetry};

/// A setting that firmware has whose waypoints count from home; that of the others counts from sea level.
const COUNTS_FROM_HOME: &str = "ap_velocity_p";

/// What is known of a flight controller.
#[derive(Debug, Default)]
pub struct Observer {
    settings: Settings,
    stored_plan: Option<FlightPlan>,
    /// Something new is known.
    changed: bool,
}

/// The settings that were read, taken over by a firmware that says what follows from them.
#[derive(Debug, Default)]
struct Settings {
    twin: Option<Box<Firmware>>,
    waypoints_from_home: bool,
}

impl Settings {
    /// Takes in what `get` prints.
    fn read(&mut self, text: &str) {
        let twin = self.twin.get_or_insert_with(|| {
            Box::new(Firmware::new(Configuration::default(), FirmwareOptions::default()))
        });
        for line in text.lines().map(str::trim) {
            let Some((name, value)) = line.split_once(" = ") else { continue };
            self.waypoints_from_home |= name == COUNTS_FROM_HOME;
            // What this program does not know or allow has no effect on what is shown.
            twin.run_cli(&mut Interpreter::default(), &format!("set {name} = {value}"));
        }
    }

    fn view(&self) -> Option<SettingsView> {
        self.twin.as_ref().map(|twin| twin.settings_view())
    }
}

impl Observer {
    /// The connection is gone: what was told is old.
    pub(super) fn forget(&mut self) {
        *self = Self { changed: true, ..Self::default() };
    }

    /// Takes in the answer to a question.
    pub(super) fn learn(&mut self, question: Question, answer: &Answer) {
        self.changed = true;
        match (question, answer) {
            (Question::Settings(_), Answer::Line { text, failed: false, .. }) => self.settings.read(text),
            (Question::Plan, Answer::Line { text, failed, .. }) => {
                let reply = CliReply { text: text.clone(), failed: *failed, ..CliReply::default() };
                self.stored_plan = plan_of_list(&reply).ok();
            }
            _ => {}
        }
    }

    /// Delivers what is new.
    pub(super) fn deliver(&mut self, mailbox: &mut RemoteController) {
        if std::mem::take(&mut self.changed) {
            mailbox.deliver_telemetry(RemoteTelemetry {
                settings: self.settings.view(),
                stored_plan: self.stored_plan.clone(),
                ..RemoteTelemetry::default()
            });
        }
    }

    /// Whether its waypoints' altitudes count from home; else from sea level.
    #[must_use]
    pub fn counts_from_home(&self) -> bool {
        self.settings.waypoints_from_home
    }

    /// Whether it is known to be armed.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        false
    }

    /// What it is, as a sentence.
    pub(super) fn introduction(&self, name: &str) -> String {
        format!("{name} answers.")
    }
}
