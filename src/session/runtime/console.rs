//! The command line of the user interface.
#![allow(clippy::disallowed_methods, reason = "a late answer is awaited in wall time")]

use std::time::Instant;

use super::Session;
use super::late::WaitingInterface;
use crate::firmware::cli::{CliReply, Interpreter, advice};
use crate::session::ReplyTo;
use crate::session::command::CliOutput;
use crate::vehicle::Answer;

impl Session {
    /// Runs a line. The answer of a remote flight controller arrives later.
    pub(super) fn run_cli(&mut self, line: String, reply: ReplyTo<CliOutput>) {
        match self.vehicle.controller_mut().run_cli(&mut self.console, &line) {
            Answer::Now(mut answer) => {
                self.host.add_to(&mut answer);
                let restarted = self.carry_out_actions(&mut answer);
                reply.send(output(&line, answer, restarted));
            }
            Answer::Later(ticket) => {
                self.late_answers.expect(ticket, WaitingInterface::Line { line, reply }, Instant::now());
            }
        }
    }

    /// Carries out the actions of a line for an embedded flight controller. Returns `true` if it restarted.
    fn carry_out_actions(&mut self, reply: &mut CliReply) -> bool {
        let controller = self.vehicle.controller_mut();
        let done = self.persistence.carry_out(reply, controller);
        let restarted = done.restarted.is_some();
        if restarted {
            self.console = Interpreter::default();
            if let Some(endpoints) = &mut self.endpoints {
                endpoints.handler.after_restart(true, controller);
            }
        }
        done.notices.into_iter().for_each(|notice| self.notice(notice));
        restarted
    }
}

/// Returns the console's output for an answer.
pub(super) fn output(line: &str, answer: CliReply, restarted: bool) -> CliOutput {
    let advice = advice(line, &answer);
    CliOutput { text: answer.text, advice, restarted }
}
