//! The data that a remote flight controller has reported, and the conclusions from it.

mod events;
mod leg;
mod mission;
mod settings;

use super::identify::Question;
use crate::fc::client::Answer;
use crate::fc::plan_of_list;
use crate::fc::telemetry::{Mission, MissionPhase, Observation, Origin};
use crate::firmware::cli::CliReply;
use crate::geo::LocalFrame;
use crate::msp::{ApiVersion, BoardInfo, BuildInfo, FcVersion};
use crate::plan::{AltitudeReference, CraftPlan};
use crate::telemetry::Mode;
use crate::telemetry::snapshot::{CraftView, ModeRange};
use crate::vehicle::{RemoteController, RemoteTelemetry};
pub(super) use events::EventObserver;
use leg::LegObserver;
use settings::Settings;

/// The variation of the GPS altitude at rest that still counts as the same place, m.
const SAME_ALT_M: f64 = 3.0;

/// The known state of a flight controller.
#[derive(Debug, Clone, Default)]
pub struct Observer {
    identity: Identity,
    observation: Observation,
    settings: Settings,
    /// The plan as the flight controller stores it.
    stored_plan: Option<CraftPlan>,
    mission: Option<Mission>,
    leg: LegObserver,
    /// The first position of the craft. It is the origin of drawings when no world gives a starting place.
    first_fix: Option<Origin>,
    /// The altitude above mean sea level of a craft that is known to be disarmed, m. Arming makes it the
    /// altitude of home.
    standing_alt_m: Option<f64>,
    /// `true` if it has disarmed and the positions of its switches were not requested since.
    awaits_switches: bool,
    events: EventObserver,
    /// `true` if there is new data to deliver.
    changed: bool,
}

#[derive(Debug, Clone, Default)]
struct Identity {
    api: Option<ApiVersion>,
    version: Option<FcVersion>,
    board: Option<BoardInfo>,
    build: Option<BuildInfo>,
}

/// Facts about a craft that are known because it is simulated here.
#[derive(Debug, Clone, Copy)]
pub struct Simulated {
    /// The altitude of its home above mean sea level, m.
    pub home_m: Option<f64>,
    /// `true` while the switch that makes it fly home is on; `None` without such a switch.
    pub commanded: Option<bool>,
}

impl Observer {
    /// Forgets the reported data after the connection was lost. Its settings and its first position may still
    /// be valid.
    pub(super) fn forget(&mut self) {
        self.observation = Observation::default();
        self.mission = None;
        self.leg = LegObserver::default();
        self.standing_alt_m = None;
        self.awaits_switches = false;
        self.changed = true;
    }

    /// Forgets everything, because it has restarted or another one may have taken its place.
    pub(super) fn restarted(&mut self) {
        *self = Self { changed: true, ..Self::default() };
    }

    /// Marks that other data of the delivery has changed.
    pub(super) fn deliver_again(&mut self) {
        self.changed = true;
    }

    /// Takes the answer to a question.
    pub(super) fn learn(&mut self, question: Question, answer: &Answer) {
        self.changed = true;
        match (question, answer) {
            (Question::ApiVersion, Answer::Msp(Some(payload))) => {
                self.identity.api = ApiVersion::decode(payload);
            }
            (Question::Version, Answer::Msp(Some(payload))) => {
                self.identity.version = FcVersion::decode(payload);
            }
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

    /// Takes the reply to a polled message.
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

    /// Records that the positions of its switches were requested, with or without an answer.
    pub(super) fn asked_for_switches(&mut self) {
        self.awaits_switches = false;
    }

    /// Takes the output of `waypoint status`. Returns a sentence if the mission was aborted since the last
    /// one.
    pub(super) fn take_mission(&mut self, output: &str) -> Option<String> {
        let mission = Mission::parse(output)?;
        self.changed = true;
        let before = self.mission.replace(mission).and_then(|mission| mission.phase);
        match self.mission.as_ref().and_then(|mission| mission.phase.as_ref()) {
            Some(MissionPhase::Aborted { cause })
                if !matches!(before, Some(MissionPhase::Aborted { .. })) =>
            {
                let cause = if cause.is_empty() { "it gives no reason" } else { cause };
                Some(format!("The firmware aborted its mission: {cause}."))
            }
            _ => None,
        }
    }

    /// Returns the frame at the first position of the craft.
    pub(super) fn first_fix(&self) -> Option<LocalFrame> {
        self.first_fix.map(|Origin { position, alt_amsl_m }| {
            LocalFrame::new(position.lat_deg(), position.lon_deg(), alt_amsl_m)
        })
    }

    /// Delivers new telemetry and the events that it shows. Positions are relative to the origin of `frame`.
    /// A disarming is reported only once it is known if a switch caused it.
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
        // A return home may be a mission of its own, to which the stored plan does not belong.
        let flown_plan = stored_plan.as_ref().filter(|_| commanded != Some(true));
        let craft = CraftView { commanded, ..self.observation.craft_view() };
        let engaged = self.observation.is_active(Mode::Autopilot);
        let mut reported = self.mission.as_ref().map(|reported| mission::nav(reported, engaged, flown_plan));
        if let Some(nav) = &mut reported {
            nav.home_distance_m = self.observation.home_distance_m();
            self.leg.follow(nav, flown_plan, self.observation.position());
        }
        for event in self.events.follow(&craft, reported.as_ref(), flown_plan) {
            mailbox.deliver_event(event);
        }
        let mut estimate = self.observation.estimate_view(origin);
        if simulated.is_some() && !self.observation.altitude_has_settled() {
            (estimate.alt, estimate.climb_mps) = (None, None);
        }
        if simulated.is_some() && !self.observation.altitude_agrees_with_gps(origin) {
            estimate.alt = None;
        }
        let armed = craft.armed;
        mailbox.deliver_telemetry(RemoteTelemetry {
            estimate,
            craft,
            nav: reported.map(|nav| self.events.completed(nav, armed)),
            settings: self.settings.view(),
            configuration: self.settings.configuration(),
            stored_plan,
            altitude_reference,
            last_disarm: self.events.last_disarm(),
            takes_rc: simulated.is_some(),
        });
    }

    /// Returns the reference of the altitudes of waypoints.
    fn altitude_reference(&self, home_m: Option<f64>) -> AltitudeReference {
        if !self.settings.report_altitude_reference() {
            AltitudeReference::Unreported
        } else if self.counts_from_home() {
            AltitudeReference::Home
        } else {
            AltitudeReference::SeaLevel { home_m }
        }
    }

    /// Returns `true` if its settings are known, at least those that show the reference of waypoint
    /// altitudes.
    pub(super) fn knows_settings(&self) -> bool {
        self.settings.report_altitude_reference()
    }

    /// Returns `true` if it has just disarmed and the positions of its switches must be requested.
    pub(super) fn awaits_switches(&self) -> bool {
        self.awaits_switches
    }

    /// Returns the conditions of its modes, as far as they were reported.
    pub(super) fn mode_ranges(&self) -> Vec<ModeRange> {
        self.observation.mode_ranges().unwrap_or_default()
    }

    /// Returns `true` if its waypoint altitudes are above home, `false` if they are above sea level.
    pub fn counts_from_home(&self) -> bool {
        self.settings.waypoints_from_home()
    }

    /// Returns `true` if it is a build of upstream's master, whose altitudes are above sea level.
    pub(super) fn is_master(&self) -> bool {
        self.settings.report_altitude_reference() && !self.counts_from_home()
    }

    /// Returns `true` if it uses the magnetometer for its heading, so that the heading is known at rest.
    pub(super) fn trusts_mag(&self) -> bool {
        self.settings.trusts_mag()
    }

    /// Returns `true` if it is known to store and fly plans.
    pub fn has_plans(&self) -> bool {
        let built_in = self.identity.build.as_ref().and_then(BuildInfo::has_flight_plan);
        self.stored_plan.is_some() || built_in == Some(true)
    }

    /// Returns `true` if it is armed; `None` until it has reported that.
    pub(super) fn armed(&self) -> Option<bool> {
        self.observation.armed()
    }

    /// Returns `true` if it is known to be armed.
    pub fn is_armed(&self) -> bool {
        self.observation.armed() == Some(true)
    }

    /// Returns its identity as a sentence.
    pub(super) fn introduction(&self, name: &str) -> String {
        let Identity { api, version, board, .. } = &self.identity;
        let version =
            version.as_ref().map_or_else(|| "of an unknown version".to_owned(), FcVersion::to_string);
        let board = board
            .as_ref()
            .map_or("an unknown board", |board| board.target.as_deref().unwrap_or(&board.identifier));
        let api = api.map_or_else(String::new, |api| format!(", MSP {}.{}", api.major, api.minor));
        let plans = if self.has_plans() { self.about_altitudes() } else { "it has no waypoints" };
        format!("{name} answers: Betaflight {version} on {board}{api}; {plans}.")
    }

    /// Returns the reference of its waypoint altitudes as part of a sentence.
    pub(super) fn about_altitudes(&self) -> &'static str {
        match (self.knows_settings(), self.counts_from_home()) {
            (false, _) => "the reference of its waypoints' altitudes is not known yet",
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
    use crate::msp::code;
    use crate::vehicle::Vehicle;

    #[test]
    fn a_mission_that_is_given_up_is_reported_once_with_its_cause() {
        let mut observer = Observer::default();
        let status = |state: &str| format!("Waypoint count: 2\r\n\nRuntime status:\r\n  state: {state}\r\n");
        assert_eq!(observer.take_mission(&status("TARGETING")), None);
        let aborted = status("ABORTED") + "  abort reason: MAG FAULT\r\n";
        let reported = "The firmware aborted its mission: MAG FAULT.".to_owned();
        assert_eq!(observer.take_mission(&aborted), Some(reported));
        assert_eq!(observer.take_mission(&aborted), None);
    }

    /// The number of reports after which a steady altitude is believed.
    const STEADY: usize = 10;

    #[test]
    fn the_altitude_of_a_simulated_craft_is_unknown_until_its_estimate_has_settled() {
        let mut vehicle = Vehicle::elsewhere().unwrap();
        let mut observer = Observer::default();
        let mut report = |observer: &mut Observer, alt_m: f64, climb_mps: f64, simulated| {
            let mut payload = ((alt_m * 100.0) as i32).to_le_bytes().to_vec();
            payload.extend(((climb_mps * 100.0) as i16).to_le_bytes());
            observer.take_message(code::ALTITUDE, &payload);
            observer.deliver(vehicle.remote_mut().unwrap(), None, simulated);
            let estimate = vehicle.snapshot().estimate;
            (estimate.alt, estimate.climb_mps)
        };
        let simulated = Some(Simulated { home_m: None, commanded: None });
        for (alt_m, climb_mps) in [(47.0, 77.0), (308.0, 259.0), (313.0, 0.0), (309.0, -4.0)] {
            assert_eq!(report(&mut observer, alt_m, climb_mps, simulated), (None, None));
        }
        for _ in 0..9 {
            assert_eq!(report(&mut observer, 300.0, 0.5, simulated), (None, None));
        }
        assert_eq!(report(&mut observer, 300.0, 0.0, simulated), (Some(300.0), Some(0.0)));
        assert_eq!(report(&mut observer, 310.0, 20.0, simulated), (Some(310.0), Some(20.0)), "it flies");
        observer.restarted();
        assert_eq!(report(&mut observer, 47.0, 77.0, simulated), (None, None));
        assert_eq!(report(&mut observer, 47.0, 77.0, None), (Some(47.0), Some(77.0)), "a real craft");
    }

    #[test]
    fn the_altitude_of_a_disarmed_craft_is_unknown_if_it_contradicts_the_gps() {
        let mut vehicle = Vehicle::elsewhere().unwrap();
        let mut observer = Observer::default();
        let home = LocalFrame::new(47.0, 8.0, 300.0);
        observer.take_message(code::BOXIDS, &[0]);
        let mut reported = |armed: bool, alt_m: i32, gps_m: u16| {
            let status = [&[0; 6][..], &u32::from(armed).to_le_bytes(), &[0; 17]].concat();
            observer.take_message(code::STATUS_EX, &status);
            let gps = [&[2, 12][..], &[0; 8], &gps_m.to_le_bytes(), &[0; 6]].concat();
            observer.take_message(code::RAW_GPS, &gps);
            for _ in 0..STEADY {
                observer.take_message(code::ALTITUDE, &[&(alt_m * 100).to_le_bytes()[..], &[0; 2]].concat());
            }
            let simulated = Some(Simulated { home_m: Some(300.0), commanded: None });
            observer.deliver(vehicle.remote_mut().unwrap(), Some(&home), simulated);
            vehicle.snapshot().estimate.alt
        };
        assert_eq!(reported(false, 300, 300), Some(0.0), "above sea level, before the first arming");
        assert_eq!(reported(true, 53, 340), Some(53.0), "in flight it is what the firmware flies by");
        assert_eq!(reported(false, -6, 347), None, "it was disarmed in the air, and counts from there");
        assert_eq!(reported(false, 2, 301), Some(2.0), "landed");
    }
}
