//! Passes on the late answers of a remote flight controller.

use std::time::Instant;

use super::Session;
use super::console::output;
use crate::fc::UploadView;
use crate::fc::{Upload, UploadProgress, UploadReport, plan_above_home};
use crate::firmware::cli::CliAction;
use crate::plan::FlightPlan;
use crate::session::ReplyTo;
use crate::session::command::CliOutput;
use crate::session::hazards;
use crate::session::late_answers::{NO_ANSWER, no_answer_line};
use crate::vehicle::LateAnswer;

/// A part of the user interface that waits for the answer of a remote flight controller.
#[derive(Debug)]
pub(super) enum WaitingInterface {
    Line {
        /// The line that was run.
        line: String,
        reply: ReplyTo<CliOutput>,
    },
    Download {
        reply: ReplyTo<Result<Box<FlightPlan>, String>>,
    },
    Save {
        /// Receives `Ok` once the configuration is stored.
        reply: ReplyTo<Result<(), String>>,
    },
    /// An upload, which continues with the answer.
    Upload {
        /// The rest of the upload.
        upload: Box<Upload>,
        reply: ReplyTo<Result<UploadReport, String>>,
    },
}

impl Session {
    /// Passes on the new answers, and gives up overdue requests.
    pub(super) fn take_late_answers(&mut self, now: Instant) {
        while let Some((ticket, answer)) = self.vehicle.controller_mut().take_answer() {
            self.changed = true;
            match (self.late_answers.take(ticket), answer) {
                (Some(WaitingInterface::Line { line, reply }), LateAnswer::Cli(said)) => {
                    // It has saved and restarted by itself.
                    let restarted =
                        said.actions.iter().any(|action| matches!(action, CliAction::Restart { .. }));
                    reply.send(output(&line, said, restarted));
                }
                (Some(WaitingInterface::Upload { mut upload, reply }), LateAnswer::Cli(said)) => {
                    let progress = upload.take_answer(&said, self.vehicle.controller_mut());
                    self.report_upload(upload, progress, reply, now);
                }
                (Some(WaitingInterface::Download { reply }), LateAnswer::Cli(said)) => {
                    let reference = self.vehicle.controller().altitude_reference();
                    reply.send(plan_above_home(&said, reference).map(Box::new));
                }
                (Some(WaitingInterface::Save { reply }), LateAnswer::Msp(stored)) => {
                    let refusal = || "Not saved: the flight controller refuses to store now.".to_owned();
                    reply.send(stored.map(drop).ok_or_else(refusal));
                }
                (_, answer) => {
                    if let Some(endpoints) = &mut self.endpoints {
                        endpoints.handler.deliver(ticket, answer);
                    }
                }
            }
        }
        for recipient in self.late_answers.take_overdue(now) {
            match recipient {
                WaitingInterface::Line { reply, .. } => {
                    reply.send(CliOutput { text: no_answer_line(), ..CliOutput::default() });
                }
                WaitingInterface::Download { reply } => reply.send(Err(NO_ANSWER.to_owned())),
                WaitingInterface::Upload { reply, .. } => reply.send(Err(NO_ANSWER.to_owned())),
                WaitingInterface::Save { reply } => reply.send(Err(NO_ANSWER.to_owned())),
            }
        }
        if let Some(endpoints) = &mut self.endpoints {
            endpoints.handler.give_up_overdue(now);
        }
    }

    /// Returns the progress of the current upload.
    pub(super) fn upload_under_way(&self) -> Option<UploadView> {
        self.late_answers.recipients().find_map(|recipient| match recipient {
            WaitingInterface::Upload { upload, .. } => Some(upload.lines_sent()),
            WaitingInterface::Line { .. }
            | WaitingInterface::Download { .. }
            | WaitingInterface::Save { .. } => None,
        })
    }

    /// Reports the result of an upload once it is finished.
    pub(super) fn report_upload(
        &mut self,
        upload: Box<Upload>,
        progress: UploadProgress,
        reply: ReplyTo<Result<UploadReport, String>>,
        now: Instant,
    ) {
        match progress {
            UploadProgress::Done(result) => {
                if result.is_ok() {
                    for hazard in hazards(&self.vehicle, self.takeoff_m, None) {
                        self.notice(hazard);
                    }
                }
                reply.send(result);
            }
            UploadProgress::Waiting(ticket) => {
                self.late_answers.expect(ticket, WaitingInterface::Upload { upload, reply }, now);
            }
        }
    }
}
