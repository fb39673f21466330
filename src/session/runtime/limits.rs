//! Refuses actions that are not allowed on a real craft.

use tokio::sync::oneshot;

use crate::fc::{Access, Denial, Impact, NOTHING_MOVES, NOTHING_SIMULATED};
use crate::link::Request;
use crate::link::proto::command_line::LineReply;
use crate::session::command::{CliOutput, Command};
use crate::vehicle::VehicleCommand;

/// Returns the command if it is allowed. Otherwise answers it.
///
/// # Errors
/// Returns the refusal as a notice, if the command has no answer.
pub(super) fn refuse_to_real_craft(command: Command, access: Access) -> Result<Command, Option<String>> {
    let Err(denial) = access.check(impact_of(&command)) else { return Ok(command) };
    let sentence = denial.to_string();
    match command {
        Command::Cli { reply, .. } => {
            let (text, advice) = ("###ERROR: NOT DONE###".to_owned(), Some(sentence));
            reply.send(CliOutput { text, advice, restarted: false });
        }
        Command::Upload { reply, .. } => reply.send(Err(sentence)),
        Command::Save { reply } | Command::World { reply, .. } => reply.send(Err(sentence)),
        _ => return Err(Some(sentence)),
    }
    Err(None)
}

/// Returns the impact of a command on a remote craft. Time and forecasts have their own rules.
fn impact_of(command: &Command) -> Impact {
    match command {
        Command::Cli { line, .. } => Impact::of_line(line),
        Command::Upload { .. } | Command::Save { .. } => Impact::Changes,
        Command::Vehicle(command) => impact_on_vehicle(command),
        Command::StartPilot => Impact::Forbidden(NOTHING_MOVES),
        Command::World { .. } => Impact::Forbidden(NOTHING_SIMULATED),
        Command::Pause(_)
        | Command::Step(_)
        | Command::Speed(_)
        | Command::Seek(_)
        | Command::FlyOn
        | Command::Download { .. }
        | Command::CopyVehicle(_)
        | Command::RecordedFlight(_)
        | Command::PermitChanges(_)
        | Command::Subscribe(_)
        | Command::Quit => Impact::Reads,
    }
}

fn impact_on_vehicle(command: &VehicleCommand) -> Impact {
    match command {
        VehicleCommand::Line(line) => Impact::of_line(&line.1),
        VehicleCommand::Message(message) => Impact::of_message(message.code, &message.payload),
        VehicleCommand::Restart(_) => Impact::Changes,
        VehicleCommand::CliOpened | VehicleCommand::CliClosed => Impact::Reads,
        VehicleCommand::ResetCraft | VehicleCommand::World(_) => Impact::Forbidden(NOTHING_SIMULATED),
        VehicleCommand::Rc(..)
        | VehicleCommand::SticksFirst(_)
        | VehicleCommand::ReturnHome
        | VehicleCommand::InFlight(_)
        | VehicleCommand::CancelReturn
        | VehicleCommand::Sticks(_)
        | VehicleCommand::CutRc(_)
        | VehicleCommand::HoldChannel(_)
        | VehicleCommand::ReleaseChannel(_)
        | VehicleCommand::StartPilot(_)
        | VehicleCommand::StopPilot => Impact::Forbidden(NOTHING_MOVES),
    }
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

/// Returns the impact of a client's request on the craft.
pub(super) fn impact_of_request(request: &Request) -> Impact {
    match request {
        Request::Msp { code, payload, .. } => Impact::of_message(*code, payload),
        Request::Cli { line, .. } => Impact::of_line(line),
        Request::Restart { .. } => Impact::Changes,
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
    use crate::plan::FlightPlan;
    use crate::session::ReplyTo;
    use crate::signals::RcFrame;
    use crate::telemetry::InFlightCommand;

    const MOVES: Impact = Impact::Forbidden(NOTHING_MOVES);
    const SIMULATED: Impact = Impact::Forbidden(NOTHING_SIMULATED);

    #[test]
    fn commands_of_the_interface_are_held_to_the_rule_too() {
        fn channel<T: Send + 'static>() -> ReplyTo<T> {
            ReplyTo::channel().0
        }
        let line = |line: &str| Command::Cli { line: line.to_owned(), reply: channel() };
        for (command, impact) in [
            (line("get"), Impact::Reads),
            (line("save"), Impact::Changes),
            (line("motor 1 1500"), MOVES),
            (
                Command::Upload {
                    plan: Box::new(FlightPlan::default()),
                    settings: Vec::new(),
                    reply: channel(),
                },
                Impact::Changes,
            ),
            (Command::Save { reply: channel() }, Impact::Changes),
            (Command::Download { reply: channel() }, Impact::Reads),
            (Command::Vehicle(VehicleCommand::Sticks(RcFrame::SAFE)), MOVES),
            (Command::Vehicle(VehicleCommand::CutRc(true)), MOVES),
            (Command::StartPilot, MOVES),
            (Command::Vehicle(VehicleCommand::ReturnHome), MOVES),
            (Command::Vehicle(VehicleCommand::CancelReturn), MOVES),
            (Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::HoldHere)), MOVES),
            (Command::Vehicle(VehicleCommand::ResetCraft), SIMULATED),
            (Command::World { line: "wind=5@270".to_owned(), reply: channel() }, SIMULATED),
            (Command::PermitChanges(1), Impact::Reads),
            (Command::Quit, Impact::Reads),
        ] {
            assert_eq!(impact_of(&command), impact, "{command:?}");
        }
    }

    #[test]
    fn a_refused_client_is_answered() {
        let client = ClientId(1);
        let (reply, answer) = oneshot::channel();
        let message = Request::Msp { client, code: crate::msp::code::SET_MOTOR, payload: vec![0; 8], reply };
        assert_eq!(refuse_request(message, Access::Changing).unwrap_err(), Denial::Never(NOTHING_MOVES));
        assert_eq!(answer.blocking_recv(), Ok(None));

        let (reply, answer) = oneshot::channel();
        let line = Request::Cli { client, line: "set a = 1".to_owned(), source: LineSource::Framed, reply };
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
        let from = "127.0.0.1:1".parse().unwrap();
        let rc = || Request::Rc { stamp_s: 0.0, frame: RcFrame::SAFE, from, at: Instant::now() };
        for access in [Access::Reading, Access::Changing] {
            assert!(refuse_request(rc(), access).is_err());
            let restart = Request::Restart { client: ClientId(1) };
            assert_eq!(refuse_request(restart, access).is_ok(), access == Access::Changing);
        }
        assert!(refuse_request(rc(), Access::Everything).is_ok());
    }
}
