//! Places for texts beside marks, so that they do not cover each other.

use super::Point;
use super::canvas::{Anchor, text_width};

/// The distance of a text from its mark, px.
const GAP: f64 = 7.0;

/// The texts of a picture so far.
#[derive(Debug, Default)]
pub(super) struct Labels {
    /// Left, top, right and bottom, px.
    taken: Vec<[f64; 4]>,
}

impl Labels {
    /// Takes the place of a mark, px to the right and down.
    pub(super) fn mark(&mut self, (x, y): Point, radius: f64) {
        self.taken.push([x - radius, y - radius, x + radius, y + radius]);
    }

    /// Returns the side of the mark and the centre of a text beside it, px. Returns `None` if there is no place.
    pub(super) fn place(
        &mut self,
        (x, y): Point,
        text: &str,
        size: f64,
        width: f64,
    ) -> Option<(Anchor, Point)> {
        let length = text_width(text, size);
        let sides = [(Anchor::Start, x + GAP, x + GAP), (Anchor::End, x - GAP - length, x - GAP)];
        for dy in [-GAP, GAP] {
            for (side, left, at) in sides.iter() {
                let middle = y + dy;
                let box_of = [*left, middle - size / 2.0, left + length, middle + size / 2.0];
                let fits = *left >= 0.0 && left + length <= width;
                if fits && !self.taken.iter().any(|other| overlap(other, &box_of)) {
                    self.taken.push(box_of);
                    return Some((*side, (*at, middle)));
                }
            }
        }
        None
    }
}

fn overlap(one: &[f64; 4], other: &[f64; 4]) -> bool {
    one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_texts_fit_around_a_place_and_the_fifth_is_left_out() {
        let mut labels = Labels::default();
        let places: Vec<_> = (0..5).map(|_| labels.place((100.0, 100.0), "WP 1", 12.0, 400.0)).collect();
        assert!(places[..4].iter().all(Option::is_some) && places[4].is_none());
        let near_the_edge = labels.place((395.0, 50.0), "a long name", 12.0, 400.0).expect("a place");
        assert!(matches!(near_the_edge.0, Anchor::End));
    }
}
