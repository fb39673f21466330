//! The ground of a world: the shape that its switch names, or the relief of elevation tiles.

use nalgebra::{Vector2, Vector3};

use super::surface::{Surface, TangentPlane};
use crate::geo::LocalFrame;
use crate::sim::config::Home;
use crate::sim::error::WorldError;
use crate::terrain::Relief;

/// Elevation tiles around the home of a world.
#[derive(Debug, Clone)]
pub(super) struct LocalRelief {
    relief: Relief,
    frame: LocalFrame,
    metres_per_deg: (f64, f64),
}

impl LocalRelief {
    /// Returns the relief around a home.
    pub(super) fn new(relief: Relief, home: &Home) -> Self {
        let frame = LocalFrame::new(home.lat_deg, home.lon_deg, home.alt_amsl_m);
        Self { relief, frame, metres_per_deg: frame.metres_per_deg() }
    }

    /// Returns the height above home at a place, m, and its gradient towards east and north. Where the tiles know no
    /// height, the ground is as high as home.
    fn at(&self, place: &Vector2<f64>) -> (f64, Vector2<f64>) {
        let (lat_deg, lon_deg, _) = self.frame.to_geodetic(Vector3::new(place.x, place.y, 0.0));
        let Some((height_m, (north, east))) = self.relief.spot(lat_deg, lon_deg) else {
            return (0.0, Vector2::zeros());
        };
        let (per_lat, per_lon) = self.metres_per_deg;
        (height_m, Vector2::new(east / per_lon, north / per_lat))
    }
}

/// The ground of a world. Home is on it, at height zero.
#[derive(Debug, Clone)]
pub struct Landform {
    surface: Surface,
    /// The tiles, if the surface is theirs.
    relief: Option<LocalRelief>,
}

impl Landform {
    /// Level ground at height zero.
    pub const FLAT: Self = Self { surface: Surface::Flat, relief: None };

    /// Returns the ground of a shape; `relief` is that of the tiles, if there are any.
    ///
    /// # Errors
    /// Fails if the shape is that of the tiles and there are none.
    pub(super) fn new(surface: Surface, relief: Option<&LocalRelief>) -> Result<Self, WorldError> {
        match (surface, relief) {
            (Surface::Terrain, None) => Err(WorldError::NoTerrain),
            (Surface::Terrain, Some(relief)) => Ok(Self { surface, relief: Some(relief.clone()) }),
            (Surface::Flat | Surface::Slope(_), _) => Ok(Self { surface, relief: None }),
        }
    }

    /// Returns the shape.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Returns the height of the ground at a place east and north of home, m.
    pub fn elevation_m(&self, place: &Vector2<f64>) -> f64 {
        match &self.relief {
            Some(relief) => relief.at(place).0,
            None => self.surface.elevation_m(place),
        }
    }

    /// Returns the tangent plane of the ground below or above a point.
    pub fn tangent_at(&self, point: &Vector3<f64>) -> TangentPlane {
        let Some(relief) = &self.relief else { return self.surface.tangent_at(point) };
        let (height_m, gradient) = relief.at(&point.xy());
        TangentPlane::new(Vector3::new(point.x, point.y, height_m), &gradient)
    }
}
