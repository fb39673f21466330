//! The counters of an endpoint, updated by its tasks and read for display.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use crate::link::endpoint::{ClientStats, PacketStats};

/// The time without a packet after which the rate counts as zero.
const RATE_EXPIRES: Duration = Duration::from_secs(2);

/// Marks that no message was requested yet.
const NO_MESSAGE: u32 = u32::MAX;

/// The counters of one endpoint.
#[derive(Debug)]
pub(super) struct EndpointStats {
    opened: Instant,
    clients: AtomicU32,
    last_message: AtomicU32,
    received_bytes: AtomicU64,
    sent_bytes: AtomicU64,
    packets: AtomicU64,
    wrong_size: AtomicU64,
    errors: AtomicU64,
    /// The time of the newest packet, ms since `opened`.
    newest_ms: AtomicU64,
    window_start_ms: AtomicU64,
    window_packets: AtomicU64,
    rate_hz: AtomicU32,
}

impl EndpointStats {
    pub(super) fn new(now: Instant) -> Self {
        Self {
            opened: now,
            clients: AtomicU32::new(0),
            last_message: AtomicU32::new(NO_MESSAGE),
            received_bytes: AtomicU64::new(0),
            sent_bytes: AtomicU64::new(0),
            packets: AtomicU64::new(0),
            wrong_size: AtomicU64::new(0),
            errors: AtomicU64::new(0),
            newest_ms: AtomicU64::new(0),
            window_start_ms: AtomicU64::new(0),
            window_packets: AtomicU64::new(0),
            rate_hz: AtomicU32::new(0),
        }
    }

    pub(super) fn client_connected(&self) {
        self.clients.fetch_add(1, Relaxed);
    }

    pub(super) fn client_disconnected(&self) {
        self.clients.fetch_sub(1, Relaxed);
    }

    pub(super) fn clients(&self) -> u32 {
        self.clients.load(Relaxed)
    }

    pub(super) fn asked(&self, code: u16) {
        self.last_message.store(u32::from(code), Relaxed);
    }

    pub(super) fn received(&self, bytes: usize) {
        self.received_bytes.fetch_add(bytes as u64, Relaxed);
    }

    pub(super) fn sent(&self, bytes: usize) {
        self.sent_bytes.fetch_add(bytes as u64, Relaxed);
    }

    pub(super) fn error(&self) {
        self.errors.fetch_add(1, Relaxed);
    }

    pub(super) fn wrong_size(&self) {
        self.wrong_size.fetch_add(1, Relaxed);
    }

    /// Counts a valid packet.
    pub(super) fn packet(&self, now: Instant) {
        let now_ms = self.millis(now);
        self.packets.fetch_add(1, Relaxed);
        self.newest_ms.store(now_ms, Relaxed);
        let packets = self.window_packets.fetch_add(1, Relaxed) + 1;
        let elapsed = now_ms.saturating_sub(self.window_start_ms.load(Relaxed));
        if elapsed >= 1000 {
            self.rate_hz.store((packets * 1000 / elapsed) as u32, Relaxed);
            self.window_start_ms.store(now_ms, Relaxed);
            self.window_packets.store(0, Relaxed);
        }
    }

    fn millis(&self, now: Instant) -> u64 {
        now.saturating_duration_since(self.opened).as_millis() as u64
    }

    /// Returns the current counters of a server.
    pub(super) fn client_stats(&self) -> ClientStats {
        let last = self.last_message.load(Relaxed);
        ClientStats {
            clients: self.clients(),
            last_message: (last != NO_MESSAGE).then_some(last as u16),
            received_bytes: self.received_bytes.load(Relaxed),
            sent_bytes: self.sent_bytes.load(Relaxed),
            errors: self.errors.load(Relaxed),
        }
    }

    /// Returns the counters of a receiver at `now`.
    pub(super) fn packet_stats(&self, now: Instant) -> PacketStats {
        let packets = self.packets.load(Relaxed);
        let age_ms = (packets > 0).then(|| self.millis(now).saturating_sub(self.newest_ms.load(Relaxed)));
        let is_flowing = age_ms.is_some_and(|age| u128::from(age) <= RATE_EXPIRES.as_millis());
        PacketStats {
            packets,
            rate_hz: if is_flowing { self.rate_hz.load(Relaxed) } else { 0 },
            age_ms,
            wrong_size: self.wrong_size.load(Relaxed),
            errors: self.errors.load(Relaxed),
        }
    }
}
