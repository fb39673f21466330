//! The files under each plan on the map, remembered in the state directory by the file of the plan.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::storage::state_file;

/// The name of the file.
const NAME: &str = "backdrops.json";
/// The largest file, bytes.
const LARGEST: u64 = 1 << 20;
/// The most plans that are remembered, and the most files of one.
const MAX_PLANS: usize = 200;
const MAX_FILES: usize = 20;

/// The files under one plan.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Remembered {
    plan: PathBuf,
    files: Vec<PathBuf>,
}

/// The memory of all plans.
#[derive(Debug)]
pub(super) struct Backdrops {
    file: Option<PathBuf>,
}

impl Backdrops {
    /// Remembers in the state directory; `None` remembers nothing.
    pub(super) fn new(state: Option<&Path>) -> Self {
        Self { file: state.map(|state| state.join(NAME)) }
    }

    /// Returns the files under a plan.
    pub(super) fn of(&self, plan: &Path) -> Vec<PathBuf> {
        let mut files =
            self.read().into_iter().rfind(|kept| kept.plan == plan).map_or(Vec::new(), |kept| kept.files);
        files.truncate(MAX_FILES);
        files
    }

    /// Remembers the files under a plan; none forgets the plan. If this fails, they are forgotten at the end of the
    /// program, as the entered lines are.
    pub(super) fn keep(&self, plan: &Path, files: Vec<PathBuf>) {
        let Some(file) = &self.file else { return };
        // Read again, because another program may have written it.
        let mut all = self.read();
        all.retain(|kept| kept.plan != plan);
        if !files.is_empty() {
            all.push(Remembered { plan: plan.to_owned(), files });
        }
        let oldest = all.len().saturating_sub(MAX_PLANS);
        all.drain(..oldest);
        if let Ok(text) = serde_json::to_vec_pretty(&all) {
            state_file::replace(file, &text).ok();
        }
    }

    fn read(&self) -> Vec<Remembered> {
        let Some(file) = &self.file else { return Vec::new() };
        let Ok(Some(text)) = state_file::read(file, LARGEST) else { return Vec::new() };
        serde_json::from_slice(&text).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_remembered_by_plan_and_forgotten() {
        let state = tempfile::tempdir().expect("a directory");
        let backdrops = Backdrops::new(Some(state.path()));
        let (field, town) = (Path::new("/plans/field.toml"), Path::new("/plans/town.plan"));
        assert!(backdrops.of(field).is_empty());
        backdrops.keep(field, vec!["/maps/field.kml".into()]);
        backdrops.keep(town, vec!["/maps/roads.geojson".into(), "/maps/zones.kmz".into()]);
        let again = Backdrops::new(Some(state.path()));
        assert_eq!(again.of(field), [PathBuf::from("/maps/field.kml")]);
        again.keep(field, Vec::new());
        assert!(backdrops.of(field).is_empty());
        assert_eq!(backdrops.of(town).len(), 2);
        for number in 0..MAX_PLANS {
            backdrops.keep(&PathBuf::from(format!("/plans/{number}.toml")), vec!["/maps/a.kml".into()]);
        }
        assert!(backdrops.of(town).is_empty(), "the oldest is forgotten first");
        std::fs::write(state.path().join(NAME), "{ not json").expect("written");
        assert!(backdrops.of(field).is_empty());
        Backdrops::new(None).keep(field, vec!["/maps/field.kml".into()]);
    }
}
