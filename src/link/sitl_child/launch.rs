//! Starts the executable through a second process of this program. That process asks the system to end it
//! with its parent, and then becomes the executable. So no executable keeps running when this program is
//! killed.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::ChildConfig;

/// Exit codes of a launcher that could not become the executable, as used by shells.
const NOT_EXECUTABLE: i32 = 126;
const NOT_FOUND: i32 = 127;
/// The exit code for a parent that was gone before the child could ask to end with it.
const ORPHAN: i32 = 125;

/// The subcommand by which this program starts an executable. For internal use only.
const LAUNCH: &str = "launch-firmware";

/// The prefix of environment variables for this program's options. They are not passed to the executable.
const OUR_VARIABLES: &str = "BETADECK_";

/// The reason why an executable could not be started.
#[derive(Debug, thiserror::Error)]
pub enum LaunchError {
    /// Its directory cannot be created.
    #[error("cannot make the directory {directory} for the firmware: {error}")]
    Directory {
        directory: PathBuf,
        /// The system's error.
        error: io::Error,
    },
    /// The system cannot start the process.
    #[error("cannot start {program}: {error}")]
    Start {
        /// The program to start.
        program: PathBuf,
        /// The system's error.
        error: io::Error,
    },
}

/// The variable by which the launcher gets the library to preload into the executable. The launcher itself runs without it.
const LIBRARY: &str = "BETADECK_PRELOAD";
/// The variable by which the launcher gets the path of a file that the executable inherits, open to read and write …
const FILE: &str = "BETADECK_FILE";
/// … and the variable to whose value it adds a comma and the descriptor.
const SETTINGS: &str = "BETADECK_SETTINGS";

/// A library that is preloaded into the executable, with a variable for its settings.
#[derive(Debug, Clone)]
pub(super) struct Preload {
    pub(super) library: PathBuf,
    pub(super) variable: &'static str,
    pub(super) settings: String,
}

/// Makes the directory in which the executable runs.
pub(super) fn make_directory(config: &ChildConfig) -> Result<(), LaunchError> {
    std::fs::create_dir_all(&config.directory)
        .map_err(|error| LaunchError::Directory { directory: config.directory.clone(), error })
}

/// Starts the executable in its directory, with its output piped.
pub(super) fn spawn(config: &ChildConfig, preload: Option<(&Preload, &Path)>) -> Result<Child, LaunchError> {
    make_directory(config)?;
    let mut command = Command::new(&config.launcher);
    command.arg(LAUNCH).arg(std::process::id().to_string()).arg(&config.program).args(&config.arguments);
    command.current_dir(&config.directory);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    for (name, _) in std::env::vars_os() {
        if name.to_str().is_some_and(|name| name.starts_with(OUR_VARIABLES)) {
            command.env_remove(name);
        }
    }
    if let Some((Preload { library, variable, settings }, file)) = preload {
        command.env(LIBRARY, library).env(FILE, file).env(SETTINGS, variable).env(variable, settings);
    }
    #[cfg(unix)]
    // The terminal's interrupt is meant for this program, which ends the child itself.
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn().map_err(|error| LaunchError::Start { program: config.launcher.clone(), error })
}

/// Becomes the executable that a launcher's command line (program name first) names. Returns only if that
/// failed, with an exit code after a sentence on standard error. Returns `None` for any other command line.
pub fn launch_firmware(arguments: &[OsString]) -> Option<u8> {
    let [_, command, parent, program, arguments @ ..] = arguments else { return None };
    if command != LAUNCH {
        return None;
    }
    let parent = parent.to_str()?.parse().ok()?;
    Some(exec_with_parent(parent, Path::new(program), arguments))
}

#[allow(clippy::print_stderr, reason = "the process that reads it tells its user")]
fn exec_with_parent(parent: i32, program: &Path, arguments: &[OsString]) -> u8 {
    #[cfg(target_os = "linux")]
    {
        use rustix::process::{Signal, getppid, set_parent_process_death_signal};
        if let Err(error) = set_parent_process_death_signal(Some(Signal::KILL)) {
            eprintln!("betadeck: the firmware may outlive this program: {error}");
        }
        // A parent that ended in the meantime sends no signal.
        if getppid().is_none_or(|pid| pid.as_raw_nonzero().get() != parent) {
            return ORPHAN as u8;
        }
    }
    let _ = parent;
    let mut command = Command::new(program);
    command.args(arguments);
    [LIBRARY, FILE, SETTINGS].iter().for_each(|name| _ = command.env_remove(name));
    if let Some(library) = std::env::var_os(LIBRARY) {
        command.env("LD_PRELOAD", library);
    }
    let _file = match inherited_file(&mut command) {
        Ok(file) => file,
        Err(error) => {
            eprintln!("betadeck: cannot reach the program that starts the firmware: {error}");
            return NOT_EXECUTABLE as u8;
        }
    };
    #[cfg(unix)]
    let error = std::os::unix::process::CommandExt::exec(&mut command);
    #[cfg(not(unix))]
    let error = match command.status() {
        Ok(status) => return status.code().unwrap_or(NOT_EXECUTABLE) as u8,
        Err(error) => error,
    };
    eprintln!("betadeck: cannot start {}: {error}", program.display());
    (if error.kind() == io::ErrorKind::NotFound { NOT_FOUND } else { NOT_EXECUTABLE }) as u8
}

/// Opens the file that the executable inherits, if there is one, and adds its descriptor to the settings.
fn inherited_file(command: &mut Command) -> io::Result<Option<File>> {
    #[cfg(target_os = "linux")]
    if let (Some(path), Some(name)) = (std::env::var_os(FILE), std::env::var_os(SETTINGS)) {
        use std::os::fd::AsRawFd as _;
        let file = File::options().read(true).write(true).open(path)?;
        rustix::io::fcntl_setfd(&file, rustix::io::FdFlags::empty())?;
        let mut settings = std::env::var_os(&name).unwrap_or_default();
        settings.push(format!(",{}", file.as_raw_fd()));
        command.env(name, settings);
        return Ok(Some(file));
    }
    let _ = command;
    Ok(None)
}

/// Returns the error that an exit code of the launcher means; `None` if the code is the executable's own.
pub(super) fn error_of_code(code: i32, config: &ChildConfig) -> Option<String> {
    let program = config.program.display();
    match code {
        NOT_FOUND => Some(format!("there is no executable {program}")),
        NOT_EXECUTABLE => Some(format!(
            "the system cannot run {program}: it is not an executable for this machine, or not marked \
             executable (chmod +x)"
        )),
        _ => None,
    }
}
