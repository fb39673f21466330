//! The ground above home.

use std::sync::Arc;

use super::tiles::Tiles;
use crate::geo::LatLon;

/// The notice for a home whose height the tiles do not know.
pub const HOME_UNKNOWN: &str =
    "The ground at home is unknown in the elevation tiles: clearances are not checked.";

/// Tiles as seen from a home whose height they know.
#[derive(Debug, Clone, PartialEq)]
pub struct Relief {
    tiles: Arc<Tiles>,
    home: LatLon,
    home_m: f64,
}

impl Relief {
    /// Returns `None` if the tiles do not know the height of home.
    pub fn new(tiles: Arc<Tiles>, home: LatLon) -> Option<Self> {
        let home_m = tiles.elevation(home)?;
        Some(Self { tiles, home, home_m })
    }

    /// Returns the place whose ground has height zero.
    pub fn home(&self) -> LatLon {
        self.home
    }

    /// Returns the tiles.
    pub fn tiles(&self) -> &Tiles {
        &self.tiles
    }

    /// Returns the height of the ground above that at home, m: T(p) − T(home).
    pub fn above_home_m(&self, place: LatLon) -> Option<f64> {
        self.tiles.elevation(place).map(|elevation_m| elevation_m - self.home_m)
    }

    /// Returns the height of the ground above that at home, m, and its rise towards north and east, m in a degree.
    pub fn spot(&self, lat_deg: f64, lon_deg: f64) -> Option<(f64, (f64, f64))> {
        let spot = self.tiles.spot(lat_deg, lon_deg)?;
        Some((spot.elevation_m - self.home_m, spot.rise_m_per_deg))
    }
}
