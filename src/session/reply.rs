//! Delivers the answer to the sender of a command.

use std::fmt;

use tokio::sync::oneshot;

/// Delivers the answer to a command. A command that is dropped unanswered delivers `None`.
pub struct ReplyTo<T>(Option<Box<dyn FnOnce(Option<T>) + Send>>);

impl<T> ReplyTo<T> {
    /// Creates a reply that calls `deliver`, which must not wait: the session calls it.
    pub fn new(deliver: impl FnOnce(Option<T>) + Send + 'static) -> Self {
        Self(Some(Box::new(deliver)))
    }

    /// Delivers the answer.
    pub fn send(mut self, answer: T) {
        if let Some(deliver) = self.0.take() {
            deliver(Some(answer));
        }
    }
}

impl<T: Send + 'static> ReplyTo<T> {
    /// Creates a reply with a receiver of its own.
    pub fn channel() -> (Self, oneshot::Receiver<T>) {
        let (sender, receiver) = oneshot::channel();
        let deliver = |answer: Option<T>| drop(answer.map(|answer| sender.send(answer)));
        (Self::new(deliver), receiver)
    }
}

impl<T> Drop for ReplyTo<T> {
    fn drop(&mut self) {
        if let Some(deliver) = self.0.take() {
            deliver(None);
        }
    }
}

impl<T> fmt::Debug for ReplyTo<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ReplyTo").finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_or_its_absence_is_delivered_once() {
        let (sender, receiver) = std::sync::mpsc::channel();
        let reply = || {
            let sender = sender.clone();
            ReplyTo::new(move |answer: Option<u8>| sender.send(answer).unwrap())
        };
        reply().send(7);
        drop(reply());
        drop(sender);
        assert_eq!(receiver.iter().collect::<Vec<_>>(), [Some(7), None]);
    }

    #[test]
    fn a_receiver_of_its_own_sees_that_no_answer_comes() {
        let (reply, answer) = ReplyTo::channel();
        reply.send(7);
        assert_eq!(answer.blocking_recv(), Ok(7));
        let (reply, answer) = ReplyTo::<u8>::channel();
        drop(reply);
        assert!(answer.blocking_recv().is_err());
    }
}
