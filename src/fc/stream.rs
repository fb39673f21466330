//! Moves the bytes of a flight controller's serial port, and tracks its connection.

use std::task::{Context, Poll};
use std::time::Instant;

use super::silence::Silence;
use super::{RemoteLink, RemoteNotice, RemoteState};
use crate::link::StreamEvent;
use crate::vehicle::Vehicle;

/// The maximum number of pieces and bytes that are read between two steps, so that a flood from the peer does
/// not hold up the craft. Unread data holds up the peer.
const MOST_READ: usize = 64;
const MOST_BYTES: usize = 8 * 1024;

impl RemoteLink {
    /// Reads the data that has arrived over the serial port.
    pub(super) fn read_stream(
        &mut self,
        vehicle: &mut Vehicle,
        mut context: Option<&mut Context<'_>>,
        now: Instant,
    ) {
        let since = now.saturating_duration_since(self.started);
        let mut read = 0;
        for _ in 0..MOST_READ {
            if read >= MOST_BYTES {
                break;
            }
            let event = match &mut context {
                Some(context) => match self.ends.stream.from.poll_recv(context) {
                    Poll::Ready(event) => event,
                    Poll::Pending => None,
                },
                None => self.ends.stream.from.try_recv().ok(),
            };
            match event {
                None => return,
                Some(StreamEvent::Bytes(bytes)) => {
                    self.heard = true;
                    self.reported_loss = None;
                    read += bytes.len();
                    self.client.push(&bytes, since);
                }
                Some(StreamEvent::Connected) => {
                    self.first_connected.get_or_insert(now);
                    self.connected = Some(now);
                    self.heard = false;
                    self.meet();
                    if let Some(peer) = &mut self.ends.peer {
                        peer.came_up();
                    }
                }
                Some(StreamEvent::Lost(reason)) => self.lose(&reason, vehicle),
            }
        }
        // The queue was not polled until it was empty, so no wake-up is registered.
        if let Some(context) = context {
            context.waker().wake_by_ref();
        }
    }

    fn lose(&mut self, reason: &str, vehicle: &mut Vehicle) {
        self.client.disconnected();
        self.connected = None;
        self.permission.lost();
        self.silence = Silence::default();
        self.observer.forget();
        match self.state {
            RemoteState::Unusable(_) => {}
            // Its own program may still be starting. A delay that is too long is reported elsewhere.
            RemoteState::Connecting if self.ends.child.is_some() => {}
            RemoteState::Connecting => {
                let notice = format!("No connection to {}: {reason}; trying again.", self.ends.name);
                self.notices.push(RemoteNotice::Lost(notice));
            }
            // A program that somebody else started closes its port when it ends to be restarted.
            RemoteState::Identifying | RemoteState::Ready
                if self.is_fed() && self.ends.child.is_none() && self.heard =>
            {
                let notice = format!(
                    "{} ended or is restarting: when it is back, the craft is at home.",
                    self.ends.name
                );
                self.restart(vehicle, notice);
                self.state = RemoteState::Lost;
            }
            RemoteState::Identifying | RemoteState::Ready | RemoteState::Lost => {
                // A connection that closes at once is reported only once.
                if self.state != RemoteState::Lost && self.reported_loss.as_deref() != Some(reason) {
                    let notice =
                        format!("The connection to {} is lost: {reason}; reconnecting.", self.ends.name);
                    self.notices.push(RemoteNotice::Lost(notice));
                    self.reported_loss = Some(reason.to_owned());
                }
                if let Some(peer) = self.ends.peer.as_mut().filter(|_| !self.heard) {
                    peer.went_down();
                }
                self.state = RemoteState::Lost;
            }
        }
    }

    /// Sends the client's output.
    pub(super) fn write_stream(&mut self) {
        let output = self.client.take_output();
        if !output.is_empty() {
            // A full queue means that the stream carries nothing any more. The client gives the request up.
            drop(self.ends.stream.to.try_send(output));
        }
    }
}

#[cfg(test)]
mod tests {
    use tokio::sync::mpsc;

    use super::*;
    use crate::fc::RemoteEnds;
    use crate::link::FcStream;

    #[test]
    #[allow(clippy::disallowed_methods, reason = "an instant to count from")]
    fn a_peer_that_floods_is_read_a_part_at_a_time() {
        let ((to, _sent), (pieces, from)) = (mpsc::channel(1), mpsc::channel(MOST_READ));
        while pieces.try_send(StreamEvent::Bytes(vec![b'$'; 4096])).is_ok() {}
        let stream = FcStream { to, from, place: "tcp:here:1".to_owned(), bytes_per_s: None };
        let ends = RemoteEnds { name: "the board".to_owned(), stream, peer: None, child: None };
        let mut vehicle = Vehicle::elsewhere().unwrap();
        let now = Instant::now();
        let mut link = RemoteLink::new(ends, now);
        link.exchange(&mut vehicle, None, now);
        assert_eq!(pieces.capacity(), 2, "pieces read");
        link.exchange(&mut vehicle, None, now);
        assert_eq!(pieces.capacity(), 4, "pieces read");
    }
}
