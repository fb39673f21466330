//! The open plans: showing, opening, closing, saving.

use std::path::PathBuf;

use super::{Editor, OpenPlan};
use crate::plan::FlightPlan;
use crate::plan::edit::{History, PlanDocument};
use crate::ui::model::backdrop::BackdropLayer;
use crate::ui::model::effect::Effect;
use crate::ui::model::files::{FileRequest, Opened};
use crate::ui::model::plan_id::PlanId;

/// The first identifier of plans made here. Plans opened from files have lower ones.
const FIRST_NEW: u32 = 1 << 16;

impl Editor {
    /// Shows the next or the previous open plan.
    pub(in crate::ui) fn show_other(&mut self, step: isize) {
        let count = self.plans.len();
        self.show((self.current + count).wrapping_add_signed(step) % count);
    }

    pub(super) fn show(&mut self, index: usize) {
        self.current = index.min(self.plans.len() - 1);
        self.row = 0;
        self.anchor = None;
        self.field = None;
    }

    /// Returns the request to write a plan to a file.
    pub(in crate::ui) fn write(&self, id: PlanId, path: PathBuf, replace: bool, accepted: bool) -> Effect {
        let plan = self.plan_of(id).unwrap_or_else(|| self.plan());
        Effect::Files(FileRequest::Save {
            id,
            path,
            document: Box::new(plan.document().clone()),
            revision: plan.history().at(),
            replace,
            accepted,
        })
    }

    /// Opens a new plan with this document, under an identifier that no plan had before, so that replies still on their
    /// way to a closed plan do not reach it.
    pub(in crate::ui) fn open_new(&mut self, document: PlanDocument) -> Effect {
        let id = PlanId(FIRST_NEW + self.made);
        self.made += 1;
        let begin = FileRequest::Begin(id, Box::new(document.clone()));
        self.add(OpenPlan::new(id, None, History::new(document, false)));
        Effect::Files(begin)
    }

    /// Shows a plan that was read. It replaces an open plan with the same identifier.
    pub(in crate::ui) fn opened(&mut self, opened: Opened) {
        let mut plan = OpenPlan::new(opened.id, opened.file, opened.history);
        match self.plans.iter().position(|other| other.id() == plan.id()) {
            Some(index) => {
                *plan.backdrop_mut() = std::mem::take(self.plans[index].backdrop_mut());
                self.plans[index] = plan;
                self.show(index);
            }
            None => self.add(plan),
        }
    }

    fn add(&mut self, plan: OpenPlan) {
        self.plans.push(plan);
        self.show(self.plans.len() - 1);
    }

    /// Closes a plan. Closing the last one opens an empty one.
    pub(in crate::ui) fn close(&mut self, id: PlanId) -> Vec<Effect> {
        let discard = self.plan_of(id).is_some_and(OpenPlan::is_unsaved);
        let mut effects = vec![Effect::Files(FileRequest::Close { id, discard })];
        if self.plans.len() == 1 {
            effects.push(self.open_new(PlanDocument::default()));
        }
        self.plans.retain(|plan| plan.id() != id);
        self.show(self.current.saturating_sub(1));
        effects
    }

    /// Returns the open plan with this identifier.
    pub fn plan_of(&self, id: PlanId) -> Option<&OpenPlan> {
        self.plans.iter().find(|plan| plan.id() == id)
    }

    /// Shows the open plan with this identifier.
    pub(in crate::ui) fn show_plan(&mut self, id: PlanId) {
        if let Some(index) = self.plans.iter().position(|plan| plan.id() == id) {
            self.show(index);
        }
    }

    /// Replaces the waypoints of an open plan, shown or not, as one revision. Returns `None` if it was closed.
    pub(in crate::ui) fn replace_waypoints(
        &mut self,
        id: PlanId,
        label: &str,
        waypoints: FlightPlan,
    ) -> Option<Vec<Effect>> {
        if self.plan().id() == id {
            return Some(self.edit(label, |document| document.plan = waypoints));
        }
        let plan = self.plan_of_mut(id)?;
        let after = PlanDocument { plan: waypoints, ..plan.document().clone() };
        let line = plan.commit(label, after);
        Some(line.map(|line| Effect::Files(FileRequest::Journal(id, line))).into_iter().collect())
    }

    /// Records that a plan was written.
    pub(in crate::ui) fn saved(&mut self, id: PlanId, file: PathBuf, revision: usize) {
        if let Some(plan) = self.plan_of_mut(id) {
            plan.saved(file, revision);
        }
    }

    /// Records that somebody else changed the file of a plan. Returns the plan's title if it is open.
    pub(in crate::ui) fn changed_on_disk(&mut self, id: PlanId) -> Option<String> {
        let plan = self.plan_of_mut(id)?;
        plan.set_changed_on_disk(true);
        Some(plan.title())
    }

    /// Puts a file under a plan on the map, in place of one of the same name. Returns `false` if the plan was closed.
    pub(in crate::ui) fn add_backdrop(&mut self, id: PlanId, layer: BackdropLayer) -> bool {
        let Some(plan) = self.plan_of_mut(id) else { return false };
        let layers = plan.backdrop_mut();
        layers.retain(|other| other.path != layer.path);
        layers.push(layer);
        true
    }

    /// Removes the backdrop of the shown plan. Returns the request to forget it, if there was one.
    pub(in crate::ui) fn remove_backdrop(&mut self) -> Option<Effect> {
        let plan = self.plan_mut();
        let had = !std::mem::take(plan.backdrop_mut()).is_empty();
        had.then(|| Effect::Files(FileRequest::NoBackdrop(plan.id())))
    }

    fn plan_of_mut(&mut self, id: PlanId) -> Option<&mut OpenPlan> {
        self.plans.iter_mut().find(|plan| plan.id() == id)
    }
}
