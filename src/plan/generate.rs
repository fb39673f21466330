//! Plans from a few numbers: square, circle, zig-zag, and survey lines over a rectangle.

use std::f64::consts::TAU;

use nalgebra::Vector2;

use super::{Altitude, LegSpeed, MAX_WAYPOINTS, Waypoint, WaypointType};
use crate::geo::{GroundPlane, LatLon};
use crate::math;

/// A shape that can be generated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, strum::Display, strum::EnumIter, strum::EnumString)]
#[strum(serialize_all = "kebab-case", ascii_case_insensitive)]
pub enum Shape {
    /// The corners of a rectangle, and back to the first corner.
    #[default]
    Square,
    /// Points on a circle, and back to the first point.
    Circle,
    /// From side to side along the length.
    ZigZag,
    /// Parallel lines over a rectangle, flown back and forth.
    Survey,
}

/// A shape with its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pattern {
    /// The shape.
    pub shape: Shape,
    /// Extent along the heading, m; the diameter of a circle.
    pub length_m: f64,
    /// Extent across, m.
    pub width_m: f64,
    /// Distance between neighbours, m: points of a circle, turns of a zig-zag, lines of a survey.
    pub spacing_m: f64,
    /// Direction of the length, degrees from north, clockwise.
    pub heading_deg: f64,
    /// Altitude of all waypoints.
    pub altitude: Altitude,
    /// Speed on all legs.
    pub speed: LegSpeed,
    /// Type of all waypoints.
    pub kind: WaypointType,
}

impl Default for Pattern {
    fn default() -> Self {
        Self {
            shape: Shape::Square,
            length_m: 80.0,
            width_m: 80.0,
            spacing_m: 20.0,
            heading_deg: 0.0,
            altitude: Altitude::above_home(20.0),
            speed: LegSpeed::default(),
            kind: WaypointType::Flyover,
        }
    }
}

/// The smallest and the largest extent, m.
const EXTENT_M: std::ops::RangeInclusive<f64> = 1.0..=20_000.0;
/// A number of places that no real plan has. A spacing that needs more is a typing error.
const MAX_PLACES: usize = 3000;

impl Pattern {
    /// Returns the places, metres north and east of the middle, in flight order.
    ///
    /// # Errors
    /// Returns a sentence with the mistake in the numbers.
    pub fn places(&self) -> Result<Vec<Vector2<f64>>, String> {
        self.check()?;
        let (half, side) = (self.length_m / 2.0, self.width_m / 2.0);
        let steps = |extent: f64| (extent / self.spacing_m).round().max(1.0) as usize;
        let share = |step: usize, steps: usize| step as f64 / steps as f64;
        let mut places: Vec<Vector2<f64>> = match self.shape {
            Shape::Square => [(half, -side), (half, side), (-half, side), (-half, -side), (half, -side)]
                .map(|(n, e)| Vector2::new(n, e))
                .to_vec(),
            Shape::Circle => {
                let points = steps(TAU * half).max(3);
                (0..=points)
                    .map(|step| TAU * share(step % points, points))
                    .map(|angle| Vector2::new(math::cos(angle), math::sin(angle)) * half)
                    .collect()
            }
            Shape::ZigZag => {
                let turns = steps(self.length_m);
                (0..=turns)
                    .map(|step| {
                        let east = if step % 2 == 0 { -side } else { side };
                        Vector2::new(self.length_m * share(step, turns) - half, east)
                    })
                    .collect()
            }
            Shape::Survey => {
                let lines = steps(self.width_m);
                (0..=lines)
                    .flat_map(|line| {
                        let east = self.width_m * share(line, lines) - side;
                        let start = if line % 2 == 0 { -half } else { half };
                        [Vector2::new(start, east), Vector2::new(-start, east)]
                    })
                    .collect()
            }
        };
        let (sin, cos) = math::sin_cos(self.heading_deg.to_radians());
        for place in &mut places {
            *place = Vector2::new(place.x * cos - place.y * sin, place.x * sin + place.y * cos);
        }
        Ok(places)
    }

    fn check(&self) -> Result<(), String> {
        let numbers = [("length", self.length_m), ("width", self.width_m), ("spacing", self.spacing_m)];
        if let Some((name, value)) = numbers.into_iter().find(|(_, value)| !EXTENT_M.contains(value)) {
            let (least, most) = (EXTENT_M.start(), EXTENT_M.end());
            return Err(format!("The {name} is {value} m: {least} to {most} m is allowed."));
        }
        let longest = TAU / 2.0 * self.length_m.max(self.width_m);
        if longest / self.spacing_m > MAX_PLACES as f64 {
            return Err(format!(
                "A spacing of {} m makes far too many waypoints: make it wider.",
                self.spacing_m
            ));
        }
        if !self.heading_deg.is_finite() {
            return Err("The heading is not a number of degrees.".to_owned());
        }
        Ok(())
    }

    /// Returns the waypoints about `middle`; there may be more than a plan holds.
    ///
    /// # Errors
    /// Returns the errors of [`Self::places`].
    pub fn waypoints(&self, middle: LatLon) -> Result<Vec<Waypoint>, String> {
        let plane = GroundPlane::new(middle);
        let waypoint = |place| Waypoint {
            position: plane.to_position(place),
            altitude: self.altitude,
            speed: self.speed,
            kind: self.kind,
            ..Waypoint::default()
        };
        Ok(self.places()?.into_iter().map(waypoint).collect())
    }

    /// Returns the narrowest spacing, in whole metres, with which the shape has at most this many waypoints.
    pub fn spacing_that_fits(&self, most: usize) -> Option<f64> {
        let widest = self.length_m.max(self.width_m).ceil() * 4.0;
        let mut spacing_m = self.spacing_m.ceil();
        while spacing_m <= widest {
            let places = Self { spacing_m, ..*self }.places().ok()?;
            if places.len() <= most {
                return Some(spacing_m);
            }
            // The number of places falls with the inverse of the spacing, so a wide field does not need a try for
            // every metre.
            spacing_m = (spacing_m * 1.02).ceil().max(spacing_m + 1.0);
        }
        None
    }
}

/// Splits the waypoints into plans of at most [`MAX_WAYPOINTS`]. Each plan begins where the previous one ends.
pub fn split(waypoints: &[Waypoint]) -> Vec<Vec<Waypoint>> {
    let mut rest = waypoints;
    let mut plans = Vec::new();
    while rest.len() > MAX_WAYPOINTS {
        plans.push(rest[..MAX_WAYPOINTS].to_vec());
        rest = &rest[MAX_WAYPOINTS - 1..];
    }
    plans.push(rest.to_vec());
    plans
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_square_has_its_corners_and_ends_where_it_began() {
        let places = Pattern { heading_deg: 90.0, ..Pattern::default() }.places().unwrap();
        assert_eq!(places.len(), 5);
        assert!((places[0] - places[4]).norm() < 1e-9);
        assert!((places[0] - Vector2::new(40.0, 40.0)).norm() < 1e-9, "{}", places[0]);
    }

    #[test]
    fn a_survey_with_too_many_lines_finds_the_spacing_that_fits() {
        let field = Pattern { shape: Shape::Survey, width_m: 200.0, spacing_m: 5.0, ..Pattern::default() };
        let waypoints = field.waypoints(LatLon::default()).unwrap();
        assert_eq!(waypoints.len(), 82);
        let spacing_m = field.spacing_that_fits(MAX_WAYPOINTS).unwrap();
        let wider = Pattern { spacing_m, ..field }.places().unwrap();
        assert!(wider.len() <= MAX_WAYPOINTS && wider.len() > 20, "{spacing_m}: {}", wider.len());
        let plans = split(&waypoints);
        assert_eq!(plans.iter().map(Vec::len).collect::<Vec<_>>(), [30, 30, 24]);
        assert_eq!(plans[0].last(), plans[1].first());
    }

    #[test]
    fn wrong_numbers_are_sentences() {
        for (spacing_m, width_m) in [(0.0, 50.0), (f64::NAN, 50.0), (10.0, -1.0), (1.0, 20_000.0)] {
            let pattern = Pattern { shape: Shape::Survey, spacing_m, width_m, ..Pattern::default() };
            assert!(pattern.places().unwrap_err().ends_with('.'), "{spacing_m} {width_m}");
        }
    }

    proptest! {
        #[test]
        fn every_shape_stays_inside_its_extent(
            shape in 0_usize..4, length_m in 1.0..500.0_f64, width_m in 1.0..500.0_f64, spacing_m in 1.0..200.0_f64,
        ) {
            let shape = [Shape::Square, Shape::Circle, Shape::ZigZag, Shape::Survey][shape];
            let pattern = Pattern { shape, length_m, width_m, spacing_m, ..Pattern::default() };
            for place in pattern.places().unwrap() {
                let across = if shape == Shape::Circle { length_m } else { width_m };
                prop_assert!(place.x.abs() <= length_m / 2.0 + 1e-6 && place.y.abs() <= across / 2.0 + 1e-6);
            }
        }
    }
}
