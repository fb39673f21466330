//! The part of the screen that comes back with the next start: the focus and the places of the panels, the window of the
//! map, the graphs, the open plans and the row of the shown one, the speed, and the air.
//!
//! It is kept in the state directory while the program runs, so that it also comes back after a kill.

use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::graphs::ChosenGraphs;
use super::layout::Arrangement;
use super::map_state::MapMode;

/// The most plans that are opened again.
pub(super) const MOST_PLANS: usize = 16;

/// The version of the form in which the screen is kept.
pub(super) const VERSION: u32 = 1;

/// The reason why a kept screen does not come back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unread {
    /// The text is damaged.
    Damaged,
    /// A later version of the program wrote it.
    Later,
}

/// The part of the screen that comes back. A missing part of a file has its default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct KeptScreen {
    pub(super) version: u32,
    /// The name of the panel with the focus.
    pub(super) focus: String,
    pub(super) zoomed: bool,
    /// The names of the panels in the places that several panels share.
    pub(super) places: Vec<String>,
    /// The sizes of the panels and their places.
    pub(super) arrangement: Arrangement,
    pub(super) map: KeptMap,
    pub(super) graphs: ChosenGraphs,
    /// The files of the open plans.
    pub(super) plans: Vec<PathBuf>,
    /// The file of the shown plan, and its row with the cursor.
    pub(super) shown: Option<PathBuf>,
    pub(super) row: usize,
    /// The speed, times real time, if it is not real time.
    pub(super) speed: Option<f64>,
    /// The lines that make the air of a calm world.
    pub(super) air: Vec<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub(super) struct KeptMap {
    pub(super) mode: MapMode,
    pub(super) grid: bool,
    pub(super) course_up: bool,
    pub(super) hides_past: bool,
}

/// The screen of the run before, and the one that is kept for the next run.
#[derive(Debug, Default)]
pub struct KeptScreens {
    /// `true` if the screen is kept.
    pub(super) is_kept: bool,
    /// The screen that comes back, until it does.
    pub(super) before: Option<KeptScreen>,
    /// The screen that was kept last.
    pub(super) last: Option<KeptScreen>,
    /// The time of the last look for a change.
    pub(super) looked: Duration,
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
        serde_json::from_str(text).map_err(|_| Unread::Damaged)
    }

    /// Returns the text from which the screen can be read again.
    pub(super) fn text(&self) -> Option<String> {
        serde_json::to_string_pretty(self).ok()
    }

    /// Returns the file of the plan that was shown.
    pub fn shown_plan(&self) -> Option<&Path> {
        self.shown.as_deref()
    }

    /// Returns the row that had the cursor, if the plan of this file was shown.
    pub fn row_of(&self, path: Option<&Path>) -> Option<usize> {
        path.filter(|path| self.shown_plan() == Some(*path)).map(|_| self.row)
    }

    /// Returns the files of the open plans.
    pub fn plans(&self) -> impl Iterator<Item = &Path> {
        self.plans.iter().take(MOST_PLANS).map(PathBuf::as_path)
    }
}

impl KeptScreens {
    /// Returns screens of which nothing is kept.
    pub fn none() -> Self {
        Self::default()
    }

    /// Returns screens that are kept, with the one of the run before.
    pub fn after(before: Option<KeptScreen>) -> Self {
        Self { is_kept: true, before, ..Self::default() }
    }

    /// Returns screens that are kept as before, but of which none comes back.
    #[must_use]
    pub fn fresh(self) -> Self {
        Self { before: None, ..self }
    }

    /// Returns `true` if the screen is kept for the next run.
    pub fn is_kept(&self) -> bool {
        self.is_kept
    }

    /// Returns the screen of the run before, until it comes back.
    pub fn before(&self) -> Option<&KeptScreen> {
        self.before.as_ref()
    }
}
