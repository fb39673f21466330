//! 9 Settings: all settings of the craft, searched, compared and changed in place.

mod details;
mod editing;
mod list;

use crossterm::event::{KeyEvent, MouseEvent};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{Content, Hint};
use crate::fc::{Allowed, CraftSetting, cli_block};
use crate::ui::acts::setting_changes;
use crate::ui::acts::setting_list::{Choice, Row, rows};
use crate::ui::model::action::{Action, PanelAction};
use crate::ui::model::effect::Effect;
use crate::ui::model::event_log::Severity;
use crate::ui::model::message::{Change, NewPopup, Request};
use crate::ui::model::panel_table::Panel;
use crate::ui::model::settings::comparison::Comparison;
use crate::ui::model::settings::{Assignment, SettingsChange, Step};
use crate::ui::popup::{ActionMenu, Popup};
use crate::ui::shared::Shared;
use crate::ui::text_field::TextField;
use editing::{Edit, Purpose};

/// The state of the Settings panel.
#[derive(Debug, Default)]
pub(in crate::ui) struct SettingsPanel {
    choice: Choice,
    /// The search, and `true` while it is typed.
    search: TextField,
    is_typing: bool,
    /// The name of the selected setting, and its row when it was selected.
    selected: Option<String>,
    row: usize,
    edit: Option<Edit>,
}

/// The actions of the menu of a setting.
const MENU: [PanelAction; 15] = [
    PanelAction::SettingEdit,
    PanelAction::SettingMore,
    PanelAction::SettingLess,
    PanelAction::SettingDefault,
    PanelAction::SettingTry,
    PanelAction::SettingUndo,
    PanelAction::SettingRedo,
    PanelAction::SettingCompare,
    PanelAction::SettingsBeside,
    PanelAction::SettingSearch,
    PanelAction::CopySettings,
    PanelAction::SettingIntoPlan,
    PanelAction::SettingsIntoPlan,
    PanelAction::SettingsFile,
    PanelAction::AllDefault,
];

impl SettingsPanel {
    /// Returns the row of the selected setting: where it is now, else the row where it was.
    fn selected_row(&self, rows: &[Row<'_>]) -> Option<usize> {
        let is_selected = |row: &Row<'_>| matches!(row, Row::Setting(setting) if Some(&setting.name) == self.selected.as_ref());
        let is_setting = |at: &usize| matches!(rows.get(*at), Some(Row::Setting(_)));
        let last = rows.len().checked_sub(1)?;
        let near = self.row.min(last);
        rows.iter()
            .position(is_selected)
            .or_else(|| (near..rows.len()).chain((0..near).rev()).find(is_setting))
    }

    /// Returns the selected setting.
    fn setting<'a>(&self, state: &'a Shared) -> Option<&'a CraftSetting> {
        let rows = rows(state, &self.choice);
        match rows.get(self.selected_row(&rows)?)? {
            Row::Setting(setting) => Some(setting),
            Row::Heading(_) => None,
        }
    }

    fn select(&mut self, rows: &[Row<'_>], at: usize) {
        if let Some(Row::Setting(setting)) = rows.get(at) {
            self.selected = Some(setting.name.clone());
            self.row = at;
        }
    }

    /// Selects the setting `by` settings further down.
    fn move_by(&mut self, state: &Shared, by: isize) {
        let rows = rows(state, &self.choice);
        let places: Vec<usize> =
            (0..rows.len()).filter(|at| matches!(rows.get(*at), Some(Row::Setting(_)))).collect();
        let Some(now) = self.selected_row(&rows) else { return };
        let at = places.iter().position(|place| *place == now).unwrap_or(0);
        let to = at.saturating_add_signed(by).min(places.len().saturating_sub(1));
        if let Some(&place) = places.get(to) {
            self.select(&rows, place);
        }
    }

    /// Selects the first setting of the next group, or of this one and then of the previous group.
    fn move_to_group(&mut self, state: &Shared, down: bool) {
        let rows = rows(state, &self.choice);
        let Some(now) = self.selected_row(&rows) else { return };
        let mut firsts = (0..rows.len())
            .filter(|at| matches!(rows.get(*at), Some(Row::Heading(_))))
            .map(|heading| heading + 1);
        let to = if down { firsts.find(|&first| first > now) } else { firsts.rfind(|&first| first < now) };
        if let Some(to) = to {
            self.select(&rows, to);
        }
    }

    /// Selects the next match of the search, or the previous one; the first follows the last.
    fn next_match(&mut self, state: &Shared, back: bool) -> Vec<Request> {
        if self.choice.query.is_empty() {
            let key = state.key(Action::Panel(PanelAction::SettingSearch));
            return vec![Change::Notify(Severity::Info, format!("No search yet: `{key}` begins.")).into()];
        }
        let before = self.selected.clone();
        self.move_by(state, if back { -1 } else { 1 });
        if self.selected == before {
            self.move_by(state, if back { isize::MAX } else { isize::MIN });
        }
        Vec::new()
    }

    /// Takes the typed search.
    fn find(&mut self) {
        self.choice.query = self.search.value().to_owned();
        self.choice.on_top = None;
        self.row = 0;
    }

    fn end_search(&mut self) {
        self.search = TextField::default();
        self.is_typing = false;
        self.choice.query.clear();
        self.choice.on_top = None;
    }

    /// Returns the shown settings that differ from the compared values, or all shown if the list is searched.
    fn chosen<'a>(&self, state: &'a Shared) -> Vec<&'a CraftSetting> {
        let is_whole_list = self.choice.comparison == Comparison::All && self.choice.query.is_empty();
        let shown = rows(state, &self.choice).into_iter().filter_map(|row| match row {
            Row::Setting(setting) => Some(setting),
            Row::Heading(_) => None,
        });
        shown.filter(|setting| !is_whole_list || setting.is_changed()).collect()
    }

    fn copy(&self, state: &Shared) -> Vec<Request> {
        let chosen = self.chosen(state);
        if chosen.is_empty() {
            let text = "No setting is changed, so there is nothing to copy.".to_owned();
            return vec![Change::Notify(Severity::Info, text).into()];
        }
        let text = format!("Copied {} settings as CLI lines.", chosen.len());
        vec![Effect::Copy(cli_block(&chosen)).into(), Change::Notify(Severity::Info, text).into()]
    }

    fn put_in_plan(&self, state: &Shared, all: bool) -> Vec<Request> {
        let chosen = if all { self.chosen(state) } else { self.setting(state).into_iter().collect() };
        let assignment =
            |setting: &&CraftSetting| Assignment { name: setting.name.clone(), value: setting.value.clone() };
        vec![Change::Settings(SettingsChange::IntoPlan(chosen.iter().map(assignment).collect())).into()]
    }

    /// Sets the selected setting to a value.
    fn set(&mut self, state: &Shared, value: Option<String>) -> Vec<Request> {
        self.choice.freeze(&state.settings);
        let Some((setting, value)) = self.setting(state).zip(value) else { return Vec::new() };
        set(setting, value)
    }

    fn nudge(&mut self, state: &Shared, steps: i64) -> Vec<Request> {
        match self.setting(state) {
            Some(setting) if setting.nudged(steps).is_none() => {
                let key = state.key(Action::Panel(PanelAction::SettingEdit));
                let text = format!("{} has no steps: `{key}` types a value.", setting.name);
                vec![Change::Say(Severity::Info, text).into()]
            }
            found => {
                let value = found.and_then(|setting| setting.nudged(steps));
                self.set(state, value)
            }
        }
    }

    /// Goes to the next comparison.
    fn compare(&mut self) {
        self.choice.comparison = self.choice.comparison.next();
        self.choice.on_top = None;
        self.row = 0;
    }
}

/// Returns the request to set a setting.
fn set(setting: &CraftSetting, value: String) -> Vec<Request> {
    let label = format!("{} = {value}", setting.name);
    let assignments = vec![Assignment { name: setting.name.clone(), value }];
    vec![Change::Settings(SettingsChange::Set(Step { label, assignments })).into()]
}

impl Content for SettingsPanel {
    /// Returns the title with the comparison, the search and the activity.
    fn title(&self, state: &Shared) -> String {
        let mut title = state.panel_title(Panel::Settings);
        let search = if self.choice.query.is_empty() || self.is_typing {
            String::new()
        } else {
            format!("/{}", self.choice.query)
        };
        let compared = match self.choice.comparison {
            Comparison::All => String::new(),
            Comparison::Defaults => "changed from the defaults".to_owned(),
            Comparison::Plan => "other than the plan's".to_owned(),
            Comparison::Saved if state.view.remote.is_some() => "other than read first".to_owned(),
            Comparison::Saved => "not saved in flash".to_owned(),
        };
        let activity = match state.settings.pending() {
            0 if state.settings.is_reading() => "reading …".to_owned(),
            0 => String::new(),
            pending => format!("{pending} being set"),
        };
        for part in [compared, search, activity] {
            if !part.is_empty() {
                title.push_str(" — ");
                title.push_str(&part);
            }
        }
        title
    }

    fn draw(&self, state: &Shared, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        list::draw(self, state, area, buffer)
    }

    fn hints(&self, _: &Shared) -> Vec<Hint> {
        vec![
            (&[Action::Panel(PanelAction::SettingSearch)], "search"),
            (&[Action::Panel(PanelAction::SettingEdit)], "edit"),
            (&[Action::Panel(PanelAction::SettingLess), Action::Panel(PanelAction::SettingMore)], "nudge"),
            (&[Action::Panel(PanelAction::SettingTry)], "what it changes"),
            (&[Action::Panel(PanelAction::SettingCompare)], "differences"),
            (&[Action::Panel(PanelAction::SettingUndo)], "undo"),
        ]
    }

    fn typing(&self, state: &Shared) -> Option<Action> {
        let is_number = matches!(self.setting(state)?.allowed, Allowed::Number { .. } | Allowed::Numbers(_));
        is_number.then_some(Action::Panel(PanelAction::SettingType))
    }

    fn act(&mut self, state: &Shared, action: PanelAction) -> Vec<Request> {
        match action {
            PanelAction::SettingSearch => {
                self.end_search();
                self.is_typing = true;
                self.edit = None;
                return vec![Request::Act(Action::Show(Panel::Settings))];
            }
            PanelAction::NextSetting => return self.next_match(state, false),
            PanelAction::PreviousSetting => return self.next_match(state, true),
            PanelAction::NextGroup => self.move_to_group(state, true),
            PanelAction::PreviousGroup => self.move_to_group(state, false),
            PanelAction::SettingEdit => return self.begin_edit(state, Purpose::Set),
            PanelAction::SettingType => return self.begin_typing(state, Purpose::Set),
            PanelAction::SettingTry => return self.begin_typing(state, Purpose::Try),
            PanelAction::SettingMore => return self.nudge(state, 1),
            PanelAction::SettingLess => return self.nudge(state, -1),
            PanelAction::SettingMoreMuch => return self.nudge(state, 10),
            PanelAction::SettingLessMuch => return self.nudge(state, -10),
            PanelAction::SettingDefault => {
                let value = self.setting(state).and_then(|setting| setting.default.clone());
                return self.set(state, value);
            }
            PanelAction::AllDefault => {
                return vec![match setting_changes::nothing_to_reset(state) {
                    Some(why) => Change::Say(Severity::Info, why.to_owned()).into(),
                    None => Request::Open(NewPopup::ResetSettings),
                }];
            }
            PanelAction::SettingUndo => return vec![Change::Settings(SettingsChange::Undo).into()],
            PanelAction::SettingRedo => return vec![Change::Settings(SettingsChange::Redo).into()],
            PanelAction::SettingCompare => self.compare(),
            PanelAction::SettingsBeside => {
                let comparison = match self.choice.comparison {
                    Comparison::All => Comparison::Defaults,
                    other => other,
                };
                return vec![Request::Open(NewPopup::Settings(comparison))];
            }
            PanelAction::CopySettings => return self.copy(state),
            PanelAction::SettingIntoPlan => return self.put_in_plan(state, false),
            PanelAction::SettingsIntoPlan => return self.put_in_plan(state, true),
            PanelAction::SettingsFile => return vec![Request::Type("settings-file ".to_owned())],
            PanelAction::ReadSettings => return vec![Change::Settings(SettingsChange::Read).into()],
            _ => {}
        }
        Vec::new()
    }

    fn key(&mut self, state: &Shared, event: KeyEvent) -> Vec<Request> {
        if self.edit.is_some() { self.edit_key(state, event) } else { self.search_key(state, event) }
    }

    fn field(&mut self) -> Option<&mut TextField> {
        match &mut self.edit {
            Some(edit) => Some(&mut edit.field),
            None => self.is_typing.then_some(&mut self.search),
        }
    }

    fn close_field(&mut self) {
        if self.edit.take().is_none() {
            self.end_search();
        }
    }

    fn go_back(&mut self, _: &Shared) -> Option<Vec<Request>> {
        if !self.choice.query.is_empty() {
            self.end_search();
        } else if self.choice.comparison != Comparison::All {
            self.choice = Choice::default();
        } else {
            return None;
        }
        Some(Vec::new())
    }

    fn visit(&mut self) {
        self.choice.on_top = None;
    }

    fn scroll(&mut self, state: &Shared, _: Rect, by: isize) -> Vec<Request> {
        // The setting whose value is typed stays selected.
        if self.edit.is_none() {
            self.move_by(state, by);
        }
        Vec::new()
    }

    fn press(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Vec<Request> {
        let rows = rows(state, &self.choice);
        let Some(at) = list::row_at(self, state, area, event.row) else { return Vec::new() };
        let was_selected = self.selected_row(&rows) == Some(at);
        self.edit = None;
        self.select(&rows, at);
        // A second press, on the value, begins to edit it.
        if was_selected && list::is_value(self, area, event.column) {
            return self.begin_edit(state, Purpose::Set);
        }
        vec![Request::Chosen]
    }

    fn menu(&mut self, state: &Shared, area: Rect, event: &MouseEvent) -> Option<Popup> {
        let rows = rows(state, &self.choice);
        if let Some(at) = list::row_at(self, state, area, event.row) {
            self.select(&rows, at);
        }
        let title = self.setting(state).map_or_else(String::new, |setting| setting.name.clone());
        let actions = MENU.map(Action::Panel).to_vec();
        Some(Popup::Actions(ActionMenu::new(title, (event.column, event.row), actions)))
    }
}
