//! The open plan, or the settings of the craft, beside another version of them, row by row.

mod rows;

use crate::plan::FlightPlan;
use crate::ui::model::action::{Action, EditAction, PanelAction};
use crate::ui::model::settings::comparison::Comparison;
use crate::ui::shared::Shared;

/// The name of the open plan as it is now.
const THIS: &str = "this plan";

/// The other version.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Against {
    /// The plan that the craft stores.
    Craft,
    /// The file of the plan as it is on disk now.
    File,
    /// A revision of the plan.
    Revision(usize),
    /// Other values of the settings of the craft.
    Settings(Comparison),
}

/// The state of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::ui) enum Mark {
    Same,
    /// Both versions have it, with different values.
    Changed,
    /// Only the current version has it.
    Added,
    /// Only the other version has it.
    Removed,
}

/// A row: the same thing in both versions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) struct DiffRow {
    pub(in crate::ui) mark: Mark,
    pub(in crate::ui) label: String,
    /// The value in the other version.
    pub(in crate::ui) other: String,
    /// The value in the current version.
    pub(in crate::ui) current: String,
    /// The waypoint of the current version, for a row about one.
    pub(in crate::ui) waypoint: Option<usize>,
    /// `true` for a value of the row before it.
    pub(in crate::ui) is_part: bool,
}

/// Two versions beside each other.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::ui) struct Diff {
    /// The name of the other version.
    pub(in crate::ui) other: String,
    /// The edit that made the other version; empty if there is none.
    pub(in crate::ui) label: String,
    /// The name of the current version.
    pub(in crate::ui) current: String,
    pub(in crate::ui) rows: Vec<DiffRow>,
    /// The other plan, for the map; `None` if settings are compared.
    pub(in crate::ui) plan: Option<FlightPlan>,
}

impl Diff {
    /// Compares with another version.
    ///
    /// # Errors
    /// Returns the reason why it cannot be compared, a sentence.
    pub(in crate::ui) fn of(state: &Shared, against: Against) -> Result<Self, String> {
        let open = state.editor.plan();
        let history = open.history();
        match against {
            Against::Craft => {
                let stored = state.view.vehicle.stored_plan.as_ref().ok_or_else(|| {
                    let key = state.key(Action::Edit(EditAction::Download));
                    format!("The plan of the craft is not known: `{key}` reads it.")
                })?;
                let mut rows = rows::of_plans(stored, state.plan(), state.units);
                rows.extend(rows::of_plan_settings(state));
                let plan = Some(stored.clone());
                Ok(Self {
                    other: "craft".to_owned(),
                    label: String::new(),
                    current: THIS.to_owned(),
                    rows,
                    plan,
                })
            }
            Against::File => {
                if open.file().is_none() {
                    return Err("This plan has no file yet.".to_owned());
                }
                let on_disk = state.editor.on_disk.as_ref().filter(|(id, _)| *id == open.id());
                let (_, read) = on_disk.ok_or_else(|| "Reading the file …".to_owned())?;
                let document = read.as_ref().map_err(Clone::clone)?;
                let rows = rows::of_documents(document, open.document(), state.units);
                let plan = Some(document.plan.clone());
                Ok(Self {
                    other: "file".to_owned(),
                    label: String::new(),
                    current: THIS.to_owned(),
                    rows,
                    plan,
                })
            }
            Against::Revision(revision) => {
                let document = history.document_at(revision).ok_or("There is no such revision.")?;
                let rows = rows::of_documents(&document, open.document(), state.units);
                let label = history.label(revision).unwrap_or("as opened").to_owned();
                let other = format!("revision {revision}");
                Ok(Self { other, label, current: THIS.to_owned(), rows, plan: Some(document.plan) })
            }
            Against::Settings(comparison) => {
                let key = || state.key(Action::Panel(PanelAction::ReadSettings));
                let craft = state.settings.craft().ok_or_else(|| match state.settings.refusal() {
                    Some(refusal) => refusal.to_owned(),
                    None if state.settings.is_reading() => "Reading the settings …".to_owned(),
                    None => format!("The settings of the craft were not read yet: `{}` reads them.", key()),
                })?;
                let rows = rows::of_settings(state, &craft.all, comparison);
                let other = comparison.name(state).to_owned();
                Ok(Self { other, label: String::new(), current: "craft".to_owned(), rows, plan: None })
            }
        }
    }

    /// Returns the number of differing waypoints, texts and settings, in words that fit into so many columns.
    pub(in crate::ui) fn summary(&self, columns: usize) -> String {
        let count = |mark| self.rows.iter().filter(|row| !row.is_part && row.mark == mark).count();
        let all = [Mark::Changed, Mark::Added, Mark::Removed, Mark::Same].map(|mark| (mark, count(mark)));
        if self.rows.iter().all(|row| row.mark == Mark::Same) {
            return format!("No difference in {} rows.", count(Mark::Same));
        }
        let texts = |words: [&str; 4]| {
            let shown = std::iter::zip(all, words).filter(|((_, count), _)| *count > 0);
            let texts = shown.map(|((mark, count), words)| format!("{} {count} {words}", mark.symbol()));
            texts.collect::<Vec<_>>().join("   ")
        };
        let only = |name: &str| format!("only in {name}");
        let long = texts(["changed", &only(&self.current), &only(&self.other), "the same"]);
        if long.chars().count() <= columns {
            return long;
        }
        texts(["changed", &self.current, &self.other, "same"])
    }
}

impl Mark {
    /// Returns the character of the mark.
    pub(in crate::ui) fn symbol(self) -> char {
        match self {
            Self::Same => '=',
            Self::Changed => '≠',
            Self::Added => '+',
            Self::Removed => '-',
        }
    }
}

/// Returns the comparisons that are possible now, in the order of their tabs.
pub(in crate::ui) fn possible(state: &Shared) -> Vec<Against> {
    let plan = state.editor.plan();
    let file = plan.file().map(|_| Against::File);
    let revision = other_revision(state, plan.history().at(), false).map(Against::Revision);
    let settings = Some(Against::Settings(Comparison::Defaults));
    [Some(Against::Craft), file, revision, settings].into_iter().flatten().collect()
}

/// Returns the comparison to begin with: what the title of the plan warns about, else the last edit.
pub(in crate::ui) fn most_useful(state: &Shared) -> Against {
    let plan = state.editor.plan();
    let stored = state.view.vehicle.stored_plan.as_ref();
    let is_other =
        stored.is_some_and(|stored| !stored.waypoints.is_empty() && *stored != plan.document().plan);
    match other_revision(state, plan.history().at(), false) {
        _ if plan.is_changed_on_disk() => Against::File,
        _ if is_other => Against::Craft,
        Some(revision) => Against::Revision(revision),
        None => Against::Craft,
    }
}

/// Returns the next revision before a revision, or after it, that is not the current one. From the first one it goes on
/// to a later one.
pub(in crate::ui) fn other_revision(state: &Shared, from: usize, later: bool) -> Option<usize> {
    let history = state.editor.plan().history();
    let is_other = |revision: &usize| *revision != history.at();
    let after = || (from + 1..=history.len()).find(is_other);
    if later { after() } else { (0..from).rev().find(is_other).or_else(after) }
}
