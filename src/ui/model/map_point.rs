//! Places on the map: metres north and east of the boot place.

use crate::geo::{LatLon, LocalFrame};
use crate::session::SessionView;

/// A place on the ground, metres north and east of the boot place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MapPoint {
    /// North, m.
    pub n: f64,
    /// East, m.
    pub e: f64,
}

impl MapPoint {
    pub(in crate::ui) const fn new(n: f64, e: f64) -> Self {
        Self { n, e }
    }

    /// Returns the distance to another place, m.
    pub(in crate::ui) fn distance(self, other: Self) -> f64 {
        (self.n - other.n).hypot(self.e - other.e)
    }

    /// Returns the place at the fraction `t` of the way to `other`.
    pub(in crate::ui) fn towards(self, other: Self, t: f64) -> Self {
        Self::new(self.n + (other.n - self.n) * t, self.e + (other.e - self.e) * t)
    }

    /// Returns the place in axes that are turned clockwise by an angle, rad: `n` is then the distance in the direction
    /// of this bearing, and `e` the distance to the right of it.
    pub(in crate::ui) fn turned(self, bearing_rad: f64) -> Self {
        if bearing_rad == 0.0 {
            return self;
        }
        let (sin, cos) = bearing_rad.sin_cos();
        Self::new(self.n * cos + self.e * sin, self.e * cos - self.n * sin)
    }
}

/// Converts a position to metres from the origin of the map.
pub(in crate::ui) fn to_map(origin: &LocalFrame, position: LatLon) -> MapPoint {
    let enu = origin.to_enu(position.lat_deg(), position.lon_deg(), 0.0);
    MapPoint::new(enu.y, enu.x)
}

/// Returns the position of the craft: the true one if the simulator reports it, else the estimate.
pub(in crate::ui) fn craft(view: &SessionView) -> Option<MapPoint> {
    let vehicle = &view.vehicle;
    match (&vehicle.truth, vehicle.estimate.n, vehicle.estimate.e) {
        (Some(truth), ..) => Some(MapPoint::new(truth.n, truth.e)),
        (None, Some(n), Some(e)) => Some(MapPoint::new(n, e)),
        _ => None,
    }
    .filter(|place| place.n.is_finite() && place.e.is_finite())
}
