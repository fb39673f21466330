//! Converts answers of a remote flight controller to those of the embedded one.

use crate::fc::client::Answer;
use crate::firmware::cli::{CliAction, CliReply};

/// Converts the answer of a remote flight controller to the reply of an embedded command line.
pub(super) fn cli_reply(answer: Answer) -> CliReply {
    match answer {
        Answer::Line { text, failed, restarted } => {
            let actions =
                if restarted { vec![CliAction::Restart { close_links: false }] } else { Vec::new() };
            CliReply { text, actions, failed, ..CliReply::default() }
        }
        Answer::NotAnswered(why) => {
            CliReply { text: format!("###ERROR: {why}###\r\n"), failed: true, ..CliReply::default() }
        }
        Answer::Msp(_) => CliReply::default(),
    }
}

/// Converts the answer to a line at the prompt, which is still open if `open`.
pub(super) fn typed_reply(answer: Answer, open: bool) -> CliReply {
    let action = match &answer {
        Answer::Line { restarted: true, .. } => Some(CliAction::Restart { close_links: true }),
        Answer::Line { .. } if !open => Some(CliAction::Leave),
        _ => None,
    };
    CliReply { actions: action.into_iter().collect(), ..cli_reply(answer) }
}
