//! The places of a door's clients. When all are taken, a connection that has not sent a request yet gives its
//! place to the next one. Half-finished handshakes and silent connections thus do not block a door.

use std::sync::{Arc, Mutex, PoisonError};

use tokio_util::sync::CancellationToken;

use super::request::ClientId;

/// The maximum number of clients of one door.
pub(super) const CLIENTS_MAX: usize = 32;

/// One occupied place.
#[derive(Debug)]
struct Taken {
    by: ClientId,
    has_spoken: bool,
    evicted: CancellationToken,
}

/// The places of one door, in the order in which they were taken. All listeners of the door share them.
#[derive(Debug, Clone, Default)]
pub(super) struct Seats(Arc<Mutex<Vec<Taken>>>);

/// The place of one client. Dropping it frees the place.
#[derive(Debug)]
pub(super) struct Seat {
    client: ClientId,
    seats: Seats,
    evicted: CancellationToken,
}

impl Seats {
    /// Returns a place for a client. If all places are taken, the client gets that of the oldest connection
    /// without a request. Returns `None` if all clients have sent one.
    pub(super) fn take(&self, client: ClientId) -> Option<Seat> {
        let evicted = CancellationToken::new();
        self.change(|taken| {
            if taken.len() >= CLIENTS_MAX {
                let silent = taken.iter().position(|seat| !seat.has_spoken)?;
                taken.remove(silent).evicted.cancel();
            }
            taken.push(Taken { by: client, has_spoken: false, evicted: evicted.clone() });
            Some(())
        })?;
        Some(Seat { client, seats: self.clone(), evicted })
    }

    fn change<T>(&self, change: impl FnOnce(&mut Vec<Taken>) -> T) -> T {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Seat {
    pub(super) fn client(&self) -> ClientId {
        self.client
    }

    /// Keeps the place for the client, because it has sent a request.
    pub(super) fn keep(&self) {
        self.seats.change(|taken| {
            if let Some(seat) = taken.iter_mut().find(|seat| seat.by == self.client) {
                seat.has_spoken = true;
            }
        });
    }

    /// Waits until the place is given to another client.
    pub(super) async fn evicted(&self) {
        self.evicted.cancelled().await;
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        self.seats.change(|taken| taken.retain(|seat| seat.by != self.client));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_connection_that_was_silent_for_the_longest_makes_room() {
        let seats = Seats::default();
        let taken: Vec<Seat> = (0..CLIENTS_MAX as u64).map(|id| seats.take(ClientId(id)).unwrap()).collect();
        taken[0].keep();
        taken[2].keep();
        let next = seats.take(ClientId(100)).unwrap();
        let evicted = |seats: &[Seat]| -> Vec<u64> {
            seats.iter().filter(|seat| seat.evicted.is_cancelled()).map(|seat| seat.client.0).collect()
        };
        assert_eq!(evicted(&taken), [1]);
        drop(taken);
        assert!(!next.evicted.is_cancelled());
    }

    #[test]
    fn clients_that_have_spoken_keep_their_places_until_they_go() {
        let seats = Seats::default();
        let mut taken: Vec<Seat> =
            (0..CLIENTS_MAX as u64).map(|id| seats.take(ClientId(id)).unwrap()).collect();
        taken.iter().for_each(Seat::keep);
        assert!(seats.take(ClientId(100)).is_none());
        taken.pop();
        assert!(seats.take(ClientId(101)).is_some());
    }
}
