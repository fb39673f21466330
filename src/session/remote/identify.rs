//! Asks a flight controller what it is and how it is set, one question after the other.

use super::observer::Observer;
use crate::link::proto::fc_client::{Answer, Ask, Unanswered};

/// What is asked after each connection, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Question {
    /// The version of its MSP.
    ApiVersion,
    /// Which firmware it is.
    Variant,
    /// The firmware's version.
    Version,
    /// The board.
    Board,
    /// When and with what it was built.
    Build,
    /// Its boxes, in the order of the mode bits.
    Boxes,
    /// The conditions of its modes …
    ModeRanges,
    /// … and which of them follow others.
    ModeLinks,
    /// Settings that displays and the pilot need: all whose names contain this.
    Settings(&'static str),
    /// The plan that it holds.
    Plan,
}

const QUESTIONS: [Question; 12] = [
    Question::ApiVersion,
    Question::Variant,
    Question::Version,
    Question::Board,
    Question::Build,
    Question::Boxes,
    Question::ModeRanges,
    Question::ModeLinks,
    Question::Settings("ap_"),
    Question::Settings("alt_hold_"),
    Question::Settings("min_check"),
    Question::Plan,
];

/// The only firmware that is spoken with.
const BETAFLIGHT: &[u8] = b"BTFL";

impl Question {
    pub(super) fn ask(self) -> Ask {
        let code = match self {
            Self::ApiVersion => 1,
            Self::Variant => 2,
            Self::Version => 3,
            Self::Board => 4,
            Self::Build => 5,
            Self::Boxes => 119,
            Self::ModeRanges => 34,
            Self::ModeLinks => 238,
            Self::Settings(part) => return Ask::Line(format!("get {part}")),
            Self::Plan => return Ask::Line("waypoint list".to_owned()),
        };
        Ask::Msp { code, payload: Vec::new() }
    }
}

/// How far the questions are.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Identification {
    asked: usize,
}

impl Identification {
    /// The next question, when its turn has come.
    pub(super) fn next(&self) -> Option<Question> {
        QUESTIONS.get(self.asked).copied()
    }

    /// Takes an answer; says whether it was the last.
    ///
    /// # Errors
    /// Why the flight controller is of no use, as a part of a sentence.
    pub(super) fn take(
        &mut self,
        question: Question,
        answer: &Answer,
        observer: &mut Observer,
    ) -> Result<bool, String> {
        match (question, answer) {
            // The connection is gone: everything is asked again over the next.
            (_, Answer::NotAnswered(Unanswered::LinkLost)) => return Ok(false),
            (Question::ApiVersion, Answer::NotAnswered(_)) => {
                return Err(
                    "nothing there answers MSP: is it a flight controller, and the right port and speed?"
                        .to_owned(),
                );
            }
            (Question::Variant, Answer::Msp(Some(variant))) if variant != BETAFLIGHT => {
                let variant = String::from_utf8_lossy(variant).escape_debug().to_string();
                return Err(format!(
                    "the flight controller there says {variant}, not BTFL: only Betaflight is spoken with"
                ));
            }
            _ => observer.learn(question, answer),
        }
        self.asked += 1;
        Ok(self.asked == QUESTIONS.len())
    }
}
