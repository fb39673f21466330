//! The plan editor: the open plans, the cursor in the waypoint table, and the value being typed.
//!
//! Every edit is one revision of a plan's history and one line of its journal. Requests to keep or write something
//! leave as [`Effect::Files`].

mod browser;
mod clipboard;
pub(in crate::ui) mod column;
mod form;
mod form_edits;
mod forms;
mod open_plan;
mod plans;
mod popup;
mod question;
pub(in crate::ui) mod zones;

pub use browser::{Browser, Purpose};
pub(in crate::ui) use browser::{BrowserKey, BrowserPlace};
use clipboard::Pasted;
pub use column::Column;
pub use form::{Form, FormField, FormKind};
pub(in crate::ui) use form::{FormClick, FormKey};
use form_edits::GeneratorFoot;
pub use open_plan::OpenPlan;
pub use popup::{EditorPopup, LossList};
pub use question::Question;
use zones::ZoneReview;

use crate::plan::edit::PlanDocument;
use crate::plan::{Altitude, FlightPlan, MAX_WAYPOINTS, Waypoint};
use crate::ui::model::effect::Effect;
use crate::ui::model::files::FileRequest;
use crate::ui::model::plan_id::PlanId;
use crate::ui::text_field::TextField;
use crate::ui::units::Units;

/// The state of the plan editor.
#[derive(Debug)]
pub struct Editor {
    plans: Vec<OpenPlan>,
    current: usize,
    /// The number of plans made here so far.
    made: u32,
    row: usize,
    column: Column,
    anchor: Option<usize>,
    field: Option<CellField>,
    register: Vec<Waypoint>,
    /// The plan uploaded to the craft last.
    uploaded: Option<Uploaded>,
    /// The upload before the last one.
    uploaded_before: Option<Uploaded>,
    /// The plan whose upload is under way and after whose upload the pilot starts.
    pub(in crate::ui) fly_after_upload: Option<PlanId>,
    /// The sentence for the answer to the current upload, if that upload replaces the fence of the craft.
    pub(in crate::ui) replaced_fence: Option<String>,
    pub(in crate::ui) popup: Option<EditorPopup>,
    /// The waypoint whose altitude is dragged in the profile, and its current altitude, cm.
    pub(in crate::ui) dragged_altitude: Option<(usize, Altitude)>,
    /// `true` if the program ends as soon as every plan is saved or given up.
    pub(in crate::ui) quitting: bool,
    /// `true` while edits cannot be kept because their journal cannot be written.
    pub(in crate::ui) journal_fails: bool,
    /// `true` if the user wants no edits kept.
    pub(in crate::ui) keeps_nothing: bool,
    /// A plan whose file was read for a comparison, and the document in the file, or the reason why there is none.
    pub(in crate::ui) on_disk: Option<(PlanId, Result<Box<PlanDocument>, String>)>,
    /// The result that the open generator form would give.
    generator: Option<GeneratorFoot>,
    /// The findings about the zones of the backdrop.
    pub(in crate::ui) zones: ZoneReview,
}

/// A plan as it was uploaded to the craft.
#[derive(Debug)]
struct Uploaded {
    id: PlanId,
    plan: FlightPlan,
    settings: Vec<String>,
    /// The setting lines that the firmware refused, with its reason.
    refused: Vec<String>,
}

/// The cell being typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct CellField {
    pub(crate) text: TextField,
    /// The problem with the typed value.
    pub(crate) problem: Option<String>,
}

impl Editor {
    /// Returns an editor with one open plan.
    pub fn new(plan: OpenPlan) -> Self {
        Self {
            plans: vec![plan],
            current: 0,
            made: 0,
            row: 0,
            column: Column::default(),
            anchor: None,
            field: None,
            register: Vec::new(),
            uploaded: None,
            uploaded_before: None,
            fly_after_upload: None,
            replaced_fence: None,
            popup: None,
            dragged_altitude: None,
            quitting: false,
            journal_fails: false,
            keeps_nothing: false,
            on_disk: None,
            generator: None,
            zones: ZoneReview::default(),
        }
    }

    /// Returns `true` if edits are not kept, so that they are lost when the program is killed.
    pub(in crate::ui) fn loses_edits(&self) -> bool {
        self.journal_fails || self.keeps_nothing
    }

    /// Returns the shown plan.
    pub fn plan(&self) -> &OpenPlan {
        &self.plans[self.current.min(self.plans.len() - 1)]
    }

    fn plan_mut(&mut self) -> &mut OpenPlan {
        let current = self.current.min(self.plans.len() - 1);
        &mut self.plans[current]
    }

    /// Remembers the shown plan as the one being uploaded to the craft.
    pub(in crate::ui) fn remember_upload(&mut self) {
        let document = self.document();
        let (plan, settings) = (document.plan.clone(), document.settings.clone());
        let uploaded = Uploaded { id: self.plan().id(), plan, settings, refused: Vec::new() };
        self.uploaded_before = self.uploaded.replace(uploaded);
    }

    /// Forgets an upload that failed: the craft has what it had before.
    pub(in crate::ui) fn forget_upload(&mut self, id: PlanId) {
        if self.uploaded.as_ref().is_some_and(|uploaded| uploaded.id == id) {
            self.uploaded = self.uploaded_before.take();
        }
    }

    /// Remembers the settings of the plan uploaded last that the firmware refused.
    pub(in crate::ui) fn remember_refused(&mut self, id: PlanId, refused: Vec<String>) {
        if let Some(uploaded) = self.uploaded.as_mut().filter(|uploaded| uploaded.id == id) {
            uploaded.refused = refused;
        }
    }

    /// Returns the settings that the firmware refused when this editor uploaded this plan.
    pub(in crate::ui) fn refused_settings(&self, plan: &FlightPlan) -> &[String] {
        let uploaded = self.uploaded.as_ref().filter(|uploaded| uploaded.plan == *plan);
        uploaded.map_or(&[], |uploaded| &uploaded.refused)
    }

    /// Returns `true` if this editor uploaded this plan to the craft.
    pub(in crate::ui) fn has_uploaded(&self, plan: &FlightPlan) -> bool {
        self.uploaded.as_ref().is_some_and(|uploaded| uploaded.plan == *plan)
    }

    /// Returns the settings that this editor uploaded with a plan; `None` if it uploaded another one last.
    pub(in crate::ui) fn uploaded_settings(&self, plan: &FlightPlan) -> Option<&[String]> {
        let uploaded = self.uploaded.as_ref().filter(|uploaded| uploaded.plan == *plan)?;
        Some(&uploaded.settings)
    }

    /// Returns the plan uploaded to the craft last.
    pub(in crate::ui) fn uploaded_last(&self) -> Option<PlanId> {
        self.uploaded.as_ref().map(|uploaded| uploaded.id)
    }

    pub fn plans(&self) -> &[OpenPlan] {
        &self.plans
    }

    /// Returns the index of the shown plan.
    pub fn current(&self) -> usize {
        self.current
    }

    /// Returns the shown document.
    pub fn document(&self) -> &PlanDocument {
        self.plan().document()
    }

    /// Returns the index of the waypoint under the cursor; 0 for an empty plan.
    pub fn row(&self) -> usize {
        self.row.min(self.document().plan.waypoints.len().saturating_sub(1))
    }

    /// Returns the column under the cursor.
    pub fn column(&self) -> Column {
        self.column
    }

    /// Returns the selected waypoints, while there is a selection.
    pub fn selection(&self) -> Option<std::ops::RangeInclusive<usize>> {
        let anchor = self.anchor?.min(self.document().plan.waypoints.len().saturating_sub(1));
        Some(anchor.min(self.row())..=anchor.max(self.row()))
    }

    /// Returns the selected waypoints, else the one under the cursor.
    fn selected(&self) -> std::ops::RangeInclusive<usize> {
        self.selection().unwrap_or_else(|| self.row()..=self.row())
    }

    /// Returns the cell being typed.
    pub(crate) fn field(&self) -> Option<&CellField> {
        self.field.as_ref()
    }

    /// Returns `true` if letters are text here.
    pub fn takes_text(&self) -> bool {
        self.field.is_some() || self.popup.is_some()
    }

    /// The waypoint whose altitude is dragged in the profile, and its current altitude, cm.
    pub(crate) fn dragged_altitude(&self) -> Option<(usize, Altitude)> {
        self.dragged_altitude
    }

    /// Puts the cursor on a value.
    pub(in crate::ui) fn go_to_cell(&mut self, row: usize, column: Column) {
        self.row = row;
        self.column = column;
        self.anchor = None;
        self.field = None;
    }

    /// Moves the cursor, unless a value is being typed.
    pub(in crate::ui) fn move_cursor(&mut self, rows: isize, columns: isize) {
        if self.field.is_some() {
            return;
        }
        let last = self.document().plan.waypoints.len().saturating_sub(1);
        self.row = self.row().saturating_add_signed(rows).min(last);
        self.column = self.column.beside(columns);
    }

    /// Puts the cursor on a waypoint.
    pub(in crate::ui) fn go_to_row(&mut self, row: usize) {
        self.row = row;
        self.field = None;
    }

    /// Begins or ends a selection at the cursor.
    pub(in crate::ui) fn toggle_selection(&mut self) {
        self.anchor = if self.anchor.is_some() { None } else { Some(self.row()) };
    }

    pub(in crate::ui) fn select_all(&mut self) {
        self.anchor = Some(0);
        self.row = self.document().plan.waypoints.len().saturating_sub(1);
    }

    /// Ends selection and typing. Returns `true` if there was any.
    pub(in crate::ui) fn cancel(&mut self) -> bool {
        let field = self.field.take().is_some();
        let popup = self.popup.take().is_some();
        self.quitting = false;
        field || popup || self.anchor.take().is_some()
    }

    /// Makes an edit as one revision. Does nothing if the edit changes nothing.
    pub(in crate::ui) fn edit(&mut self, label: &str, change: impl FnOnce(&mut PlanDocument)) -> Vec<Effect> {
        let mut after = self.document().clone();
        change(&mut after);
        self.replace_document(label, after)
    }

    /// Replaces the document by `after`, as one revision. Discards the value being typed, because its row may hold
    /// another waypoint now.
    pub(in crate::ui) fn replace_document(&mut self, label: &str, after: PlanDocument) -> Vec<Effect> {
        self.field = None;
        let plan = self.plan_mut();
        let id = plan.id();
        let line = plan.commit(label, after);
        line.map(|line| Effect::Files(FileRequest::Journal(id, line))).into_iter().collect()
    }

    /// Undoes the last edit. Returns its label.
    pub(in crate::ui) fn undo(&mut self) -> Option<(String, Effect)> {
        let id = self.plan().id();
        let (label, line) = self.plan_mut().undo()?;
        self.field = None;
        Some((label, Effect::Files(FileRequest::Journal(id, line))))
    }

    /// Redoes the edit that was undone last.
    pub(in crate::ui) fn redo(&mut self) -> Option<(String, Effect)> {
        let id = self.plan().id();
        let (label, line) = self.plan_mut().redo()?;
        self.field = None;
        Some((label, Effect::Files(FileRequest::Journal(id, line))))
    }

    /// Goes to the revision made before the shown one, or after it, in any branch.
    pub(in crate::ui) fn go_in_time(&mut self, later: bool) -> Option<Effect> {
        let id = self.plan().id();
        let line = self.plan_mut().go_in_time(later)?;
        self.field = None;
        self.anchor = None;
        Some(Effect::Files(FileRequest::Journal(id, line)))
    }

    /// Inserts waypoints after the cursor and selects them.
    pub(in crate::ui) fn insert(
        &mut self,
        label: &str,
        waypoints: &[Waypoint],
    ) -> Result<Vec<Effect>, String> {
        let have = self.document().plan.waypoints.len();
        if have + waypoints.len() > MAX_WAYPOINTS {
            return Err(format!(
                "A plan holds {MAX_WAYPOINTS} waypoints: there are {have}, so {} more do not fit.",
                waypoints.len()
            ));
        }
        let at = if have == 0 { 0 } else { self.row() + 1 };
        let mut after = self.document().clone();
        let tail: Vec<Waypoint> = after.plan.waypoints.drain(at..).collect();
        after.plan.waypoints.extend(waypoints.iter().copied());
        after.plan.waypoints.extend(tail);
        let effects = self.replace_document(label, after);
        self.anchor = None;
        self.row = at + waypoints.len().saturating_sub(1);
        Ok(effects)
    }

    /// Deletes the selected waypoints.
    pub(in crate::ui) fn delete(&mut self) -> Vec<Effect> {
        let selected = self.selected();
        let label = match selected.clone().count() {
            1 => format!("delete WP{}", selected.start()),
            count => format!("delete {count} waypoints"),
        };
        let effects = self.edit(&label, |document| {
            let end = document.plan.waypoints.len().min(selected.end() + 1);
            document.plan.waypoints.drain(*selected.start().min(&end)..end);
        });
        self.anchor = None;
        self.row = *selected.start();
        effects
    }

    /// Moves the selected waypoints up or down in the order of flight.
    pub(in crate::ui) fn move_waypoints(&mut self, down: bool) -> Vec<Effect> {
        let selected = self.selected();
        let last = self.document().plan.waypoints.len().saturating_sub(1);
        if if down { *selected.end() >= last } else { *selected.start() == 0 } {
            return Vec::new();
        }
        let effects = self.edit("move in order", |document| {
            let waypoints = &mut document.plan.waypoints;
            if down {
                waypoints[*selected.start()..=selected.end() + 1].rotate_right(1);
            } else {
                waypoints[selected.start() - 1..=*selected.end()].rotate_left(1);
            }
        });
        let step = if down { 1 } else { -1 };
        self.row = self.row().saturating_add_signed(step);
        self.anchor = self.anchor.map(|anchor| anchor.saturating_add_signed(step));
        effects
    }

    /// Changes the value under the cursor in all selected waypoints that use it.
    pub(in crate::ui) fn nudge(&mut self, steps: i32, units: Units) -> Vec<Effect> {
        let (column, selected) = (self.column, self.selected());
        self.edit(&format!("{} of {}", column.name(), which(&selected)), |document| {
            for index in selected {
                if let Some(wp) = document.plan.waypoints.get_mut(index).filter(|wp| column.is_used(wp.kind))
                {
                    column.nudge(wp, steps, units);
                }
            }
        })
    }

    /// Begins typing the value under the cursor.
    ///
    /// # Errors
    /// Returns a sentence if the waypoint has no such value.
    pub(in crate::ui) fn begin_typing(&mut self, units: Units) -> Result<(), String> {
        let Some(wp) = self.document().plan.waypoints.get(self.row()) else {
            return Err("There is no waypoint to edit.".to_owned());
        };
        if !self.column.is_used(wp.kind) {
            return Err(format!("A {} has no {}.", wp.kind, self.column.name()));
        }
        self.field =
            Some(CellField { text: TextField::selected(self.column.text(wp, units)), problem: None });
        Ok(())
    }

    /// Returns the cell being typed, to pass keys to it.
    pub(in crate::ui) fn field_mut(&mut self) -> Option<&mut CellField> {
        self.field.as_mut()
    }

    /// Sets the typed value in all selected waypoints that use it. A wrong value stays in the field with its problem.
    pub(in crate::ui) fn end_typing(&mut self, units: Units) -> Vec<Effect> {
        let Some(mut field) = self.field.take() else { return Vec::new() };
        let (column, selected) = (self.column, self.selected());
        let mut after = self.document().clone();
        for index in selected.clone() {
            let Some(wp) = after.plan.waypoints.get_mut(index) else { continue };
            if !column.is_used(wp.kind) {
                continue;
            }
            if let Err(problem) = column.set(wp, field.text.value(), units) {
                field.problem = Some(problem);
                self.field = Some(field);
                return Vec::new();
            }
        }
        self.replace_document(&format!("{} of {}", column.name(), which(&selected)), after)
    }

    /// Copies the selected waypoints. Returns their number and their CLI lines.
    pub(in crate::ui) fn copy(&mut self) -> Option<(usize, String)> {
        let waypoints = self.document().plan.waypoints.get(self.selected())?.to_vec();
        let text = clipboard::to_text(&waypoints);
        let count = waypoints.len();
        self.register = waypoints;
        self.anchor = None;
        (count > 0).then_some((count, text))
    }

    /// Returns `true` if waypoints were copied.
    pub(in crate::ui) fn has_copy(&self) -> bool {
        !self.register.is_empty()
    }

    /// Inserts the waypoints copied last.
    pub(in crate::ui) fn paste_copied(&mut self) -> Result<Vec<Effect>, String> {
        let waypoints = self.register.clone();
        self.insert("paste", &waypoints)
    }

    /// Inserts the waypoints of a pasted text; a text with `waypoint clear` replaces those of the plan.
    pub(in crate::ui) fn paste_text(&mut self, text: &str) -> Result<(Pasted, Vec<Effect>), String> {
        let pasted = clipboard::from_text(text)?;
        let effects = if pasted.replaces {
            self.anchor = None;
            self.row = 0;
            self.edit("paste", |document| document.plan = pasted.file.plan.clone())
        } else {
            self.insert("paste", &pasted.file.plan.waypoints)?
        };
        Ok((pasted, effects))
    }
}

/// Returns `WP3` or `WP1…3`.
fn which(selected: &std::ops::RangeInclusive<usize>) -> String {
    if selected.start() == selected.end() {
        format!("WP{}", selected.start())
    } else {
        format!("WP{}…{}", selected.start(), selected.end())
    }
}
