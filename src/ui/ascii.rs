//! The ASCII picture. Panels draw with the full character set; this module replaces characters that the terminal cannot
//! show.

use ratatui::buffer::Buffer;

/// Replaces every character outside ASCII in `buffer`.
pub(super) fn replace(buffer: &mut Buffer) {
    let width = usize::from(buffer.area.width).max(1);
    for at in 0..buffer.content.len() {
        let symbol = buffer.content[at].symbol();
        if symbol.is_ascii() {
            continue;
        }
        let first = symbol.chars().next();
        let mut shown = first.map_or(' ', plain);
        // `<=` and `->` use the blank after them.
        let second = match first {
            Some('≤' | '≥') => Some('='),
            Some('→') if is_transition(buffer, at, width) => {
                shown = '-';
                Some('>')
            }
            _ => None,
        };
        if let Some(second) = second
            && (at + 1) % width != 0
            && let Some(next) = buffer.content.get_mut(at + 1).filter(|next| next.symbol() == " ")
        {
            next.set_char(second);
        }
        buffer.content[at].set_char(shown);
    }
}

/// Returns `true` for an arrow with a blank on each side and words beyond, from one state or value to another.
fn is_transition(buffer: &Buffer, at: usize, width: usize) -> bool {
    let column = at % width;
    if column < 2 || column + 2 >= width {
        return false;
    }
    let is_blank = |at: usize| buffer.content[at].symbol() == " ";
    let is_word =
        |at: usize| buffer.content[at].symbol().chars().all(|c| c.is_alphanumeric() || ")%°—-".contains(c));
    is_blank(at - 1) && is_blank(at + 1) && is_word(at - 2) && is_word(at + 2)
}

/// Returns the nearest ASCII character.
fn plain(c: char) -> char {
    match c {
        '━' => '=',
        '─' | '╌' | '╍' | '—' | '−' | '–' => '-',
        '│' | '┃' | '╎' | '╏' | '▐' | '▌' | '‖' => '|',
        '╱' => '/',
        '╲' => '\\',
        '●' | '▮' | '█' | '■' => '#',
        '•' | '○' | '◌' | '◎' | '◯' | '∞' => 'o',
        '▯' | '░' | '·' | '┈' => '.',
        '▁' => '_',
        '˙' => '\'',
        '◆' | '◇' | '×' | '✎' => '*',
        '⊕' => '+',
        '⇄' => '=',
        '⌂' => 'H',
        '≠' => '!',
        '▲' | '↑' => '^',
        '▼' | '↓' => 'v',
        '►' | '▶' | '▸' | '→' | '➤' => '>',
        '◄' | '◀' | '←' | '◂' | '≤' => '<',
        '≥' => '>',
        '↗' | '↙' => '/',
        '↘' | '↖' => '\\',
        '✓' => 'y',
        '✗' | '✖' => 'x',
        '°' => 'd',
        'µ' => 'u',
        '²' => '2',
        '…' | '≈' => '~',
        '\u{2500}'..='\u{257f}' => '+',
        '\u{2800}'..='\u{28ff}' => '.',
        _ => '?',
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;

    #[test]
    fn an_arrow_between_two_states_is_drawn_as_two_characters() {
        for (drawn, shown) in [
            ("IDLE → APPROACHING", "IDLE ->APPROACHING"),
            ("xte 1.2 m → 0.9 m", "xte 1.2 m ->0.9 m"),
            ("→ F flies", "> F flies"),
            (" ← → size", " < > size"),
            ("WP1→2", "WP1>2"),
            ("5.5 ≤ 5.5", "5.5 <=5.5"),
        ] {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 20, 1));
            for (cell, c) in buffer.content.iter_mut().zip(drawn.chars()) {
                cell.set_char(c);
            }
            replace(&mut buffer);
            let text: String = buffer.content.iter().map(ratatui::buffer::Cell::symbol).collect();
            assert_eq!(text.trim_end(), shown);
        }
    }
}
