//! Applies the forms to the open plans.

use super::{Editor, EditorPopup, Form, FormField, FormKind, forms, which};
use crate::geo::LatLon;
use crate::plan::edit::PlanDocument;
use crate::plan::edit::transform::middle;
use crate::plan::format::SettingCheck;
use crate::plan::{MAX_WAYPOINTS, Waypoint};
use crate::ui::model::effect::Effect;

/// The result that the generator form would give, and its input.
#[derive(Debug, PartialEq)]
pub(super) struct GeneratorFoot {
    fields: Vec<FormField>,
    middle: Option<LatLon>,
    /// The number of waypoints already in the plan.
    taken: usize,
    reported: Result<String, String>,
    /// The plans that it would give.
    plans: Vec<Vec<Waypoint>>,
    /// The number of the waypoint with which they begin.
    first: usize,
}

impl Editor {
    /// Runs the generator of an open form again if its values, the plan or home have changed.
    pub(in crate::ui) fn follow_generator(&mut self, home: Option<LatLon>) {
        let Some(EditorPopup::Form(form)) = self.popup.as_ref().filter(|popup| popup.generates()) else {
            self.generator = None;
            return;
        };
        let waypoints = &self.document().plan.waypoints;
        let (middle, taken) = (middle(waypoints).or(home), waypoints.len());
        let is_reported =
            |foot: &GeneratorFoot| foot.fields == form.fields && foot.middle == middle && foot.taken == taken;
        if self.generator.as_ref().is_some_and(is_reported) {
            return;
        }
        let (plans, reported) = match self.generated(form, home) {
            Ok(generated) => (generated.plans, Ok(generated.reported)),
            Err(problem) => (Vec::new(), Err(problem)),
        };
        let first = if form.appends() { taken } else { 0 };
        let fields = form.fields.clone();
        self.generator = Some(GeneratorFoot { fields, middle, taken, reported, plans, first });
    }

    /// Returns `true` while the form of the generator is open.
    pub(in crate::ui) fn is_generating(&self) -> bool {
        self.popup.as_ref().is_some_and(EditorPopup::generates)
    }

    /// Returns the plans that the open generator form would give, and the number of the first waypoint.
    pub(in crate::ui) fn preview(&self) -> Option<(&[Vec<Waypoint>], usize)> {
        let foot = self.generator.as_ref().filter(|_| self.is_generating())?;
        Some((&foot.plans, foot.first))
    }

    /// Applies the values of a form. Returns the effects and a sentence about the result.
    ///
    /// # Errors
    /// Returns the problem with a value, as a sentence.
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
                    "Name, home and settings are set.".to_owned(),
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
                    // As an edit, so that it is kept and the user is asked before it is lost.
                    let plan = forms::plan_of(waypoints);
                    effects.extend(self.replace_document("generate", PlanDocument { plan, ..empty }));
                }
                self.show(first);
                Ok((effects, generated.reported))
            }
        }
    }

    /// Returns the result that the generator form would give now, centred on the middle of the plan, else on home.
    fn generated(&self, form: &Form, home: Option<LatLon>) -> Result<forms::Generated, String> {
        let waypoints = &self.document().plan.waypoints;
        let middle = middle(waypoints).or(home).ok_or("Home is not known yet: wait for the GPS fix.")?;
        forms::generated(form, middle, waypoints.len())
    }

    /// Returns the line under a form: the result it would give, or the problem.
    ///
    /// # Errors
    /// Returns the problem with a value, as a sentence.
    pub(crate) fn form_reported(&self, form: &Form) -> Result<String, String> {
        match (&form.problem, form.kind) {
            (Some(problem), _) => Err(problem.clone()),
            (None, FormKind::Generate) => {
                self.generator.as_ref().map_or_else(|| Ok(String::new()), |foot| foot.reported.clone())
            }
            (None, FormKind::Bulk) => Ok(format!("{} · empty = as it is", which(&self.selected()))),
            (None, FormKind::Properties) => Ok(String::new()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::edit::History;
    use crate::ui::model::editor::OpenPlan;
    use crate::ui::model::plan_id::PlanId;
    use crate::ui::units::Units;

    #[test]
    fn the_generator_runs_when_something_changed_and_only_then() {
        let history = History::new(PlanDocument::default(), true);
        let mut editor = Editor::new(OpenPlan::new(PlanId(1), None, history));
        let form = Form::of(FormKind::Generate, editor.document(), Units::Metric);
        editor.popup = Some(EditorPopup::Form(form.clone()));
        editor.follow_generator(None);
        assert!(editor.form_reported(&form).unwrap_err().starts_with("Home is not known"));
        let home = Some(LatLon::new(404_635_000, -795_182_000));
        editor.follow_generator(home);
        let reported = editor.form_reported(&form).unwrap();
        assert!(reported.contains("waypoints"), "{reported}");

        editor.generator.as_mut().unwrap().reported = Ok("as it was".to_owned());
        editor.follow_generator(home);
        assert_eq!(editor.form_reported(&form).unwrap(), "as it was");
        let Some(EditorPopup::Form(open)) = &mut editor.popup else { unreachable!() };
        open.set(1, "123").unwrap();
        editor.follow_generator(home);
        assert_ne!(editor.form_reported(&form).unwrap(), "as it was");
        editor.popup = None;
        editor.follow_generator(home);
        assert_eq!(editor.generator, None);
    }
}
