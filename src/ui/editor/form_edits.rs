//! What the forms do to the open plans.

use super::{Editor, Form, FormKind, forms, which};
use crate::geo::LatLon;
use crate::plan::MAX_WAYPOINTS;
use crate::plan::edit::PlanDocument;
use crate::plan::edit::transform::middle;
use crate::plan::format::SettingCheck;
use crate::ui::message::Effect;

impl Editor {
    /// Does what the values of a form say; the sentence tells what was done.
    ///
    /// # Errors
    /// What is wrong with a value, as a sentence.
    pub(in crate::ui) fn take_form(
        &mut self,
        form: &Form,
        home: Option<LatLon>,
        check: SettingCheck,
    ) -> Result<(Vec<Effect>, String), String> {
        let mut after = self.document().clone();
        match form.kind {
            FormKind::Bulk => {
                let selected = self.selected();
                let label = format!("change {}", which(&selected));
                forms::take_bulk(form, &mut after, selected)?;
                Ok((self.replace_document(&label, after), format!("Done: {label}.")))
            }
            FormKind::Properties => {
                forms::take_properties(form, &mut after, check)?;
                Ok((
                    self.replace_document("properties", after),
                    "Name, home and settings are taken.".to_owned(),
                ))
            }
            FormKind::Generate => {
                let generated = self.generated(form, home)?;
                let have = if form.appends() { after.plan.waypoints.len() } else { 0 };
                after.plan.waypoints.truncate(have);
                after
                    .plan
                    .waypoints
                    .extend(generated.plans.iter().flatten().take(MAX_WAYPOINTS - have).copied());
                let name = after.name.clone();
                let mut effects = self.replace_document("generate", after);
                let first = self.current;
                for (number, waypoints) in generated.plans.iter().enumerate().skip(1) {
                    let name = format!("{name}-{}", number + 1);
                    let empty = PlanDocument { name, ..PlanDocument::default() };
                    effects.push(self.open_new(empty.clone()));
                    // As an edit, so that it is kept and asked for.
                    let plan = forms::plan_of(waypoints);
                    effects.extend(self.replace_document("generate", PlanDocument { plan, ..empty }));
                }
                self.show(first);
                Ok((effects, generated.told))
            }
        }
    }

    /// What the generator's form would make now: about the middle of the plan, else about home.
    fn generated(&self, form: &Form, home: Option<LatLon>) -> Result<forms::Generated, String> {
        let waypoints = &self.document().plan.waypoints;
        let middle = middle(waypoints).or(home).ok_or("Home is not known yet: wait for the GPS fix.")?;
        forms::generated(form, middle, waypoints.len())
    }

    /// The line under a form: what it would make, or what is wrong.
    ///
    /// # Errors
    /// What is wrong with a value, as a sentence.
    pub(crate) fn form_told(&self, form: &Form, home: Option<LatLon>) -> Result<String, String> {
        match (&form.problem, form.kind) {
            (Some(problem), _) => Err(problem.clone()),
            (None, FormKind::Generate) => self.generated(form, home).map(|generated| generated.told),
            (None, FormKind::Bulk) => Ok(format!("{} · empty = as it is", which(&self.selected()))),
            (None, FormKind::Properties) => Ok(String::new()),
        }
    }
}
