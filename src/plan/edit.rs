//! Editing a plan: the document, its history, and the edits that are more than typing a value.
//!
//! `history` is a tree of revisions, each a small `change` that can be taken back; `journal` is the same as lines of
//! text, for a file that survives the program; `transform` edits many waypoints at once, `fix` takes a finding away.

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
