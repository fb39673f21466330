//! Typing a value in place, and typing the search.

use crossterm::event::{KeyCode, KeyEvent};

use super::{SettingsPanel, set};
use crate::fc::{Allowed, CraftSetting};
use crate::ui::model::message::{Change, Request};
use crate::ui::model::settings::{Assignment, SettingsChange};
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;

/// The purpose of a typed value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// The craft gets it.
    Set,
    /// A flight ahead is flown with it.
    Try,
}

/// The value being typed.
#[derive(Debug)]
pub(super) struct Edit {
    /// The name of the setting.
    pub(super) name: String,
    pub(super) field: TextField,
    pub(super) purpose: Purpose,
    /// The problem with the typed value.
    pub(super) problem: Option<String>,
}

impl SettingsPanel {
    /// Handles Enter on a setting: a switch is switched, any other value is typed.
    pub(super) fn begin_edit(&mut self, state: &Shared, purpose: Purpose) -> Vec<Request> {
        let is_switch =
            |setting: &&CraftSetting| matches!(&setting.allowed, Allowed::Words(words) if words.len() == 2);
        match self.setting(state).filter(is_switch) {
            Some(setting) => {
                let other = setting.nudged(1);
                self.set(state, other)
            }
            None => self.begin_typing(state, purpose),
        }
    }

    /// Opens the field for a value of the selected setting. A value that was tried is offered to be set, and a value to
    /// try is another one than the present.
    pub(super) fn begin_typing(&mut self, state: &Shared, purpose: Purpose) -> Vec<Request> {
        self.choice.freeze(&state.settings);
        self.is_typing = false;
        let Some(setting) = self.setting(state) else { return Vec::new() };
        let tried = state.forecast.tried(&setting.name).map(|(value, _)| value.to_owned());
        let steps = if matches!(setting.allowed, Allowed::Words(_)) { 1 } else { 10 };
        let mut others = [steps, -steps].into_iter().filter_map(|steps| setting.nudged(steps));
        let other = others.find(|other| purpose == Purpose::Try && *other != setting.value);
        let value = tried.or(other).unwrap_or_else(|| setting.value.clone());
        self.selected = Some(setting.name.clone());
        let (name, field) = (setting.name.clone(), TextField::selected(value));
        self.edit = Some(Edit { name, field, purpose, problem: None });
        Vec::new()
    }

    /// Handles a key while a value is typed.
    pub(super) fn edit_key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        let Some(edit) = &mut self.edit else { return Vec::new() };
        let Some(setting) = state.settings.find(&edit.name) else {
            self.edit = None;
            return Vec::new();
        };
        match event.code {
            KeyCode::Esc => self.edit = None,
            KeyCode::Enter => match setting.read(edit.field.value()) {
                Err(problem) => edit.problem = Some(problem),
                Ok(value) => {
                    let purpose = edit.purpose;
                    self.edit = None;
                    return match purpose {
                        Purpose::Set => set(setting, value),
                        Purpose::Try => {
                            let assignment = Assignment { name: setting.name.clone(), value };
                            vec![Change::Settings(SettingsChange::Try(assignment)).into()]
                        }
                    };
                }
            },
            // The typed value goes on in steps, words of a list one by one.
            KeyCode::Up | KeyCode::Down => {
                let typed = setting.read(edit.field.value()).unwrap_or_else(|_| setting.value.clone());
                let steps = match (&setting.allowed, event.code) {
                    (Allowed::Words(_), KeyCode::Down) | (_, KeyCode::Up) => 1,
                    _ => -1,
                };
                let from = CraftSetting { value: typed, ..setting.clone() };
                if let Some(value) = from.nudged(steps) {
                    edit.field = TextField::selected(value);
                    edit.problem = None;
                }
            }
            KeyCode::Tab => {
                if let Ok(value) = setting.read(edit.field.value()) {
                    edit.field = TextField::new(value);
                }
            }
            _ => {
                edit.field.key(event);
                edit.problem = None;
            }
        }
        Vec::new()
    }

    /// Handles a key while the search is typed.
    pub(super) fn search_key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        match event.code {
            KeyCode::Esc => self.end_search(),
            KeyCode::Enter => self.is_typing = false,
            KeyCode::Up => self.move_by(state, -1),
            KeyCode::Down => self.move_by(state, 1),
            _ => {
                if self.search.key(event) {
                    self.find();
                }
            }
        }
        Vec::new()
    }
}
