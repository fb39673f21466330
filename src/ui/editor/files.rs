//! What the editor asks of the file system, and what comes back. Carried out in the order of asking.

use std::path::PathBuf;

use super::open_plan::PlanId;
use crate::plan::edit::{History, JournalLine, PlanDocument};
use crate::ui::history::LineField;

#[derive(Debug, Clone, PartialEq)]
pub enum FileRequest {
    /// Read a plan, with the history that its journal has.
    Open(PathBuf),
    Save {
        id: PlanId,
        path: PathBuf,
        document: Box<PlanDocument>,
        /// The revision that is written.
        revision: usize,
        /// Replace whatever is there. Otherwise only what was read from there or written there by this plan.
        replace: bool,
    },
    /// List a directory for the file browser; `None` = where plans were opened last.
    List(Option<PathBuf>),
    /// Keep an action, so that it survives the program. The first line of a plan is kept by whoever opens it.
    Journal(PlanId, JournalLine),
    /// Keep a line that was entered in a text field, so that it can be recalled after a restart.
    KeepLine(LineField, String),
    /// A new plan begins its journal.
    Begin(PlanId, Box<PlanDocument>),
    /// The plan was closed; its journal goes when edits are given up.
    Close {
        id: PlanId,
        /// Its edits are given up.
        discard: bool,
    },
}

#[derive(Debug, Clone)]
pub enum FileReply {
    /// A plan was read.
    Opened(Box<Opened>),
    /// A plan was written.
    Saved {
        id: PlanId,
        path: PathBuf,
        /// The revision that was written.
        revision: usize,
        /// What the format could not carry, one sentence each.
        lost: Vec<String>,
    },
    /// There is something else in the file: it was not written.
    Occupied {
        id: PlanId,
        path: PathBuf,
        /// This plan had read or written the file, and somebody else changed it since.
        changed: bool,
    },
    /// Somebody else changed or removed the file of a plan.
    Changed(PlanId),
    Listed(Listing),
    /// It did not work: why, in one sentence.
    Failed(String),
    /// Edits cannot be kept from now on: why, in one sentence.
    NotKept(String),
    /// All edits are kept again.
    KeptAgain,
    /// Edits of an earlier start could not be read: which, and where they are kept, in a sentence or two.
    EditsLost(String),
}

/// A plan that was read.
#[derive(Debug, Clone)]
pub struct Opened {
    /// What it is called from now on.
    pub id: PlanId,
    /// Its file, if it has one.
    pub file: Option<PathBuf>,
    /// The document with the history that its journal has.
    pub history: History,
    /// What is worth knowing about the file, one sentence each.
    pub notes: Vec<String>,
    /// Edits that were never saved are in it.
    pub recovered: bool,
}

/// A directory as the file browser shows it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Listing {
    pub directory: PathBuf,
    /// Directories, then plan files, each by name.
    pub entries: Vec<Entry>,
}

/// An entry of a directory.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    pub name: String,
    /// Whether it is a directory.
    pub is_directory: bool,
}
