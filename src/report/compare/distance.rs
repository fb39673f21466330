//! The distance between two tracks.

use nalgebra::Vector3;

use super::track::Track;
use crate::report::route::distance_to_segment;

/// The most places of a track for a comparison. The work grows with the square of that number.
const MOST: usize = 2000;

/// Returns the root mean square of the distance from each place of one track to the nearest place of the other, in
/// space and in both directions, m. Time does not count. Returns `None` if one of the tracks has no place.
pub(super) fn rms_m(one: &Track, other: &Track) -> Option<f64> {
    let (one, other) = (places(one), places(other));
    let squares: Vec<f64> = squares_to(&one, &other).chain(squares_to(&other, &one)).collect();
    if one.is_empty() || other.is_empty() {
        return None;
    }
    Some((squares.iter().sum::<f64>() / squares.len() as f64).sqrt())
}

/// Returns the places of a track, with as many as can be compared.
fn places(track: &Track) -> Vec<Vector3<f64>> {
    let every = track.samples.len().div_ceil(MOST).max(1);
    let last = track.samples.len().saturating_sub(1);
    let kept = track.samples.iter().enumerate().filter(|(index, _)| index % every == 0 || *index == last);
    kept.map(|(_, sample)| sample.position()).collect()
}

/// Returns the squares of the distances from the places to the line through the places of the other track.
fn squares_to<'a>(places: &'a [Vector3<f64>], line: &'a [Vector3<f64>]) -> impl Iterator<Item = f64> + 'a {
    places.iter().map(|place| {
        let to_sections = line.windows(2).map(|ends| match ends {
            [from, to] => distance_to_segment(*place, *from, *to),
            _ => f64::INFINITY,
        });
        // A track with a single place has no section.
        let to_first = line.first().map(|first| (place - first).norm());
        to_sections.chain(to_first).fold(f64::INFINITY, f64::min).powi(2)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::route::TrackSample;
    use nalgebra::Vector2;

    fn line(alt_m: f64, points: usize) -> Track {
        let samples = (0..points)
            .map(|index| TrackSample {
                time_s: 0.0,
                ne: Vector2::new(100.0 * index as f64 / (points - 1) as f64, 0.0),
                alt_m,
                attitude: None,
            })
            .collect();
        Track { samples, ..Track::default() }
    }

    #[test]
    fn parallel_tracks_lie_as_far_apart_as_their_lines_however_they_were_sampled() {
        for (one, other) in [(10, 10), (10, 3777), (2, 9999)] {
            let rms = rms_m(&line(5.0, one), &line(7.0, other)).unwrap();
            assert!((rms - 2.0).abs() < 1e-6, "{one} {other}: {rms}");
        }
        assert!(rms_m(&line(5.0, 10), &line(5.0, 500)).unwrap() < 1e-9);
        assert_eq!(rms_m(&line(5.0, 10), &Track::default()), None);
    }

    #[test]
    fn what_only_one_of_them_flew_counts() {
        let mut longer = line(5.0, 101);
        longer.samples.push(TrackSample {
            time_s: 0.0,
            ne: Vector2::new(100.0, 30.0),
            alt_m: 5.0,
            attitude: None,
        });
        let (there, back) = (rms_m(&longer, &line(5.0, 101)), rms_m(&line(5.0, 101), &longer));
        assert_eq!(there, back);
        assert!((there.unwrap() - (900.0_f64 / 203.0).sqrt()).abs() < 1e-9);
    }
}
