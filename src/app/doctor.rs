//! `betadeck doctor`: checks that the program has all that it needs.
#![allow(clippy::disallowed_methods, reason = "it looks at the environment")]

use std::fmt::Write as _;
use std::io::{ErrorKind, IsTerminal as _};
use std::net::{TcpListener, UdpSocket};
use std::path::Path;

use super::layers::{self, Outside};
use super::screen::is_dumb;
use super::{keys, usage};
use crate::args::{self, DoorArgs, Layers};
use crate::files::directories;
use crate::process::error::AppError;
use crate::process::{build, error};
use crate::ui::Theme;
use crate::ui::screen_layout::SMALLEST;
use crate::ui::theme::{Charset, Palette};

/// Prints the findings; exit code 0 if there is no problem.
pub(super) fn run() -> Result<u8, AppError> {
    let mut report = Report::default();
    let _ = writeln!(report.text, "betadeck {}", build::version());
    let layers = configuration(&mut report);
    match directories::directories() {
        Ok(directories) => state_directory(&mut report, &directories.state),
        Err(error) => report.line(false, "directories", &error.message),
    }
    terminal(&mut report);
    // Problems of the options were reported above. In that case the default doors are checked.
    let doors =
        [layers, Layers::default()].iter().find_map(|layers| args::parse(["betadeck".into()], layers).ok());
    doors.iter().for_each(|cli| ports(&mut report, &cli.tui.doors));
    error::print(&report.text)?;
    Ok(if report.is_bad { error::ENVIRONMENT } else { 0 })
}

#[derive(Debug, Default)]
struct Report {
    text: String,
    is_bad: bool,
}

impl Report {
    fn line(&mut self, good: bool, what: &str, found: &str) {
        self.is_bad |= !good;
        let mark = if good { '✓' } else { '✗' };
        let _ = writeln!(self.text, "{mark} {what:<20}  {found}");
    }
}

/// Checks the configuration file and the environment, with all their problems.
fn configuration(report: &mut Report) -> Layers {
    const FILE: &str = "configuration file";
    let Outside { layers, keys } = match layers::read() {
        Ok(outside) => outside,
        Err(error) => {
            report.line(false, FILE, error.message.trim_end());
            return Layers::default();
        }
    };
    let mut problems = args::layer_problems(&usage::printable_layers(&layers));
    if let Err(error) = keys::keymap(&layers.file_name, &keys) {
        problems.extend(error.message.lines().map(str::to_owned));
    }
    if problems.is_empty() && !layers.file_name.is_empty() {
        let found = if Path::new(&layers.file_name).exists() { "present" } else { "none, defaults apply" };
        report.line(true, FILE, &format!("{} ({found})", layers.file_name));
    }
    for problem in problems {
        report.line(false, "configuration", &problem);
    }
    layers
}

/// Checks the state directory: the nearest existing folder above it decides if it can be created.
fn state_directory(report: &mut Report, path: &Path) {
    let existing = path.ancestors().find(|folder| folder.exists());
    let writable = existing.is_some_and(|folder| {
        folder.is_dir() && rustix::fs::access(folder, rustix::fs::Access::WRITE_OK).is_ok()
    });
    let word = if writable { "writable" } else { "not writable: choose one with --state-dir" };
    report.line(writable, "state directory", &format!("{} ({word})", path.display()));
}

/// Checks the terminal. Only the user interface needs one, so a missing terminal is not a fault.
fn terminal(report: &mut Report) {
    const TERMINAL: &str = "terminal";
    if is_dumb() {
        report.line(
            true,
            TERMINAL,
            "TERM=dumb has no screen: betadeck needs --plain here; betadeck fly needs none",
        );
        return;
    }
    if !std::io::stdout().is_terminal() {
        report.line(true, TERMINAL, "none here; betadeck fly and betadeck --plain need none");
        return;
    }
    match crossterm::terminal::size() {
        Ok((columns, rows)) => {
            let theme = Theme::from_environment(|name| std::env::var(name).ok());
            let colours = match theme.palette {
                Palette::Mono => "no colours",
                Palette::Ansi16 => "16 colours",
                Palette::Dark | Palette::Light | Palette::HighContrast => "all colours",
            };
            let characters = match theme.charset {
                Charset::Unicode => "Unicode characters",
                Charset::Ascii => "ASCII characters",
            };
            let (least_columns, least_rows) = SMALLEST;
            let enough = columns >= least_columns && rows >= least_rows;
            let need =
                if enough { String::new() } else { format!(": needs at least {least_columns}x{least_rows}") };
            report.line(enough, TERMINAL, &format!("{columns}x{rows}, {colours}, {characters}{need}"));
        }
        Err(error) => report.line(false, TERMINAL, &format!("size unknown: {error}")),
    }
}

/// Checks that the ports of the doors are free.
fn ports(report: &mut Report, doors: &DoorArgs) {
    if doors.no_ports {
        report.line(true, "ports", "none: doors are closed by no-ports");
        return;
    }
    let udp = doors.udp_ports();
    let tcp = |port| TcpListener::bind((doors.address(), port)).map(drop);
    let datagrams = |port| UdpSocket::bind((doors.address(), port)).map(drop);
    let found = [
        ("websocket", "--ws-port", doors.ws_port(), tcp(doors.ws_port())),
        ("TCP", "--tcp-port", doors.tcp_port(), tcp(doors.tcp_port())),
        ("UDP simulator", "--udp-ports", udp.fdm, datagrams(udp.fdm)),
        ("UDP RC", "--udp-ports", udp.rc, datagrams(udp.rc)),
    ];
    for (name, option, port, bound) in found {
        let what = format!("port {name}");
        match bound {
            Ok(()) if port == 0 => report.line(true, &what, "any free one"),
            Ok(()) => report.line(true, &what, &format!("{port} is free")),
            Err(error) if error.kind() == ErrorKind::AddrInUse => report.line(
                false,
                &what,
                &format!("{port} is in use: stop the program that uses it, or choose another with {option}"),
            ),
            Err(error) => report.line(
                false,
                &what,
                &format!(
                    "{port} cannot be opened on {}: {error}; choose another with {option}",
                    doors.address()
                ),
            ),
        }
    }
}
