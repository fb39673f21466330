//! Keeps off what may not be done with a craft that is real.

use tokio::sync::oneshot;

use super::Session;
use crate::link::Request;
use crate::link::proto::command_line::LineReply;
use crate::session::command::{CliOutput, Command};
use crate::session::remote::{Access, Denial, Impact, NOTHING_MOVES, NOTHING_SIMULATED, RemoteLink};

impl Session {
    /// What may be done with the craft.
    pub(super) fn access(&self) -> Access {
        self.remote.as_ref().map_or(Access::Everything, RemoteLink::access)
    }

    /// The command, unless it may not be carried out: then it is answered.
    pub(super) fn refuse_to_real_craft(&mut self, command: Command) -> Option<Command> {
        let Err(denial) = self.access().check(impact_of(&command)) else { return Some(command) };
        let sentence = denial.to_string();
        match command {
            Command::Cli { reply, .. } => {
                let (text, advice) = ("###ERROR: NOT DONE###".to_owned(), Some(sentence));
                drop(reply.send(CliOutput { text, advice, restarted: false }));
            }
            Command::Upload { reply, .. } => drop(reply.send(Err(sentence))),
            Command::Save { reply } | Command::World { reply, .. } => {
                drop(reply.send(Err(sentence)));
            }
            _ => self.notice(sentence),
        }
        None
    }
}

/// What a command does to a craft outside. Time and forecasts have rules of their own.
fn impact_of(command: &Command) -> Impact {
    match command {
        Command::Cli { line, .. } => Impact::of_line(line),
        Command::Upload { .. } | Command::Save { .. } => Impact::Changes,
        Command::Sticks(_)
        | Command::CutRc(_)
        | Command::Pilot(_)
        | Command::InFlight(_)
        | Command::ReturnHome
        | Command::CancelReturn => Impact::Forbidden(NOTHING_MOVES),
        Command::ResetCraft | Command::World { .. } => Impact::Forbidden(NOTHING_SIMULATED),
        Command::Pause(_)
        | Command::Step(_)
        | Command::Speed(_)
        | Command::Seek(_)
        | Command::FlyOn
        | Command::Download { .. }
        | Command::CopyVehicle(_)
        | Command::RecordedFlight(_)
        | Command::PermitChanges(_)
        | Command::Quit => Impact::Reads,
    }
}

/// The request of a client, unless it may not be handled: then it is answered, and why comes back.
pub(super) fn refuse_request(request: Request, access: Access) -> Result<Request, Denial> {
    let impact = match &request {
        Request::Msp { code, payload, .. } => Impact::of_message(*code, payload),
        Request::Cli { line, .. } => Impact::of_line(line),
        Request::Restart { .. } => Impact::Changes,
        Request::Rc { .. } | Request::Fdm { .. } => Impact::Forbidden(NOTHING_MOVES),
        // The client's own line, in which nothing is typed yet.
        Request::EnterCli { .. }
        | Request::Complete { .. }
        | Request::LeftCli { .. }
        | Request::Notice(_) => Impact::Reads,
    };
    let Err(denial) = access.check(impact) else { return Ok(request) };
    match request {
        Request::Msp { reply, .. } => answer(reply, None),
        Request::Cli { reply, .. } => {
            let text = format!("###ERROR: {}###\r\n", denial.to_string().trim_end_matches('.'));
            answer(reply, LineReply { text, refused: true, ..LineReply::default() });
        }
        _ => {}
    }
    Err(denial)
}

/// A client that went away needs no answer.
fn answer<T>(reply: oneshot::Sender<T>, value: T) {
    drop(reply.send(value));
}
