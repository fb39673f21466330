//! What a door tells the user: each thing once, however many clients cause it at however many addresses.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

use tokio::sync::mpsc;

use super::request::Request;

/// Most notices of one door.
const NOTICES_MAX: usize = 64;

/// The notices of one door, shared by all its listeners and clients.
#[derive(Debug, Clone)]
pub(super) struct Notices {
    requests: mpsc::Sender<Request>,
    told: Arc<Mutex<BTreeSet<String>>>,
}

impl Notices {
    pub(super) fn new(requests: mpsc::Sender<Request>) -> Self {
        Self { requests, told: Arc::default() }
    }

    /// Tells this unless it was told before. When nobody has time to listen it is told the next time; until then it is seen
    /// in the door's count of errors.
    pub(super) fn tell(&self, notice: String) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.len() < NOTICES_MAX
            && !told.contains(&notice)
            && self.requests.try_send(Request::Notice(notice.clone())).is_ok()
        {
            told.insert(notice);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_notice_is_told_once_whoever_tells_it_and_again_when_nobody_listened() {
        let (requests, mut inbox) = mpsc::channel(1);
        let notices = Notices::new(requests);
        notices.tell("first".to_owned());
        notices.tell("second".to_owned());
        let mut next = || inbox.try_recv().map(|request| format!("{request:?}")).ok();
        assert_eq!(next().as_deref(), Some(r#"Notice("first")"#));
        notices.clone().tell("first".to_owned());
        assert_eq!(next(), None);
        notices.tell("second".to_owned());
        assert_eq!(next().as_deref(), Some(r#"Notice("second")"#));
    }

    #[test]
    fn there_is_an_end_to_them() {
        let (requests, mut inbox) = mpsc::channel(1000);
        let notices = Notices::new(requests);
        (0..500).for_each(|number| notices.tell(number.to_string()));
        assert_eq!(std::iter::from_fn(|| inbox.try_recv().ok()).count(), NOTICES_MAX);
    }
}
