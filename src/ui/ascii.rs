//! The seven-bit picture: panels draw with the full character set, and this replaces what the terminal cannot show.

use ratatui::buffer::Buffer;

/// Replaces every character outside ASCII in `buffer`.
pub(super) fn replace(buffer: &mut Buffer) {
    for cell in &mut buffer.content {
        if cell.symbol().is_ascii() {
            continue;
        }
        let plain = cell.symbol().chars().next().map_or(' ', plain);
        cell.set_char(plain);
    }
}

/// The nearest ASCII character.
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
        '˙' => '\'',
        '◆' | '◇' | '×' | '✎' => '*',
        '⌖' | '⊕' => '+',
        '⇄' => '=',
        '⌂' => 'H',
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
