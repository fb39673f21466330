//! A set of tiles, and the height at a place.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::grid::Grid;
use super::square::Square;
use crate::geo::{LatLon, METRES_PER_E7};
use crate::math;

/// Tiles by their squares. A clone shares them.
#[derive(Clone, Default, PartialEq)]
pub struct Tiles {
    grids: BTreeMap<Square, Arc<Grid>>,
}

/// The ground at a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Above sea level, m.
    pub elevation_m: f64,
    /// The rise towards the north and towards the east, m in a degree. Zero beside a void.
    pub rise_m_per_deg: (f64, f64),
}

impl Tiles {
    /// Adds the tile of a square, or replaces it.
    pub fn insert(&mut self, square: Square, grid: Grid) {
        self.grids.insert(square, Arc::new(grid));
    }

    /// Returns `true` if there is a tile of this square.
    pub fn has(&self, square: Square) -> bool {
        self.grids.contains_key(&square)
    }

    /// Returns the squares of the tiles.
    pub fn squares(&self) -> impl Iterator<Item = Square> {
        self.grids.keys().copied()
    }

    /// Returns the height of the ground above sea level, m; `None` if no tile knows it.
    pub fn elevation(&self, place: LatLon) -> Option<f64> {
        self.spot_in(Square::of(place), place.lat_deg(), place.lon_deg()).map(|spot| spot.elevation_m)
    }

    /// Returns the ground at a latitude and a longitude, degrees.
    pub fn spot(&self, lat_deg: f64, lon_deg: f64) -> Option<Spot> {
        self.spot_in(Square::of(LatLon::from_degrees(lat_deg, lon_deg)), lat_deg, lon_deg)
    }

    /// Returns the distance between two samples at a place, m; `None` without a tile there.
    pub fn step_m(&self, place: LatLon) -> Option<f64> {
        let grid = self.grids.get(&Square::of(place))?;
        let metres = METRES_PER_E7 * 1e7;
        let across = grid.lon_step_deg * math::cos(place.lat_deg().to_radians());
        Some(grid.lat_step_deg.min(across) * metres)
    }

    /// Interpolates between four samples. If one of them is a void, the nearest valid one counts.
    fn spot_in(&self, square: Square, lat_deg: f64, lon_deg: f64) -> Option<Spot> {
        let grid = self.grids.get(&square)?;
        let (row, col) = grid.position(lat_deg, lon_deg);
        let (top, left) = (row.floor() as i64, col.floor() as i64);
        let corner = |down, right| self.sample(square, grid, top + down, left + right);
        let corners = corner(0, 0).zip(corner(0, 1)).zip(corner(1, 0).zip(corner(1, 1)));
        let Some(((nw, ne), (sw, se))) = corners else {
            let elevation_m = grid.nearest_valid((row, col))?;
            return Some(Spot { elevation_m, rise_m_per_deg: (0.0, 0.0) });
        };
        let (down, right) = (row - top as f64, col - left as f64);
        let (north, south) = (nw + (ne - nw) * right, sw + (se - sw) * right);
        let (west, east) = (nw + (sw - nw) * down, ne + (se - ne) * down);
        Some(Spot {
            elevation_m: north + (south - north) * down,
            rise_m_per_deg: ((north - south) / grid.lat_step_deg, (east - west) / grid.lon_step_deg),
        })
    }

    /// Returns a sample of a tile. Beyond the edge it is that of the neighbour, else the last one of the tile.
    fn sample(&self, square: Square, grid: &Grid, row: i64, col: i64) -> Option<f64> {
        if grid.has(row, col) {
            return grid.sample(row, col);
        }
        let beyond = |index: i64, count: usize| match index {
            ..0 => -1,
            index if index >= count as i64 => 1,
            _ => 0,
        };
        let neighbour = square.moved(-beyond(row, grid.rows), beyond(col, grid.cols));
        let Some(other) = self.grids.get(&neighbour) else { return grid.clamped(row, col) };
        let (lat_deg, mut lon_deg) = grid.place(row, col);
        lon_deg -= (((lon_deg - other.west_deg - 0.5) / 360.0).round()) * 360.0;
        let (row, col) = other.position(lat_deg, lon_deg);
        other.clamped(row.round() as i64, col.round() as i64)
    }
}

impl std::fmt::Debug for Tiles {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_set().entries(self.grids.keys()).finish()
    }
}
