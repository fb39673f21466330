//! The state of the user interface.

use std::time::Duration;

use crossterm::event::KeyEvent;

use crate::campaign::ForecastAnswer;
use crate::events::{Event, ReplayNotice, SessionEvent};
use crate::fc::RemoteNotice;
use crate::session::SessionView;
use crate::signals::SimTime;
use crate::telemetry::{EventKind, FirmwareEvent, NavEvent};

use super::permission::Permission;
use super::popup::{CommandLine, Popup};
use super::shared::Shared;
use super::transitions::Transition;
use super::tutorial::Tutorial;
use crate::ui::acts::screen_layout::Border;
use crate::ui::model::action::Action;
use crate::ui::model::config::UiConfig;
use crate::ui::model::event_log::Severity;
use crate::ui::model::kept_screen::KeptScreens;
use crate::ui::model::panel_table::Panel;
use crate::ui::panel::Panels;

/// The state of the user interface.
#[derive(Debug)]
pub struct AppState {
    pub shared: Shared,
    pub panels: Panels,
    /// Returns an event as a sentence.
    pub sentence: fn(&Event) -> String,
    /// Returns the answer of many flights of a plan as a sentence.
    pub go_sentence: fn(&str, &ForecastAnswer) -> String,
    pub popups: Vec<Popup>,
    /// The tutorial, while it is shown.
    pub tutorial: Option<Tutorial>,
    /// The `:` line.
    pub command_line: CommandLine,
    /// The permission to change a real craft.
    pub permission: Permission,
    /// The time of the last Ctrl-C.
    pub cancelled: Option<Duration>,
    /// The screen that is kept.
    pub kept: KeptScreens,
    /// The panel that had the focus before one that takes text.
    pub before_text: Panel,
    /// `true` after a key that moved to a value of the focused panel.
    pub has_chosen: bool,
    /// The keys for settings that are still being read.
    pub waiting_keys: Vec<KeyEvent>,
    /// The number of ticks of one navigator update.
    pub step_ticks: u32,
    /// The panel on which the mouse button went down, while it is down.
    pub pressed: Option<Panel>,
    /// The border between panels that the mouse moves.
    pub dragged: Option<Border>,
}

#[cfg(test)]
impl AppState {
    /// Returns a user interface that only has a picture.
    pub(super) fn bare(size: (u16, u16), view: SessionView) -> Self {
        Self::new(UiConfig::bare(), size, view)
    }
}

impl AppState {
    /// Returns the state at start.
    pub fn new(config: UiConfig, size: (u16, u16), view: SessionView) -> Self {
        let is_first_start = config.is_first_start;
        let mut state = Self::after_earlier_runs(config, size, view);
        if is_first_start {
            let (tutorial, help) = (state.shared.key(Action::Tutorial), state.shared.key(Action::Help));
            let text =
                format!("New here? {tutorial} starts a tutorial of five steps, {help} lists all keys.");
            state.shared.notify(Severity::Info, text);
        }
        state
    }

    fn after_earlier_runs(mut config: UiConfig, size: (u16, u16), view: SessionView) -> Self {
        Self {
            panels: Panels::new(&config.entered.cli),
            command_line: CommandLine::with_history(&config.entered.commands),
            sentence: config.sentence,
            go_sentence: config.go_sentence,
            popups: Vec::new(),
            tutorial: None,
            permission: Permission::default(),
            cancelled: None,
            kept: std::mem::take(&mut config.kept),
            before_text: Panel::Map,
            has_chosen: false,
            waiting_keys: Vec::new(),
            step_ticks: 10,
            pressed: None,
            dragged: None,
            shared: Shared::new(config, size, view),
        }
    }

    /// Processes an event.
    pub fn take_event(&mut self, event: &Event) {
        let shared = &mut self.shared;
        let text = shared.units.in_sentence(shared.keymap.in_force(&(self.sentence)(event)));
        let severity = Severity::of(&event.kind);
        if matches!(event.kind, SessionEvent::Branch { .. } | SessionEvent::Restarted) {
            self.kept.has_left = true;
        }
        if let SessionEvent::Branch { .. } = event.kind {
            // The flight continues from there.
            shared.log.leave_behind(event.time);
            self.panels.state.transitions.leave_behind(event.time);
            shared.forecast.forget_what_if();
        }
        let may_set = matches!(
            event.kind,
            SessionEvent::Branch { .. }
                | SessionEvent::Restarted
                | SessionEvent::Remote(RemoteNotice::Restarted(_))
        );
        if may_set {
            shared.settings.outdate();
        }
        if let SessionEvent::Replay(ReplayNotice::Begins(_)) = event.kind {
            shared.log.clear();
            self.panels.state.transitions.clear();
        }
        if !text.is_empty() {
            shared.log.push(event.time, severity, text.clone());
        }
        if matches!(severity, Severity::Warn | Severity::Fault) && !text.is_empty() {
            shared.notice_event(severity, text);
        }
        if let SessionEvent::Vehicle(kind) = &event.kind {
            self.follow_vehicle(event.time, kind);
        }
    }

    fn follow_vehicle(&mut self, time: SimTime, kind: &EventKind) {
        match kind {
            EventKind::Boot { rate_hz, .. } => self.step_ticks = (rate_hz / 100).max(1),
            // A recorded flight is shown as a whole.
            EventKind::Firmware(FirmwareEvent::Armed) if self.shared.view.replay.is_none() => {
                let before = self.shared.track.begin_at(time.as_secs_f64());
                self.shared.past_flights.keep_flight(before);
                self.shared.abandoned.forget();
            }
            EventKind::Firmware(FirmwareEvent::Nav(NavEvent::State { from, to, wp, reason, .. })) => {
                let received = self.shared.now;
                self.panels.state.transitions.push(Transition {
                    time,
                    received,
                    from: *from,
                    to: *to,
                    wp: *wp,
                    reason: *reason,
                });
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn notice_text(event: &Event) -> String {
        match &event.kind {
            SessionEvent::Notice(text) | SessionEvent::Warning(text) => text.clone(),
            _ => String::new(),
        }
    }

    #[test]
    fn at_the_first_start_a_warning_is_shown_rather_than_the_way_to_the_tutorial() {
        for warning in ["Not saved: cannot write the file.", "`save` cannot work: the directory is in use."] {
            let config = UiConfig { is_first_start: true, sentence: notice_text, ..UiConfig::bare() };
            let mut state = AppState::new(config, (80, 24), SessionView::default());
            let shown = |state: &AppState| state.shared.notice.as_ref().map(|notice| notice.text.clone());
            for (kind, begins) in [
                // A text alone is no warning.
                (SessionEvent::Notice(format!("{warning} (an old line)")), "New here?"),
                (SessionEvent::Warning(warning.to_owned()), warning),
            ] {
                let said = format!("{kind:?}");
                state.take_event(&Event { time: SimTime(0), kind });
                let shown = shown(&state).expect("a notice");
                assert!(shown.starts_with(begins), "{said}: {shown}");
            }
        }
    }

    #[test]
    fn the_answer_to_a_key_is_read_before_an_event_takes_its_place() {
        let mut state = AppState::new(
            UiConfig { sentence: notice_text, ..UiConfig::bare() },
            (80, 24),
            SessionView::default(),
        );
        let shown = |state: &AppState| state.shared.notice.as_ref().map(|notice| notice.text.clone());
        let warning = |text: &str| Event {
            time: SimTime(0),
            kind: SessionEvent::Warning(format!("Not saved: {text}.")),
        };
        state.take_event(&warning("one"));
        assert_eq!(shown(&state).as_deref(), Some("Not saved: one."), "nothing was pressed");
        let at = |state: &mut AppState, ms| {
            crate::ui::update::update(
                state,
                crate::ui::model::message::Msg::Clock(Duration::from_millis(ms)),
            );
        };
        at(&mut state, 20_000);
        state.shared.pressed_at = Some(state.shared.now);
        at(&mut state, 20_100);
        state.shared.notify(Severity::Info, "Saved.");
        at(&mut state, 20_105);
        state.take_event(&warning("two"));
        at(&mut state, 22_000);
        assert_eq!(shown(&state).as_deref(), Some("Saved."));
        at(&mut state, 22_101);
        assert_eq!(shown(&state).as_deref(), Some("Not saved: two."));
        at(&mut state, 40_000);
        assert_eq!(state.shared.notice.as_ref().map(|notice| notice.at.as_millis()), Some(22_101), "once");
    }
}
