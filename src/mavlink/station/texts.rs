//! Joins the chunks of long texts.

use std::time::Duration;

use super::super::message::Statustext;
use super::super::value::Severity;
use super::super::wire::printable;

/// The length of a chunk that is not the last one, bytes.
const FULL: usize = 50;
/// The number of chunks of a text. Further ones are dropped.
const MAX_CHUNKS: u8 = 20;
/// The time after which a text without an end is taken as it is.
const PATIENCE: Duration = Duration::from_secs(1);

/// A text for the pilot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PilotText {
    /// The importance.
    pub severity: Severity,
    /// The text, without control characters.
    pub text: String,
}

/// A text whose end has not arrived.
#[derive(Debug, Clone)]
struct Unfinished {
    id: u16,
    severity: Severity,
    next_chunk: u8,
    bytes: Vec<u8>,
    begun: Duration,
}

impl From<Unfinished> for PilotText {
    fn from(unfinished: Unfinished) -> Self {
        Self { severity: unfinished.severity, text: printable(&unfinished.bytes) }
    }
}

/// Joins the chunks of one text at a time.
#[derive(Debug, Clone, Default)]
pub(super) struct TextJoiner(Option<Unfinished>);

impl TextJoiner {
    /// Takes a message. Returns the texts that are complete: that before it, which has no end, and its own.
    pub(super) fn take(&mut self, message: &Statustext, now: Duration) -> [Option<PilotText>; 2] {
        let severity = Severity::from_code(message.severity).unwrap_or(Severity::Info);
        let bytes = message.text.as_bytes();
        let before = self.0.take_if(|text| message.id != text.id);
        let mut text = self.0.take().unwrap_or(Unfinished {
            id: message.id,
            severity,
            next_chunk: 0,
            bytes: Vec::new(),
            begun: now,
        });
        if message.chunk_seq > text.next_chunk {
            text.bytes.extend("…".as_bytes());
        }
        if message.chunk_seq >= text.next_chunk {
            text.bytes.extend(bytes);
            text.next_chunk = message.chunk_seq.saturating_add(1);
        }
        let is_last = message.id == 0 || bytes.len() < FULL || text.next_chunk >= MAX_CHUNKS;
        if is_last {
            return [before.map(Into::into), Some(text.into())];
        }
        self.0 = Some(text);
        [before.map(Into::into), None]
    }

    /// Returns a text whose end did not arrive in time.
    pub(super) fn overdue(&mut self, now: Duration) -> Option<PilotText> {
        self.0.take_if(|text| now.saturating_sub(text.begun) >= PATIENCE).map(Into::into)
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::Text;
    use super::*;

    fn chunk(id: u16, chunk_seq: u8, text: &str) -> Statustext {
        Statustext { severity: 4, text: Text::new(text), id, chunk_seq }
    }

    fn texts(taken: [Option<PilotText>; 2]) -> Vec<String> {
        taken.into_iter().flatten().map(|text| text.text).collect()
    }

    #[test]
    fn chunks_become_one_text() {
        let mut joiner = TextJoiner::default();
        let full = "0123456789".repeat(5);
        assert_eq!(texts(joiner.take(&chunk(7, 0, &full), Duration::ZERO)), [""; 0]);
        assert_eq!(texts(joiner.take(&chunk(7, 1, "end"), Duration::ZERO)), [format!("{full}end")]);
        assert_eq!(texts(joiner.take(&chunk(0, 0, &full), Duration::ZERO)), [full]);
    }

    #[test]
    fn a_lost_chunk_is_marked_and_a_lost_end_awaited_for_a_second() {
        let mut joiner = TextJoiner::default();
        let full = "x".repeat(50);
        joiner.take(&chunk(7, 0, &full), Duration::ZERO);
        assert_eq!(texts(joiner.take(&chunk(7, 2, "end"), Duration::ZERO)), [format!("{full}…end")]);
        joiner.take(&chunk(8, 0, &full), Duration::ZERO);
        assert_eq!(joiner.overdue(Duration::from_millis(999)), None);
        assert_eq!(joiner.overdue(Duration::from_secs(1)).unwrap().text, full);
        joiner.take(&chunk(9, 0, &full), Duration::ZERO);
        assert_eq!(texts(joiner.take(&chunk(0, 0, "new"), Duration::ZERO)), [&full, "new"]);
    }

    #[test]
    fn a_text_without_end_is_cut() {
        let mut joiner = TextJoiner::default();
        let full = "x".repeat(50);
        let all: Vec<String> =
            (0..=255).flat_map(|at| texts(joiner.take(&chunk(1, at, &full), Duration::ZERO))).collect();
        assert!(all.iter().all(|text| text.len() <= 50 * 21), "{}", all.len());
    }
}
