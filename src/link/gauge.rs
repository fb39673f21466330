//! What a door has seen, counted where it happens and read where it is shown.

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};
use std::time::{Duration, Instant};

use crate::firmware::msp::MESSAGES;

/// After this long without a packet the rate is shown as zero.
const RATE_EXPIRES: Duration = Duration::from_secs(2);

/// Marks that no message was asked yet.
const NO_MESSAGE: u32 = u32::MAX;

/// The counters of one door.
#[derive(Debug)]
pub(super) struct Gauge {
    opened: Instant,
    clients: AtomicU32,
    last_message: AtomicU32,
    received_bytes: AtomicU64,
    sent_bytes: AtomicU64,
    packets: AtomicU64,
    wrong_size: AtomicU64,
    errors: AtomicU64,
    /// Time of the newest packet, ms since opened.
    newest_ms: AtomicU64,
    window_start_ms: AtomicU64,
    window_packets: AtomicU64,
    rate_hz: AtomicU32,
}

impl Gauge {
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

    /// Counts a client that came; how many there are now.
    pub(super) fn client_came(&self) -> u32 {
        self.clients.fetch_add(1, Relaxed) + 1
    }

    pub(super) fn client_left(&self) {
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

    /// Counts a good packet.
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

    /// `2 clients, STATUS, 1.2 kB in, 3.4 kB out, 1 error`.
    pub(super) fn stream_words(&self) -> String {
        let clients = self.clients.load(Relaxed);
        let mut words = match clients {
            0 => "listening".to_owned(),
            1 => "1 client".to_owned(),
            more => format!("{more} clients"),
        };
        let last = self.last_message.load(Relaxed);
        if clients > 0
            && let Some(message) = MESSAGES.iter().find(|message| u32::from(message.code) == last)
        {
            words += &format!(", {}", message.name);
        }
        let (received, sent) = (self.received_bytes.load(Relaxed), self.sent_bytes.load(Relaxed));
        if received + sent > 0 {
            words += &format!(", {} in, {} out", bytes(received), bytes(sent));
        }
        words + &self.error_words()
    }

    /// `50 Hz, 1234 packets, 12 ms ago, 1 of wrong size`.
    pub(super) fn packet_words(&self, now: Instant) -> String {
        let packets = self.packets.load(Relaxed);
        if packets == 0 {
            let wrong = self.wrong_size.load(Relaxed);
            return if wrong > 0 {
                format!("listening, {wrong} of wrong size")
            } else {
                "listening".to_owned()
            };
        }
        let age_ms = self.millis(now).saturating_sub(self.newest_ms.load(Relaxed));
        let stale = u128::from(age_ms) > RATE_EXPIRES.as_millis();
        let rate = if stale { 0 } else { self.rate_hz.load(Relaxed) };
        let age = if age_ms < 1000 { format!("{age_ms} ms") } else { format!("{} s", age_ms / 1000) };
        let mut words = format!("{rate} Hz, {packets} packets, {age} ago");
        let wrong = self.wrong_size.load(Relaxed);
        if wrong > 0 {
            words += &format!(", {wrong} of wrong size");
        }
        words + &self.error_words()
    }

    fn error_words(&self) -> String {
        match self.errors.load(Relaxed) {
            0 => String::new(),
            1 => ", 1 error".to_owned(),
            more => format!(", {more} errors"),
        }
    }
}

fn bytes(count: u64) -> String {
    match count {
        0..1000 => format!("{count} B"),
        1000..1_000_000 => format!("{:.1} kB", count as f64 / 1e3),
        _ => format!("{:.1} MB", count as f64 / 1e6),
    }
}
