//! Answers of a flight controller outside as the embedded one gives them.

use crate::firmware::cli::{CliAction, CliReply};
use crate::link::proto::fc_client::Answer;

/// The answer to a line as the command line of an embedded flight controller gives it.
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
