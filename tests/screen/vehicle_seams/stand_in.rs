//! A stand-in for a remote flight controller, which answers after a delay.

use std::collections::VecDeque;

use betadeck::firmware::cli::Interpreter;
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::plan::AltitudeReference;
use betadeck::signals::MotorCommand;
use betadeck::telemetry::snapshot::EstimateView;
use betadeck::vehicle::{FrameOut, LateAnswer, RemoteController, RemoteRequest, RemoteTelemetry, Ticket};

/// Ticks until a motor command or an answer of the stand-in arrives.
pub(super) const DELAY: usize = 4;

/// A flight controller at the far end of a slow link, which reports only its attitude.
#[derive(Debug, Clone)]
pub(super) struct StandIn {
    pub(super) firmware: Firmware,
    /// The number of requests to restart.
    pub(super) restarts: usize,
    /// The lines at its prompt, and an empty one when the prompt is left.
    pub(super) typed: Vec<String>,
    console: Interpreter,
    motors: VecDeque<MotorCommand>,
    answers: VecDeque<(usize, Ticket, LateAnswer)>,
    ticks: usize,
}

impl StandIn {
    pub(super) fn new() -> Self {
        let mut configuration = Configuration::default();
        configuration.starter_modes();
        Self {
            firmware: Firmware::new(configuration, FirmwareOptions::default()),
            restarts: 0,
            typed: Vec::new(),
            console: Interpreter::default(),
            motors: VecDeque::new(),
            answers: VecDeque::new(),
            ticks: 0,
        }
    }

    /// Handles the frames and requests in the mailbox, and delivers the motors and answers that are due.
    pub(super) fn exchange(&mut self, mailbox: &mut RemoteController) {
        self.ticks += 1;
        while let Some(frame) = mailbox.take_frame() {
            match frame {
                FrameOut::Rc(frame, source) => self.firmware.receive_rc(&frame, source),
                FrameOut::Sensors(frame) => self.motors.push_back(self.firmware.step(&frame)),
            }
        }
        while self.motors.len() > DELAY {
            mailbox.deliver_motors(self.motors.pop_front().unwrap());
        }
        while let Some((ticket, request)) = mailbox.take_request() {
            let answer = match request {
                RemoteRequest::Typed(line) => {
                    self.typed.push(line.clone());
                    LateAnswer::Cli(self.firmware.run_cli(&mut self.console, &line))
                }
                RemoteRequest::LeavePrompt => {
                    self.typed.push(String::new());
                    continue;
                }
                RemoteRequest::Cli(line) => LateAnswer::Cli(self.firmware.run_cli(&mut self.console, &line)),
                RemoteRequest::Msp { code, payload } => {
                    LateAnswer::Msp(self.firmware.run_msp(code, &payload, None).reply)
                }
                RemoteRequest::Restart => {
                    self.restarts += 1;
                    continue;
                }
                RemoteRequest::ReturnHome | RemoteRequest::CancelReturn => continue,
            };
            self.answers.push_back((self.ticks + DELAY, ticket, answer));
        }
        while let Some((_, ticket, answer)) = self.answers.pop_front_if(|(due, ..)| *due <= self.ticks) {
            mailbox.deliver_answer(ticket, answer);
        }
        let EstimateView { roll_deg, pitch_deg, heading_deg, .. } = self.firmware.estimate_view();
        let estimate = EstimateView { roll_deg, pitch_deg, heading_deg, ..EstimateView::default() };
        let altitude_reference = AltitudeReference::Home;
        let reported = RemoteTelemetry { estimate, altitude_reference, ..RemoteTelemetry::default() };
        mailbox.deliver_telemetry(reported);
    }
}
