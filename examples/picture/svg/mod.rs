//! A screen as an SVG picture, for documents.

use std::fmt::Write as _;

mod shapes;

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

use shapes::{Shape, shape};

/// Size of a cell, px.
const CELL: (f64, f64) = (8.4, 17.0);
/// Space around the screen, px.
const MARGIN: f64 = 12.0;
/// Height of the baseline above the bottom of a cell, px.
const DESCENT: f64 = 4.2;
/// The colour of the screen, and of text without a colour.
const GROUND: &str = "#16181d";
const INK: &str = "#d6dae1";
/// The sixteen colours of a terminal.
const ANSI: [&str; 16] = [
    "#16181d", "#e06c5b", "#5bb98c", "#d9a441", "#5c9dd5", "#c58ac9", "#56b6c2", "#c5cad3", "#78808d",
    "#ef8a7a", "#7fd6aa", "#f0c674", "#86b9ea", "#dba6de", "#7fd1db", "#ffffff",
];

/// Returns the screen as a complete SVG document with a dark ground.
#[must_use]
pub(crate) fn svg(buffer: &Buffer) -> String {
    let area = buffer.area;
    let width = f64::from(area.width) * CELL.0 + 2.0 * MARGIN;
    let height = f64::from(area.height) * CELL.1 + 2.0 * MARGIN;
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.1} {height:.1}" width="{width:.0}" height="{height:.0}" font-family="DejaVu Sans Mono, Menlo, Consolas, monospace" font-size="13.9">
<rect width="100%" height="100%" rx="8" fill="{GROUND}"/>"##
    );
    for y in area.top()..area.bottom() {
        let row: Vec<&Cell> = (area.left()..area.right()).filter_map(|x| buffer.cell((x, y))).collect();
        let top = MARGIN + f64::from(y - area.top()) * CELL.1;
        backgrounds(&mut out, &row, top);
        texts(&mut out, &row, top);
    }
    out.push_str("</svg>\n");
    out
}

/// Draws runs of equal background other than the ground.
fn backgrounds(out: &mut String, row: &[&Cell], top: f64) {
    for (from, run) in runs(row, |cell| colours(cell).1) {
        let fill = colours(run[0]).1;
        if fill != GROUND {
            let x = MARGIN + from as f64 * CELL.0;
            let width = run.len() as f64 * CELL.0;
            let _ = writeln!(
                out,
                r#"<rect x="{x:.1}" y="{top:.1}" width="{width:.1}" height="{:.1}" fill="{fill}"/>"#,
                CELL.1
            );
        }
    }
}

/// Draws runs of equal style and kind of character. Text is forced to its width, so that fonts of another width keep
/// the columns.
fn texts(out: &mut String, row: &[&Cell], top: f64) {
    let style = |cell: &Cell| (colours(cell).0, cell.modifier & (Modifier::BOLD | Modifier::UNDERLINED));
    let kind = |cell: &Cell| match character(cell) {
        // Letters and symbols often come from two fonts.
        c if shape(c) == Shape::Text => (None, c.is_ascii()),
        c => (Some(std::mem::discriminant(&shape(c))), false),
    };
    for (from, run) in runs(row, |cell| (style(cell), kind(cell))) {
        let (fill, style) = style(run[0]);
        let x = MARGIN + from as f64 * CELL.0;
        let shapes = run.iter().map(|cell| shape(character(cell)));
        match shape(character(run[0])) {
            Shape::Text => text(out, run, (x, top), &fill, style),
            Shape::Lines(_) => {
                let arms: Vec<_> =
                    shapes.filter_map(|s| if let Shape::Lines(a) = s { Some(a) } else { None }).collect();
                shapes::lines(out, &arms, (x, top), &fill);
            }
            Shape::Dots(_) => {
                let bits: Vec<_> =
                    shapes.filter_map(|s| if let Shape::Dots(b) = s { Some(b) } else { None }).collect();
                shapes::dots(out, &bits, (x, top), &fill);
            }
            Shape::Block(..) => {
                for (at, one) in shapes.enumerate() {
                    if let Shape::Block(left, right, percent) = one {
                        shapes::block(out, (left, right, percent), (x + at as f64 * CELL.0, top), &fill);
                    }
                }
            }
        }
    }
}

/// Writes a run of text.
fn text(out: &mut String, run: &[&Cell], (x, top): (f64, f64), fill: &str, style: Modifier) {
    if run.iter().all(|cell| cell.symbol().trim().is_empty()) {
        return;
    }
    let y = top + CELL.1 - DESCENT;
    let length = run.len() as f64 * CELL.0;
    let bold = if style.contains(Modifier::BOLD) { r#" font-weight="bold""# } else { "" };
    let line = if style.contains(Modifier::UNDERLINED) { r#" text-decoration="underline""# } else { "" };
    let _ = write!(
        out,
        r#"<text x="{x:.1}" y="{y:.1}" textLength="{length:.1}" lengthAdjust="spacingAndGlyphs" xml:space="preserve" fill="{fill}"{bold}{line}>"#
    );
    for cell in run {
        escape(out, cell.symbol());
    }
    out.push_str("</text>\n");
}

/// Returns the character of a cell.
fn character(cell: &Cell) -> char {
    cell.symbol().chars().next().unwrap_or(' ')
}

/// Groups neighbours with an equal key. Yields the start and the cells of each group.
fn runs<'r, 'c, K: PartialEq>(
    row: &'r [&'c Cell],
    key: impl Fn(&Cell) -> K,
) -> impl Iterator<Item = (usize, &'r [&'c Cell])> {
    let mut at = 0;
    row.chunk_by(move |a, b| key(a) == key(b)).map(move |run| {
        let from = at;
        at += run.len();
        (from, run)
    })
}

/// Returns the text and background colours of a cell.
fn colours(cell: &Cell) -> (String, String) {
    let fg = colour(cell.fg, INK);
    let bg = colour(cell.bg, GROUND);
    if cell.modifier.contains(Modifier::REVERSED) { (bg, fg) } else { (fg, bg) }
}

fn colour(colour: Color, reset: &str) -> String {
    let ansi = |index: usize| ANSI[index].to_owned();
    match colour {
        Color::Reset => reset.to_owned(),
        Color::Rgb(r, g, b) => format!("#{r:02x}{g:02x}{b:02x}"),
        Color::Black => ansi(0),
        Color::Red => ansi(1),
        Color::Green => ansi(2),
        Color::Yellow => ansi(3),
        Color::Blue => ansi(4),
        Color::Magenta => ansi(5),
        Color::Cyan => ansi(6),
        Color::Gray => ansi(7),
        Color::DarkGray => ansi(8),
        Color::LightRed => ansi(9),
        Color::LightGreen => ansi(10),
        Color::LightYellow => ansi(11),
        Color::LightBlue => ansi(12),
        Color::LightMagenta => ansi(13),
        Color::LightCyan => ansi(14),
        Color::White => ansi(15),
        Color::Indexed(index @ 0..16) => ansi(usize::from(index)),
        Color::Indexed(index @ 16..232) => {
            let cube = index - 16;
            let level = |step: u8| if step == 0 { 0 } else { 55 + 40 * step };
            format!("#{:02x}{:02x}{:02x}", level(cube / 36), level(cube / 6 % 6), level(cube % 6))
        }
        Color::Indexed(index) => {
            let grey = 8 + 10 * (index - 232);
            format!("#{grey:02x}{grey:02x}{grey:02x}")
        }
    }
}

fn escape(out: &mut String, text: &str) {
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ratatui::layout::Rect;
    use ratatui::style::Style;

    #[test]
    #[allow(clippy::disallowed_methods, reason = "the text fits the buffer of this test")]
    fn a_picture_keeps_text_columns_and_colours() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 12, 2));
        buffer.set_string(2, 0, "a<b", Style::new().fg(Color::Rgb(1, 2, 3)));
        buffer.set_string(5, 0, "⣿⣿", Style::new().fg(Color::Rgb(1, 2, 3)));
        buffer.set_string(0, 1, "lit", Style::new().fg(Color::White).add_modifier(Modifier::REVERSED));
        let svg = svg(&buffer);
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert!(svg.contains(">a&lt;b</text>"), "{svg}");
        assert!(svg.contains(r##"x="28.8" y="24.8" textLength="25.2""##), "{svg}");
        assert_eq!(svg.matches("h0").count(), 16, "{svg}");
        assert!(svg.contains(r##"width="25.2" height="17.0" fill="#ffffff""##), "{svg}");
    }
}
