//! The files that a campaign names, from the disk or from the file of a run.

use std::collections::BTreeMap;

use crate::files::input_file;
use crate::headless::scenario_folder;
use crate::headless::scenario_folder::ScenarioFolder;
use crate::plan::format::PlanFile;
use crate::process::error;
use crate::report::campaign::Contents;
use crate::scenario::{BuiltinFiles, Files};

/// The files of a campaign. Those that were read are kept for the file of the run.
#[derive(Debug, Default)]
pub(super) struct Sources {
    /// The place of the other files; `None` = there are no others.
    pub(super) place: Option<ScenarioFolder>,
    pub(super) contents: BTreeMap<String, Contents>,
}

impl Sources {
    fn bytes(&mut self, name: &str, is_plan: bool) -> Result<Vec<u8>, String> {
        if let Some(known) = self.contents.get(name) {
            return known.bytes().map_err(|problem| format!("{name}: {problem}"));
        }
        let bytes = match &self.place {
            None => BuiltinFiles.text(name)?.into_bytes(),
            Some(place) => {
                let path = place.path(name)?;
                let read = if is_plan {
                    input_file::read_plan(&path)
                } else {
                    input_file::read_small(&path).map(String::into_bytes)
                };
                read.map_err(|error| error.message)?
            }
        };
        self.contents.insert(name.to_owned(), Contents::new(&bytes));
        Ok(bytes)
    }
}

impl Files for Sources {
    fn plan(&mut self, name: &str) -> Result<PlanFile, String> {
        let is_new = !self.contents.contains_key(name);
        let contents = self.bytes(name, true)?;
        let (plan, findings) = scenario_folder::read_plan(name, &contents)?;
        if is_new {
            findings.iter().for_each(|found| error::tell(&format!("{name}: {found}")));
        }
        Ok(plan)
    }

    fn text(&mut self, name: &str) -> Result<String, String> {
        let bytes = self.bytes(name, false)?;
        String::from_utf8(bytes).map_err(|_| format!("{name} is not a text file (UTF-8)"))
    }
}
