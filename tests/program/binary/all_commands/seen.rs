//! The proofs on the screen that a command acted or was refused.

use std::cmp::Ordering;

use crate::binary::pty::Terminal;

/// The change of the screen that a step makes. In texts, a blank stands for one or more.
#[derive(Debug, Clone, Copy)]
pub(super) enum Seen {
    /// A text appears.
    Shows(&'static str),
    /// A text disappears.
    Hides(&'static str),
    /// The first text gives way to the second one.
    Turns(&'static str, &'static str),
    /// A text moves: to the right or the left, down or up, or not at all in that direction.
    Moves(&'static str, Ordering, Ordering),
    /// The clock shows a later or an earlier time.
    Clock(Ordering),
    /// The background has this colour.
    Paints(u8, u8, u8),
}

/// The screen before a step, as far as the proof needs it.
#[derive(Debug, Default)]
pub(super) struct Before {
    place: Option<(usize, usize)>,
    clock: Option<f64>,
}

/// Returns the screen with one blank for each run of them, because the width of columns depends on the size of the screen.
fn text(terminal: &Terminal) -> String {
    let mut text = terminal.screen();
    text.retain({
        let mut was_blank = false;
        move |c| !std::mem::replace(&mut was_blank, c == ' ') || c != ' '
    });
    text
}

/// Returns column and row of a text.
fn place(screen: &str, text: &str) -> Option<(usize, usize)> {
    let mut rows = screen.lines().enumerate();
    rows.find_map(|(row, line)| Some((line[..line.find(text)?].chars().count(), row)))
}

/// Returns the time in the second row, s.
fn clock(terminal: &Terminal) -> Option<f64> {
    let row = terminal.row(1);
    let (minutes, seconds) = row.split_whitespace().find_map(|word| word.split_once(':'))?;
    Some(minutes.parse::<f64>().ok()? * 60.0 + seconds.parse::<f64>().ok()?)
}

impl Seen {
    /// Waits until the screen does not show yet what a step must show, because a frame may still be on its way. Returns what
    /// is needed of it.
    #[track_caller]
    pub(super) fn before(self, terminal: &mut Terminal, step: &str) -> Before {
        terminal.until(&format!("nothing yet of {step}"), |terminal| self.can_be_proved(terminal));
        let screen = terminal.screen();
        let place = match self {
            Self::Moves(text, ..) => place(&screen, text),
            _ => None,
        };
        Before { place, clock: clock(terminal) }
    }

    /// Returns `true` if the screen does not show the change yet.
    fn can_be_proved(self, terminal: &Terminal) -> bool {
        let screen = text(terminal);
        match self {
            Self::Shows(text) => !screen.contains(text),
            Self::Hides(text) => screen.contains(text),
            Self::Turns(from, to) => screen.contains(from) && !screen.contains(to),
            Self::Moves(text, ..) => screen.contains(text),
            Self::Clock(_) => clock(terminal).is_some(),
            Self::Paints(..) => !self.is_seen(terminal, &Before::default()),
        }
    }

    /// Returns `true` if the screen shows the change.
    pub(super) fn is_seen(self, terminal: &Terminal, before: &Before) -> bool {
        let screen = text(terminal);
        match self {
            Self::Shows(text) => screen.contains(text),
            Self::Hides(text) => !screen.contains(text),
            Self::Turns(from, to) => screen.contains(to) && !screen.contains(from),
            Self::Moves(text, columns, rows) => match (before.place, place(&terminal.screen(), text)) {
                (Some(was), Some(now)) => now.0.cmp(&was.0) == columns && now.1.cmp(&was.1) == rows,
                _ => false,
            },
            Self::Clock(order) => {
                clock(terminal).partial_cmp(&before.clock).is_some_and(|found| found == order)
            }
            Self::Paints(r, g, b) => terminal.background() == vt100::Color::Rgb(r, g, b),
        }
    }
}
