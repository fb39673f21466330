//! Delivers the answers of a flight controller to the parts of the program that asked.

use std::time::Duration;

use super::{Event, Life, Purpose, Question, Remote, RemoteNotice};
use crate::fc::client::{Answer, Unanswered};
use crate::fc::polling::Poll;
use crate::fc::reply::{cli_reply, typed_reply};
use crate::msp::code;
use crate::vehicle::LateAnswer;

/// The poll for the positions of the switches.
const SWITCHES: Poll = Poll::Message(code::RC);

impl Remote {
    /// Takes the answers that have arrived since the last call.
    pub(super) fn take_answers(&mut self, now: Duration) {
        while let Some((id, answer)) = self.client.next_answer() {
            let Some(purpose) = self.asked.answered(id) else { continue };
            self.first_answer.answers += u64::from(!matches!(answer, Answer::NotAnswered(_)));
            if let Some(connection) = self.life.connection_mut() {
                connection.note(&answer);
            }
            if matches!(
                purpose,
                Purpose::Line(..)
                    | Purpose::Refreshed(_)
                    | Purpose::Identity(Question::Settings(_) | Question::Plan)
            ) {
                self.permission.line_answered(&answer);
                self.report_to_client();
            }
            if let (Purpose::Line(_, true) | Purpose::Typed(_, true), Answer::Line { .. })
            | (Purpose::Message(_, true), Answer::Msp(Some(_))) = (purpose, &answer)
            {
                self.outdate_settings(now);
            }
            match purpose {
                Purpose::Line(ticket, _) => self.answer(ticket, LateAnswer::Cli(cli_reply(answer))),
                Purpose::Typed(ticket, _) => {
                    self.answer(ticket, LateAnswer::Cli(typed_reply(answer, self.client.is_in_cli())));
                }
                Purpose::Plan(ticket) => {
                    // An upload ends with it: the plan has changed.
                    self.observer.learn(Question::Plan, &answer);
                    self.answer(ticket, LateAnswer::Cli(cli_reply(answer)));
                }
                // A child that restarts closes the clients' links, which is their answer.
                Purpose::Message(..)
                    if answer == Answer::NotAnswered(Unanswered::LinkLost) && self.restarts() => {}
                Purpose::Message(ticket, _) => {
                    let payload = if let Answer::Msp(payload) = answer { payload } else { None };
                    self.answer(ticket, LateAnswer::Msp(payload));
                }
                Purpose::Identity(question) => self.identify(question, &answer),
                Purpose::Provision => {
                    self.setup.take(&answer);
                    self.finish_setup();
                }
                Purpose::Polled(subject) => self.take_polled(subject, &answer, now),
                Purpose::Refreshed(question) => self.take_refreshed(question, &answer, now),
                Purpose::Nothing => {}
            }
        }
        self.follow_silence();
    }

    fn answer(&mut self, ticket: crate::vehicle::Ticket, answer: LateAnswer) {
        self.events.push_back(Event::Answered(ticket, answer));
    }

    fn take_polled(&mut self, subject: Poll, answer: &Answer, now: Duration) {
        self.schedule.answered(subject, answer);
        let was_armed = self.observer.is_armed();
        match (subject, answer) {
            (Poll::Message(code), Answer::Msp(Some(payload))) => self.observer.take_message(code, payload),
            (Poll::Mission, Answer::Line { text, failed: false, .. }) => {
                if let Some(aborted) = self.observer.take_mission(text) {
                    self.notice(RemoteNotice::Lost(aborted));
                }
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

    /// Has the settings and the plan read again soon.
    pub(in crate::fc) fn outdate_settings(&mut self, now: Duration) {
        if let Some(connection) = self.life.connection_mut() {
            connection.refresh.request(now);
        }
    }

    /// Retries the questions that were not answered in flight, after the craft has disarmed.
    fn disarmed(&mut self, now: Duration) {
        if !self.observer.knows_settings() || self.permission.opens_cli() {
            self.permission.try_lines_again();
            self.report_to_client();
            self.outdate_settings(now);
        }
    }

    fn take_refreshed(&mut self, question: Question, answer: &Answer, now: Duration) {
        let knew_settings = self.observer.knows_settings();
        match answer {
            Answer::NotAnswered(Unanswered::CliClosed) => {
                if let Some(connection) = self.life.connection_mut() {
                    connection.refresh = super::super::refresh::Refresh::default();
                }
            }
            Answer::NotAnswered(_) => self.outdate_settings(now),
            Answer::Line { .. } | Answer::Msp(_) => self.observer.learn(question, answer),
        }
        if !knew_settings && self.observer.knows_settings() && self.observer.has_plans() {
            let reported = format!("{}: {}.", self.craft.name, self.observer.about_altitudes());
            self.notice(RemoteNotice::Reported(reported));
        }
    }

    fn identify(&mut self, question: Question, answer: &Answer) {
        // A simulated one that is stopped at a breakpoint is asked again. The time limit for that is checked
        // elsewhere.
        let is_first = matches!(question, Question::ApiVersion | Question::Variant);
        if self.craft.is_fed && is_first && matches!(answer, Answer::NotAnswered(_)) {
            return;
        }
        let Some(identification) = self.life.identification_mut() else { return };
        match identification.take(question, answer, &mut self.observer) {
            Ok(false) => {
                if let (Life::Unusable { connection, identification, .. }, Answer::Msp(Some(_))) =
                    (&mut self.life, answer)
                {
                    let (connection, identification) =
                        (connection.take().unwrap_or_default(), *identification);
                    self.life = Life::Identifying { connection, identification };
                }
            }
            Ok(true) if self.setup.is_running() => {
                self.setup.reconnected();
                self.finish_setup();
            }
            Ok(true) => self.become_ready(),
            Err(why) => self.give_up(format!("{}: {why}", self.craft.name)),
        }
    }

    /// Reports the result once the configuration is finished.
    pub(super) fn finish_setup(&mut self) {
        let Some(finished) = self.setup.finish() else { return };
        self.events.extend(finished.notices.into_iter().map(Event::Notice));
        if let Some((file, words)) = finished.note {
            self.events.push_back(Event::Configured(file, words));
        }
        match &mut self.life {
            Life::Identifying { identification, .. } if finished.is_changed_without_restart => {
                *identification = Default::default();
            }
            _ => self.become_ready(),
        }
    }

    /// Marks the identified and configured flight controller as ready. Polling starts.
    fn become_ready(&mut self) {
        let Life::Identifying { connection, .. } = &mut self.life else { return };
        self.life = Life::Ready { connection: std::mem::take(connection) };
        self.schedule.refresh();
        self.events.push_back(Event::BecameReady);
        self.notice(RemoteNotice::Reported(self.observer.introduction(&self.craft.name)));
    }
}
