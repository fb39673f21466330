//! Holds back keys that are typed faster than the session answers, for example over a slow connection.
//!
//! A key acts on the outcome of the keys before it. So it waits until the session shows the outcome of their
//! commands, and until their questions are answered, but for half a second at most.

use std::time::{Duration, Instant};

use crossterm::event::{Event as TerminalEvent, KeyEvent, MouseEventKind};

use crate::session::{Command, Seek};
use crate::ui::model::effect::Effect;
use crate::ui::model::message::Msg;

/// The longest time that keys wait.
const LONGEST: Duration = Duration::from_millis(500);

/// A question whose answer changes the meaning of the keys after it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Question {
    Upload,
    Download,
    Settings,
    Set,
    Flights,
    Deletion,
}

/// The keys that wait, and the outcomes that they wait for.
#[derive(Debug, Default)]
pub(super) struct TypedAhead {
    /// The number of commands that the session got.
    sent: u64,
    /// The number of commands whose outcome the keys wait for.
    wanted: u64,
    questions: Vec<Question>,
    /// The time of the newest request of a key.
    since: Option<Instant>,
    /// The key that moves the shown instant. Held, it repeats faster than an instant is found, so it does not wait for
    /// itself.
    repeated: Option<KeyEvent>,
    /// A key that arrived too early.
    early: Option<TerminalEvent>,
}

impl TypedAhead {
    /// Takes a message and its effects, before they are carried out. Returns `true` if keys wait for their outcome.
    pub(super) fn takes(&mut self, input: Option<Input>, effects: &[Effect], now: Instant) -> bool {
        let Some(input) = input else { return false };
        let seeks = |effect: &Effect| matches!(effect, Effect::Send(Command::Seek(Seek::Seconds(_))));
        self.repeated = input.0.filter(|_| effects.iter().any(seeks));
        let before = self.questions.len();
        self.questions.extend(effects.iter().filter_map(asked));
        if self.questions.len() > before {
            self.since = Some(now);
        }
        true
    }

    /// Counts a command that the session gets. Keys wait for the outcome of those of a key.
    pub(super) fn sends(&mut self, is_awaited: bool, now: Instant) {
        self.sent += 1;
        if is_awaited {
            (self.wanted, self.since) = (self.sent, Some(now));
        }
    }

    /// Forgets the key that waits.
    pub(super) fn drop_key(&mut self) {
        self.early = None;
    }

    /// Takes the answer to a question.
    pub(super) fn hears(&mut self, msg: &Msg) {
        if matches!(msg, Msg::Busy) {
            self.questions.clear();
        }
        let answered = answered(msg);
        if let Some(at) = self.questions.iter().position(|question| Some(*question) == answered) {
            self.questions.remove(at);
        }
    }

    /// Returns `true` while keys wait. `taken` is the number of commands that the session has carried out.
    pub(super) fn holds_keys(&mut self, taken: u64, now: Instant) -> bool {
        let is_late = self.since.is_some_and(|since| now.duration_since(since) >= LONGEST);
        if is_late {
            self.questions.clear();
            (self.wanted, self.since) = (0, None);
        }
        !self.questions.is_empty() || taken < self.wanted
    }

    /// Returns `true` if the next key is read from the terminal.
    pub(super) fn reads_keys(&self, is_held: bool) -> bool {
        self.early.is_none() && (!is_held || self.repeated.is_some())
    }

    /// Returns the event, unless it has to wait.
    pub(super) fn let_through(&mut self, event: TerminalEvent, is_held: bool) -> Option<TerminalEvent> {
        let is_repeated = matches!(&event, TerminalEvent::Key(key) if Some(*key) == self.repeated);
        if !is_held || is_repeated {
            return Some(event);
        }
        self.early = Some(event);
        None
    }

    /// Returns the event that has waited, once it may act.
    pub(super) fn next(&mut self, is_held: bool) -> Option<TerminalEvent> {
        if is_held { None } else { self.early.take() }
    }
}

/// An input of the user: the key, if it is one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Input(Option<KeyEvent>);

impl Input {
    /// Returns the input of a message. The mouse moves faster than anything can follow, so nothing waits for it.
    pub(super) fn of(msg: &Msg) -> Option<Self> {
        match msg {
            Msg::Key(key) => Some(Self(Some(*key))),
            Msg::Paste(_) => Some(Self(None)),
            Msg::Mouse(event) => {
                matches!(event.kind, MouseEventKind::Down(_) | MouseEventKind::Up(_)).then_some(Self(None))
            }
            _ => None,
        }
    }
}

/// Returns the question of an effect.
fn asked(effect: &Effect) -> Option<Question> {
    match effect {
        Effect::Upload { .. } => Some(Question::Upload),
        Effect::Download(_) => Some(Question::Download),
        Effect::ReadSettings => Some(Question::Settings),
        Effect::Set(_) => Some(Question::Set),
        Effect::ListFlights { after } => after.is_zero().then_some(Question::Flights),
        Effect::DeleteFlight(_) => Some(Question::Deletion),
        // The link to the files counts its questions itself.
        Effect::Files(_) => None,
        // Their outcome is in the next picture of the session.
        Effect::Send(_) | Effect::World(_) => None,
        // Their answers are shown and logged, and no key acts on them. A survey and a long forecast also take too long.
        Effect::Cli(_)
        | Effect::SaveToFlash
        | Effect::Curves(_)
        | Effect::Forecast(_)
        | Effect::Survey(_)
        | Effect::EndSurvey(_)
        | Effect::WriteFlight { .. }
        | Effect::WriteRecording { .. } => None,
        Effect::ShowFlights { .. } | Effect::Copy(_) | Effect::Redraw | Effect::Suspend | Effect::Quit => {
            None
        }
    }
}

/// Returns the question that a message answers.
fn answered(msg: &Msg) -> Option<Question> {
    match msg {
        Msg::UploadReply { .. } => Some(Question::Upload),
        Msg::DownloadReply { .. } => Some(Question::Download),
        Msg::SettingsReply(_) => Some(Question::Settings),
        Msg::SetReply { .. } => Some(Question::Set),
        Msg::Flights(_) => Some(Question::Flights),
        Msg::FlightDeleted { .. } => Some(Question::Deletion),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crossterm::event::{KeyCode, KeyModifiers};

    fn key(c: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(c), KeyModifiers::NONE)
    }

    fn event(c: char) -> TerminalEvent {
        TerminalEvent::Key(key(c))
    }

    /// Presses a key that has these effects, `commands` of which are commands.
    fn press(ahead: &mut TypedAhead, c: char, effects: &[Effect], commands: usize, now: Instant) {
        let is_awaited = ahead.takes(Input::of(&Msg::Key(key(c))), effects, now);
        (0..commands).for_each(|_| ahead.sends(is_awaited, now));
    }

    #[test]
    fn a_key_waits_for_the_commands_and_the_questions_of_the_keys_before_it() {
        let (mut ahead, now) = (TypedAhead::default(), Instant::now());
        assert!(!ahead.holds_keys(0, now) && ahead.reads_keys(false));
        let pause = || [Effect::Send(Command::Pause(true))];
        press(&mut ahead, 'p', &pause(), 1, now);
        assert!(ahead.holds_keys(0, now) && !ahead.reads_keys(true));
        assert!(!ahead.holds_keys(1, now), "the picture has it");
        // A command of the screen itself is counted, and nobody waits for it.
        ahead.sends(false, now);
        assert!(!ahead.holds_keys(1, now));
        press(&mut ahead, 'p', &pause(), 1, now);
        assert!(ahead.holds_keys(2, now) && !ahead.holds_keys(3, now));

        let list = [Effect::ListFlights { after: Duration::ZERO }];
        press(&mut ahead, 'f', &list, 0, now);
        ahead.hears(&Msg::Flights(Err(String::new())));
        assert!(!ahead.holds_keys(3, now));
        press(&mut ahead, 'f', &list, 0, now);
        assert!(ahead.holds_keys(3, now));
        assert!(!ahead.holds_keys(3, now + LONGEST), "a slow disk does not hold them for long");
        press(&mut ahead, 'f', &[Effect::ListFlights { after: LONGEST }], 0, now);
        assert!(!ahead.holds_keys(3, now), "the next look at the library is nobody's key");
        press(&mut ahead, 'u', &[Effect::ReadSettings], 1, now);
        ahead.hears(&Msg::Busy);
        assert!(ahead.holds_keys(3, now) && !ahead.holds_keys(4, now));
    }

    #[test]
    fn a_held_rewind_key_does_not_wait_for_itself_and_the_key_after_it_does() {
        let (mut ahead, now) = (TypedAhead::default(), Instant::now());
        press(&mut ahead, '<', &[Effect::Send(Command::Seek(Seek::Seconds(-10.0)))], 1, now);
        assert!(ahead.holds_keys(0, now) && ahead.reads_keys(true));
        assert_eq!(ahead.let_through(event('<'), true), Some(event('<')));
        assert_eq!(ahead.let_through(event('b'), true), None);
        assert!(!ahead.reads_keys(true) && ahead.next(true).is_none(), "the order stays");
        assert!(!ahead.holds_keys(1, now));
        assert_eq!(ahead.next(false), Some(event('b')));
        assert!(ahead.reads_keys(false));
    }
}
