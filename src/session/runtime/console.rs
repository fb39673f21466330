//! The command line of the user interface.

use tokio::sync::oneshot;

use super::Session;
use crate::firmware::cli::{CliAction, CliReply, Interpreter, advice};
use crate::session::command::CliOutput;
use crate::session::persistence;
use crate::vehicle::{Answer, LateAnswer};

impl Session {
    /// Runs a line; the answer of a remote flight controller comes later.
    pub(super) fn run_cli(&mut self, line: String, reply: oneshot::Sender<CliOutput>) {
        match self.vehicle.controller_mut().run_cli(&mut self.console, &line) {
            Answer::Now(answer) => self.answer_cli(&line, answer, reply),
            Answer::Later(ticket) => {
                self.unanswered.insert(ticket, (line, reply));
            }
        }
    }

    /// Passes on what a remote flight controller has answered since.
    pub(super) fn take_late_answers(&mut self) {
        while let Some((ticket, answer)) = self.vehicle.controller_mut().take_answer() {
            if let (Some((line, reply)), LateAnswer::Cli(answer)) = (self.unanswered.remove(&ticket), answer)
            {
                self.answer_cli(&line, answer, reply);
            }
        }
    }

    fn answer_cli(&mut self, line: &str, answer: CliReply, reply: oneshot::Sender<CliOutput>) {
        let restarted = self.carry_out_actions(&answer);
        let advice = advice(line, &answer);
        drop(reply.send(CliOutput { text: answer.text, advice, restarted }));
    }

    /// Does what a command line asked the owner of the firmware to do; says whether the firmware restarted. A remote
    /// flight controller saves and restarts by itself.
    fn carry_out_actions(&mut self, reply: &CliReply) -> bool {
        let starter_modes =
            self.endpoints.as_ref().is_none_or(|endpoints| endpoints.handler.gives_starter_modes());
        let Some(firmware) = self.vehicle.embedded_mut() else { return false };
        let mut restarted = false;
        let mut notices = Vec::new();
        for action in &reply.actions {
            match action {
                CliAction::Save => notices.extend(persistence::save(firmware, &mut self.store).err()),
                CliAction::Restart { .. } => {
                    notices.extend(persistence::restart(firmware, &mut self.store, starter_modes));
                    self.console = Interpreter::default();
                    restarted = true;
                }
                // The firmware itself has carried these out.
                CliAction::Leave | CliAction::MotorTest { .. } | CliAction::PlanChanged => {}
            }
        }
        if restarted && let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(true, firmware);
        }
        notices.into_iter().for_each(|notice| self.notice(notice));
        restarted
    }
}
