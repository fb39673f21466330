//! The plans of the run before, and the place of the screen that is kept.

use super::PlanFiles;
use crate::screen_files::screen_file::ScreenFile;
use crate::ui::files::{FileReply, FileRequest};
use crate::ui::{KeptScreen, PlanId};

impl PlanFiles {
    /// Keeps no journals, and leaves those of other programs alone.
    pub(crate) fn without_journals(&mut self) {
        self.journals = None;
    }

    /// Keeps the screen in these files.
    pub(crate) fn keep_screen_in(&mut self, screen: ScreenFile) {
        self.screen = screen;
    }

    /// Opens the plans of the run before, and shows the first plan again, with the cursor at its row. `edited` is the first
    /// plan with the edits of a run in which it had no file: it is shown in its place.
    pub(crate) fn open_kept(
        &mut self,
        kept: &KeptScreen,
        first: PlanId,
        edited: Option<PlanId>,
    ) -> Vec<FileReply> {
        let first_file = self.open.get(&first);
        let shown = first_file.and_then(|file| file.path.clone());
        let name = first_file.map_or("", |file| file.kept.history.document().name.as_str());
        let row = kept.row_of(shown.as_deref(), name).unwrap_or(0);
        let mut replies = Vec::new();
        // A plan that is gone is not missed.
        for path in kept.plans().filter(|path| Some(*path) != shown.as_deref() && path.exists()) {
            let request = FileRequest::Open { path: path.to_owned(), home: None, accepted: true };
            replies.extend(self.carry_out(request));
        }
        replies.push(FileReply::Shown(edited.unwrap_or(first), row));
        replies
    }
}
