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
        // `<=` uses the blank after it.
        if let Some('≤' | '≥') = first
            && (at + 1) % width != 0
            && let Some(next) = buffer.content.get_mut(at + 1).filter(|next| next.symbol() == " ")
        {
            next.set_char('=');
        }
        buffer.content[at].set_char(first.map_or(' ', plain));
    }
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
