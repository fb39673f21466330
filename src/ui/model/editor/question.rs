//! Questions of the editor before an edit or a file is lost, before an upload changes the current target, or before a
//! flight of another plan than the open one.

use std::path::PathBuf;

use crate::ui::model::plan_id::PlanId;

#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Question {
    /// The file to be written has other content.
    Replace {
        id: PlanId,
        path: PathBuf,
        /// `true` if it was this plan's file and somebody else has changed it since.
        changed: bool,
    },
    /// An upload in flight would move the waypoint that the craft is flying to.
    MovesTarget {
        id: PlanId,
        /// The change of that waypoint, a sentence.
        change: String,
    },
    /// The plan that was asked to be flown is not on the craft as it is now.
    FliesWhich {
        id: PlanId,
        /// The difference, in sentences.
        difference: String,
    },
    /// The plan to be closed has edits that no file holds.
    Unsaved {
        id: PlanId,
        /// `true` if the program ends once this is answered for all plans.
        quits: bool,
    },
}

impl Question {
    /// Returns `true` if the program can end and keep the edits for the next start. `loses_edits` says that edits cannot be
    /// kept.
    pub fn offers_later(&self, loses_edits: bool) -> bool {
        matches!(self, Self::Unsaved { quits: true, .. }) && !loses_edits
    }

    /// Returns the sentence about a plan with unsaved edits.
    pub fn unsaved(&self, title: &str, loses_edits: bool) -> String {
        let lost = if matches!(self, Self::Unsaved { quits: true, .. }) && loses_edits {
            ", and they cannot be kept for later"
        } else {
            ""
        };
        format!("{title} has edits that no file holds{lost}.")
    }

    /// Returns the answers: the key and its effect. `loses_edits` says that edits cannot be kept.
    pub fn answers(&self, loses_edits: bool) -> &'static [(char, &'static str)] {
        match self {
            Self::Replace { changed: true, .. } => &[
                ('v', "compare"),
                ('y', "replace it"),
                ('r', "read it again"),
                ('o', "other name"),
                ('n', "leave it"),
            ],
            Self::Replace { changed: false, .. } => {
                &[('y', "replace it"), ('o', "other name"), ('n', "leave it")]
            }
            Self::MovesTarget { .. } => &[('y', "upload it"), ('n', "leave it")],
            Self::FliesWhich { .. } => &[('y', "upload, fly"), ('c', "fly the craft's"), ('n', "do not fly")],
            Self::Unsaved { .. } if self.offers_later(loses_edits) => {
                &[('s', "save"), ('d', "discard"), ('y', "quit, keep the edits for later"), ('n', "stay")]
            }
            Self::Unsaved { .. } => &[('s', "save"), ('d', "discard"), ('n', "stay")],
        }
    }
}
