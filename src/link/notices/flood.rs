//! Counts connections that use another protocol, so that many of them cause one notice.

use std::time::{Duration, Instant};

use crate::link::proto::first_line::ForeignProtocol;

/// The time without a connection after which a flood is over.
const OVER_AFTER: Duration = Duration::from_secs(600);

/// The evidence that the other end of a connection is no serial client.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::link) enum Stranger {
    /// Its first bytes.
    Began(ForeignProtocol),
    /// Bytes that came later.
    WentOn,
}

/// Connections of one kind.
#[derive(Debug, Default)]
pub(super) struct Flood {
    newest: Option<Instant>,
    number: u64,
}

impl Flood {
    /// Counts a connection. Returns `true` if it begins a flood.
    pub(super) fn count(&mut self, now: Instant) -> bool {
        self.number += 1;
        let last = self.newest.replace(now);
        last.is_none_or(|last| now.saturating_duration_since(last) > OVER_AFTER)
    }

    /// Returns the number of connections since the last notice and restarts the count.
    pub(super) fn take_number(&mut self) -> u64 {
        std::mem::take(&mut self.number)
    }
}

/// Returns the notice for this number of connections.
pub(super) fn sentence(door: &str, stranger: Stranger, number: u64) -> String {
    let (connections, were) = match number {
        1 => (format!("A connection to the {door} door"), "was"),
        _ => (format!("{number} connections to the {door} door"), "were"),
    };
    let (said, advice) = match stranger {
        Stranger::Began(ForeignProtocol::Http) => {
            ("began like HTTP", "the door is for MSP and the command line")
        }
        Stranger::Began(ForeignProtocol::Tls) => {
            ("began like TLS", "the door is for MSP and the command line")
        }
        Stranger::Began(ForeignProtocol::Binary) => {
            ("began with binary data such as that of WebRTC", "the door is for MSP and the command line")
        }
        Stranger::Began(ForeignProtocol::Text) => ("began with text", "`#` opens the command line"),
        Stranger::WentOn => {
            ("sent bytes that are neither MSP nor text", "a web page or a broken program sends such bytes")
        }
    };
    format!(
        "{connections} {said} and {were} closed without being interpreted: {advice}. Further ones are only counted as \
         errors of the door."
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_reported_once_and_the_next_one_with_all_that_came_since() {
        let (mut flood, start) = (Flood::default(), Instant::now());
        let at = |seconds: u64| start + Duration::from_secs(seconds);
        assert!(flood.count(at(0)));
        assert!(!flood.count(at(0)));
        assert_eq!(flood.take_number(), 2);
        assert!((1..3000).all(|second| !flood.count(at(second))), "it has not ended");
        assert!(!flood.count(at(3599)));
        assert!(flood.count(at(4200)));
        assert_eq!(flood.take_number(), 3001);
    }

    #[test]
    fn one_connection_is_reported_in_the_singular() {
        let stranger = Stranger::Began(ForeignProtocol::Text);
        assert_eq!(
            sentence("TCP", stranger, 1),
            "A connection to the TCP door began with text and was closed without being interpreted: `#` opens \
             the command line. Further ones are only counted as errors of the door."
        );
        assert!(
            sentence("TCP", stranger, 7)
                .starts_with("7 connections to the TCP door began with text and were closed")
        );
    }
}
