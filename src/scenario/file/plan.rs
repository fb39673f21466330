//! `[plan]`: a built-in plan, a file, or waypoint lines.

use super::keys::PLAN_KEYS;
use super::reader::{Layers, Reader};
use crate::plan::builtin::BuiltinPlan;
use crate::plan::format::{self, Format, PlanFile};
use crate::plan::review::Finding;
use crate::plan::validate::check_plan;

/// The number of words of a waypoint line without its index.
const WORDS: usize = 7;

/// Reads the plan of a case.
pub(super) fn read(layers: &Layers<'_, '_>, reader: &mut Reader<'_, '_>) -> PlanFile {
    let tables = layers.tables("plan", reader);
    let Some(table) = tables.last() else {
        reader.problem(0..0, "the scenario has no plan", "add [plan] with builtin, file or waypoints");
        return PlanFile::default();
    };
    for table in &tables {
        reader.refuse_unknown(table, PLAN_KEYS);
    }
    let given: Vec<&str> = PLAN_KEYS.iter().copied().filter(|key| table.get(key).is_some()).collect();
    let [key] = given.as_slice() else {
        reader.problem(table.span(), "a plan has one of builtin, file and waypoints", "");
        return PlanFile::default();
    };
    let Some(value) = table.get(key) else { return PlanFile::default() };
    let plan = match *key {
        "waypoints" => {
            let lines = reader.texts(table, key).unwrap_or_default();
            read_lines(&lines, reader)
        }
        _ => {
            let Some(name) = reader.text(value) else { return PlanFile::default() };
            let found = match (*key, BuiltinPlan::find(&name)) {
                ("builtin", None) => {
                    let guess = BuiltinPlan::suggest(&name);
                    let guess = guess.map_or_else(String::new, |word| format!("; did you mean {word}?"));
                    Err(format!("there is no built-in plan {name}{guess}"))
                }
                ("builtin", Some(_)) => reader.plan_file(&name),
                _ => reader.plan_from_file(&name).and_then(|plan| match plan.plan.waypoints.is_empty() {
                    true => Err(format!("{name} has no waypoints: name a plan, or write the waypoints here")),
                    false => Ok(plan),
                }),
            };
            found.unwrap_or_else(|problem| {
                reader.problem(value.span(), problem, "");
                PlanFile::default()
            })
        }
    };
    if !plan.plan.waypoints.is_empty()
        && let Err(fault) = check_plan(&plan.plan)
    {
        reader.problem(value.span(), Finding::Fault(fault).to_string(), "the craft refuses such a plan");
    }
    plan
}

/// Reads waypoints in the form of the arguments of `waypoint insert`, with or without the index.
fn read_lines(lines: &[(String, std::ops::Range<usize>)], reader: &mut Reader<'_, '_>) -> PlanFile {
    let mut plan = PlanFile::default();
    for (index, (line, span)) in lines.iter().enumerate() {
        let indexed = line.split_whitespace().count() > WORDS;
        let values = if indexed {
            line.trim().split_once(' ').map_or("", |(_, values)| values)
        } else {
            line.as_str()
        };
        match format::parse("waypoint", &format!("waypoint insert 0 {values}"), Format::CliText) {
            Ok(one) => {
                let full = one
                    .plan
                    .waypoints
                    .into_iter()
                    .any(|waypoint| plan.plan.waypoints.try_push(waypoint).is_err());
                if full {
                    reader.problem(
                        span.clone(),
                        format!("waypoint {index} does not fit"),
                        "a plan holds at most 30",
                    );
                    break;
                }
            }
            Err(errors) => {
                for error in errors {
                    reader.problem(span.clone(), error.message, error.hint);
                }
            }
        }
    }
    plan
}
