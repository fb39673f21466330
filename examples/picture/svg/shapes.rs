//! Characters that are drawings: box lines, blocks and Braille as paths, so that a picture does not depend on the
//! viewer's font.

use std::fmt::Write as _;

use super::CELL;

/// Diameter of a Braille dot and width of a line, px.
const DOT: f64 = 2.1;
const STROKE: f64 = 1.1;

/// The way to draw a character.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// By the font.
    Text,
    /// Strokes from the middle to these sides: up, right, down, left.
    Lines([bool; 4]),
    /// Dots, one for each bit in Unicode's order.
    Dots(u8),
    /// A block: the first and the last eighth of the width, and the opacity in percent.
    Block(u8, u8, u8),
}

/// Returns the way to draw a character.
pub(super) fn shape(c: char) -> Shape {
    match c {
        '─' => Shape::Lines([false, true, false, true]),
        '│' => Shape::Lines([true, false, true, false]),
        '┌' => Shape::Lines([false, true, true, false]),
        '┐' => Shape::Lines([false, false, true, true]),
        '└' => Shape::Lines([true, true, false, false]),
        '┘' => Shape::Lines([true, false, false, true]),
        '├' => Shape::Lines([true, true, true, false]),
        '┤' => Shape::Lines([true, false, true, true]),
        '┬' => Shape::Lines([false, true, true, true]),
        '┴' => Shape::Lines([true, true, false, true]),
        '┼' => Shape::Lines([true; 4]),
        '█' => Shape::Block(0, 8, 100),
        '▌' => Shape::Block(0, 4, 100),
        '▐' => Shape::Block(4, 8, 100),
        '░' => Shape::Block(0, 8, 35),
        '\u{2800}'..='\u{28ff}' => Shape::Dots((u32::from(c) - 0x2800) as u8),
        _ => Shape::Text,
    }
}

/// Draws neighbours of one colour that are all lines, from the top left corner `(x, y)`.
pub(super) fn lines(out: &mut String, run: &[[bool; 4]], (x, y): (f64, f64), colour: &str) {
    let _ = write!(out, r#"<path fill="none" stroke="{colour}" stroke-width="{STROKE}" d=""#);
    let middle = y + CELL.1 / 2.0;
    // Strokes that continue sideways become one.
    let mut from: Option<f64> = None;
    for (at, [_, right, _, left]) in run.iter().enumerate() {
        let column = x + at as f64 * CELL.0;
        if !*left && let Some(start) = from.take() {
            let _ = write!(out, "M{start:.1} {middle:.1}H{column:.1}");
        }
        let begin = if *left { column } else { column + CELL.0 / 2.0 };
        let end = if *right { column + CELL.0 } else { column + CELL.0 / 2.0 };
        let start = from.unwrap_or(begin);
        from = right.then_some(start);
        if !*right && end > start {
            let _ = write!(out, "M{start:.1} {middle:.1}H{end:.1}");
        }
    }
    if let Some(start) = from {
        let _ = write!(out, "M{start:.1} {middle:.1}H{:.1}", x + run.len() as f64 * CELL.0);
    }
    for (at, [up, _, down, _]) in run.iter().enumerate() {
        let centre = x + (at as f64 + 0.5) * CELL.0;
        let top = if *up { y } else { middle };
        let bottom = if *down { y + CELL.1 } else { middle };
        if bottom > top {
            let _ = write!(out, "M{centre:.1} {top:.1}V{bottom:.1}");
        }
    }
    out.push_str("\"/>\n");
}

/// Draws neighbours of one colour that are all Braille.
pub(super) fn dots(out: &mut String, run: &[u8], (x, y): (f64, f64), colour: &str) {
    /// Column and row of each bit.
    const PLACES: [(f64, f64); 8] =
        [(0.0, 0.0), (0.0, 1.0), (0.0, 2.0), (1.0, 0.0), (1.0, 1.0), (1.0, 2.0), (0.0, 3.0), (1.0, 3.0)];
    let _ =
        write!(out, r#"<path fill="none" stroke="{colour}" stroke-width="{DOT}" stroke-linecap="round" d=""#);
    for (at, bits) in run.iter().enumerate() {
        for (bit, (column, row)) in PLACES.iter().enumerate() {
            if bits & (1 << bit) != 0 {
                let dot_x = x + (at as f64 + 0.25 + column / 2.0) * CELL.0;
                let dot_y = y + (row + 0.5) * CELL.1 / 4.0;
                let _ = write!(out, "M{dot_x:.1} {dot_y:.1}h0");
            }
        }
    }
    out.push_str("\"/>\n");
}

/// Draws one block.
pub(super) fn block(out: &mut String, (from, to, percent): (u8, u8, u8), (x, y): (f64, f64), colour: &str) {
    let eighth = CELL.0 / 8.0;
    let left = x + f64::from(from) * eighth;
    let width = f64::from(to - from) * eighth;
    let opacity = f64::from(percent) / 100.0;
    let _ = writeln!(
        out,
        r#"<rect x="{left:.1}" y="{y:.1}" width="{width:.1}" height="{:.1}" fill="{colour}" fill-opacity="{opacity}"/>"#,
        CELL.1
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_join_into_strokes() {
        let Shape::Lines(corner) = shape('┌') else { panic!("a line") };
        let Shape::Lines(flat) = shape('─') else { panic!("a line") };
        let mut out = String::new();
        lines(&mut out, &[corner, flat, flat], (0.0, 0.0), "red");
        assert!(out.contains("M4.2 8.5H25.2"), "{out}");
        assert!(out.contains("M4.2 8.5V17.0"), "{out}");
    }

    #[test]
    fn braille_has_a_dot_for_each_bit() {
        let mut out = String::new();
        dots(&mut out, &[0xff, 0x01], (0.0, 0.0), "red");
        assert_eq!(out.matches("h0").count(), 9);
    }
}
