//! The plan that was shown last.

use crate::args::PlanArg;
use crate::headless::setup;
use crate::plan::format::{HomePosition, PlanFile};
use crate::process::error::AppError;
use crate::ui::KeptScreen;

/// Reads the plan that was shown last, or one that was open beside it. A plan that cannot be read is a sentence for
/// `notices`.
pub(super) fn read(
    kept: Option<&KeptScreen>,
    home: Option<HomePosition>,
    notices: &mut Vec<String>,
) -> Option<(PlanArg, PlanFile)> {
    let shown = kept.and_then(KeptScreen::shown_plan)?;
    let others = kept.into_iter().flat_map(KeptScreen::plans).filter(|path| path.exists());
    for path in std::iter::once(shown).chain(others) {
        let plan = PlanArg::File(path.to_owned(), None);
        match setup::read_plan(&plan, home) {
            Ok(file) => return Some((plan, file)),
            Err(AppError { message, .. }) => {
                let why = message.lines().next().unwrap_or_default();
                notices.push(format!("The plan of the last run is not open: {}.", why.trim_end_matches('.')));
            }
        }
    }
    None
}
