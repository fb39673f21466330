//! Runs the executable in its own home directory.

use std::path::PathBuf;
use std::time::Duration;

use tempfile::TempDir;

use super::lines::Line;

/// The executable.
pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_betadeck");

/// The time after which a run that does not end by itself counts as hung. Normal runs take far less.
const HUNG: Duration = Duration::from_secs(600);

/// An empty home directory, which is also the working directory of the programs that run in it.
pub(crate) struct Sandbox {
    directory: TempDir,
}

/// The result of a run.
#[derive(Debug)]
pub(crate) struct Ran {
    /// The exit code; `None` after a signal.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) out: String,
    /// Standard error.
    pub(crate) err: String,
}

impl Sandbox {
    /// Creates an empty home directory.
    pub(crate) fn new() -> Self {
        Self { directory: tempfile::tempdir().expect("a directory") }
    }

    /// Returns the path of a file in the directory.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    /// Writes a file into the directory.
    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("a writable directory");
    }

    /// Reads a file in the directory.
    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Returns the names of the files in the directory.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory.path()).expect("a readable directory");
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
    }

    /// Returns the environment of a run: this home, and nothing of the real one.
    pub(crate) fn environment(&self) -> Vec<(&'static str, PathBuf)> {
        let home = self.directory.path();
        vec![
            ("HOME", home.to_path_buf()),
            ("XDG_CONFIG_HOME", home.join(".config")),
            ("XDG_STATE_HOME", home.join(".state")),
            ("XDG_DATA_HOME", home.join(".data")),
        ]
    }

    /// Returns a command that runs the executable.
    pub(crate) fn command(&self, arguments: &[&str]) -> std::process::Command {
        let mut command = std::process::Command::new(PROGRAM);
        command.env_clear().envs(self.environment()).current_dir(self.directory.path()).args(arguments);
        command
    }

    /// Runs the executable to its end.
    pub(crate) fn run(&self, arguments: &[&str]) -> Ran {
        self.run_with(arguments, "")
    }

    /// Runs the executable with this text on standard input.
    pub(crate) fn run_with(&self, arguments: &[&str], input: &str) -> Ran {
        let output = assert_cmd::Command::from_std(self.command(arguments))
            .timeout(HUNG)
            .write_stdin(input)
            .output()
            .expect("the executable runs");
        Ran {
            code: output.status.code(),
            out: String::from_utf8(output.stdout).expect("UTF-8 on standard output"),
            err: String::from_utf8(output.stderr).expect("UTF-8 on standard error"),
        }
    }

    /// Flies with JSON lines on standard output and checks every line.
    pub(crate) fn fly(&self, arguments: &[&str]) -> Flown {
        let ran = self.run(&[&["fly", "--json", "-"], arguments].concat());
        let lines = Line::read_all(&ran.out);
        Flown { code: ran.code, err: ran.err, lines }
    }
}

impl Ran {
    /// Asserts the exit code, and shows the output when it differs.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "\n{}\n{}", self.out, self.err);
        self
    }
}

#[derive(Debug)]
pub(crate) struct Flown {
    pub(crate) code: Option<i32>,
    /// Standard error.
    pub(crate) err: String,
    pub(crate) lines: Vec<Line>,
}

impl Flown {
    /// Asserts the exit code and the result of the `end` event.
    #[track_caller]
    pub(crate) fn ends(self, code: i32, result: &str) -> Self {
        let end = self.lines.last().expect("lines");
        assert_eq!(
            (self.code, end.event(), end.text("result")),
            (Some(code), "end", result),
            "\n{}",
            self.err
        );
        let said = self.err.lines().rev().nth(1).expect("a result line");
        assert!(said.starts_with(&format!("{result}: ")), "{said}");
        assert!(self.err.lines().last().expect("a summary").starts_with("flown "), "{}", self.err);
        self
    }

    /// Returns the lines of this event.
    pub(crate) fn all<'a>(&'a self, event: &'a str) -> impl DoubleEndedIterator<Item = &'a Line> + 'a {
        self.lines.iter().filter(move |line| line.event() == event)
    }

    /// Returns the first line of this event.
    #[track_caller]
    pub(crate) fn first(&self, event: &str) -> &Line {
        let found = self.lines.iter().find(|line| line.event() == event);
        found.unwrap_or_else(|| panic!("no {event} in {:#?}", self.lines))
    }

    /// Returns the simulated time of the first engagement.
    pub(crate) fn engaged_at(&self) -> f64 {
        self.all("state").find(|line| line.text("from") == "IDLE").expect("an engagement").time()
    }

    /// Returns the states entered, with the waypoint: `APPROACHING 0`.
    pub(crate) fn states(&self) -> Vec<String> {
        self.all("state").map(|line| format!("{} {}", line.text("to"), line.number("wp"))).collect()
    }
}

/// Returns the folder of the shipped plans.
pub(crate) fn plans() -> PathBuf {
    test_support::path("plans")
}

/// Returns the path of a shipped plan as an argument.
pub(crate) fn plan(name: &str) -> String {
    plans().join(name).to_str().expect("a plain path").to_owned()
}
