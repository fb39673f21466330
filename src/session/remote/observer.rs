//! What a remote flight controller has told of itself, and what follows from it.

mod events;
mod mission;
mod settings;

use super::identify::Question;
use crate::firmware::cli::CliReply;
use crate::geo::LocalFrame;
use crate::link::proto::fc_client::Answer;
use crate::link::proto::fc_client::telemetry::{
    ApiVersion, BoardInfo, BuildInfo, Mission, MissionPhase, Observation, Origin, version,
};
use crate::plan::{AltitudeReference, FlightPlan};
use crate::session::upload::plan_of_list;
use crate::telemetry::Mode;
use crate::vehicle::{RemoteController, RemoteTelemetry};
use events::EventObserver;
use settings::Settings;

/// What is known of a flight controller.
#[derive(Debug, Default)]
pub struct Observer {
    identity: Identity,
    observation: Observation,
    settings: Settings,
    /// As it holds it.
    stored_plan: Option<FlightPlan>,
    mission: Option<Mission>,
    /// Where the craft was first seen, when no world says where it stood.
    first_fix: Option<Origin>,
    events: EventObserver,
    /// Something new is known.
    changed: bool,
}

/// What it is.
#[derive(Debug, Clone, Default)]
struct Identity {
    api: Option<ApiVersion>,
    version: Option<String>,
    board: Option<BoardInfo>,
    build: Option<BuildInfo>,
}

impl Observer {
    /// The connection is gone: what was told is old. What it was set to and where it was seen first may still hold.
    pub(super) fn forget(&mut self) {
        self.observation = Observation::default();
        self.mission = None;
        self.changed = true;
    }

    /// It started anew, so that nothing of before counts.
    pub(super) fn restarted(&mut self) {
        *self = Self { changed: true, ..Self::default() };
    }

    /// Takes in the answer to a question.
    pub(super) fn learn(&mut self, question: Question, answer: &Answer) {
        self.changed = true;
        match (question, answer) {
            (Question::ApiVersion, Answer::Msp(Some(payload))) => {
                self.identity.api = ApiVersion::decode(payload);
            }
            (Question::Version, Answer::Msp(Some(payload))) => self.identity.version = version(payload),
            (Question::Board, Answer::Msp(Some(payload))) => self.identity.board = BoardInfo::decode(payload),
            (Question::Build, Answer::Msp(Some(payload))) => self.identity.build = BuildInfo::decode(payload),
            (Question::Settings(_), Answer::Line { text, failed: false, .. }) => self.settings.read(text),
            (Question::Plan, Answer::Line { text, failed, .. }) => {
                let reply = CliReply { text: text.clone(), failed: *failed, ..CliReply::default() };
                self.stored_plan = plan_of_list(&reply).ok();
            }
            (_, Answer::Msp(Some(payload))) => {
                if let Some(code) = question.code() {
                    self.observation.take(code, payload);
                }
            }
            _ => {}
        }
    }

    /// Takes in the reply to a message that was polled.
    pub(super) fn take_message(&mut self, code: u16, payload: &[u8]) {
        self.changed |= self.observation.take(code, payload);
        if self.first_fix.is_none()
            && let Some(gps) = self.observation.gps().filter(|gps| gps.fix)
        {
            self.first_fix = Some(Origin { position: gps.position, alt_amsl_m: gps.alt_amsl_m });
        }
    }

    /// Takes in the output of `waypoint status`; gives a sentence when the mission was given up since the last.
    pub(super) fn take_mission(&mut self, output: &str) -> Option<String> {
        let mission = Mission::parse(output)?;
        self.changed = true;
        let before = self.mission.replace(mission).and_then(|mission| mission.phase);
        match self.mission.as_ref().and_then(|mission| mission.phase.as_ref()) {
            Some(MissionPhase::Aborted { cause })
                if !matches!(before, Some(MissionPhase::Aborted { .. })) =>
            {
                let cause = if cause.is_empty() { "it does not say why" } else { cause };
                Some(format!("The firmware gave its mission up: {cause}."))
            }
            _ => None,
        }
    }

    /// The frame of the place where the craft was seen first.
    pub(super) fn first_fix(&self) -> Option<LocalFrame> {
        self.first_fix.map(|Origin { position, alt_amsl_m }| {
            LocalFrame::new(position.lat_deg(), position.lon_deg(), alt_amsl_m)
        })
    }

    /// Delivers what is new: telemetry, and the events that it shows. `frame` is that of the boot place, when there is a
    /// world.
    pub(super) fn deliver(&mut self, mailbox: &mut RemoteController, frame: Option<&LocalFrame>) {
        if !std::mem::take(&mut self.changed) {
            return;
        }
        let origin = frame.map(origin_of).or(self.first_fix);
        let altitude_reference = self.altitude_reference(origin);
        let stored_plan =
            self.stored_plan.as_ref().and_then(|plan| altitude_reference.plan_of_craft(plan).ok());
        let craft = self.observation.craft_view();
        let engaged = self.observation.is_active(Mode::Autopilot);
        let told = self.mission.as_ref().map(|told| mission::nav(told, engaged, stored_plan.as_ref()));
        for event in self.events.follow(&craft, told.as_ref(), stored_plan.as_ref()) {
            mailbox.deliver_event(event);
        }
        mailbox.deliver_telemetry(RemoteTelemetry {
            estimate: self.observation.estimate_view(origin),
            craft,
            nav: told.map(|nav| self.events.completed(nav)),
            settings: self.settings.view(),
            stored_plan,
            altitude_reference,
            last_disarm: self.events.last_disarm(),
        });
    }

    /// From where it counts the altitudes of waypoints.
    fn altitude_reference(&self, origin: Option<Origin>) -> AltitudeReference {
        if !self.settings.tell_altitude_reference() {
            AltitudeReference::Untold
        } else if self.counts_from_home() {
            AltitudeReference::Home
        } else {
            AltitudeReference::SeaLevel { home_m: origin.map(|origin| origin.alt_amsl_m) }
        }
    }

    /// Whether its waypoints' altitudes count from home; else from sea level.
    #[must_use]
    pub fn counts_from_home(&self) -> bool {
        self.settings.waypoints_from_home()
    }

    /// Whether its altitude loop has no limit in LAND, as in upstream's master, which counts altitudes from sea level.
    pub(super) fn falls_in_land(&self) -> bool {
        self.settings.tell_altitude_reference() && !self.counts_from_home()
    }

    /// Whether its heading is that of the magnetometer, so that it is known at rest.
    pub(super) fn trusts_mag(&self) -> bool {
        self.settings.trusts_mag()
    }

    /// Whether it holds and flies plans, as far as it has told.
    #[must_use]
    pub fn has_plans(&self) -> bool {
        let built_in = self.identity.build.as_ref().and_then(BuildInfo::has_flight_plan);
        self.stored_plan.is_some() || built_in == Some(true)
    }

    /// Whether it is armed, once it has told.
    pub(super) fn armed(&self) -> Option<bool> {
        self.observation.armed()
    }

    /// Whether it is known to be armed.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.observation.armed() == Some(true)
    }

    /// What it is, as a sentence.
    pub(super) fn introduction(&self, name: &str) -> String {
        let Identity { api, version, board, .. } = &self.identity;
        let version = version.as_deref().unwrap_or("of an unknown version");
        let board = board
            .as_ref()
            .map_or("an unknown board", |board| board.target.as_deref().unwrap_or(&board.identifier));
        let api = api.map_or_else(String::new, |api| format!(", MSP {}.{}", api.major, api.minor));
        let plans = match (self.has_plans(), self.counts_from_home()) {
            (false, _) => "it has no waypoints",
            (true, true) => "its waypoints' altitudes count from home",
            (true, false) => "its waypoints' altitudes count from sea level and are converted",
        };
        format!("{name} answers: Betaflight {version} on {board}{api}; {plans}.")
    }
}

fn origin_of(frame: &LocalFrame) -> Origin {
    let (lat_deg, lon_deg, alt_amsl_m) = frame.to_geodetic(nalgebra::Vector3::zeros());
    Origin { position: crate::geo::LatLon::from_degrees(lat_deg, lon_deg), alt_amsl_m }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mission_that_is_given_up_is_told_once_with_its_cause() {
        let mut observer = Observer::default();
        let status = |state: &str| format!("Waypoint count: 2\r\n\nRuntime status:\r\n  state: {state}\r\n");
        assert_eq!(observer.take_mission(&status("TARGETING")), None);
        let aborted = status("ABORTED") + "  abort reason: MAG FAULT\r\n";
        let told = "The firmware gave its mission up: MAG FAULT.".to_owned();
        assert_eq!(observer.take_mission(&aborted), Some(told));
        assert_eq!(observer.take_mission(&aborted), None);
    }
}
