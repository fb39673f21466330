//! A program in a pseudo-terminal, shown on an emulated screen.
#![allow(clippy::disallowed_methods, reason = "a deadline for a program that hangs needs the clock")]

use std::io::{Read as _, Write as _};
use std::num::NonZeroU16;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use vt100::{MouseProtocolMode, Parser};

use super::support::Sandbox;

/// The time after which an expected event counts as missing.
const NEVER: Duration = Duration::from_secs(600);

/// A running program and its screen. It is killed when dropped.
pub(crate) struct Terminal {
    child: Box<dyn Child + Send + Sync>,
    master: Box<dyn MasterPty + Send>,
    keys: Box<dyn std::io::Write + Send>,
    output: Receiver<Vec<u8>>,
    parser: Parser,
    raw: Vec<u8>,
    home: Sandbox,
}

impl Terminal {
    /// Starts the executable.
    pub(crate) fn betadeck(columns: u16, rows: u16, arguments: &[&str]) -> Self {
        Self::start(columns, rows, super::support::PROGRAM, arguments)
    }

    /// Starts any program, with its own home directory.
    pub(crate) fn start(columns: u16, rows: u16, program: &str, arguments: &[&str]) -> Self {
        Self::start_in(Sandbox::new(), columns, rows, program, arguments)
    }

    /// Starts any program in this home directory.
    pub(crate) fn start_in(
        home: Sandbox,
        columns: u16,
        rows: u16,
        program: &str,
        arguments: &[&str],
    ) -> Self {
        let pty = native_pty_system().openpty(size(columns, rows)).expect("a pseudo-terminal");
        let command = command(&home, program, arguments);
        let child = pty.slave.spawn_command(command).expect("the program runs");
        drop(pty.slave);
        let mut reader = pty.master.try_clone_reader().expect("a reader");
        let (sender, output) = channel();
        std::thread::spawn(move || {
            let mut bytes = [0; 8192];
            // The loop ends with the program: the pseudo-terminal then returns an error or no bytes.
            while let Ok(count @ 1..) = reader.read(&mut bytes) {
                if sender.send(bytes[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        Self {
            keys: pty.master.take_writer().expect("a writer"),
            child,
            master: pty.master,
            output,
            parser: Parser::new(cells(rows), cells(columns), 0),
            raw: Vec::new(),
            home,
        }
    }

    /// Starts the executable and closes its terminal when it shows a text. Returns the exit code.
    pub(crate) fn closed_when_shown(text: &str) -> u32 {
        let home = Sandbox::new();
        let pty = native_pty_system().openpty(size(80, 24)).expect("a pseudo-terminal");
        let command = command(&home, super::support::PROGRAM, &["--no-ports"]);
        let mut child = pty.slave.spawn_command(command).expect("the program runs");
        drop(pty.slave);
        let mut reader = pty.master.try_clone_reader().expect("a reader");
        let mut parser = Parser::new(cells(24), cells(80), 0);
        let mut bytes = [0; 8192];
        while !parser.screen().contents().contains(text) {
            let count = reader.read(&mut bytes).expect("output");
            assert!(count > 0, "ended before: {text}");
            parser.process(&bytes[..count]);
        }
        drop(reader);
        drop(pty.master);
        child.wait().expect("an exit status").exit_code()
    }

    /// Returns the home directory of the program.
    pub(crate) fn home(&self) -> &Sandbox {
        &self.home
    }

    /// Returns the home directory of a program that has ended, for the next one.
    pub(crate) fn into_home(mut self) -> Sandbox {
        std::mem::replace(&mut self.home, Sandbox::new())
    }

    /// Blocks the output of the program, as a terminal does after Ctrl-S.
    pub(crate) fn hold_output(&self) {
        let name = self.master.tty_name().expect("a name");
        let flags = rustix::fs::OFlags::RDWR | rustix::fs::OFlags::NOCTTY;
        let terminal = rustix::fs::open(name, flags, rustix::fs::Mode::empty()).expect("the terminal");
        rustix::termios::tcflow(terminal, rustix::termios::Action::OOff).expect("output held");
    }

    /// Returns the process id.
    pub(crate) fn id(&self) -> u32 {
        self.child.process_id().expect("a process")
    }

    /// Returns `true` if the program is stopped, as by Ctrl-Z.
    pub(crate) fn is_stopped(&self) -> bool {
        let id = self.id();
        let stat = std::fs::read_to_string(format!("/proc/{id}/stat")).expect("a process");
        stat.rsplit(") ").next().is_some_and(|rest| rest.starts_with('T'))
    }

    /// Returns `true` if the program shows its own screen.
    pub(crate) fn is_alternate(&self) -> bool {
        self.parser.screen().alternate_screen()
    }

    /// Types keys.
    pub(crate) fn send(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).expect("the program listens");
        self.keys.flush().expect("the program listens");
    }

    /// Changes the size of the window.
    pub(crate) fn resize(&mut self, columns: u16, rows: u16) {
        self.master.resize(size(columns, rows)).expect("a new size");
        self.parser.screen_mut().set_size(cells(rows), cells(columns));
    }

    /// Sends a signal to the program.
    pub(crate) fn signal(&self, name: &str) {
        let id = self.id().to_string();
        let sent = std::process::Command::new("kill").args(["-s", name, &id]).status().expect("kill");
        assert!(sent.success());
    }

    /// Returns the screen as text.
    pub(crate) fn screen(&self) -> String {
        self.parser.screen().contents()
    }

    /// Returns a row of the screen, counted from 0.
    pub(crate) fn row(&self, row: usize) -> String {
        self.screen().lines().nth(row).unwrap_or("").to_owned()
    }

    /// Returns the colour of the background at the top left.
    pub(crate) fn background(&self) -> vt100::Color {
        self.parser.screen().cell(0, 0).map_or(vt100::Color::Default, vt100::Cell::bgcolor)
    }

    /// Returns all bytes so far.
    pub(crate) fn raw(&self) -> String {
        String::from_utf8_lossy(&self.raw).into_owned()
    }

    /// Waits until `is` accepts the screen.
    #[track_caller]
    pub(crate) fn until(&mut self, wanted: &str, is: impl Fn(&Self) -> bool) {
        self.watch(wanted, |terminal| is(terminal));
    }

    /// Waits until the screen shows a text.
    #[track_caller]
    pub(crate) fn until_shown(&mut self, text: &str) {
        self.watch(text, |terminal| terminal.screen().contains(text));
    }

    /// Checks every change of the screen until `done`.
    #[track_caller]
    pub(crate) fn watch(&mut self, wanted: &str, mut done: impl FnMut(&Self) -> bool) {
        let deadline = Instant::now() + NEVER;
        while !done(self) {
            let left = deadline.saturating_duration_since(Instant::now());
            match self.output.recv_timeout(left) {
                Ok(bytes) => {
                    self.parser.process(&bytes);
                    self.raw.extend(bytes);
                }
                Err(RecvTimeoutError::Timeout) => panic!("never seen: {wanted}\n{}", self.screen()),
                Err(RecvTimeoutError::Disconnected) => panic!("ended before: {wanted}\n{}", self.raw_tail()),
            }
        }
    }

    /// Waits for the end of the program and reads all its output. Returns the exit code.
    #[track_caller]
    pub(crate) fn end(&mut self) -> u32 {
        let deadline = Instant::now() + NEVER;
        loop {
            let left = deadline.saturating_duration_since(Instant::now());
            match self.output.recv_timeout(left) {
                Ok(bytes) => {
                    self.parser.process(&bytes);
                    self.raw.extend(bytes);
                }
                Err(RecvTimeoutError::Timeout) => panic!("still running\n{}", self.screen()),
                Err(RecvTimeoutError::Disconnected) => break,
            }
        }
        self.child.wait().expect("an exit status").exit_code()
    }

    /// Asserts that the terminal is in the state that a shell expects: the ordinary screen, a visible cursor,
    /// no mouse, no bracketed paste and default colours.
    #[track_caller]
    pub(crate) fn assert_given_back(&self) {
        let screen = self.parser.screen();
        assert!(!screen.alternate_screen(), "still in the alternate screen: {}", self.raw_tail());
        assert!(!screen.hide_cursor(), "the cursor is hidden: {}", self.raw_tail());
        assert!(!screen.bracketed_paste(), "bracketed paste is on: {}", self.raw_tail());
        assert_eq!(screen.mouse_protocol_mode(), MouseProtocolMode::None, "{}", self.raw_tail());
        assert_eq!(screen.fgcolor(), vt100::Color::Default);
        assert!(!screen.bold() && !screen.inverse());
    }

    /// Returns the line discipline as text.
    pub(crate) fn discipline(&self) -> String {
        format!("{:?}", self.master.get_termios().expect("a terminal"))
    }

    fn raw_tail(&self) -> String {
        let raw = self.raw();
        let from = raw.char_indices().rev().nth(600).map_or(0, |(at, _)| at);
        format!("{:?}", &raw[from..])
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        // The process may have ended already.
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// Returns a command that runs the program with its own home directory.
fn command(home: &Sandbox, program: &str, arguments: &[&str]) -> CommandBuilder {
    let mut command = CommandBuilder::new(program);
    command.args(arguments);
    command.env_clear();
    for (name, value) in home.environment() {
        command.env(name, value);
    }
    command.env("TERM", "xterm-256color");
    command.env("LANG", "C.UTF-8");
    command.env("PATH", "/usr/bin:/bin");
    command.cwd(home.path("."));
    command
}

fn size(columns: u16, rows: u16) -> PtySize {
    PtySize { rows, cols: columns, pixel_width: 0, pixel_height: 0 }
}

fn cells(count: u16) -> NonZeroU16 {
    NonZeroU16::new(count).expect("a size")
}
