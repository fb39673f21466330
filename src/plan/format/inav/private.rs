//! The private data of an INAV file: the whole plan in the project's own format, in comments. They are used only if
//! the items of the file are still those of that plan.

use super::super::{HomePosition, MAX_TOML, PlanFile, Problems, ReadOptions, native_read, native_write};
use super::{Form, Item, as_place, from_plan};
use crate::geo::LatLon;

/// The first words of the comment, with the version of the data.
pub(super) const MARK: &str = "betadeck 1";

/// Returns the private data of a plan; `None` if they are too large to be read.
pub(super) fn text(file: &PlanFile) -> Option<String> {
    let text = native_write::write(file).text().into_owned();
    (text.len() <= MAX_TOML).then_some(text)
}

/// The private data that are still right.
#[derive(Debug)]
pub(super) struct Restored {
    pub(super) file: PlanFile,
    /// The items of the file are those of the plan.
    pub(super) has_plan: bool,
}

/// Reads private data. `items` and `home` are the public contents of the file.
///
/// # Errors
///
/// Returns the reason to drop them.
pub(super) fn restore(
    text: &str,
    items: &[Item],
    home: Option<LatLon>,
    form: Form,
    options: &ReadOptions,
) -> Result<Restored, &'static str> {
    if text.len() > MAX_TOML {
        return Err("they are too large for a plan and are not used");
    }
    let mut problems = Problems::new("private data", text);
    let mut file = native_read::read(text, options, &mut problems);
    if !problems.is_empty() {
        return Err("they cannot be read and are not used");
    }
    let ours = from_plan::items(&file, form);
    let has_plan = !ours.is_refused() && ours.items == items;
    if form.has_home && file.home.map(|home| as_place(home.position)) != home {
        file.home = home.map(|position| HomePosition { position, amsl_m: None });
    }
    Ok(Restored { file, has_plan })
}

/// The reason to drop the plan of items that another program edited.
pub(super) const EDITED: &str =
    "another program edited the items, so the waypoints are those of the items alone";
