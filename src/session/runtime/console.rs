//! The command line of the user interface.
#![allow(clippy::disallowed_methods, reason = "a late answer is awaited in wall time")]

use std::time::Instant;

use tokio::sync::oneshot;

use super::Session;
use super::late::WaitingInterface;
use crate::firmware::cli::{CliAction, CliReply, Interpreter, advice};
use crate::session::command::CliOutput;
use crate::vehicle::Answer;

impl Session {
    /// Runs a line; the answer of a remote flight controller comes later.
    pub(super) fn run_cli(&mut self, line: String, reply: oneshot::Sender<CliOutput>) {
        match self.vehicle.controller_mut().run_cli(&mut self.console, &line) {
            Answer::Now(answer) => {
                let restarted = self.carry_out_actions(&answer);
                drop(reply.send(output(&line, answer, restarted)));
            }
            Answer::Later(ticket) => {
                self.late_answers.expect(ticket, WaitingInterface::Line { line, reply }, Instant::now());
            }
        }
    }

    /// Does what a line asked the owner of an embedded flight controller to do; says whether that restarted.
    fn carry_out_actions(&mut self, reply: &CliReply) -> bool {
        let controller = self.vehicle.controller_mut();
        let mut restarted = false;
        let mut notices = Vec::new();
        for action in &reply.actions {
            match action {
                CliAction::Save => notices.extend(self.persistence.save(controller).err()),
                CliAction::Restart { .. } => {
                    notices.extend(self.persistence.restart(controller));
                    self.console = Interpreter::default();
                    restarted = true;
                }
                // The firmware itself has carried these out.
                CliAction::Leave | CliAction::MotorTest { .. } | CliAction::PlanChanged => {}
            }
        }
        if restarted && let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(true, controller);
        }
        notices.into_iter().for_each(|notice| self.notice(notice));
        restarted
    }
}

/// What the console shows of an answer.
pub(super) fn output(line: &str, answer: CliReply, restarted: bool) -> CliOutput {
    let advice = advice(line, &answer);
    CliOutput { text: answer.text, advice, restarted }
}
