//! The samples of one tile.

use super::{HIGHEST_M, LOWEST_M, TileError};
use crate::math;

/// The distance, in samples, within which the nearest valid sample replaces a void.
const VOID_REACH: i64 = 3;

/// Heights above sea level, row by row from the north, each row from west to east.
#[derive(Clone, PartialEq)]
pub enum Samples {
    /// Whole metres; `i16::MIN` is a void.
    Metres(Vec<i16>),
    /// Metres; a number that is not finite is a void.
    Floats(Vec<f32>),
}

/// A grid of samples with its place.
#[derive(Clone, PartialEq)]
pub struct Grid {
    /// The number of rows, from north to south.
    pub rows: usize,
    /// The number of columns, from west to east.
    pub cols: usize,
    /// Latitude of the first row, degrees.
    pub north_deg: f64,
    /// Longitude of the first column, degrees.
    pub west_deg: f64,
    /// Distance between adjacent rows, degrees.
    pub lat_step_deg: f64,
    /// Distance between adjacent columns, degrees.
    pub lon_step_deg: f64,
    /// `rows` times `cols` samples.
    pub samples: Samples,
}

impl Grid {
    /// Returns the height of a sample, m; `None` outside the grid and for a void.
    pub fn sample(&self, row: i64, col: i64) -> Option<f64> {
        let (row, col) = (usize::try_from(row).ok()?, usize::try_from(col).ok()?);
        if row >= self.rows || col >= self.cols {
            return None;
        }
        let index = row * self.cols + col;
        match &self.samples {
            Samples::Metres(metres) => {
                metres.get(index).copied().filter(|metres| *metres != i16::MIN).map(f64::from)
            }
            Samples::Floats(metres) => {
                metres.get(index).copied().filter(|metres| metres.is_finite()).map(f64::from)
            }
        }
    }

    /// Returns the grid if every height can be one of the ground.
    pub(super) fn checked(self) -> Result<Self, TileError> {
        let is_ground = |metres: f64| (LOWEST_M..=HIGHEST_M).contains(&metres);
        let odd = match &self.samples {
            Samples::Metres(metres) => {
                let mut heights = metres.iter().filter(|metres| **metres != i16::MIN).copied().map(f64::from);
                heights.find(|metres| !is_ground(*metres))
            }
            Samples::Floats(metres) => {
                let mut heights = metres.iter().copied().map(f64::from).filter(|metres| metres.is_finite());
                heights.find(|metres| !is_ground(*metres))
            }
        };
        odd.map_or(Ok(self), |metres| Err(TileError::Height(metres.round() as i32)))
    }

    /// Returns the row and column of a place, with fractions.
    pub(super) fn position(&self, lat_deg: f64, lon_deg: f64) -> (f64, f64) {
        ((self.north_deg - lat_deg) / self.lat_step_deg, (lon_deg - self.west_deg) / self.lon_step_deg)
    }

    /// Returns the place of a sample: latitude and longitude, degrees.
    pub(super) fn place(&self, row: i64, col: i64) -> (f64, f64) {
        (self.north_deg - row as f64 * self.lat_step_deg, self.west_deg + col as f64 * self.lon_step_deg)
    }

    pub(super) fn has(&self, row: i64, col: i64) -> bool {
        (0..self.rows as i64).contains(&row) && (0..self.cols as i64).contains(&col)
    }

    /// Returns the sample of the grid that is nearest to an index.
    pub(super) fn clamped(&self, row: i64, col: i64) -> Option<f64> {
        self.sample(row.clamp(0, self.rows as i64 - 1), col.clamp(0, self.cols as i64 - 1))
    }

    /// Returns the valid sample nearest to a position, if there is one within three samples.
    pub(super) fn nearest_valid(&self, (row, col): (f64, f64)) -> Option<f64> {
        let (row0, col0) = (row.round() as i64, col.round() as i64);
        let mut best: Option<(f64, f64)> = None;
        for r in row0 - VOID_REACH..=row0 + VOID_REACH {
            for c in col0 - VOID_REACH..=col0 + VOID_REACH {
                let distance = math::hypot(r as f64 - row, c as f64 - col);
                if distance > VOID_REACH as f64 || best.is_some_and(|(nearest, _)| distance >= nearest) {
                    continue;
                }
                if let Some(metres) = self.sample(r, c) {
                    best = Some((distance, metres));
                }
            }
        }
        best.map(|(_, metres)| metres)
    }
}

impl std::fmt::Debug for Grid {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Grid({} × {} from {}, {})", self.rows, self.cols, self.north_deg, self.west_deg)
    }
}
