//! The plans of the run before.

use super::PlanFiles;
use crate::ui::KeptScreen;
use crate::ui::editor::{FileReply, FileRequest, PlanId};

impl PlanFiles {
    /// Opens the plans of the run before, and shows the first plan again, with the cursor at its row. `edited` is the first
    /// plan with the edits of a run in which it had no file: it is shown in its place.
    pub(in crate::app) fn open_kept(
        &mut self,
        kept: &KeptScreen,
        first: PlanId,
        edited: Option<PlanId>,
    ) -> Vec<FileReply> {
        let shown = self.open.get(&first).and_then(|file| file.path.clone());
        let mut replies = Vec::new();
        // A plan that is gone is not missed.
        for path in kept.plans().filter(|path| Some(*path) != shown.as_deref() && path.exists()) {
            let request = FileRequest::Open { path: path.to_owned(), home: None, accepted: true };
            replies.extend(self.carry_out(request));
        }
        let row = kept.row_of(shown.as_deref()).unwrap_or(0);
        replies.push(FileReply::Shown(edited.unwrap_or(first), row));
        replies
    }
}
