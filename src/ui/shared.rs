//! The state that every panel may read.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use crate::fc::{RemoteView, UploadView};
use crate::plan::FlightPlan;
use crate::replay::{Overview, Series};
use crate::session::{Command, SessionView};
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::PlanSource;

use super::formatting::within;
use super::theme::Theme;
use super::units::Units;
use crate::ui::model::action::Action;
use crate::ui::model::config::UiConfig;
use crate::ui::model::console::CliHelp;
use crate::ui::model::editor::Editor;
use crate::ui::model::effect::{Effect, FlightForm};
use crate::ui::model::event_log::{LogState, Severity};
use crate::ui::model::flights::FlightsState;
use crate::ui::model::forecast::ForecastState;
use crate::ui::model::graphs::GraphsState;
use crate::ui::model::ground::GroundState;
use crate::ui::model::history::UsedNames;
use crate::ui::model::keymap::Keymap;
use crate::ui::model::layout::{Arrangement, SavedLayouts, Slots};
use crate::ui::model::map_state::MapState;
use crate::ui::model::other_flight::{Alignment, OtherFlight};
use crate::ui::model::panel_table::Panel;
use crate::ui::model::plan_id::PlanId;
use crate::ui::model::settings::SettingsState;
use crate::ui::model::stick_recording::StickRecording;
use crate::ui::model::survey::SurveyState;
use crate::ui::model::track::{KeptTracks, Track};
use crate::ui::model::world_history::WorldHistory;

/// The altitude from which a craft that touches nothing counts as in the air, m. A bounce stays below it.
const IN_THE_AIR_M: f64 = 1.0;
/// The time within which the session confirms a speed.
const SPEED_CONFIRMED_WITHIN: Duration = Duration::from_secs(1);

/// The time by which a view may be older than the newest event, s.
const VIEW_LAG_S: f64 = 1.0;

/// The time for which the map shows another revision of the plan while the craft flies.
const REVISION_SHOWN: Duration = Duration::from_secs(8);

/// The time for which the answer to a key stays before an event takes its place.
const ANSWER_FOR: Duration = Duration::from_secs(2);
/// The time after a key in which a notice is its answer.
const ANSWERED_IN: Duration = Duration::from_millis(500);

/// A sentence that is shown for a moment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    pub text: String,
    pub severity: Severity,
    /// The time at which it appeared, wall clock.
    pub at: Duration,
    /// `true` for the answer to a key.
    pub(super) is_answer: bool,
}

/// The state that every panel may read.
#[derive(Debug)]
pub struct Shared {
    pub view: SessionView,
    pub theme: Theme,
    /// Units of the shown values.
    pub units: Units,
    /// Altitude above home above which a waypoint gets a warning, m.
    pub max_altitude_m: f64,
    /// The ground.
    pub ground: GroundState,
    /// Completion and help of the CLI panel.
    pub cli_help: CliHelp,
    pub keymap: Keymap,
    /// The open plans and the state of editing.
    pub editor: Editor,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// The panel that gets the keys.
    pub focus: Panel,
    /// `true` if the focused panel fills the screen.
    pub zoomed: bool,
    /// The panels in the shared places.
    pub slots: Slots,
    /// The sizes of the panels and their places, as the user changed them.
    pub arrangement: Arrangement,
    /// The layouts that the user saved.
    pub layouts: SavedLayouts,
    /// Wall-clock time since start.
    pub now: Duration,
    pub map: MapState,
    pub graphs: GraphsState,
    /// The path that the craft has flown.
    pub track: Track,
    /// The recorded flight whose track and graphs are shown.
    pub past: Option<Arc<Overview>>,
    /// A second flight, beside the one that is shown.
    pub other: Option<OtherFlight>,
    /// The library of recorded flights.
    pub flights: FlightsState,
    /// The tracks of abandoned branches of the flight.
    pub abandoned: KeptTracks,
    /// The tracks of the flights before this one.
    pub past_flights: KeptTracks,
    /// Flights flown ahead of time.
    pub forecast: ForecastState,
    /// All settings of the craft.
    pub settings: SettingsState,
    /// Many flights of the open plan.
    pub survey: SurveyState,
    pub log: LogState,
    /// The changes of the air and the faults.
    pub world_history: WorldHistory,
    /// The names chosen in the palette.
    pub used: UsedNames,
    pub notice: Option<Notice>,
    /// The warning or fault that a lighter notice would have covered; it is shown above it.
    pub(super) alarm: Option<Notice>,
    /// The event that is shown after the answer to a key.
    pub(super) next_notice: Option<Notice>,
    /// The time of the last key, wall clock.
    pub(super) pressed_at: Option<Duration>,
    /// Notices that stay until Esc clears them, the oldest first.
    pub pinned: Vec<String>,
    pub stick_recording: StickRecording,
    /// The sticks sent but not yet confirmed by the session, and the time of sending.
    pub sticks_sent: Option<(RcFrame, Duration)>,
    /// The speed that was requested but not yet confirmed by the session, and the time of the request.
    pub(super) speed_sent: Option<(f64, Duration)>,
    /// The key that ends the flight and was pressed once in the air, and the time of that, wall clock.
    pub asked_in_flight: Option<(Action, Duration)>,
}

#[cfg(test)]
impl Shared {
    /// Returns a state that only has a picture.
    pub(super) fn bare(size: (u16, u16), view: SessionView) -> Self {
        Self::new(UiConfig::bare(), size, view)
    }
}

impl Shared {
    /// Returns the state at start.
    pub(super) fn new(config: UiConfig, size: (u16, u16), view: SessionView) -> Self {
        Self {
            view,
            theme: config.theme,
            units: config.units,
            max_altitude_m: config.max_altitude_m,
            ground: GroundState::new(config.ground),
            cli_help: config.cli,
            keymap: config.keymap,
            editor: Editor::new(config.plan),
            size,
            focus: Panel::Map,
            zoomed: false,
            slots: Slots::default(),
            arrangement: Arrangement::default(),
            layouts: config.layouts,
            now: Duration::ZERO,
            map: MapState::default(),
            graphs: GraphsState::default(),
            track: Track::default(),
            past: None,
            other: None,
            flights: FlightsState::default(),
            abandoned: KeptTracks::default(),
            past_flights: KeptTracks::default(),
            forecast: ForecastState::default(),
            settings: SettingsState::new(config.given_settings),
            survey: SurveyState::default(),
            log: LogState::default(),
            world_history: WorldHistory::default(),
            used: UsedNames::of(&config.entered.palette),
            notice: None,
            next_notice: None,
            pressed_at: None,
            pinned: Vec::new(),
            stick_recording: StickRecording::default(),
            sticks_sent: None,
            speed_sent: None,
            asked_in_flight: None,
            alarm: None,
        }
    }

    /// Requests a speed, times real time. The next request counts from it.
    pub(super) fn request_speed(&mut self, factor: f64) -> Effect {
        self.view.speed_wanted = factor;
        self.speed_sent = Some((factor, self.now));
        Effect::Send(Command::Speed(factor))
    }

    /// Reports a requested speed that the status line does not show, because the flight is paused.
    pub(super) fn say_speed_in_pause(&mut self, factor: f64) {
        if self.view.paused {
            let go_on = self.key(Action::Pause);
            let speed =
                if factor.is_finite() { format!("at {factor}×") } else { "as fast as it can".to_owned() };
            self.say(Severity::Info, format!("`{go_on}` goes on {speed}."));
        }
    }

    /// Puts the requested speed into a picture from before the session got the request.
    pub(super) fn keep_requested_speed(&mut self, view: &mut SessionView) {
        let Some((factor, at)) = self.speed_sent else { return };
        if view.speed_wanted.to_bits() == factor.to_bits() || !within(self.now, at, SPEED_CONFIRMED_WITHIN) {
            self.speed_sent = None;
        } else {
            view.speed_wanted = factor;
        }
    }

    /// Returns the remote flight controller if its craft is real.
    pub(super) fn real_craft(&self) -> Option<&RemoteView> {
        self.view.remote.as_ref().filter(|remote| remote.access.is_limited())
    }

    /// Returns the current key of an action, for sentences.
    pub(super) fn key(&self, action: Action) -> String {
        self.keymap.key(action)
    }

    /// Returns the current key that shows a panel, followed by the panel's name.
    pub(super) fn panel_title(&self, panel: Panel) -> String {
        let key = self.keymap.shown_keys(Action::Show(panel)).into_iter().next();
        key.map_or_else(|| panel.name().to_owned(), |key| format!("{key} {}", panel.name()))
    }

    /// Shows a notice for a moment and keeps it in the log.
    pub fn notify(&mut self, severity: Severity, text: impl Into<String>) {
        let text = self.units.in_sentence(text.into());
        self.log.push(self.log_time(), severity, text.clone());
        self.say(severity, text);
    }

    /// Returns the time of a line about now: that of the view, or of a newer event that the view does not show yet.
    fn log_time(&self) -> SimTime {
        let shown = self.view.vehicle.time;
        let newest = self.log.newest_first().find(|line| !line.left_behind).map(|line| line.time);
        let newest = newest.filter(|newest| !self.is_rewound() && newest.seconds_since(shown) < VIEW_LAG_S);
        newest.map_or(shown, |newest| newest.max(shown))
    }

    /// Shows a notice in place of effects.
    pub(super) fn only_notify(&mut self, severity: Severity, text: impl Into<String>) -> Vec<Effect> {
        self.notify(severity, text);
        Vec::new()
    }

    /// Adds a line to the log only.
    pub(super) fn log_only(&mut self, severity: Severity, text: impl Into<String>) {
        self.log.push(self.log_time(), severity, self.units.in_sentence(text.into()));
    }

    /// Reports a loss in the log, and on the screen until Esc clears it.
    pub(super) fn pin(&mut self, text: String) {
        let text = self.units.in_sentence(text);
        self.log.push(self.log_time(), Severity::Fault, text.clone());
        self.pinned.push(text);
    }

    /// Shows a notice for a moment without keeping it in the log.
    pub(super) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        let is_answer = self.pressed_at.is_some_and(|at| within(self.now, at, ANSWERED_IN));
        let text = self.units.in_sentence(text.into());
        self.show(Notice { text, severity, at: self.now, is_answer });
    }

    /// Shows a notice. A warning or fault that it would cover stays above it.
    fn show(&mut self, notice: Notice) {
        let covered = self.notice.replace(notice);
        let is_lighter = |covered: &Notice| {
            self.notice.as_ref().is_some_and(|notice| notice.severity < Severity::Warn.min(covered.severity))
        };
        if let Some(alarm) = covered.filter(|covered| !covered.is_answer && is_lighter(covered)) {
            self.alarm = Some(alarm);
        }
    }

    /// Shows an event for a moment, after the answer to a key that was shown just now. A fault does not wait.
    pub(super) fn notice_event(&mut self, severity: Severity, text: String) {
        let event = Notice { text, severity, at: self.now, is_answer: false };
        if severity == Severity::Fault || !self.shows_answer() {
            self.show(event);
        } else if self.next_notice.as_ref().is_none_or(|next| next.severity <= severity) {
            self.next_notice = Some(event);
        }
    }

    /// Shows the event that waits, once the answer to the key was shown long enough.
    pub(super) fn follow_notices(&mut self) {
        if !self.shows_answer()
            && let Some(next) = self.next_notice.take()
        {
            self.show(Notice { at: self.now, ..next });
        }
    }

    fn shows_answer(&self) -> bool {
        let notice = self.notice.as_ref().filter(|notice| notice.is_answer);
        notice.is_some_and(|notice| within(self.now, notice.at, ANSWER_FOR))
    }

    /// Returns `true` while the plan is edited on the map.
    pub(super) fn edits_on_map(&self) -> bool {
        self.map.edit.is_some() || self.map.moving.is_some()
    }

    /// Returns `true` for a while after another revision of the plan was chosen.
    pub(super) fn shows_revision(&self) -> bool {
        self.map.revision_at.is_some_and(|at| within(self.now, at, REVISION_SHOWN))
    }

    /// Returns `true` if the map shows the edited plan rather than the flown one.
    pub(super) fn shows_edited_plan(&self) -> bool {
        self.edits_on_map() || self.shows_revision()
    }

    /// Returns the plan on the map: the edited one, else the flown one, else the open one, else the craft's.
    pub fn shown_plan(&self) -> &FlightPlan {
        let vehicle = &self.view.vehicle;
        match &vehicle.active_plan {
            _ if self.shows_edited_plan() => self.plan(),
            Some(plan) => plan,
            None if self.plan().waypoints.is_empty() => vehicle.stored_plan.as_ref().unwrap_or(self.plan()),
            None => self.plan(),
        }
    }

    /// Returns `true` if the autopilot flies a stored plan, not one of its own.
    pub fn flies_stored_plan(&self) -> bool {
        let nav = self.view.vehicle.nav.as_ref();
        nav.is_some_and(|nav| nav.engaged && nav.source == PlanSource::Stored)
    }

    /// Returns `true` if the autopilot flies this plan.
    pub fn flies(&self, plan: &FlightPlan) -> bool {
        self.view.vehicle.active_plan.as_ref() == Some(plan)
    }

    /// Returns `true` if the craft has stored another plan than the one it flies. The stored one takes effect at the
    /// next engagement.
    pub fn flies_older_plan(&self) -> bool {
        let stored = self.view.vehicle.stored_plan.as_ref();
        // A remote flight controller does not report the plan that it flies.
        self.view.remote.is_none()
            && self.flies_stored_plan()
            && stored.is_some_and(|stored| !stored.waypoints.is_empty() && !self.flies(stored))
    }

    /// Returns the request to write the flight just flown.
    pub(super) fn write_flight(&mut self, form: FlightForm, file: Option<PathBuf>) -> Effect {
        self.notify(
            Severity::Info,
            match form {
                FlightForm::Scenario => "The flight is flown again to derive its expectations.",
                FlightForm::Log => "The flight is flown again to write its log.",
            },
        );
        Effect::WriteFlight { form, file, plan: self.editor.plan().document().name.clone() }
    }

    /// Returns the request to write the recording of the flight so far.
    pub(super) fn write_recording(&self, file: Option<PathBuf>) -> Effect {
        Effect::WriteRecording { file, plan: self.editor.plan().document().name.clone() }
    }

    /// Returns the waypoints of the open plan.
    pub fn plan(&self) -> &FlightPlan {
        &self.editor.document().plan
    }

    /// Returns `true` if the craft is in the air with its motors off.
    pub(super) fn is_disarmed_in_the_air(&self) -> bool {
        let vehicle = &self.view.vehicle;
        vehicle.craft.armed == Some(false)
            && vehicle.truth.as_ref().is_some_and(|truth| !truth.on_ground && truth.alt > IN_THE_AIR_M)
    }

    /// Returns the progress of the upload of an open plan while it is under way.
    pub(super) fn upload_of(&self, id: PlanId) -> Option<UploadView> {
        self.view.upload.filter(|_| self.editor.uploaded_last() == Some(id))
    }

    /// Returns `true` if the craft stores the open plan.
    pub fn plan_is_on_craft(&self) -> bool {
        self.view.vehicle.stored_plan.as_ref() == Some(self.plan())
    }

    /// Returns the alignment of the second flight with the shown one, and the time to add to its times, µs.
    pub(super) fn other_aligned(&self) -> Option<(Alignment, i64)> {
        let timeline = self.view.timeline.as_ref()?;
        Some(self.other.as_ref()?.aligned(&timeline.marks, timeline.first))
    }

    /// Returns the second flight, and the time to add to its times, s.
    pub(super) fn other_flight(&self) -> Option<(&OtherFlight, f64)> {
        let (_, offset_us) = self.other_aligned()?;
        Some((self.other.as_ref()?, offset_us as f64 / 1e6))
    }

    /// Returns the recorded series.
    pub(super) fn series(&self) -> &[Series] {
        self.view.replay.as_ref().map_or(&[], |replay| &replay.overview.series)
    }

    /// Returns the value of a recorded series at the shown instant, if it is known.
    pub(super) fn series_value(&self, index: usize) -> Option<f64> {
        let values = &self.view.replay.as_ref()?.values;
        values.get(index).copied().filter(|value| value.is_finite())
    }

    /// Returns `true` if an earlier instant is shown while the flight waits.
    pub fn is_rewound(&self) -> bool {
        self.view.is_rewound()
    }

    /// Returns `true` if the flight is recorded and can be continued from an earlier instant.
    pub fn flies_again(&self) -> bool {
        self.view.timeline.as_ref().is_some_and(|timeline| !timeline.cannot_continue)
    }

    /// Returns `true` if `time` is after the shown earlier instant.
    pub(super) fn is_later_than_shown(&self, time: SimTime) -> bool {
        self.is_rewound() && time > self.view.vehicle.time
    }

    /// Returns the time from the shown instant to the newest, s; `None` if the newest is shown.
    pub(super) fn rewound_s(&self) -> Option<f64> {
        let timeline = self.view.timeline.as_ref().filter(|timeline| timeline.rewound)?;
        Some(timeline.head.seconds_since(self.view.vehicle.time))
    }

    /// Returns the number of track points up to the shown instant.
    pub(super) fn track_points_shown(&self) -> usize {
        let points = self.track.points();
        if !self.is_rewound() {
            return points.len();
        }
        let shown_s = self.view.vehicle.time.as_secs_f64();
        points.partition_point(|point| point.time_s <= shown_s)
    }
}
