//! Asks a flight controller for its identity and settings, one question after the other.

use super::observer::Observer;
use crate::fc::LIST;
use crate::fc::client::{Answer, Ask, Unanswered};
use crate::msp::{BETAFLIGHT, code};

/// The questions after each new connection, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Question {
    /// The version of its MSP API.
    ApiVersion,
    /// The kind of firmware.
    Variant,
    /// The version of the firmware.
    Version,
    Board,
    /// The date, time and revision of the build, and its options.
    Build,
    /// The boxes, in the order of the mode bits.
    Boxes,
    /// The conditions of its modes …
    ModeRanges,
    /// … and the links between them.
    ModeLinks,
    /// Settings that displays and the pilot need: all whose names contain this text.
    Settings(&'static str),
    /// The stored plan.
    Plan,
}

const QUESTIONS: [Question; 13] = [
    Question::ApiVersion,
    Question::Variant,
    Question::Version,
    Question::Board,
    Question::Build,
    Question::Boxes,
    Question::ModeRanges,
    Question::ModeLinks,
    Question::Settings("ap_"),
    Question::Settings("trust_mag"),
    Question::Settings("alt_hold_"),
    Question::Settings("min_check"),
    Question::Plan,
];

/// Returns the questions that are asked again once the answers may have changed.
pub(super) fn how_it_is_set() -> impl Iterator<Item = Question> {
    QUESTIONS.into_iter().filter(|question| matches!(question, Question::Settings(_) | Question::Plan))
}

impl Question {
    pub(super) fn ask(self) -> Ask {
        match (self.code(), self) {
            (Some(code), _) => Ask::Msp { code, payload: Vec::new() },
            (None, Self::Settings(part)) => Ask::Line(format!("get {part}")),
            (None, _) => Ask::Line(LIST.to_owned()),
        }
    }

    /// Returns the code of the message; `None` for a line.
    pub(super) fn code(self) -> Option<u16> {
        Some(match self {
            Self::ApiVersion => code::API_VERSION,
            Self::Variant => code::FC_VARIANT,
            Self::Version => code::FC_VERSION,
            Self::Board => code::BOARD_INFO,
            Self::Build => code::BUILD_INFO,
            Self::Boxes => code::BOXIDS,
            Self::ModeRanges => code::MODE_RANGES,
            Self::ModeLinks => code::MODE_RANGES_EXTRA,
            Self::Settings(_) | Self::Plan => return None,
        })
    }
}

/// The progress of the questions.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Identification {
    asked: usize,
}

impl Identification {
    /// Returns the next question.
    pub(super) fn next(&self) -> Option<Question> {
        QUESTIONS.get(self.asked).copied()
    }

    /// Takes an answer. Returns `true` if it was the last.
    ///
    /// # Errors
    /// Returns the reason why the flight controller cannot be used, as part of a sentence.
    pub(super) fn take(
        &mut self,
        question: Question,
        answer: &Answer,
        observer: &mut Observer,
    ) -> Result<bool, String> {
        match (question, answer) {
            // The connection is lost. All questions are asked again over the next one.
            (_, Answer::NotAnswered(Unanswered::LinkLost)) => return Ok(false),
            (Question::ApiVersion, Answer::NotAnswered(Unanswered::InCli)) => {
                return Err(
                    "another program left its command line open, and leaving it may restart the board: \
                     the command allow-changes permits that"
                        .to_owned(),
                );
            }
            (Question::ApiVersion, Answer::NotAnswered(_)) => {
                return Err(
                    "nothing there answers MSP: is it a flight controller, and are port and speed right?"
                        .to_owned(),
                );
            }
            (Question::Variant, Answer::Msp(Some(variant))) if variant == BETAFLIGHT => {}
            (Question::Variant, Answer::Msp(Some(variant))) => {
                let variant = String::from_utf8_lossy(variant).escape_debug().to_string();
                return Err(format!(
                    "the flight controller there reports {variant}, not BTFL: only Betaflight is supported"
                ));
            }
            (Question::Variant, _) => {
                return Err(
                    "the flight controller there does not identify itself: only Betaflight is supported"
                        .to_owned(),
                );
            }
            _ => observer.learn(question, answer),
        }
        self.asked += 1;
        Ok(self.asked == QUESTIONS.len())
    }
}
