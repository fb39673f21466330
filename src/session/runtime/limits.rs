//! Answers refused commands, and refuses requests of clients that are not allowed on a real craft.

use tokio::sync::oneshot;

use crate::fc::{Access, Denial, Impact, NOTHING_MOVES};
use crate::link::Request;
use crate::link::proto::command_line::LineReply;
use crate::session::command::{CliOutput, Command, REWOUND_FOR_CLIENTS};
use crate::session::policy::{REWOUND, Refusal};

/// Answers a command with the reason for its refusal. Returns the reason as a notice if the command has no answer.
pub(in crate::session) fn refuse_command(command: Command, refusal: Refusal) -> Option<String> {
    let sentence = refusal.to_string();
    match command {
        Command::Cli { reply, .. } => {
            let done = if refusal == Refusal::Now(REWOUND) { "REWOUND" } else { "NOT DONE" };
            let (text, advice) = (format!("###ERROR: {done}###"), Some(sentence));
            reply.send(CliOutput { text, advice, restarted: false });
        }
        Command::Upload { reply, .. } => reply.send(Err(sentence)),
        Command::Download { reply } => reply.send(Err(sentence)),
        Command::ReadSettings { reply } => reply.send(Err(sentence)),
        Command::Save { reply } | Command::World { reply, .. } => reply.send(Err(sentence)),
        Command::CopyVehicle { reply, .. } => reply.send(Err(sentence)),
        _ => return Some(sentence),
    }
    None
}

/// Returns the request of a client if it is allowed. Otherwise answers it and returns the refusal.
pub(super) fn refuse_request(request: Request, access: Access) -> Result<Request, Denial> {
    match access.check(impact_of_request(&request)) {
        Ok(()) => Ok(request),
        Err(denial) => {
            refuse(request, &denial.to_string());
            Err(denial)
        }
    }
}

/// Returns the request of a client, unless it would change the vehicle that waits while an earlier instant is
/// shown. Such a request is refused with the reason.
pub(super) fn refuse_changing_request(request: Request) -> Option<Request> {
    // Leaving the command line changes nothing.
    let leaves = matches!(&request, Request::Cli { line, .. } if is_exit_without_reboot(line));
    if leaves || impact_of_request(&request) == Impact::Reads {
        return Some(request);
    }
    refuse(request, REWOUND_FOR_CLIENTS);
    None
}

/// Returns `true` if a line only leaves the command line.
fn is_exit_without_reboot(line: &str) -> bool {
    let mut words = line.split_ascii_whitespace();
    let mut next_is = |word: &str| words.next().is_some_and(|next| next.eq_ignore_ascii_case(word));
    next_is("exit") && next_is("noreboot") && words.next().is_none()
}

/// Returns the impact of a client's request on the craft.
fn impact_of_request(request: &Request) -> Impact {
    match request {
        Request::Msp { code, payload, .. } => Impact::from_message(*code, payload),
        Request::Cli { line, .. } => Impact::from_line(line),
        Request::Restart => Impact::Changes,
        Request::Rc { .. } | Request::Fdm { .. } => Impact::Forbidden(NOTHING_MOVES),
        // The client's own command line, into which nothing is typed yet.
        Request::EnterCli { .. }
        | Request::Complete { .. }
        | Request::LeftCli { .. }
        | Request::Ignored { .. }
        | Request::Notice(_) => Impact::Reads,
    }
}

/// Answers a request with the reason for its refusal, if the request has an answer.
pub(super) fn refuse(request: Request, reason: &str) {
    match request {
        Request::Msp { reply, .. } => answer(reply, None),
        Request::Cli { reply, .. } => {
            let text = format!("###ERROR: {}###\r\n", reason.trim_end_matches('.'));
            answer(reply, LineReply { text, refused: true, ..LineReply::default() });
        }
        _ => {}
    }
}

/// Sends an answer. A client that has disconnected needs none.
fn answer<T>(reply: oneshot::Sender<T>, value: T) {
    drop(reply.send(value));
}

#[cfg(test)]
mod tests {
    use std::time::Instant;

    use super::*;
    use crate::link::ClientId;
    use crate::link::proto::command_line::LineSource;
    use crate::signals::RcFrame;

    #[test]
    fn a_refused_client_is_answered() {
        let (reply, answer) = oneshot::channel();
        let message = Request::Msp { code: crate::msp::code::SET_MOTOR, payload: vec![0; 8], reply };
        assert_eq!(refuse_request(message, Access::Changing).unwrap_err(), Denial::Never(NOTHING_MOVES));
        assert_eq!(answer.blocking_recv(), Ok(None));

        let (reply, answer) = oneshot::channel();
        let line = Request::Cli {
            client: ClientId(1),
            line: "set a = 1".to_owned(),
            source: LineSource::Framed,
            reply,
        };
        assert_eq!(refuse_request(line, Access::Reading).unwrap_err(), Denial::NotPermitted);
        let said = answer.blocking_recv().unwrap();
        assert!(
            said.refused && said.text.starts_with("###ERROR: Changes are not permitted"),
            "{}",
            said.text
        );
    }

    #[test]
    fn scripts_never_reach_a_real_craft_and_always_a_simulated_one() {
        let rc = || Request::Rc { stamp_s: 0.0, frame: RcFrame::SAFE, at: Instant::now() };
        for access in [Access::Reading, Access::Changing] {
            assert!(refuse_request(rc(), access).is_err());
            let restart = Request::Restart;
            assert_eq!(refuse_request(restart, access).is_ok(), access == Access::Changing);
        }
        assert!(refuse_request(rc(), Access::Everything).is_ok());
    }
}
