//! The terminal, borrowed and always given back: at the end, on an error, and before a panic is printed.

use std::io::{self, Stdout, Write as _, stdout};
use std::mem::ManuallyDrop;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use crossterm::event::{
    DisableBracketedPaste, DisableMouseCapture, EnableBracketedPaste, EnableMouseCapture,
};
use crossterm::terminal::{
    BeginSynchronizedUpdate, Clear, ClearType, EndSynchronizedUpdate, EnterAlternateScreen,
    LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use crossterm::{cursor, execute, style};
use nix::unistd::{Pid, getpgid, getpgrp, getppid, getsid};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;

use super::app_state::AppState;
use super::draw::draw;

/// Whether the terminal is ours at the moment; the panic hook of any thread must know.
static TAKEN_OVER: AtomicBool = AtomicBool::new(false);
static HOOK: Once = Once::new();

/// The terminal while it is ours; dropping it gives it back.
pub struct Tui {
    /// Never dropped: that would complain on a standard error that may be the terminal that went away. The cursor is shown
    /// by [`restore`].
    terminal: ManuallyDrop<Terminal<CrosstermBackend<Stdout>>>,
    mouse: bool,
    /// What is on the screen is not what was drawn.
    is_lost: bool,
}

impl Tui {
    /// Takes the terminal: raw mode, alternate screen, bracketed paste, mouse if wanted.
    ///
    /// # Errors
    /// Whatever the terminal says.
    pub fn enter(mouse: bool) -> io::Result<Self> {
        HOOK.call_once(|| {
            let before = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |info| {
                restore();
                before(info);
            }));
        });
        // The theme decides about colours; the library's own reading of NO_COLOR would wipe bold and reverse, too.
        style::force_color_output(true);
        match take_over(mouse).and_then(|()| Terminal::new(CrosstermBackend::new(stdout()))) {
            Ok(terminal) => Ok(Self { terminal: ManuallyDrop::new(terminal), mouse, is_lost: false }),
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    /// Gives the terminal back and stops the program, until the shell continues it.
    ///
    /// # Errors
    /// Whatever the terminal says.
    pub fn suspend(&mut self) -> io::Result<()> {
        restore();
        // The whole job, as the terminal does: a script or cargo may have started the program, and the shell waits for
        // them. The signal of Ctrl-Z is handled here, and would not stop it.
        rustix::process::kill_current_process_group(rustix::process::Signal::STOP)?;
        self.resume()
    }

    /// Takes the terminal again after the program was stopped: the shell has used it meanwhile.
    ///
    /// # Errors
    /// Whatever the terminal says.
    pub fn resume(&mut self) -> io::Result<()> {
        take_over(self.mouse)?;
        // Clearing the terminal that is there would ask for the place of the cursor, and wait for the answer.
        self.terminal = ManuallyDrop::new(Terminal::new(CrosstermBackend::new(stdout()))?);
        execute!(stdout(), Clear(ClearType::All))
    }

    /// The next frame is drawn anew: a window that shrinks and grows again before anybody looks has its old size, and has
    /// lost what was drawn.
    pub fn lose_screen(&mut self) {
        self.is_lost = true;
    }

    /// Draws a frame; a terminal that can shows it all at once.
    ///
    /// # Errors
    /// Whatever the terminal says.
    pub fn draw(&mut self, state: &AppState) -> io::Result<()> {
        execute!(stdout(), BeginSynchronizedUpdate)?;
        if std::mem::take(&mut self.is_lost) {
            let size = self.terminal.size()?;
            self.terminal.resize(size.into())?;
        }
        self.terminal.draw(|frame| draw(state, frame))?;
        execute!(stdout(), EndSynchronizedUpdate)
    }

    /// The terminal to draw on.
    pub fn terminal(&mut self) -> &mut Terminal<CrosstermBackend<Stdout>> {
        &mut self.terminal
    }
}

impl Drop for Tui {
    fn drop(&mut self) {
        restore();
    }
}

/// Raw mode, alternate screen, bracketed paste, mouse if wanted.
fn take_over(mouse: bool) -> io::Result<()> {
    enable_raw_mode()?;
    TAKEN_OVER.store(true, Ordering::SeqCst);
    execute!(stdout(), EnterAlternateScreen, EnableBracketedPaste)?;
    if mouse { execute!(stdout(), EnableMouseCapture) } else { Ok(()) }
}

/// Returns whether a shell with jobs waits for this program: only such a one continues it after it was stopped. The process
/// that leads a session, as under `xterm -e` or in a container, has none.
pub(super) fn can_be_continued() -> bool {
    /// Programs between this one and the shell, such as scripts and cargo.
    const MOST: usize = 64;
    let (Ok(session), group) = (getsid(None), getpgrp()) else { return false };
    let mut ancestor = Some(getppid());
    for _ in 0..MOST {
        // 0 is the parent in another PID namespace; asked for its session, the system answers for this program.
        let parent = match ancestor {
            Some(parent) if parent.as_raw() > 0 && getsid(Some(parent)) == Ok(session) => parent,
            _ => return false,
        };
        if getpgid(Some(parent)) != Ok(group) {
            return true;
        }
        ancestor = parent_of(parent);
    }
    false
}

/// Returns the parent of another process, where the system has `/proc`.
fn parent_of(process: Pid) -> Option<Pid> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of the program stands in brackets, and may have brackets and blanks in it.
    let parent = stat.rsplit_once(") ")?.1.split(' ').nth(1)?;
    Some(Pid::from_raw(parent.parse().ok()?))
}

/// Restores the line discipline without writing to the terminal, which nobody may be reading.
pub fn restore_terminal_modes() {
    if TAKEN_OVER.load(Ordering::SeqCst) {
        disable_raw_mode().ok();
    }
}

/// Restores the terminal, once.
fn restore() {
    if !TAKEN_OVER.swap(false, Ordering::SeqCst) {
        return;
    }
    // Each on its own: when one fails the others still help.
    let mut out = stdout();
    execute!(out, EndSynchronizedUpdate, DisableMouseCapture).ok();
    execute!(out, DisableBracketedPaste).ok();
    execute!(out, LeaveAlternateScreen, cursor::Show, style::ResetColor).ok();
    disable_raw_mode().ok();
    out.flush().ok();
}
