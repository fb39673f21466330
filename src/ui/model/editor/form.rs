//! A form: a few labelled values that are typed or chosen and then applied together.

use crossterm::event::{KeyCode, KeyEvent};

use super::forms;
use crate::plan::edit::PlanDocument;
use crate::ui::text_field::TextField;
use crate::ui::units::Units;

/// The purpose of a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::VariantNames)]
pub enum FormKind {
    /// Edits of the selected waypoints.
    Bulk,
    /// A plan from a shape.
    Generate,
    /// Name, description, home and settings of the plan.
    Properties,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FormField {
    /// The name of the value.
    pub label: String,
    /// Its unit or its allowed values.
    pub hint: String,
    /// The typed value, or the chosen word of a choice.
    pub text: TextField,
    /// The words of a choice; empty for a typed value.
    pub choices: &'static [&'static str],
}

impl FormField {
    /// Returns a field for a typed value.
    pub(super) fn typed(label: impl Into<String>, hint: impl Into<String>, value: impl Into<String>) -> Self {
        Self { label: label.into(), hint: hint.into(), text: TextField::new(value), choices: &[] }
    }

    /// Returns a field for a choice; the first word is selected at first.
    pub(super) fn choice(label: &'static str, choices: &'static [&'static str]) -> Self {
        let first = choices.first().copied().unwrap_or_default();
        Self { label: label.to_owned(), hint: "← →".to_owned(), text: TextField::new(first), choices }
    }

    fn choose(&mut self, step: isize) {
        let at = self.choices.iter().position(|choice| *choice == self.text.value()).unwrap_or(0);
        let count = self.choices.len();
        if let Some(next) = self.choices.get((at + count).wrapping_add_signed(step) % count.max(1)) {
            self.text = TextField::new(*next);
        }
    }
}

/// An open form.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Form {
    /// The purpose of the form.
    pub kind: FormKind,
    /// The units of typed lengths and speeds.
    pub units: Units,
    pub fields: Vec<FormField>,
    /// The index of the field with the cursor.
    pub at: usize,
    /// The problem with the form, after the user tried to accept it.
    pub problem: Option<String>,
}

/// A click on a row of a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) struct FormClick {
    /// The index of the field.
    pub(in crate::ui) field: usize,
    /// The column in the value, from its first one on; `None` beside the value.
    pub(in crate::ui) column: Option<u16>,
    /// The columns of the value.
    pub(in crate::ui) width: u16,
}

/// The effect of a key on a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum FormKey {
    Edited,
    Accept,
    Cancel,
}

impl Form {
    pub(super) fn new(kind: FormKind, units: Units, fields: Vec<FormField>) -> Self {
        let mut form = Self { kind, units, fields, at: 0, problem: None };
        form.go_to(0);
        form
    }

    /// Moves the cursor to this field and selects its value.
    fn go_to(&mut self, at: usize) {
        if let Some(left) = self.fields.get_mut(self.at) {
            left.text.select(false);
        }
        self.at = at;
        if let Some(field) = self.fields.get_mut(at).filter(|field| field.choices.is_empty()) {
            field.text.select(true);
        }
    }

    /// Returns the text of the field with this label.
    pub fn value(&self, label: &str) -> &str {
        self.fields.iter().find(|field| field.label == label).map_or("", |field| field.text.value().trim())
    }

    /// Returns the number in the field with this label; `None` if it is empty.
    ///
    /// # Errors
    /// Returns a sentence if it is not a number.
    pub(super) fn number(&self, label: &str) -> Result<Option<f64>, String> {
        let text = self.value(label);
        if text.is_empty() {
            return Ok(None);
        }
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Some(value)),
            _ => Err(format!("{label}: {text} is not a number.")),
        }
    }

    /// Returns the length in the field with this label, m; `None` if it is empty.
    ///
    /// # Errors
    /// Returns a sentence if it is not a number.
    pub(super) fn metres(&self, label: &str) -> Result<Option<f64>, String> {
        Ok(self.number(label)?.map(|shown| self.units.metres(shown)))
    }

    /// Returns the speed in the field with this label, m/s; `None` if it is empty.
    ///
    /// # Errors
    /// Returns a sentence if it is not a number.
    pub(super) fn metres_per_second(&self, label: &str) -> Result<Option<f64>, String> {
        Ok(self.number(label)?.map(|shown| self.units.metres_per_second(shown)))
    }

    /// Returns the form of this kind for a document.
    pub(in crate::ui) fn of(kind: FormKind, document: &PlanDocument, units: Units) -> Self {
        match kind {
            FormKind::Bulk => forms::bulk(units),
            FormKind::Generate => forms::generate(document.plan.waypoints.is_empty(), units),
            FormKind::Properties => forms::properties(document, units),
        }
    }

    /// Sets the value of a field.
    ///
    /// # Errors
    /// Returns a sentence with the words of a choice if the value is not among them.
    pub(in crate::ui) fn set(&mut self, at: usize, value: &str) -> Result<(), String> {
        let Some(field) = self.fields.get_mut(at) else { return Ok(()) };
        if !field.choices.is_empty() && !field.choices.contains(&value) {
            return Err(format!("{}: choose {}.", field.label, field.choices.join(", ")));
        }
        field.text = TextField::new(value);
        self.problem = None;
        Ok(())
    }

    /// Returns `true` if the generated waypoints are appended to the existing ones.
    pub(super) fn appends(&self) -> bool {
        self.value("result").starts_with("append")
    }

    pub(in crate::ui) fn key(&mut self, event: KeyEvent) -> FormKey {
        let last = self.fields.len().saturating_sub(1);
        let is_choice = self.fields.get(self.at).is_some_and(|field| !field.choices.is_empty());
        self.problem = None;
        match event.code {
            KeyCode::Esc => return FormKey::Cancel,
            KeyCode::Enter => return FormKey::Accept,
            KeyCode::Up | KeyCode::BackTab => self.go_to(self.at.checked_sub(1).unwrap_or(last)),
            KeyCode::Down | KeyCode::Tab => self.go_to(if self.at == last { 0 } else { self.at + 1 }),
            KeyCode::Left if is_choice => self.choose(-1),
            KeyCode::Right | KeyCode::Char(' ') if is_choice => self.choose(1),
            _ if is_choice => {}
            _ => {
                if let Some(field) = self.fields.get_mut(self.at) {
                    field.text.key(event);
                }
            }
        }
        FormKey::Edited
    }

    /// Handles a click: the first one selects the field. A click on the selected one puts the cursor into its value or
    /// takes its next choice. A click on an arrow of a choice takes the choice on that side.
    pub(in crate::ui) fn click(&mut self, click: FormClick) {
        let was_selected = self.at == click.field;
        self.problem = None;
        if !was_selected {
            self.go_to(click.field);
        }
        let Some(field) = self.fields.get_mut(click.field) else { return };
        if field.choices.is_empty() {
            if let Some(column) = click.column.filter(|_| was_selected) {
                field.text.click(column, click.width);
            }
            return;
        }
        // `◂ word ▸`
        let last = field.text.value().chars().count() as u16 + 3;
        match click.column {
            Some(0) => field.choose(-1),
            Some(column) if column == last => field.choose(1),
            _ if was_selected => field.choose(1),
            _ => {}
        }
    }

    /// Inserts pasted text into the field with the cursor. Returns `true` if that field takes typed text.
    pub(super) fn paste(&mut self, text: &str) -> bool {
        let typed = self.fields.get_mut(self.at).filter(|field| field.choices.is_empty());
        if let Some(field) = typed {
            field.text.insert(text);
            self.problem = None;
            return true;
        }
        false
    }

    fn choose(&mut self, step: isize) {
        if let Some(field) = self.fields.get_mut(self.at) {
            field.choose(step);
        }
    }
}
