//! The state of the user interface.

use std::collections::VecDeque;
use std::time::Duration;

use crate::fc::UploadView;
use crate::plan::FlightPlan;
use crate::session::{Event, SessionEvent, SessionView};
use crate::signals::{RcFrame, SimTime};
use crate::telemetry::{EventKind, FirmwareEvent, NavEvent, NavState, PlanSource, TransitionReason};

use super::action::Action;
use super::console::{CliHelp, CliState};
use super::editor::{Editor, OpenPlan, PlanId};
use super::event_log::{LogState, Severity};
use super::forecast::ForecastState;
use super::graphs::GraphsState;
use super::history::EnteredLines;
use super::keymap::Keymap;
use super::knobs::KnobsState;
use super::layout::Slots;
use super::log_view::LogView;
use super::message::Effect;
use super::panel::Panel;
use super::popup::{CommandLine, Popup};
use super::stick_recording::StickRecording;
use super::theme::Theme;
use super::timeline::TimelineState;
use super::track::Track;
use super::tutorial::Tutorial;
use super::units::Units;
use super::viewport::MapState;

/// The altitude from which a craft that touches nothing counts as in the air, m. A bounce stays below it.
const IN_THE_AIR_M: f64 = 1.0;
/// The number of transitions kept for the State panel.
const MAX_TRANSITIONS: usize = 200;

/// The configuration of the user interface at start.
#[derive(Debug, Clone)]
pub struct UiConfig {
    pub theme: Theme,
    /// Units of the shown values.
    pub units: Units,
    /// Altitude above home above which a waypoint gets a warning, m.
    pub max_altitude_m: f64,
    pub keymap: Keymap,
    /// Completion and help of the CLI panel.
    pub cli: CliHelp,
    /// Returns an event as a sentence; empty for events that nobody needs to read.
    pub sentence: fn(&Event) -> String,
    /// The plan that is open at start.
    pub plan: OpenPlan,
    /// `true` to use the mouse.
    pub mouse: bool,
    /// Lines entered in earlier runs.
    pub entered: EnteredLines,
    /// `true` to point to the tutorial on the first screen.
    pub is_first_start: bool,
}

/// A sentence that is shown for a moment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notice {
    pub text: String,
    pub severity: Severity,
    /// The time at which it appeared, wall clock.
    pub at: Duration,
}

/// A transition of the state machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transition {
    pub time: SimTime,
    /// The time at which the interface received it, wall clock.
    pub received: Duration,
    pub from: NavState,
    pub to: NavState,
    pub wp: u8,
    pub reason: TransitionReason,
}

/// The first visible line of each panel that scrolls.
#[derive(Debug, Clone, Copy, Default)]
pub struct Scrolls {
    /// The first visible transition of the State panel.
    pub transitions: usize,
    pub log: usize,
}

/// The state of the user interface.
#[derive(Debug)]
pub struct AppState {
    pub view: SessionView,
    pub theme: Theme,
    /// Units of the shown values.
    pub units: Units,
    /// Altitude above home above which a waypoint gets a warning, m.
    pub max_altitude_m: f64,
    /// Completion and help of the CLI panel.
    pub cli_help: CliHelp,
    /// Returns an event as a sentence.
    pub sentence: fn(&Event) -> String,
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
    pub popups: Vec<Popup>,
    /// Wall-clock time since start.
    pub now: Duration,
    /// The tutorial, while it is shown.
    pub tutorial: Option<Tutorial>,
    pub map: MapState,
    /// Selected channel of the RC panel.
    pub channel: usize,
    /// The firmware's command line.
    pub cli: CliState,
    /// The `:` line.
    pub command_line: CommandLine,
    pub log: LogState,
    /// Search and filter of the Log panel.
    pub log_view: LogView,
    pub knobs: KnobsState,
    pub graphs: GraphsState,
    pub stick_recording: StickRecording,
    /// Transitions, the newest last.
    pub transitions: VecDeque<Transition>,
    pub scrolls: Scrolls,
    /// The path that the craft has flown.
    pub track: Track,
    /// The tracks of abandoned branches of the flight.
    pub timeline: TimelineState,
    pub notice: Option<Notice>,
    /// Notices that stay until Esc clears them, the oldest first.
    pub pinned: Vec<String>,
    /// Effects that wait until the user permits changes of the remote craft.
    pub held: Vec<Effect>,
    /// The connection for which the user has permitted changes.
    pub permitted: Option<u32>,
    /// The time of the last Ctrl-C.
    pub cancelled: Option<Duration>,
    /// The time at which the key that arms was pressed in the air, wall clock.
    pub disarm_asked: Option<Duration>,
    /// The sticks sent but not yet confirmed by the session, and the time of sending.
    pub sticks_sent: Option<(RcFrame, Duration)>,
    /// The plan whose upload is under way and after whose upload the pilot starts.
    pub fly_after_upload: Option<PlanId>,
    /// The sentence for the answer to the current upload, if that upload replaces the fence of the craft.
    pub(super) replaced_fence: Option<String>,
    /// The number of ticks of one navigator update.
    pub step_ticks: u32,
    /// Flights flown ahead of time.
    pub forecast: ForecastState,
    /// The panel on which the mouse button went down, while it is down.
    pub pressed: Option<Panel>,
    /// The cell where the mouse button went down, and the values that the drag changes: for the map its centre (north,
    /// east), for the altitude profile the metres per row and the altitude, cm.
    pub drag: Option<(u16, u16, f64, f64)>,
}

#[cfg(test)]
use crate::plan::edit::{History, PlanDocument};

#[cfg(test)]
use crate::plan::estimate::MAX_ALTITUDE_M;

#[cfg(test)]
impl AppState {
    /// Returns a user interface that only has a picture.
    pub(super) fn bare(size: (u16, u16), view: SessionView) -> Self {
        let config = UiConfig {
            theme: Theme::default(),
            units: Units::default(),
            max_altitude_m: MAX_ALTITUDE_M,
            keymap: Keymap::default(),
            cli: CliHelp::default(),
            sentence: |_| String::new(),
            plan: OpenPlan::new(PlanId::default(), None, History::new(PlanDocument::default(), true)),
            mouse: false,
            entered: EnteredLines::default(),
            is_first_start: false,
        };
        Self::new(config, size, view)
    }
}

impl AppState {
    /// Returns the state at start.
    pub fn new(config: UiConfig, size: (u16, u16), view: SessionView) -> Self {
        let is_first_start = config.is_first_start;
        let mut state = Self::after_earlier_runs(config, size, view);
        if is_first_start {
            let (tutorial, help) = (state.key(Action::Tutorial), state.key(Action::Help));
            let text =
                format!("New here? {tutorial} starts a tutorial of five steps, {help} lists all keys.");
            state.notify(Severity::Info, text);
        }
        state
    }

    fn after_earlier_runs(config: UiConfig, size: (u16, u16), view: SessionView) -> Self {
        Self {
            view,
            theme: config.theme,
            cli_help: config.cli,
            sentence: config.sentence,
            keymap: config.keymap,
            units: config.units,
            max_altitude_m: config.max_altitude_m,
            editor: Editor::new(config.plan),
            size,
            focus: Panel::Map,
            zoomed: false,
            slots: Slots::default(),
            popups: Vec::new(),
            now: Duration::ZERO,
            tutorial: None,
            map: MapState::default(),
            channel: 0,
            cli: CliState::with_history(&config.entered.cli),
            command_line: CommandLine::with_history(&config.entered.commands),
            log: LogState::default(),
            log_view: LogView::default(),
            knobs: KnobsState::default(),
            graphs: GraphsState::default(),
            stick_recording: StickRecording::default(),
            transitions: VecDeque::new(),
            scrolls: Scrolls::default(),
            track: Track::default(),
            timeline: TimelineState::default(),
            notice: None,
            pinned: Vec::new(),
            held: Vec::new(),
            permitted: None,
            cancelled: None,
            disarm_asked: None,
            sticks_sent: None,
            fly_after_upload: None,
            replaced_fence: None,
            step_ticks: 10,
            forecast: ForecastState::default(),
            pressed: None,
            drag: None,
        }
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
        let text = text.into();
        self.log.push(self.view.vehicle.time, severity, text.clone());
        self.notice = Some(Notice { text, severity, at: self.now });
    }

    /// Reports a loss in the log, and on the screen until Esc clears it.
    pub(super) fn pin(&mut self, text: String) {
        self.log.push(self.view.vehicle.time, Severity::Fault, text.clone());
        self.pinned.push(text);
    }

    /// Shows a notice for a moment without keeping it in the log.
    pub(super) fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.notice = Some(Notice { text: text.into(), severity, at: self.now });
    }

    /// Processes an event.
    pub fn take_event(&mut self, event: &Event) {
        let text = self.keymap.in_force(&(self.sentence)(event));
        let severity = Severity::of(&event.kind);
        if let SessionEvent::Branch { .. } = event.kind {
            self.leave_behind(event.time);
            self.forecast.forget_what_if();
        }
        if !text.is_empty() {
            self.log.push(event.time, severity, text.clone());
        }
        if let SessionEvent::Vehicle(kind) = &event.kind {
            self.follow_vehicle(event.time, kind);
        }
        if matches!(severity, Severity::Warn | Severity::Fault) && !text.is_empty() {
            self.notice = Some(Notice { text, severity, at: self.now });
        }
    }

    fn follow_vehicle(&mut self, time: SimTime, kind: &EventKind) {
        match kind {
            EventKind::Boot { rate_hz, .. } => self.step_ticks = (rate_hz / 100).max(1),
            EventKind::Firmware(FirmwareEvent::Armed) => {
                self.track.clear();
                self.timeline.forget_tracks();
            }
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { from, to, wp, reason, .. })) => {
                if self.transitions.len() == MAX_TRANSITIONS {
                    self.transitions.pop_front();
                }
                self.transitions.push_back(Transition {
                    time,
                    received: self.now,
                    from: *from,
                    to: *to,
                    wp: *wp,
                    reason: *reason,
                });
            }
            _ => {}
        }
    }

    /// Returns `true` if the map shows the edited plan rather than the flown one.
    pub(super) fn edits_on_map(&self) -> bool {
        self.map.edit.is_some() || self.map.moving.is_some()
    }

    /// Returns the plan on the map: the edited one, else the flown one, else the open one, else the craft's.
    pub fn shown_plan(&self) -> &FlightPlan {
        let vehicle = &self.view.vehicle;
        match &vehicle.active_plan {
            // While the user edits on the map, it shows the edited plan.
            _ if self.edits_on_map() => self.plan(),
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

    /// Returns `true` if the craft has the open plan, but not the latest edits of its settings.
    pub(super) fn has_settings_to_upload(&self) -> bool {
        self.plan_is_on_craft()
            && !super::editor::settings_in_force::to_upload(self, self.editor.document()).is_empty()
    }

    /// Returns `true` if the craft stores the open plan.
    pub fn plan_is_on_craft(&self) -> bool {
        self.view.vehicle.stored_plan.as_ref() == Some(self.plan())
    }
}
