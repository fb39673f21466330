//! The notices of a door to the user. Each is sent once, however many clients at however many addresses cause
//! it. Connections that use another protocol are counted.

#![allow(clippy::disallowed_methods, reason = "the doors wait for people and programs")]

mod flood;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::mpsc;

use super::request::Request;
pub(super) use flood::Stranger;
use flood::{Flood, sentence};

/// The maximum number of notices of one door.
const NOTICES_MAX: usize = 64;
/// The time for which connections of strangers are counted before their first notice.
const COUNTED_FOR: Duration = Duration::from_secs(1);

/// The notices of one door, shared by all its listeners and clients.
#[derive(Debug, Clone)]
pub(super) struct Notices {
    requests: mpsc::Sender<Request>,
    reported: Arc<Mutex<BTreeSet<String>>>,
    floods: Arc<Mutex<BTreeMap<Stranger, Flood>>>,
}

impl Notices {
    pub(super) fn new(requests: mpsc::Sender<Request>) -> Self {
        Self { requests, reported: Arc::default(), floods: Arc::default() }
    }

    /// Sends this notice unless it was sent before. If the session's queue is full, the notice is sent the
    /// next time; until then only the door's error count shows it.
    pub(super) fn tell(&self, notice: String) {
        let mut reported = self.reported.lock().unwrap_or_else(PoisonError::into_inner);
        if reported.len() < NOTICES_MAX
            && !reported.contains(&notice)
            && self.requests.try_send(Request::Notice(notice.clone())).is_ok()
        {
            reported.insert(notice);
        }
    }

    /// Counts a connection that was closed because of its protocol. Reports a flood of them once, a moment
    /// after it began.
    pub(super) fn count_stranger(&self, door: &'static str, stranger: Stranger) {
        if !self.change(stranger, |flood| flood.count(Instant::now())) {
            return;
        }
        let notices = self.clone();
        tokio::spawn(async move {
            tokio::time::sleep(COUNTED_FOR).await;
            let number = notices.change(stranger, Flood::take_number);
            let _gone = notices.requests.send(Request::Notice(sentence(door, stranger, number))).await;
        });
    }

    fn change<T>(&self, stranger: Stranger, change: impl FnOnce(&mut Flood) -> T) -> T {
        let mut floods = self.floods.lock().unwrap_or_else(PoisonError::into_inner);
        change(floods.entry(stranger).or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_notice_is_reported_once_by_all_its_sources_and_again_without_a_listener() {
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
