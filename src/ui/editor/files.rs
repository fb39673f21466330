//! The editor's requests to the file system, and the replies. Requests are carried out in order.

use std::path::PathBuf;

use super::open_plan::PlanId;
use crate::plan::edit::{History, JournalLine, PlanDocument};
use crate::ui::backdrop::BackdropLayer;
use crate::ui::history::LineField;

#[derive(Debug, Clone, PartialEq)]
pub enum FileRequest {
    /// Read a plan, with the history from its journal.
    Open(PathBuf),
    Save {
        id: PlanId,
        path: PathBuf,
        document: Box<PlanDocument>,
        /// The revision to write.
        revision: usize,
        /// Replace any content of the file. Otherwise only content that this plan has read or written there is
        /// replaced.
        replace: bool,
    },
    /// Read a file and put it under a plan on the map. It is remembered with the file of the plan.
    Backdrop(PlanId, PathBuf),
    /// Forget the files under a plan.
    NoBackdrop(PlanId),
    /// List a directory for the file browser; `None` for the one in which a plan was opened last.
    List(Option<PathBuf>),
    /// Keep an edit, an undo or a redo in the journal, so that it survives the program. The first line of a journal is
    /// written when the plan is opened or begun.
    Journal(PlanId, JournalLine),
    /// Keep a line entered in a text field, so that it can be recalled after a restart.
    KeepLine(LineField, String),
    /// Begin the journal of a new plan.
    Begin(PlanId, Box<PlanDocument>),
    /// Close a plan. Its journal is removed if its edits are given up.
    Close {
        id: PlanId,
        /// `true` if its edits are given up.
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
        /// The written revision.
        revision: usize,
        /// The parts that the format could not carry, one sentence each.
        lost: Vec<String>,
    },
    /// The file has other content, so it was not written.
    Occupied {
        id: PlanId,
        path: PathBuf,
        /// `true` if this plan had read or written the file and somebody else has changed it since.
        changed: bool,
    },
    /// Somebody else changed or removed the file of a plan.
    Changed(PlanId),
    Listed(Listing),
    /// A file for the backdrop of a plan was read.
    Backdrop {
        id: PlanId,
        layer: BackdropLayer,
        /// `true` if the user has just chosen it, `false` if it was remembered.
        is_new: bool,
    },
    /// The request failed; the reason in one sentence.
    Failed(String),
    /// Edits cannot be kept from now on; the reason in one sentence.
    NotKept(String),
    /// All edits are kept again.
    KeptAgain,
    /// Edits of an earlier run could not be read. One or two sentences name them and where they are kept.
    EditsLost(String),
}

/// A plan that was read.
#[derive(Debug, Clone)]
pub struct Opened {
    /// The identifier of the plan from now on.
    pub id: PlanId,
    /// Its file, if it has one.
    pub file: Option<PathBuf>,
    /// The document with the history from its journal.
    pub history: History,
    /// Notes about the file, one sentence each.
    pub notes: Vec<String>,
    /// `true` if it contains edits that were never saved.
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
    /// `true` for a directory.
    pub is_directory: bool,
}
