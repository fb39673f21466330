//! The files that a scenario names. A scenario may come from somebody else, and its errors go into public logs: it names
//! files of its own folder only, and no error shows text of a file that is no plan.

use std::path::{Path, PathBuf};

use crate::flight::setup::check_setting;
use crate::plan::format::loss::Finding;
use crate::plan::format::{self, Format, PlanFile, ReadOptions};

/// The folder of a scenario, to which the names in it are relative.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScenarioFolder {
    pub(crate) folder: PathBuf,
    /// `true` if it may name files of other folders: by `--any-folder`, or because the user named them all.
    pub(crate) names_any: bool,
}

impl ScenarioFolder {
    /// Returns the folder of the file of a scenario.
    pub(crate) fn of(scenario: &Path, names_any: bool) -> Self {
        Self { folder: scenario.parent().map(Path::to_owned).unwrap_or_default(), names_any }
    }

    /// Returns the path of a file that the scenario names.
    ///
    /// # Errors
    /// Returns a sentence if the file is in another folder, also by a link.
    pub(crate) fn path(&self, name: &str) -> Result<PathBuf, String> {
        let path = self.folder.join(name);
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let is_inside = || {
            let folder = folder.canonicalize().ok()?;
            // The place of a file that does not exist is the nearest folder that does.
            let nearest = path.ancestors().find_map(|place| place.canonicalize().ok())?;
            Some(nearest.starts_with(folder))
        };
        if self.names_any || is_inside() == Some(true) {
            return Ok(path);
        }
        Err(format!(
            "{name} is not in the folder of the scenario: copy it there, or allow files of any folder with --any-folder"
        ))
    }
}

/// Reads the plan in a file that a scenario names, with the findings for the user.
///
/// # Errors
/// Returns a sentence without a part of the file if it is not recognised as a plan, else all problems of the plan.
pub(crate) fn read_plan(name: &str, contents: &[u8]) -> Result<(PlanFile, Vec<Finding>), String> {
    if !Format::is_recognised(contents) {
        let formats = Format::names(false);
        return Err(format!(
            "{name} is not recognised as a plan: is it the right file? The formats of plans are {formats}"
        ));
    }
    let (format, finding) = Format::detect(name, contents);
    let options = ReadOptions { check: check_setting, ..ReadOptions::default() };
    let plan = format::read(name, contents, format, &options)
        .map_err(|errors| format::report(&errors).trim_end().to_owned())?;
    let findings = finding.into_iter().chain(plan.losses.findings.iter().cloned()).collect();
    Ok((plan, findings))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_other_folders_need_the_option_also_behind_a_link_or_if_they_do_not_exist() {
        let outer = tempfile::tempdir().unwrap();
        let folder = outer.path().join("scenarios");
        std::fs::create_dir_all(folder.join("plans")).unwrap();
        std::fs::write(folder.join("plans/a.toml"), "").unwrap();
        std::fs::write(outer.path().join("secret"), "").unwrap();
        std::os::unix::fs::symlink(outer.path().join("secret"), folder.join("link")).unwrap();
        let of = |names_any| ScenarioFolder::of(&folder.join("s.toml"), names_any);
        for name in ["plans/a.toml", "plans/../plans/a.toml", "absent.toml", "absent/b.toml"] {
            assert_eq!(of(false).path(name), Ok(folder.join(name)), "{name}");
        }
        let absolute = outer.path().join("secret").display().to_string();
        for name in ["../secret", "../absent", "link", "plans/../../secret", absolute.as_str(), "/absent/x"] {
            let refused = of(false).path(name).unwrap_err();
            assert!(refused.starts_with(name) && refused.ends_with("--any-folder"), "{refused}");
            assert!(of(true).path(name).is_ok(), "{name}");
        }
        assert!(ScenarioFolder::default().path("Cargo.toml").is_ok(), "a scenario of standard input");
    }
}
