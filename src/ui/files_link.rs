//! The user interface's link to the plan files.
#![allow(clippy::disallowed_methods, reason = "the shell of the user interface waits in wall-clock time")]

use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use tokio::sync::{mpsc, watch};
use tokio::time::timeout;

use crate::ui::model::files::{FileReply, FileRequest};

/// The longest wait for an edit to be kept. A busy machine must not show edits that a kill loses. A disk that hangs blocks the
/// screen only once.
const PATIENCE: Duration = Duration::from_secs(10);

/// The longest time that keys wait for the answer to the request of an earlier key.
const TYPED_AHEAD: Duration = Duration::from_millis(500);

/// The user interface's link to the plan files.
#[derive(Debug)]
pub struct FilesLink {
    requests: Sender<FileRequest>,
    pub(super) replies: mpsc::UnboundedReceiver<FileReply>,
    /// The number of requests carried out.
    done: watch::Receiver<u64>,
    asked: u64,
    /// The number of the newest edit among the requests.
    edited: u64,
    /// The number of the newest request whose answer changes the meaning of the keys after it, and its time.
    decisive: Option<(u64, Instant)>,
    /// `true` after a wait that was too long, until the edits are kept.
    hangs: bool,
}

impl FilesLink {
    /// Returns the link to the thread that carries out `requests`, sends `replies`, and counts finished requests in
    /// `done`.
    pub fn new(
        requests: Sender<FileRequest>,
        replies: mpsc::UnboundedReceiver<FileReply>,
        done: watch::Receiver<u64>,
    ) -> Self {
        Self { requests, replies, done, asked: 0, edited: 0, decisive: None, hangs: false }
    }

    /// Sends a request. Returns `false` if nobody receives it.
    pub(super) fn ask(&mut self, request: FileRequest) -> bool {
        self.asked += 1;
        if matches!(request, FileRequest::Journal(..)) {
            self.edited = self.asked;
        }
        let is_decisive = matches!(
            request,
            FileRequest::List(_)
                | FileRequest::Open { .. }
                | FileRequest::Save { .. }
                | FileRequest::SaveSettings { .. }
                | FileRequest::ReadDisk { .. }
                | FileRequest::Backdrop(..)
        );
        if is_decisive {
            self.decisive = Some((self.asked, Instant::now()));
        }
        self.requests.send(request).is_ok()
    }

    /// Returns `true` while the keys typed ahead are meant for the answer to a request. A slow disk does not hold them for
    /// long.
    pub(super) fn holds_keys(&self) -> bool {
        self.decisive.is_some_and(|(number, at)| *self.done.borrow() < number && at.elapsed() < TYPED_AHEAD)
    }

    /// Waits until the newest edit is kept, so that the edits on the screen survive the program.
    pub(super) async fn keep_edits(&mut self) {
        let edited = self.edited;
        let patience = if self.hangs { Duration::ZERO } else { PATIENCE };
        // If the files hang or are gone, they report it themselves.
        self.hangs = timeout(patience, self.done.wait_for(|&done| done >= edited)).await.is_err();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::edit::JournalLine;
    use crate::ui::model::plan_id::PlanId;

    #[tokio::test]
    async fn an_edit_is_not_shown_before_a_busy_machine_has_kept_it() {
        let (requests, _asked) = std::sync::mpsc::channel();
        let (done, kept) = watch::channel(0);
        let mut link = FilesLink::new(requests, mpsc::unbounded_channel().1, kept);
        for number in 0..6 {
            assert!(link.ask(FileRequest::Journal(PlanId(1), JournalLine::Saved(number.to_string()))));
        }
        let keeper = std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(300));
            done.send_modify(|done| *done = 6);
        });
        link.keep_edits().await;
        assert_eq!(*link.done.borrow(), 6);
        keeper.join().expect("the keeper ends");
    }

    #[tokio::test]
    async fn a_disk_that_hangs_stops_the_screen_once() {
        let (requests, _asked) = std::sync::mpsc::channel();
        let (done, kept) = watch::channel(0);
        let mut link = FilesLink::new(requests, mpsc::unbounded_channel().1, kept);
        link.hangs = true;
        assert!(link.ask(FileRequest::Journal(PlanId(1), JournalLine::Saved("a plan".to_owned()))));
        link.keep_edits().await;
        assert!(link.hangs, "without a wait, the edit is not kept");
        done.send_modify(|done| *done = 1);
        link.keep_edits().await;
        assert!(!link.hangs, "the next edit is waited for");
    }
}
