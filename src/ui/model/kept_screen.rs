//! The part of the screen that comes back with the next start: the focus and the places of the panels, the window of the
//! map, the graphs, the open plans and the row of the shown one, and the place in a flight that is over.
//!
//! It is kept in the state directory while the program runs, so that it also comes back after a kill. Each kind of session
//! has its own screen, because their panels differ in use. Plans and place are kept for each craft and each flight.

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::ui::model::graphs::ChosenGraphs;
use crate::ui::model::layout::Arrangement;
use crate::ui::model::map_state::MapMode;

/// The most plans that are opened again.
pub(in crate::ui) const MAX_PLANS: usize = 16;

/// The version of the form in which the screen is kept.
pub(in crate::ui) const VERSION: u32 = 1;

/// The reason why a kept screen does not come back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unread {
    /// The text is damaged.
    Damaged,
    /// A later version of the program wrote it.
    Later,
}

/// The session whose screen is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KeptOf {
    /// A flight of this program.
    #[default]
    Flight,
    /// A remote flight controller.
    Craft,
    /// A flight that was flown to its end before the screen opened, and can be flown on.
    Flown,
    /// A recorded flight.
    Record,
}

impl KeptOf {
    /// Returns `true` if plans and place belong to one craft or one flight, not to the next of its kind.
    pub(in crate::ui) fn has_subject(self) -> bool {
        self != Self::Flight
    }
}

/// The screen that comes back.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KeptScreen {
    /// `None` if they are unknown.
    pub(in crate::ui) panels: Option<KeptPanels>,
    pub(in crate::ui) subject: KeptSubject,
}

/// The panels. A missing part of a file has its default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(in crate::ui) struct KeptPanels {
    /// The name of the panel with the focus.
    pub(in crate::ui) focus: String,
    pub(in crate::ui) zoomed: bool,
    /// The names of the panels in the places that several panels share.
    pub(in crate::ui) places: Vec<String>,
    /// The sizes of the panels and their places.
    pub(in crate::ui) arrangement: Arrangement,
    pub(in crate::ui) map: KeptMap,
    pub(in crate::ui) graphs: ChosenGraphs,
}

/// The part of the screen that belongs to its craft or its flight.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(in crate::ui) struct KeptSubject {
    /// The files of the open plans.
    pub(in crate::ui) plans: Vec<PathBuf>,
    /// The file of the shown plan, and its row with the cursor.
    pub(in crate::ui) shown: Option<PathBuf>,
    pub(in crate::ui) row: usize,
    /// The name of the shown plan if it has no file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ui) shown_name: Option<String>,
    /// The shown place in a flight that is over.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ui) place: Option<KeptPlace>,
    /// The window of the map that the user chose, if it has a meaning for this craft or flight only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(in crate::ui) window: Option<MapMode>,
}

/// A place in the flights of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptPlace {
    /// The number of the flight, from zero.
    pub flight: usize,
    /// The time of the instant on the craft's clock, µs; `None` if it is the beginning or the end.
    pub at_us: Option<u64>,
}

/// The file form of all parts, or of one of them.
#[derive(Default, Serialize, Deserialize)]
#[serde(default)]
struct KeptFile<Panels, Subject> {
    version: u32,
    #[serde(flatten)]
    panels: Panels,
    #[serde(flatten)]
    subject: Subject,
}

/// No part of a file.
#[derive(Default, Serialize)]
struct Nothing {}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(in crate::ui) struct KeptMap {
    pub(in crate::ui) mode: MapMode,
    pub(in crate::ui) grid: bool,
    pub(in crate::ui) course_up: bool,
    pub(in crate::ui) hides_past: bool,
}

/// The texts of the files of a screen; `None` for a file that stays as it is.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct KeptTexts {
    pub screen: Option<String>,
    /// The part that belongs to the craft or the flight, if it has a file of its own.
    pub subject: Option<String>,
}

/// The screen of the run before, and the one that is kept for the next run.
#[derive(Debug, Default)]
pub struct KeptScreens {
    /// `true` if the screen is kept.
    pub(crate) is_kept: bool,
    pub(in crate::ui) of: KeptOf,
    /// The screen that comes back, until it does.
    pub(in crate::ui) before: Option<KeptScreen>,
    /// The shown place in a flight that is over.
    pub(in crate::ui) place: Option<KeptPlace>,
    /// `true` once the flight was continued from an earlier instant, or the firmware was restarted. `place` then
    /// stays as it is.
    pub(in crate::ui) has_left: bool,
    /// The screen that was kept last.
    pub(in crate::ui) last: Option<KeptScreen>,
    /// The time of the last look for a change.
    pub(in crate::ui) looked: Duration,
}

impl KeptScreen {
    /// Reads a kept screen.
    ///
    /// # Errors
    /// Returns the reason if the text is damaged or of a later version.
    pub fn parse(text: &str) -> Result<Self, Unread> {
        #[derive(Deserialize)]
        struct Head {
            version: u32,
        }
        let is_later = |head: Head| head.version > VERSION;
        if serde_json::from_str(text).is_ok_and(is_later) {
            return Err(Unread::Later);
        }
        let read: serde_json::Result<KeptFile<KeptPanels, KeptSubject>> = serde_json::from_str(text);
        let KeptFile { panels, subject, .. } = read.map_err(|_| Unread::Damaged)?;
        Ok(Self { panels: Some(panels), subject })
    }

    /// Returns the screen of a craft or a flight. Without panels of its own it has those of the last one of its kind.
    pub fn joined(kind: Option<Self>, subject: Option<Self>) -> Option<Self> {
        if kind.is_none() && subject.is_none() {
            return None;
        }
        let own = subject.as_ref().and_then(|screen| screen.panels.clone());
        let own = own.filter(|panels| *panels != KeptPanels::default());
        let panels = own.or(kind.and_then(|screen| screen.panels));
        Some(Self { panels, subject: subject.map(|screen| screen.subject).unwrap_or_default() })
    }

    /// Returns the texts from which the screen can be read again, without those that `last` has too.
    pub(in crate::ui) fn texts(&self, of: KeptOf, last: Option<&Self>) -> KeptTexts {
        let is_new_panels = last.is_none_or(|last| last.panels != self.panels);
        let is_new_subject = last.is_none_or(|last| last.subject != self.subject);
        let (panels, subject) = (&self.panels, &self.subject);
        if of.has_subject() {
            KeptTexts {
                screen: is_new_panels.then(|| text(panels, Nothing {})).flatten(),
                // Another program of the kind may show other panels meanwhile.
                subject: (is_new_panels || is_new_subject).then(|| text(panels, subject)).flatten(),
            }
        } else {
            let is_new = is_new_panels || is_new_subject;
            KeptTexts { screen: is_new.then(|| text(panels, subject)).flatten(), subject: None }
        }
    }

    /// Returns the file of the plan that was shown.
    pub fn shown_plan(&self) -> Option<&Path> {
        self.subject.shown.as_deref()
    }

    /// Returns the row that had the cursor, if the plan of this file was shown, or without a file, that of this name.
    pub fn row_of(&self, path: Option<&Path>, name: &str) -> Option<usize> {
        let is_it = match path {
            Some(path) => self.shown_plan() == Some(path),
            None => self.subject.shown_name.as_deref() == Some(name),
        };
        is_it.then_some(self.subject.row)
    }

    /// Returns the files of the open plans.
    pub fn plans(&self) -> impl Iterator<Item = &Path> {
        self.subject.plans.iter().take(MAX_PLANS).map(PathBuf::as_path)
    }

    /// Returns the place in the flights of the file.
    pub fn place(&self) -> Option<KeptPlace> {
        self.subject.place
    }
}

fn text(panels: impl Serialize, subject: impl Serialize) -> Option<String> {
    serde_json::to_string_pretty(&KeptFile { version: VERSION, panels, subject }).ok()
}

impl KeptScreens {
    /// Returns screens of which nothing is kept.
    pub fn none() -> Self {
        Self::default()
    }

    /// Returns screens that are kept, with the one of the run before.
    pub fn after(of: KeptOf, before: Option<KeptScreen>) -> Self {
        let place = before.as_ref().and_then(KeptScreen::place);
        Self { is_kept: true, of, before, place, ..Self::default() }
    }

    /// Returns screens that are saved but not restored.
    #[must_use]
    pub fn fresh(self) -> Self {
        Self { before: None, place: None, ..self }
    }

    /// Leaves the place out of the screen that comes back, because the command line names another.
    pub fn forget_place(&mut self) {
        self.place = None;
        if let Some(before) = &mut self.before {
            before.subject.place = None;
        }
    }

    /// Returns the screen of the run before, until it comes back.
    pub fn before(&self) -> Option<&KeptScreen> {
        self.before.as_ref()
    }
}
