//! The real program in a pseudo-terminal: keys in, screen out, and the terminal given back whatever happens.
#![cfg(unix)]
#![allow(
    clippy::disallowed_methods,
    reason = "a test that waits for another process needs an end of its patience"
)]

use std::io::{Read as _, Write};
use std::num::NonZero;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use portable_pty::{Child, CommandBuilder, MasterPty, PtySize, native_pty_system};
use vt100::{MouseProtocolMode, Parser};

/// How long anything may take on a busy machine before the test gives up.
const PATIENCE: Duration = Duration::from_secs(120);

/// A number of columns or rows.
fn cells(count: u16) -> NonZero<u16> {
    NonZero::new(count).expect("a screen has cells")
}

/// A program in a pseudo-terminal, and what it shows.
struct Session {
    master: Box<dyn MasterPty + Send>,
    child: Box<dyn Child + Send + Sync>,
    keys: Box<dyn Write + Send>,
    output: Receiver<Vec<u8>>,
    parser: Parser,
}

impl Session {
    /// Starts `command` on a screen of this many columns and rows.
    fn start(mut command: CommandBuilder, columns: u16, rows: u16) -> Self {
        let size = PtySize { rows, cols: columns, pixel_width: 0, pixel_height: 0 };
        let pair = native_pty_system().openpty(size).expect("a pseudo-terminal");
        command.env("TERM", "xterm-256color");
        command.env("LANG", "C.UTF-8");
        command.env("RUST_BACKTRACE", "0");
        command.env_remove("NO_COLOR");
        command.env_remove("LC_ALL");
        let child = pair.slave.spawn_command(command).expect("the program starts");
        let mut reader = pair.master.try_clone_reader().expect("a reader");
        let keys = pair.master.take_writer().expect("a writer");
        let (sender, output) = channel();
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(read @ 1..) = reader.read(&mut bytes) {
                if sender.send(bytes[..read].to_vec()).is_err() {
                    break;
                }
            }
        });
        let parser = Parser::new(cells(rows), cells(columns), 0);
        Self { master: pair.master, child, keys, output, parser }
    }

    /// The user interface on a fresh craft.
    fn betadeck(columns: u16, rows: u16) -> Self {
        let mut command = CommandBuilder::new(env!("CARGO_BIN_EXE_betadeck"));
        command.args(["--fresh", "--no-ports"]);
        Self::start(command, columns, rows)
    }

    fn press(&mut self, keys: &str) {
        self.keys.write_all(keys.as_bytes()).expect("the terminal takes keys");
        self.keys.flush().expect("the terminal takes keys");
    }

    fn text(&self) -> String {
        self.parser.screen().contents()
    }

    /// Reads until the screen fulfils `wanted`.
    fn until(&mut self, what: &str, wanted: impl Fn(&str) -> bool) -> String {
        let end = Instant::now() + PATIENCE;
        loop {
            let text = self.text();
            if wanted(&text) {
                return text;
            }
            match self.output.recv_timeout(end.saturating_duration_since(Instant::now())) {
                Ok(bytes) => self.parser.process(&bytes),
                Err(_) => panic!("{what} never appeared:\n{text}"),
            }
        }
    }

    fn until_shown(&mut self, word: &str) -> String {
        self.until(word, |text| text.contains(word))
    }

    /// Reads to the end of the program; gives its exit code.
    fn finish(&mut self) -> u32 {
        while let Ok(bytes) = self.output.recv_timeout(PATIENCE) {
            self.parser.process(&bytes);
        }
        self.child.wait().expect("an exit code").exit_code()
    }

    /// Asserts that nothing of the program is left on the terminal.
    fn assert_given_back(&self) {
        let screen = self.parser.screen();
        assert!(!screen.alternate_screen(), "alternate screen");
        assert!(!screen.hide_cursor(), "hidden cursor");
        assert!(!screen.bracketed_paste(), "bracketed paste");
        assert_eq!(screen.mouse_protocol_mode(), MouseProtocolMode::None, "mouse");
    }
}

/// The states in the list of transitions, the first one first; the newest transition stands on top of the list.
fn states(screen: &str) -> Vec<&str> {
    let mut states = Vec::new();
    for line in screen.lines().rev() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let Some(step) = words.windows(4).find(|w| w[1] == "→" && w[3].starts_with("WP")) {
            if states.is_empty() {
                states.push(step[0]);
            }
            states.push(step[2]);
        }
    }
    states
}

#[test]
fn f_flies_the_whole_demo_on_the_screen() {
    let mut session = Session::betadeck(200, 60);
    let before = session.master.get_termios();
    session.until_shown("○ DISARMED");
    session.until_shown("IDLE");
    session.press("F");
    session.until_shown("● ARMED");
    session.press("]]]]]]");
    let mission = [
        "IDLE",
        "APPROACHING",
        "ARRIVED",
        "APPROACHING",
        "ARRIVED",
        "APPROACHING",
        "ARRIVED",
        "HOLDING",
        "ORBITING",
        "APPROACHING",
        "ARRIVED",
        "LANDING",
        "COMPLETE",
    ];
    session.until("the whole mission", |text| {
        text.contains("◆ COMPLETE") && text.contains("○ DISARMED") && states(text) == mission
    });

    session.press("q");
    assert_eq!(session.finish(), 0);
    session.assert_given_back();
    let after = session.master.get_termios();
    assert_eq!(before.map(|t| t.local_flags), after.map(|t| t.local_flags), "raw mode");
}

#[test]
fn flying_by_hand_arms_raises_the_throttle_and_engages() {
    let mut session = Session::betadeck(120, 40);
    session.press("]]]");
    session.until_shown("has no plan.");
    session.press("U");
    session.until_shown("Ready.");
    session.press("a");
    session.until_shown("● ARMED");
    session.press("t");
    session.until_shown("holds its place");
    session.press("g");
    session.until("APPROACHING", |text| text.contains("◆ CLIMBING") || text.contains("◆ APPROACHING"));
    session.press("q");
    session.until_shown("Quit?");
    session.press("y");
    assert_eq!(session.finish(), 0);
    session.assert_given_back();
}

#[test]
fn it_follows_the_size_of_the_terminal_and_quits_at_any_size() {
    let mut session = Session::betadeck(80, 24);
    session.until_shown("3 State");
    for (columns, rows) in [(40, 10), (1, 1), (120, 40)] {
        let size = PtySize { rows, cols: columns, pixel_width: 0, pixel_height: 0 };
        session.parser.screen_mut().set_size(cells(rows), cells(columns));
        session.master.resize(size).expect("resize");
        match columns {
            40 => session.until_shown("at least 60x20"),
            120 => session.until_shown("2 Plan"),
            _ => String::new(),
        };
    }
    session.press("q");
    assert_eq!(session.finish(), 0);
    session.assert_given_back();
}

#[test]
fn the_command_line_answers_and_ctrl_c_twice_quits() {
    let mut session = Session::betadeck(120, 40);
    session.until_shown("1 Map");
    session.press("5");
    session.until_shown("▸5 CLI");
    session.press("get ap_max_velocity\r");
    session.until_shown("ap_max_velocity = ");
    session.press("\x03");
    session.until_shown("Ctrl-C again");
    session.press("\x03");
    assert_eq!(session.finish(), 0);
    session.assert_given_back();
}

#[test]
fn a_signal_ends_it_properly() {
    use rustix::process::{Pid, Signal, kill_process};
    for signal in [Signal::TERM, Signal::INT, Signal::HUP] {
        let mut session = Session::betadeck(80, 24);
        session.until_shown("1 Map");
        let pid = session.child.process_id().and_then(|pid| Pid::from_raw(pid as i32)).expect("a process");
        kill_process(pid, signal).expect("the signal is sent");
        assert_eq!(session.finish(), 130);
        session.assert_given_back();
    }
}

#[test]
fn a_panic_gives_the_terminal_back_before_it_is_printed() {
    let mut command = CommandBuilder::new(std::env::current_exe().expect("this test"));
    command.args(["--exact", "panics_on_the_terminal", "--ignored", "--nocapture"]);
    let mut session = Session::start(command, 80, 24);
    assert_ne!(session.finish(), 0);
    session.assert_given_back();
    let text = session.text();
    assert!(text.contains("panicked") && text.contains("on purpose"), "{text}");
}

/// Not a test by itself: the program of the test above.
#[test]
#[ignore = "run by a_panic_gives_the_terminal_back_before_it_is_printed"]
fn panics_on_the_terminal() {
    let _tui = betadeck::ui::Tui::enter(true).expect("a terminal");
    panic!("on purpose");
}
