//! Metres on the ground as pixels of a picture.

use std::fmt::Write as _;

use nalgebra::Vector2;

use crate::report::xml::escaped;

/// The longer side of the map, px.
const SIDE: f64 = 800.0;
/// The margin around the map, px. The names of waypoints use it, too.
const MARGIN: f64 = 60.0;
/// The least extent of the ground in the picture, m.
const LEAST_M: f64 = 20.0;
/// The least distance between two points of a line, px. Closer points are not drawn.
const STEP: f64 = 1.2;
/// The widest scale bar, as a share of the map.
const BAR: f64 = 0.3;

/// The mapping from the ground to the picture.
#[derive(Debug, Clone, Copy)]
pub(super) struct Canvas {
    /// The south-west corner of the map, m north and east.
    low: Vector2<f64>,
    /// The north-east corner of the map.
    high: Vector2<f64>,
    px_per_m: f64,
    /// Height above the map, px.
    top: f64,
}

impl Canvas {
    /// Returns a picture that contains all the places, below `top` px for texts.
    pub(super) fn around(places: impl Iterator<Item = Vector2<f64>>, top: f64) -> Self {
        let (mut low, mut high) = (Vector2::zeros(), Vector2::zeros());
        for place in places.filter(|place| place.iter().all(|value| value.is_finite())) {
            low = low.inf(&place);
            high = high.sup(&place);
        }
        let extent = (high - low).max().max(LEAST_M);
        Self { low, high, px_per_m: SIDE / extent, top }
    }

    /// Returns the width and the height of the picture, px.
    fn size(&self) -> (f64, f64) {
        let (north, east) = ((self.high - self.low).x, (self.high - self.low).y);
        let width = (self.length(east) + 2.0 * MARGIN).max(SIDE / 2.0);
        (width, self.top + self.length(north) + 2.0 * MARGIN)
    }

    /// Converts a length to px.
    pub(super) fn length(&self, metres: f64) -> f64 {
        metres * self.px_per_m
    }

    /// Converts a place to px to the right and down.
    pub(super) fn place(&self, ne: Vector2<f64>) -> (f64, f64) {
        let (right, down) = (ne.y - self.low.y, self.high.x - ne.x);
        (MARGIN + self.length(right), self.top + MARGIN + self.length(down))
    }

    /// Returns a place in the form of a point of a line.
    pub(super) fn point(&self, ne: Vector2<f64>) -> String {
        let (x, y) = self.place(ne);
        format!("{x:.1},{y:.1}")
    }

    /// Returns the points of a line, with only one of points that are too close to each other.
    pub(super) fn line(&self, places: impl Iterator<Item = Vector2<f64>>) -> String {
        let mut drawn: Vec<String> = Vec::new();
        let mut last: Option<Vector2<f64>> = None;
        for place in places {
            if last.is_none_or(|last| self.length((place - last).norm()) >= STEP) {
                drawn.push(self.point(place));
                last = Some(place);
            }
        }
        drawn.join(" ")
    }

    /// Returns the beginning of the document.
    pub(super) fn head(&self, title: &str) -> String {
        let (width, height) = self.size();
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" font-size=\"12\">\n\
             <title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
            escaped(title)
        )
    }

    /// Draws a bar of a round length, and the direction of north.
    pub(super) fn scale_bar(&self, text: &mut String) {
        let metres = round_length(BAR * SIDE / self.px_per_m);
        let (_, height) = self.size();
        let (x, y) = (16.0, height - 16.0);
        let end = x + self.length(metres);
        let _ = writeln!(
            text,
            "<path d=\"M {x:.1} {:.1} V {y:.1} H {end:.1} V {:.1}\" fill=\"none\" stroke=\"#000000\"/>\n\
             <text x=\"{:.1}\" y=\"{:.1}\">{metres} m</text>\n\
             <text x=\"{:.1}\" y=\"{:.1}\">north ↑</text>",
            y - 6.0,
            y - 6.0,
            x + 4.0,
            y - 4.0,
            end + 16.0,
            y
        );
    }
}

/// Returns the longest length of 1, 2, 5, 10, 20, 50 … that is at most `most`.
fn round_length(most: f64) -> f64 {
    let power = 10_f64.powf(most.max(1.0).log10().floor());
    [5.0, 2.0].into_iter().map(|factor| factor * power).find(|length| *length <= most).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_have_round_lengths() {
        for (most, length) in [(0.3, 1.0), (1.0, 1.0), (4.9, 2.0), (6.0, 5.0), (99.0, 50.0), (100.0, 100.0)] {
            assert!((round_length(most) - length).abs() < 1e-9, "{most}");
        }
    }

    #[test]
    fn north_is_up_and_east_to_the_right() {
        let canvas = Canvas::around([Vector2::new(100.0, 50.0)].into_iter(), 40.0);
        let (x, y) = canvas.place(Vector2::zeros());
        let (north_east_x, north_east_y) = canvas.place(Vector2::new(100.0, 50.0));
        assert!((north_east_x - x - 400.0).abs() < 1e-9 && (y - north_east_y - 800.0).abs() < 1e-9);
        let (width, height) = canvas.size();
        assert!((0.0..width).contains(&north_east_x) && (0.0..height).contains(&y));
    }
}
