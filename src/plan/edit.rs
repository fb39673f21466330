//! Plan editing: the document, its history, and edits of more than one value.
//!
//! `history` is a tree of revisions. Each revision is a small `change` that can be undone. `journal` stores the
//! history as lines of text, for a file that survives the program. `transform` edits many waypoints at once, and
//! `fix` resolves a finding.

mod change;
mod document;
pub mod fix;
mod history;
mod journal;
pub mod transform;

pub use change::Change;
pub use document::PlanDocument;
pub use history::{History, Revision};
pub use journal::{Journal, JournalLine, Losses};
