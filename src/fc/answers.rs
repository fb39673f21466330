//! Delivers the answers of a flight controller to the parts of the program that asked.

use std::time::Instant;

use super::identify::Question;
use super::reply::cli_reply;
use super::{Purpose, RemoteLink, RemoteNotice, RemoteState, Subject};
use crate::fc::client::Answer;
use crate::fc::telemetry::code;
use crate::vehicle::{LateAnswer, Vehicle};

/// The poll for the positions of the switches.
const SWITCHES: Subject = Subject::Message(code::RC);

impl RemoteLink {
    /// Takes the answers that have arrived since the last call.
    pub(super) fn take_answers(&mut self, vehicle: &mut Vehicle, now: Instant) {
        while let Some((id, answer)) = self.client.next_answer() {
            let Some(purpose) = self.waiting.remove(&id) else { continue };
            self.answers += u64::from(!matches!(answer, Answer::NotAnswered(_)));
            self.silence.note(&answer);
            if matches!(
                purpose,
                Purpose::Line(..)
                    | Purpose::Refreshed(_)
                    | Purpose::Identity(Question::Settings(_) | Question::Plan)
            ) {
                self.permission.line_answered(&answer);
                self.tell_client();
            }
            if let (Purpose::Line(_, true), Answer::Line { .. })
            | (Purpose::Message(_, true), Answer::Msp(Some(_))) = (purpose, &answer)
            {
                self.refresh.request(now);
            }
            let Some(mailbox) = vehicle.controller_mut().remote_mut() else { return };
            match purpose {
                Purpose::Line(ticket, _) => {
                    mailbox.deliver_answer(ticket, LateAnswer::Cli(cli_reply(answer)));
                }
                Purpose::Plan(ticket) => {
                    // An upload ends with it: the plan has changed.
                    self.observer.learn(Question::Plan, &answer);
                    mailbox.deliver_answer(ticket, LateAnswer::Cli(cli_reply(answer)));
                }
                Purpose::Message(ticket, _) => {
                    let payload = if let Answer::Msp(payload) = answer { payload } else { None };
                    mailbox.deliver_answer(ticket, LateAnswer::Msp(payload));
                }
                Purpose::Identity(question) => self.identify(question, &answer),
                Purpose::Provision => self.take_provision_answer(&answer),
                Purpose::Polled(subject) => self.take_polled(subject, &answer, now),
                Purpose::Refreshed(question) => self.take_refreshed(question, &answer, now),
                Purpose::Nothing => {}
            }
        }
        self.follow_silence();
    }

    fn take_polled(&mut self, subject: Subject, answer: &Answer, now: Instant) {
        self.schedule.answered(subject, answer);
        let was_armed = self.observer.is_armed();
        match (subject, answer) {
            (Subject::Message(code), Answer::Msp(Some(payload))) => self.observer.take_message(code, payload),
            (Subject::Mission, Answer::Line { text, failed: false, .. }) => {
                self.notices.extend(self.observer.take_mission(text).map(RemoteNotice::Lost));
            }
            _ => {}
        }
        if subject == SWITCHES {
            self.observer.asked_for_switches();
        }
        if was_armed && self.observer.armed() == Some(false) {
            if self.observer.awaits_switches() {
                self.schedule.hasten(SWITCHES);
            }
            self.disarmed(now);
        }
    }

    fn identify(&mut self, question: Question, answer: &Answer) {
        // A simulated one that is stopped at a breakpoint is asked again. The time limit for that is checked
        // elsewhere.
        let is_first = matches!(question, Question::ApiVersion | Question::Variant);
        if self.is_fed() && is_first && matches!(answer, Answer::NotAnswered(_)) {
            return;
        }
        match self.identification.take(question, answer, &mut self.observer) {
            Ok(false) => {
                if matches!((&self.state, answer), (RemoteState::Unusable(_), Answer::Msp(Some(_)))) {
                    self.state = RemoteState::Identifying;
                }
            }
            Ok(true) if self.provision.is_some() => self.go_on_with_provision(),
            Ok(true) => self.become_ready(),
            Err(why) => self.give_up(format!("{}: {why}", self.ends.name)),
        }
    }
}
