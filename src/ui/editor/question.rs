//! What the editor asks before an edit or a file is lost, or a flight is led elsewhere.

use std::path::PathBuf;

use super::open_plan::PlanId;

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Question {
    /// There is something else in the file that is to be written.
    Replace {
        id: PlanId,
        path: PathBuf,
        /// It was this plan's file, and somebody else changed it since.
        changed: bool,
    },
    /// The plan is to be uploaded in flight, and moves the waypoint that is flown to.
    MovesTarget {
        id: PlanId,
        /// What it does to the waypoint, a sentence.
        change: String,
    },
    /// The plan is to be closed, and has edits that no file holds.
    Unsaved {
        id: PlanId,
        /// The program ends when all plans are answered for.
        quits: bool,
    },
}

impl Question {
    /// The answers: key and what it does.
    pub fn answers(&self) -> &'static [(char, &'static str)] {
        match self {
            Self::Replace { changed: true, .. } => {
                &[('y', "replace it"), ('r', "read it again"), ('o', "other name"), ('n', "leave it")]
            }
            Self::Replace { changed: false, .. } => {
                &[('y', "replace it"), ('o', "other name"), ('n', "leave it")]
            }
            Self::MovesTarget { .. } => &[('y', "upload it"), ('n', "leave it")],
            Self::Unsaved { quits: true, .. } => {
                &[('s', "save"), ('d', "discard"), ('y', "quit, keep the edits for later"), ('n', "stay")]
            }
            Self::Unsaved { quits: false, .. } => &[('s', "save"), ('d', "discard"), ('n', "stay")],
        }
    }
}
