//! Plans as missions: the lines of an upload become a mission, the mission of the craft becomes lines.

use std::collections::VecDeque;

use super::lines::{self, not_begun};
use super::telemetry::home;
use super::{Event, RemoteNotice, done, refusal};
use crate::fc::missions::{self, Mission};
use crate::firmware::cli::CliReply;
use crate::mavlink::MissionItem;
use crate::mavlink::state::GeoPosition;
use crate::mavlink::station::{StationProtocol, TransferEnd};
use crate::mavlink::value::MissionKind;
use crate::plan::format::{self, Format, PlanError};
use crate::plan::{FlightPlan, plan_lines};
use crate::vehicle::{LateAnswer, Ticket};

/// The greatest difference of an altitude of a stored item, m. Some craft store whole centimetres.
const SAME_ALT_M: f32 = 0.011;

/// The exchange of plans with the craft.
#[derive(Debug, Default)]
pub(super) struct Exchange {
    /// The lines of a plan that was not sent yet.
    lines: Vec<String>,
    /// The number of settings of that plan, which are not sent.
    settings: usize,
    /// The requests for the plan of the craft.
    waiting: Vec<Ticket>,
    step: Step,
    /// `true` if the mission must be read.
    is_outdated: bool,
    /// The plan of the craft, or the reasons why its mission is no plan; `None` before it was read.
    stored: Option<Result<FlightPlan, String>>,
    mission: Mission,
}

/// A transfer.
#[derive(Debug, Default)]
enum Step {
    #[default]
    None,
    /// A plan is sent as a mission.
    Sending(FlightPlan, Mission),
    /// A plan was sent, and is to be read back.
    Sent(FlightPlan, Mission),
    /// The mission is read, perhaps the one that was just sent.
    Reading(Option<(FlightPlan, Mission)>),
}

impl Exchange {
    /// Has the mission of the craft read.
    pub(super) fn read(&mut self) {
        self.is_outdated = true;
    }

    /// Adds a line of a plan. The plan is sent once the craft is asked for its plan.
    pub(super) fn add_line(&mut self, line: String) {
        if line == "waypoint clear" {
            self.lines.clear();
        }
        self.lines.push(line);
    }

    /// Forgets the plan that was not sent yet: its permission has ended.
    pub(super) fn forget_lines(&mut self) {
        self.lines.clear();
        self.settings = 0;
    }

    /// Counts a setting of a plan that is not sent.
    pub(super) fn leave_setting_out(&mut self) {
        self.settings += 1;
    }

    /// Answers with the plan of the craft, after the plan that was typed is sent.
    pub(super) fn list(&mut self, ticket: Ticket) {
        self.waiting.push(ticket);
        self.is_outdated = true;
    }

    /// Returns the plan of the craft, if its mission is one.
    pub(super) fn plan(&self) -> Option<&FlightPlan> {
        self.stored.as_ref()?.as_ref().ok()
    }

    /// Returns the mission of the plan.
    pub(super) fn mission(&self) -> &Mission {
        &self.mission
    }

    /// Begins the next transfer.
    pub(super) fn advance(&mut self, station: &mut StationProtocol, events: &mut VecDeque<Event>) {
        if !station.is_connected() {
            self.step = Step::None;
            self.answer(&refusal("no craft is connected"), events);
            return;
        }
        let refused = match std::mem::take(&mut self.step) {
            Step::None if !self.is_outdated => return,
            Step::None if self.waiting.is_empty() || self.lines.is_empty() => {
                self.begin_reading(station, None)
            }
            Step::None => self.begin_sending(station, events),
            Step::Sent(plan, mission) => self.begin_reading(station, Some((plan, mission))),
            under_way => {
                self.step = under_way;
                return;
            }
        };
        if let Err(why) = refused {
            self.is_outdated = false;
            self.answer(&refusal(&why), events);
        }
    }

    fn begin_sending(
        &mut self,
        station: &mut StationProtocol,
        events: &mut VecDeque<Event>,
    ) -> Result<(), String> {
        let text = std::mem::take(&mut self.lines).join("\n");
        let home = home(station).ok_or("the craft has not reported its home yet: wait for its fix")?;
        let plan = format::parse("the lines", &text, Format::CliText)
            .map_err(|errors| errors.first().map(PlanError::headline).unwrap_or_default())?
            .plan;
        let mission = Mission::of_plan(&plan, &home);
        let begun = station.upload(MissionKind::Mission, mission.items.clone());
        begun.map_err(|why| not_begun(why).to_owned())?;
        notices(&mission.losses, events);
        let settings = std::mem::take(&mut self.settings);
        if settings > 0 {
            let sentence = format!("{settings} settings of the plan are not sent: this craft has others.");
            notices(&[sentence], events);
        }
        self.step = Step::Sending(plan, mission);
        Ok(())
    }

    fn begin_reading(
        &mut self,
        station: &mut StationProtocol,
        sent: Option<(FlightPlan, Mission)>,
    ) -> Result<(), String> {
        station.download(MissionKind::Mission).map_err(|why| not_begun(why).to_owned())?;
        self.is_outdated = false;
        self.step = Step::Reading(sent);
        Ok(())
    }

    /// Takes the end of a transfer. `home` is the home of the craft.
    pub(super) fn take(&mut self, end: TransferEnd, home: Option<GeoPosition>, events: &mut VecDeque<Event>) {
        let (step, end) = (std::mem::take(&mut self.step), end);
        let refused = match (step, end) {
            (Step::Sending(plan, mission), TransferEnd::Sent(_)) => {
                self.step = Step::Sent(plan, mission);
                return;
            }
            (Step::Reading(sent), TransferEnd::Received { items, .. }) => {
                self.store(sent, &items, home, events);
                let reply = match self.stored.as_ref() {
                    Some(Ok(plan)) => done(plan_lines(plan).collect::<Vec<_>>().join("\n")),
                    Some(Err(why)) => refusal(why),
                    None => return,
                };
                return self.answer(&reply, events);
            }
            (_, TransferEnd::Refused(_, result)) => {
                format!("the craft refused the mission: {}", lines::transfer_result(result))
            }
            (_, TransferEnd::TooLong(_, count)) => {
                format!("the mission of the craft has {count} items, more than can be read")
            }
            _ => "the craft did not answer".to_owned(),
        };
        self.answer(&refusal(&refused), events);
    }

    /// Keeps the mission that was read.
    fn store(
        &mut self,
        sent: Option<(FlightPlan, Mission)>,
        items: &[MissionItem],
        home: Option<GeoPosition>,
        events: &mut VecDeque<Event>,
    ) {
        // A mission keeps less than a plan, so the plan of the same mission is kept.
        let known = sent.or_else(|| Some((self.plan()?.clone(), self.mission.clone())));
        if let Some((plan, mission)) = known
            && has_same_places(&mission.items, items)
        {
            let changed = std::iter::zip(0.., std::iter::zip(&mission.items, items));
            let changed = changed.filter(|(_, (sent, kept))| sent.params != kept.params);
            let changed: Vec<String> = changed.map(|(number, _): (u16, _)| number.to_string()).collect();
            if !changed.is_empty() {
                let sentence = format!(
                    "The craft keeps other parameters of these items of the mission: {}.",
                    changed.join(", ")
                );
                notices(&[sentence], events);
            }
            (self.stored, self.mission) = (Some(Ok(plan)), mission);
            return;
        }
        match missions::plan(items, home.as_ref()) {
            Ok((plan, losses)) => {
                notices(&losses, events);
                self.mission = home.map(|home| Mission::of_plan(&plan, &home)).unwrap_or_default();
                self.stored = Some(Ok(plan));
            }
            Err((_, reasons)) => {
                let why = format!("the mission of the craft is not a plan: {}", reasons.join(" "));
                notices(&[format!("The plan of the craft is not shown: {why}")], events);
                (self.stored, self.mission) = (Some(Err(why)), Mission::default());
            }
        }
    }

    /// Answers all requests for the plan.
    fn answer(&mut self, reply: &CliReply, events: &mut VecDeque<Event>) {
        let answers = self.waiting.drain(..);
        events.extend(answers.map(|ticket| Event::Answered(ticket, LateAnswer::Cli(reply.clone()))));
    }
}

fn notices(sentences: &[String], events: &mut VecDeque<Event>) {
    let notice = |sentence: &String| Event::Notice(RemoteNotice::Reported(sentence.clone()));
    events.extend(sentences.iter().map(notice));
}

/// Returns `true` if the craft has stored the commands, positions and altitudes that were sent.
fn has_same_places(sent: &[MissionItem], kept: &[MissionItem]) -> bool {
    sent.len() == kept.len()
        && std::iter::zip(sent, kept).all(|(sent, kept)| {
            (sent.command, sent.x, sent.y) == (kept.command, kept.x, kept.y)
                && (sent.z - kept.z).abs() <= SAME_ALT_M
        })
}
