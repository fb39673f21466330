//! The tracks of a comparison in one picture, north up.

mod canvas;

use std::fmt::Write as _;

use nalgebra::Vector2;

use super::{Comparison, Side};
use crate::plan::WaypointType;
use crate::report::xml::escaped;
use canvas::Canvas;

/// The colours of the two firmwares. People who cannot see red or green can tell them apart, too.
const COLOURS: [&str; 2] = ["#0072b2", "#d55e00"];
/// The widths of their first flights, so that both are visible where they coincide, px.
const WIDTHS: [f64; 2] = [1.5, 3.5];
/// Width of the other flights, px.
const THIN: f64 = 0.8;
/// Height of a line of text, px.
const LINE: f64 = 18.0;
/// Left edge of texts, px.
const LEFT: f64 = 16.0;

pub(super) fn picture(comparison: &Comparison) -> String {
    let route = comparison.route.points.iter().filter_map(|point| point.ne);
    let flown = comparison.sides.iter().flat_map(|side| &side.flights).flat_map(|flight| &flight.samples);
    let places = route.chain(flown.map(|sample| sample.ne)).chain([Vector2::zeros()]);
    // The title, the two names and the scale are above the map.
    let canvas = Canvas::around(places, 4.5 * LINE);
    let mut text = canvas.head(&format!("{}: two tracks", comparison.plan));
    heading(&mut text, comparison);
    legs(&mut text, comparison, &canvas);
    // The first firmware is on top.
    for ((side, colour), width) in comparison.sides.iter().zip(COLOURS).zip(WIDTHS).rev() {
        tracks(&mut text, side, colour, width, &canvas);
    }
    waypoints(&mut text, comparison, &canvas);
    canvas.scale_bar(&mut text);
    text.push_str("</svg>\n");
    text
}

/// Draws the title and the legend of the colours.
fn heading(text: &mut String, comparison: &Comparison) {
    let title = format!("{}, {}", comparison.plan, comparison.conditions);
    let _ = writeln!(
        text,
        "<text x=\"{LEFT}\" y=\"{LINE}\" font-size=\"14\" font-weight=\"bold\">{}</text>",
        escaped(&title)
    );
    for (index, (side, colour)) in comparison.sides.iter().zip(COLOURS).enumerate() {
        let y = LINE * (index as f64 + 2.0);
        let letter = ["A", "B"].get(index).copied().unwrap_or_default();
        let _ = writeln!(
            text,
            "<line x1=\"{LEFT}\" y1=\"{line_y:.1}\" x2=\"{:.1}\" y2=\"{line_y:.1}\" stroke=\"{colour}\" stroke-width=\"3\"/>\n\
             <text x=\"{:.1}\" y=\"{y:.1}\">{letter}: {}</text>",
            LEFT + 24.0,
            LEFT + 32.0,
            escaped(&side.name),
            line_y = y - 4.0,
        );
    }
}

/// Draws the straight legs, dashed.
fn legs(text: &mut String, comparison: &Comparison, canvas: &Canvas) {
    let first = comparison.sides.iter().find_map(|side| side.flights.first()?.samples.first());
    let places = first.map(|sample| sample.ne).into_iter();
    let points: Vec<String> = places
        .chain(comparison.route.points.iter().filter_map(|point| point.ne))
        .map(|ne| canvas.point(ne))
        .collect();
    let _ = writeln!(
        text,
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#888888\" stroke-dasharray=\"5 4\"/>",
        points.join(" ")
    );
    for point in comparison.route.points.iter().filter(|point| point.pattern_m > 0.0) {
        let Some(ne) = point.ne else { continue };
        let (x, y) = canvas.place(ne);
        let radius = canvas.length(point.pattern_m);
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"none\" stroke=\"#888888\" stroke-dasharray=\"5 4\"/>"
        );
    }
}

/// Draws the flights of one firmware, the first one bold.
fn tracks(text: &mut String, side: &Side, colour: &str, bold: f64, canvas: &Canvas) {
    for (index, flight) in side.flights.iter().enumerate().rev() {
        let width = if index == 0 { bold } else { THIN };
        let points = canvas.line(flight.samples.iter().map(|sample| sample.ne));
        let _ = writeln!(
            text,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"/>"
        );
        if let Some((_, ne)) = flight.touchdown {
            let (x, y) = canvas.place(ne);
            let _ = writeln!(
                text,
                "<path d=\"M {:.1} {:.1} l 8 8 m 0 -8 l -8 8\" stroke=\"{colour}\" stroke-width=\"2\"/>",
                x - 4.0,
                y - 4.0
            );
        }
    }
}

/// Draws home and the waypoints with their numbers.
fn waypoints(text: &mut String, comparison: &Comparison, canvas: &Canvas) {
    let (x, y) = canvas.place(Vector2::zeros());
    let _ = writeln!(
        text,
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"8\" height=\"8\" fill=\"#000000\"/>\n\
         <text x=\"{:.1}\" y=\"{:.1}\">home</text>",
        x - 4.0,
        y - 4.0,
        x + 8.0,
        y + 14.0
    );
    for point in &comparison.route.points {
        let Some(ne) = point.ne else { continue };
        let (x, y) = canvas.place(ne);
        let kind =
            if point.kind == WaypointType::Flyover { String::new() } else { format!(" {}", point.kind) };
        let _ = writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"#ffffff\" stroke=\"#000000\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\">WP{}{kind}</text>",
            x + 8.0,
            y - 6.0,
            point.wp
        );
    }
}
