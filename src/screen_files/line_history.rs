//! The lines entered in text fields, kept in the state directory like the history of a shell. Each line is appended
//! when it is entered, so that programs that run at the same time lose no lines.
#![allow(clippy::disallowed_methods, reason = "the shell of the user interface reads and writes files")]

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use crate::screen_files::entered_lines::{RECALLED, is_kept, recalled};
use crate::storage::state_file::{self, Access};
use crate::ui::{EnteredLines, LineField};

/// The number of lines of a file above which the older ones are dropped at the next start.
const MAX_LINES: usize = 2 * RECALLED;
/// The largest file, bytes: twice the most lines of the greatest length.
const LARGEST: u64 = 8 << 20;
/// The fields that have a history.
const FIELDS: [LineField; 3] = [LineField::Command, LineField::Cli, LineField::Palette];

/// The files of the lines.
#[derive(Debug, Clone)]
pub(crate) struct LineHistory {
    /// The state directory; `None` keeps nothing.
    directory: Option<PathBuf>,
}

impl LineHistory {
    /// Keeps lines in the state directory.
    pub(crate) fn new(state: Option<&Path>) -> Self {
        Self { directory: state.map(Path::to_owned) }
    }

    /// Returns the earlier lines, the oldest first. A file that cannot be read counts as empty.
    pub(crate) fn read(&self) -> EnteredLines {
        EnteredLines {
            commands: self.read_field(LineField::Command),
            cli: self.read_field(LineField::Cli),
            palette: self.read_field(LineField::Palette),
        }
    }

    /// Keeps a line. If this fails, the line is lost at the end of the program, as in a shell.
    pub(crate) fn append(&self, field: LineField, line: &str) {
        if !is_kept(line) {
            return;
        }
        let Some(path) = self.path(field) else { return };
        let opened = state_file::open(&path, Access::AppendOrCreate);
        if let Ok(mut file) = opened
            && !state_file::has_other_names(&file)
        {
            // A single write of a whole line is not mixed with the lines of another program.
            file.write_all(format!("{line}\n").as_bytes()).ok();
        }
    }

    /// Returns the reasons why entered lines are not kept, one sentence for each file that does not belong to this
    /// program.
    pub(crate) fn problems(&self) -> Vec<String> {
        let paths = FIELDS.into_iter().filter_map(|field| self.path(field));
        paths.filter_map(|path| problem(&path)).collect()
    }

    fn path(&self, field: LineField) -> Option<PathBuf> {
        let name = match field {
            LineField::Command => "commands.history",
            LineField::Cli => "cli.history",
            LineField::Palette => "palette.history",
        };
        Some(self.directory.as_ref()?.join(name))
    }

    fn read_field(&self, field: LineField) -> Vec<String> {
        let Some(path) = self.path(field) else { return Vec::new() };
        let Ok(Some(text)) = state_file::read(&path, LARGEST) else { return Vec::new() };
        let Ok(text) = String::from_utf8(text) else { return Vec::new() };
        let recalled = recalled(&text);
        if text.lines().count() > MAX_LINES {
            shorten(&path, &recalled);
        }
        recalled.into_iter().map(str::to_owned).collect()
    }
}

/// Replaces a file that is too long by its newest lines. If this fails, the file stays unchanged.
fn shorten(path: &Path, lines: &[&str]) {
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    state_file::replace(path, text.as_bytes()).ok();
}

fn problem(path: &Path) -> Option<String> {
    let why = match state_file::open(path, Access::Append) {
        Ok(file) if state_file::has_other_names(&file) => "it has another name (a hard link)".to_owned(),
        Ok(_) => return None,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
        Err(error) => error.to_string(),
    };
    Some(format!("Entered lines are not kept in {}: {why}. Delete it to keep them.", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::screen_files::entered_lines::LONGEST;

    fn directory(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("betadeck-history-{name}-{}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        std::fs::create_dir_all(&path).unwrap();
        path
    }

    #[test]
    fn lines_of_two_programs_are_all_recalled_after_a_restart() {
        let directory = directory("two");
        let (one, other) = (LineHistory::new(Some(&directory)), LineHistory::new(Some(&directory)));
        for number in 0..20 {
            one.append(LineField::Command, &format!("speed {number}"));
            other.append(LineField::Command, &format!("wind {number}"));
        }
        one.append(LineField::Cli, "status");
        one.append(LineField::Cli, "two\nlines");
        let lines = LineHistory::new(Some(&directory)).read();
        assert_eq!((lines.commands.len(), lines.cli.as_slice()), (40, &["status".to_owned()][..]));
        assert_eq!(lines.commands[..2], ["speed 0", "wind 0"]);
        std::fs::remove_dir_all(directory).ok();
    }

    #[test]
    fn the_file_stays_bounded_and_garbage_in_it_is_passed_over() {
        let directory = directory("bounded");
        let history = LineHistory::new(Some(&directory));
        let file = directory.join("commands.history");
        let long = "x".repeat(LONGEST + 1);
        let many: String = (0..3000).map(|number| format!("speed {number}\n")).collect();
        std::fs::write(&file, format!("{many}\n\u{1b}[2J\n{long}\nlast\n")).unwrap();
        let lines = history.read().commands;
        assert_eq!((lines.len(), lines.last().map(String::as_str)), (RECALLED, Some("last")));
        assert_eq!(std::fs::read_to_string(&file).unwrap().lines().count(), RECALLED);
        std::fs::write(&file, [0xff, 0xfe, b'\n', 0]).unwrap();
        assert!(history.read().commands.is_empty());
        std::fs::remove_dir_all(directory).ok();
    }

    #[test]
    fn a_directory_a_fifo_or_a_link_in_its_place_and_a_missing_state_are_no_history() {
        let directory = directory("places");
        let history = LineHistory::new(Some(&directory));
        std::fs::create_dir(directory.join("commands.history")).unwrap();
        rustix::fs::mknodat(
            rustix::fs::CWD,
            directory.join("cli.history"),
            rustix::fs::FileType::Fifo,
            rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR,
            0,
        )
        .unwrap();
        let other = directory.join("other file");
        std::fs::write(&other, "map.fit\n").unwrap();
        std::os::unix::fs::symlink(&other, directory.join("palette.history")).unwrap();
        history.append(LineField::Command, "speed 2");
        history.append(LineField::Cli, "status");
        history.append(LineField::Palette, "flight.arm");
        assert_eq!(history.read(), EnteredLines::default());
        assert_eq!(std::fs::read_to_string(&other).unwrap(), "map.fit\n");
        LineHistory::new(None).append(LineField::Cli, "status");
        assert_eq!(LineHistory::new(None).read(), EnteredLines::default());
        std::fs::remove_dir_all(directory).ok();
    }
}
