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
use crate::telemetry::snapshot::{CraftView, ModeRange};
use crate::vehicle::{RemoteController, RemoteTelemetry};
use events::EventObserver;
use settings::Settings;

/// How far the altitude of a GPS at rest wanders, m: it is the same place.
const SAME_ALT_M: f64 = 3.0;

/// What is known of a flight controller.
#[derive(Debug, Default)]
pub struct Observer {
    identity: Identity,
    observation: Observation,
    settings: Settings,
    /// As it holds it.
    stored_plan: Option<FlightPlan>,
    mission: Option<Mission>,
    /// Where the craft was first seen: a drawing of it begins there when no world says where it stood.
    first_fix: Option<Origin>,
    /// Where a craft stands that is known to be disarmed, m above mean sea level: arming makes that home's altitude.
    standing_alt_m: Option<f64>,
    /// It disarmed, and where its switches stand was not asked since.
    awaits_switches: bool,
    events: EventObserver,
    /// Something new is known.
    changed: bool,
}

#[derive(Debug, Clone, Default)]
struct Identity {
    api: Option<ApiVersion>,
    version: Option<String>,
    board: Option<BoardInfo>,
    build: Option<BuildInfo>,
}

/// What is known of a craft because it is simulated here.
#[derive(Debug, Clone, Copy)]
pub(super) struct Simulated {
    /// Altitude of its home above mean sea level, m.
    pub(super) home_m: Option<f64>,
    /// The switch that has it fly home is on; `None` without one.
    pub(super) commanded: Option<bool>,
}

impl Observer {
    /// The connection is gone: what was told is old. What it was set to and where it was seen first may still hold.
    pub(super) fn forget(&mut self) {
        self.observation = Observation::default();
        self.mission = None;
        self.standing_alt_m = None;
        self.awaits_switches = false;
        self.changed = true;
    }

    /// It started anew, or another one may be there: nothing of before counts.
    pub(super) fn restarted(&mut self) {
        *self = Self { changed: true, ..Self::default() };
    }

    /// Something that is delivered with the rest is different now.
    pub(super) fn deliver_again(&mut self) {
        self.changed = true;
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
        let was_armed = self.is_armed();
        self.changed |= self.observation.take(code, payload);
        let is_disarmed = self.armed() == Some(false);
        self.awaits_switches |= was_armed && is_disarmed && self.observation.has_channels();
        let Some(gps) = self.observation.gps().filter(|gps| gps.fix) else { return };
        if self.first_fix.is_none() {
            self.first_fix = Some(Origin { position: gps.position, alt_amsl_m: gps.alt_amsl_m });
        }
        let stands_at = |alt_m: f64| (alt_m - gps.alt_amsl_m).abs() <= SAME_ALT_M;
        if is_disarmed && !self.standing_alt_m.is_some_and(stands_at) {
            self.standing_alt_m = Some(gps.alt_amsl_m);
        }
    }

    /// Where its switches stand was asked, whether it answered or not.
    pub(super) fn asked_for_switches(&mut self) {
        self.awaits_switches = false;
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

    /// Delivers what is new: telemetry, and the events that it shows. Positions count from the origin of `frame`. Of a
    /// disarming is told once it is known whether a switch did it.
    pub(super) fn deliver(
        &mut self,
        mailbox: &mut RemoteController,
        frame: Option<&LocalFrame>,
        simulated: Option<Simulated>,
    ) {
        if self.awaits_switches || !std::mem::take(&mut self.changed) {
            return;
        }
        let origin = frame.map(origin_of).or(self.first_fix);
        let altitude_reference =
            self.altitude_reference(simulated.map_or(self.standing_alt_m, |simulated| simulated.home_m));
        let stored_plan =
            self.stored_plan.as_ref().and_then(|plan| altitude_reference.plan_of_craft(plan).ok());
        let commanded = simulated.and_then(|simulated| simulated.commanded);
        let craft = CraftView { commanded, ..self.observation.craft_view() };
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
    fn altitude_reference(&self, home_m: Option<f64>) -> AltitudeReference {
        if !self.settings.tell_altitude_reference() {
            AltitudeReference::Untold
        } else if self.counts_from_home() {
            AltitudeReference::Home
        } else {
            AltitudeReference::SeaLevel { home_m }
        }
    }

    /// Whether its settings are known, as far as they say from where it counts the altitudes of waypoints.
    pub(super) fn knows_settings(&self) -> bool {
        self.settings.tell_altitude_reference()
    }

    /// Whether it has just disarmed, and where its switches stand is to be asked.
    pub(super) fn awaits_switches(&self) -> bool {
        self.awaits_switches
    }

    /// The conditions of its modes, as far as they were told.
    pub(super) fn mode_ranges(&self) -> Vec<ModeRange> {
        self.observation.mode_ranges().unwrap_or_default()
    }

    /// Whether its waypoints' altitudes count from home; else from sea level.
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
    pub fn has_plans(&self) -> bool {
        let built_in = self.identity.build.as_ref().and_then(BuildInfo::has_flight_plan);
        self.stored_plan.is_some() || built_in == Some(true)
    }

    /// Whether it is armed, once it has told.
    pub(super) fn armed(&self) -> Option<bool> {
        self.observation.armed()
    }

    /// Whether it is known to be armed.
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
        let plans = if self.has_plans() { self.about_altitudes() } else { "it has no waypoints" };
        format!("{name} answers: Betaflight {version} on {board}{api}; {plans}.")
    }

    /// From where the altitudes of its waypoints count, as a part of a sentence.
    pub(super) fn about_altitudes(&self) -> &'static str {
        match (self.knows_settings(), self.counts_from_home()) {
            (false, _) => "from where its waypoints' altitudes count is not known yet",
            (true, true) => "its waypoints' altitudes count from home",
            (true, false) => "its waypoints' altitudes count from sea level and are converted",
        }
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
