//! The settings of the craft as the screen knows them: the newest reading, the changes under way, and their history.
//!
//! ```text
//!   panel ── SettingsChange ─▶ changes ── Effect::Set ─▶ session      one line at a time
//!                                ▲                         │
//!   reading ◀── SettingsReply ───┴────── SetReply ◀────────┘
//! ```
//!
//! A changed value is shown at once. The next reading confirms it, or takes it back. The module `changes` is
//! `acts/setting_changes`, and `reading` is `acts/setting_reading`.

pub mod comparison;
pub(in crate::ui) mod steps;

use std::time::Duration;

use crate::fc::{CraftSetting, CraftSettings};
use steps::Steps;
pub(in crate::ui) use steps::{Assignment, Step};

/// A setting that an option gave the craft at its start.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GivenSetting {
    pub name: String,
    /// The option, such as `--settings craft.txt`.
    pub source: String,
}

/// A change of the craft's settings, or of what is known about them, that the panel requests.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SettingsChange {
    /// Set values, as one step that can be undone.
    Set(Step),
    Undo,
    Redo,
    /// Read all settings again.
    Read,
    /// Fly ahead with this value and without it.
    Try(Assignment),
    /// Write these settings into the open plan.
    IntoPlan(Vec<Assignment>),
}

/// The settings of the craft as the screen knows them.
#[derive(Debug, Default)]
pub struct SettingsState {
    pub(in crate::ui) craft: Option<Box<CraftSettings>>,
    /// The values of the first reading, by name, of a firmware that does not report what it has saved.
    pub(in crate::ui) first: Vec<(String, String)>,
    /// The reason why the newest reading failed, a sentence.
    pub(in crate::ui) refusal: Option<String>,
    /// `true` while a reading is on its way.
    pub(in crate::ui) is_asked: bool,
    /// `true` if the user asked for the reading and waits for its end.
    pub(in crate::ui) is_reported: bool,
    /// The time of the newest answer, wall clock.
    pub(in crate::ui) read_at: Option<Duration>,
    /// `true` if something may have changed the settings since.
    pub(in crate::ui) is_outdated: bool,
    /// The number of the connection to a remote flight controller; `None` for an embedded one.
    pub(in crate::ui) connection: Option<u32>,
    /// The settings that options gave the craft.
    pub(in crate::ui) given: Vec<GivenSetting>,
    pub(in crate::ui) steps: Steps,
}

impl SettingsState {
    pub(in crate::ui) fn new(given: Vec<GivenSetting>) -> Self {
        Self { given, ..Self::default() }
    }

    /// Returns all settings, if they were read.
    pub(in crate::ui) fn craft(&self) -> Option<&CraftSettings> {
        self.craft.as_deref()
    }

    pub(in crate::ui) fn find(&self, name: &str) -> Option<&CraftSetting> {
        self.craft()?.find(name)
    }

    /// Returns the reason why the settings could not be read, as a sentence.
    pub(in crate::ui) fn refusal(&self) -> Option<&str> {
        self.refusal.as_deref()
    }

    /// Returns `true` while the settings are read for the first time, or because the user requested it.
    pub(in crate::ui) fn is_reading(&self) -> bool {
        self.is_asked && (self.craft.is_none() || self.connection.is_some())
    }

    /// Returns the number of values that the craft has not confirmed yet.
    pub(in crate::ui) fn pending(&self) -> usize {
        self.steps.pending()
    }

    /// Returns `true` if the craft has not confirmed the value of this setting yet.
    pub(in crate::ui) fn is_pending(&self, name: &str) -> bool {
        self.steps.is_pending(name)
    }

    /// Returns the option that gave the craft this setting.
    pub(in crate::ui) fn given_by(&self, name: &str) -> Option<&str> {
        let given = self.given.iter().rev().find(|given| given.name.eq_ignore_ascii_case(name))?;
        Some(&given.source)
    }

    /// Marks the settings as outdated.
    pub(in crate::ui) fn outdate(&mut self) {
        self.is_outdated = true;
    }
}

/// Returns the name in `name = value`, and in the message of a firmware about such a line.
pub(in crate::ui) fn name_of(line: &str) -> &str {
    line.split([' ', '=']).find(|word| !word.is_empty()).unwrap_or_default()
}
