//! The terminal: taken over, and always restored at the end, on an error, and before a panic is printed.

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
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;

use super::app_state::AppState;
use super::draw::draw;

/// `true` while the program has taken over the terminal. The panic hook of any thread reads it.
static TAKEN_OVER: AtomicBool = AtomicBool::new(false);
static HOOK: Once = Once::new();

/// The terminal while the program has taken it over. Dropping it restores the terminal.
pub struct Tui {
    /// Never dropped: the drop would complain on standard error, which may be the terminal that went away. [`restore`]
    /// shows the cursor.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<Stdout>>>,
    mouse: bool,
    /// `true` if the screen no longer shows the drawn frame.
    is_lost: bool,
}

impl Tui {
    /// Takes over the terminal: raw mode, alternate screen, bracketed paste, mouse if wanted.
    ///
    /// # Errors
    /// Returns the error of the terminal.
    pub fn enter(mouse: bool) -> io::Result<Self> {
        HOOK.call_once(|| {
            let before = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |info| {
                restore();
                before(info);
            }));
        });
        // The theme decides about colours; the library's own handling of NO_COLOR would remove bold and reverse, too.
        style::force_color_output(true);
        match take_over(mouse).and_then(|()| Terminal::new(CrosstermBackend::new(stdout()))) {
            Ok(terminal) => Ok(Self { terminal: ManuallyDrop::new(terminal), mouse, is_lost: false }),
            Err(error) => {
                restore();
                Err(error)
            }
        }
    }

    /// Restores the terminal and stops the program until the shell continues it.
    ///
    /// # Errors
    /// Returns the error of the terminal.
    pub fn suspend(&mut self) -> io::Result<()> {
        restore();
        // Stops the whole job, as the terminal does: a script or cargo may have started the program, and the shell
        // waits for them. This program handles the signal of Ctrl-Z, which would not stop it.
        rustix::process::kill_current_process_group(rustix::process::Signal::STOP)?;
        self.resume()
    }

    /// Restores the terminal for another program, until [`Self::resume`].
    pub fn leave(&mut self) {
        restore();
    }

    /// Takes over the terminal again after a stop, during which the shell has used it.
    ///
    /// # Errors
    /// Returns the error of the terminal.
    pub fn resume(&mut self) -> io::Result<()> {
        take_over(self.mouse)?;
        // Clearing the existing terminal would query the cursor position and wait for the answer.
        self.terminal = ManuallyDrop::new(Terminal::new(CrosstermBackend::new(stdout()))?);
        execute!(stdout(), Clear(ClearType::All))
    }

    /// Makes the next frame redraw everything. A window that shrinks and grows again between two looks has its old
    /// size, but has lost its contents.
    pub fn lose_screen(&mut self) {
        self.is_lost = true;
    }

    /// Draws a frame. Terminals with synchronized updates show it all at once.
    ///
    /// # Errors
    /// Returns the error of the terminal.
    pub fn draw(&mut self, state: &AppState) -> io::Result<()> {
        execute!(stdout(), BeginSynchronizedUpdate)?;
        if std::mem::take(&mut self.is_lost) {
            let size = self.terminal.size()?;
            self.terminal.resize(size.into())?;
        }
        self.terminal.draw(|frame| draw(state, frame))?;
        execute!(stdout(), EndSynchronizedUpdate)
    }

    /// Returns the terminal to draw on.
    pub fn terminal(&mut self) -> &mut Terminal<CrosstermBackend<Stdout>> {
        &mut self.terminal
    }
}

impl Drop for Tui {
    fn drop(&mut self) {
        restore();
    }
}

/// Turns on raw mode, alternate screen, bracketed paste, and the mouse if wanted.
fn take_over(mouse: bool) -> io::Result<()> {
    enable_raw_mode()?;
    TAKEN_OVER.store(true, Ordering::SeqCst);
    execute!(stdout(), EnterAlternateScreen, EnableBracketedPaste)?;
    if mouse { execute!(stdout(), EnableMouseCapture) } else { Ok(()) }
}

/// Returns `true` if a shell with job control waits for this program. Only such a shell continues it after a stop. The
/// process that leads a session, as under `xterm -e` or in a container, has no such shell.
pub(super) fn can_be_continued() -> bool {
    /// The greatest number of programs between this one and the shell, such as scripts and cargo.
    const MOST: usize = 64;
    let Some([mut ancestor, group, session]) = kin("self") else { return false };
    for _ in 0..MOST {
        match kin(&ancestor) {
            Some([_, its_group, its_session]) if its_session == session && its_group != group => return true,
            Some([parent, _, its_session]) if its_session == session => ancestor = parent,
            // Also a parent in another PID namespace, which is 0.
            _ => return false,
        }
    }
    false
}

/// Returns the parent, the group and the session of a process, which is a number or `self`.
#[cfg(target_os = "linux")]
fn kin(process: &str) -> Option<[String; 3]> {
    let stat = std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    // The name of the program is in brackets and may itself contain brackets and blanks.
    let mut numbers = stat.rsplit_once(") ")?.1.split(' ').skip(1).map(str::to_owned);
    Some([numbers.next()?, numbers.next()?, numbers.next()?])
}

/// Returns the parent, the group and the session of a process, which is a number or `self`. The parent of another process
/// is unknown, 0.
#[cfg(not(target_os = "linux"))]
fn kin(process: &str) -> Option<[String; 3]> {
    use rustix::process::{Pid, getpgid, getppid, getsid};
    let other = if process == "self" { None } else { Some(Pid::from_raw(process.parse().ok()?)?) };
    let parent = other.map_or_else(getppid, |_| None);
    Some([parent, getpgid(other).ok(), getsid(other).ok()].map(|id| Pid::as_raw(id).to_string()))
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
    // Each command on its own: if one fails, the others still help.
    let mut out = stdout();
    execute!(out, EndSynchronizedUpdate, DisableMouseCapture).ok();
    execute!(out, DisableBracketedPaste).ok();
    execute!(out, LeaveAlternateScreen, cursor::Show, style::ResetColor).ok();
    disable_raw_mode().ok();
    out.flush().ok();
}
