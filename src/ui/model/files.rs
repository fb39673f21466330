//! The editor's requests to the file system, and the replies. Requests are carried out in order.

use std::path::PathBuf;
use std::sync::Arc;

use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::plan::edit::{History, JournalLine, PlanDocument};
use crate::plan::format::HomePosition;
use crate::plan::format::loss::{Finding, LossReport};
use crate::terrain::Tiles;
use crate::ui::model::backdrop::BackdropLayer;
use crate::ui::model::history::LineField;
use crate::ui::model::kept_screen::KeptTexts;
use crate::ui::model::plan_id::PlanId;

#[derive(Debug, Clone, PartialEq)]
pub enum FileRequest {
    /// Read a plan, with the history from its journal.
    Open {
        path: PathBuf,
        /// The home for a file that has none, or none with its altitude above sea level.
        home: Option<HomePosition>,
        /// `true` if the user has accepted the differences between the file and the plan.
        accepted: bool,
    },
    Save {
        id: PlanId,
        path: PathBuf,
        document: Box<PlanDocument>,
        /// The revision to write.
        revision: usize,
        /// Replace any content of the file. Otherwise only content that this plan has read or written there is
        /// replaced.
        replace: bool,
        /// `true` if the user has accepted the differences between the plan and the file.
        accepted: bool,
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
    /// Write settings as lines of the command line in a new file.
    SaveSettings {
        path: PathBuf,
        text: String,
        /// The number of settings.
        count: usize,
    },
    /// Keep the screen, so that it comes back with the next start.
    KeepScreen(KeptTexts),
    /// Append this line to the layouts that the user saved.
    KeepLayout(String),
    /// Read the file of a plan for a comparison. The open plan stays as it is.
    ReadDisk {
        id: PlanId,
        path: PathBuf,
        /// The home for a file that has none, or none with its altitude above sea level.
        home: Option<HomePosition>,
    },
    /// Read the elevation tiles under a plan and its way home.
    Ground { home: LatLon, plan: Box<FlightPlan> },
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
    /// The file and the plan would differ, so nothing was done.
    Losses(Box<ConversionLosses>),
    /// A plan was written.
    Saved {
        id: PlanId,
        path: PathBuf,
        /// The written revision.
        revision: usize,
        /// The differences between the plan and the file, one line each.
        lost: Vec<String>,
    },
    /// The document in the file of a plan, or the reason why it could not be read, a sentence.
    OnDisk {
        id: PlanId,
        document: Result<Box<PlanDocument>, String>,
    },
    /// This many settings were written in a file.
    SavedSettings {
        path: PathBuf,
        count: usize,
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
    /// Show this open plan, with the cursor at this row.
    Shown(PlanId, usize),
    /// More elevation tiles were read, if there are any; the problems, one sentence each.
    Ground {
        tiles: Option<Arc<Tiles>>,
        problems: Vec<String>,
    },
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
    /// The flight is not recorded any further; the reason in one sentence.
    NotRecorded(String),
    /// All edits are kept again.
    KeptAgain,
    /// Edits of an earlier run could not be read. One or two sentences name them and where they are kept.
    EditsLost(String),
    /// Edits are kept nowhere, because the user wants it so.
    KeepsNothing,
}

/// The differences between a file and a plan, before the user accepts them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ConversionLosses {
    /// The request that is sent again with `accepted`.
    pub conversion: Conversion,
    /// One line for each difference, the gravest first.
    pub lines: Vec<String>,
    /// The numbers of differences.
    pub summary: String,
}

impl ConversionLosses {
    /// Returns the differences that a conversion makes.
    pub fn of(conversion: Conversion, losses: &LossReport) -> Self {
        let mut findings: Vec<&Finding> = losses.findings.iter().collect();
        findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
        let mut lines: Vec<String> = Vec::new();
        let mut seen: Vec<(Finding, usize)> = Vec::new();
        for finding in findings {
            // The item of a loop is a waypoint in each round.
            let item = Finding { waypoint: None, ..finding.clone() };
            match seen.iter_mut().find(|(known, _)| finding.item.is_some() && *known == item) {
                Some((_, repeats)) => *repeats += 1,
                None => {
                    lines.push(finding.to_string());
                    seen.push((item, 0));
                }
            }
        }
        for (line, (_, repeats)) in lines.iter_mut().zip(seen).filter(|(_, (_, repeats))| *repeats > 0) {
            line.push_str(&format!(" (and {repeats} more of this item)"));
        }
        Self { conversion, lines, summary: losses.counts() }
    }
}

/// A conversion between a file and a plan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Conversion {
    Open(PathBuf),
    Save { id: PlanId, path: PathBuf, replace: bool },
}

impl Conversion {
    /// Returns the heading of the list of differences.
    pub(in crate::ui) fn title(&self) -> &'static str {
        match self {
            Self::Open(_) => "The plan would differ from the file",
            Self::Save { .. } => "The file would differ from the plan",
        }
    }

    /// Returns the question with the name of the file.
    pub(in crate::ui) fn question(&self) -> String {
        let (verb, path) = match self {
            Self::Open(path) => ("Open", path),
            Self::Save { path, .. } => ("Save", path),
        };
        let name = path.file_name().unwrap_or(path.as_os_str());
        format!("{verb} {}?", name.to_string_lossy())
    }

    /// Returns the effect of the answer yes.
    pub(in crate::ui) fn action(&self) -> &'static str {
        match self {
            Self::Open(_) => "open it",
            Self::Save { .. } => "save it",
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::format::loss::Severity;

    #[test]
    fn the_gravest_difference_comes_first_and_an_item_of_a_loop_once() {
        let finding = |severity, why: &str| Finding::new(severity, "speed", why);
        let mut losses = LossReport::default();
        losses.add(finding(Severity::Changed, "as fast as the craft").at(1).item(5));
        losses.add(finding(Severity::Changed, "as fast as the craft").at(4).item(5));
        losses.add(finding(Severity::Changed, "as fast as the craft").at(7).item(5));
        losses.add(finding(Severity::Changed, "as fast as the craft").at(8).item(6));
        losses.add(finding(Severity::Lost, "no camera"));
        let lines = ConversionLosses::of(Conversion::Open("a.plan".into()), &losses).lines;
        assert_eq!(lines.len(), 3, "{lines:#?}");
        assert!(lines[0].contains("no camera"), "{lines:#?}");
        assert!(lines[1].contains("WP 1") && lines[1].ends_with("(and 2 more of this item)"), "{lines:#?}");
        assert!(lines[2].contains("WP 8"), "{lines:#?}");
    }
}
