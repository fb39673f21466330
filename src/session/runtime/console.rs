//! The command line of the user interface.

use super::Session;
use crate::firmware::cli::{CliAction, CliReply, Interpreter, advice};
use crate::session::command::CliOutput;
use crate::session::persistence;

impl Session {
    pub(super) fn run_cli(&mut self, line: &str) -> CliOutput {
        let reply = self.vehicle.firmware_mut().run_cli(&mut self.console, line);
        let restarted = self.carry_out_actions(&reply);
        let advice = advice(line, &reply);
        CliOutput { text: reply.text, advice, restarted }
    }

    /// Does what a command line asked the owner of the firmware to do; says whether the firmware restarted.
    fn carry_out_actions(&mut self, reply: &CliReply) -> bool {
        let mut restarted = false;
        let mut notices = Vec::new();
        for action in &reply.actions {
            match action {
                CliAction::Save => {
                    notices.extend(persistence::save(self.vehicle.firmware_mut(), &mut self.store).err());
                }
                CliAction::Restart { .. } => {
                    let firmware = self.vehicle.firmware_mut();
                    notices.extend(persistence::restart(firmware, &mut self.store, true));
                    self.console = Interpreter::default();
                    restarted = true;
                }
                // The firmware itself has carried these out.
                CliAction::Leave | CliAction::MotorTest { .. } | CliAction::PlanChanged => {}
            }
        }
        if restarted && let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.after_restart(true, self.vehicle.firmware_mut());
        }
        notices.into_iter().for_each(|notice| self.notice(notice));
        restarted
    }
}
