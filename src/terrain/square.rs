//! The square degrees of the tiles, and the names of their files.

use std::collections::BTreeSet;

use crate::geo::LatLon;

const DEGREE_E7: i32 = 10_000_000;
/// The distance of two looks along a line, degrees × 10⁷.
const LOOK_E7: i64 = 100_000;

/// A square degree, named by its south-west corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Square {
    /// Latitude of the southern edge, −90…89.
    pub lat_deg: i32,
    /// Longitude of the western edge, −180…179.
    pub lon_deg: i32,
}

impl Square {
    /// Returns the square of a place.
    pub fn of(place: LatLon) -> Self {
        Self::wrapped(place.lat_e7.div_euclid(DEGREE_E7), place.lon_e7.div_euclid(DEGREE_E7))
    }

    /// Returns the square so many degrees to the north and to the east.
    pub(super) fn moved(self, north: i32, east: i32) -> Self {
        Self::wrapped(self.lat_deg + north, self.lon_deg + east)
    }

    fn wrapped(lat_deg: i32, lon_deg: i32) -> Self {
        Self { lat_deg: lat_deg.clamp(-90, 89), lon_deg: (lon_deg + 180).rem_euclid(360) - 180 }
    }

    /// Returns the name of its `.hgt` file: `N40W080.hgt`.
    pub fn hgt_name(self) -> String {
        let (ns, lat, ew, lon) = self.parts();
        format!("{ns}{lat:02}{ew}{lon:03}.hgt")
    }

    /// Returns the name of its Copernicus file for a spacing of 10 (30 m) or 30 (90 m):
    /// `Copernicus_DSM_COG_10_N40_00_W080_00_DEM.tif`.
    pub fn copernicus_name(self, spacing: u32) -> String {
        let (ns, lat, ew, lon) = self.parts();
        format!("Copernicus_DSM_COG_{spacing}_{ns}{lat:02}_00_{ew}{lon:03}_00_DEM.tif")
    }

    fn parts(self) -> (char, u32, char, u32) {
        let ns = if self.lat_deg < 0 { 'S' } else { 'N' };
        let ew = if self.lon_deg < 0 { 'W' } else { 'E' };
        (ns, self.lat_deg.unsigned_abs(), ew, self.lon_deg.unsigned_abs())
    }
}

/// Returns the squares that the lines from place to place cross.
pub fn squares_of(places: &[LatLon]) -> BTreeSet<Square> {
    let mut squares: BTreeSet<Square> = places.iter().copied().map(Square::of).collect();
    for pair in places.windows(2) {
        let lat = i64::from(pair[1].lat_e7) - i64::from(pair[0].lat_e7);
        let turn = 360 * i64::from(DEGREE_E7);
        let lon =
            (i64::from(pair[1].lon_e7) - i64::from(pair[0].lon_e7) + turn / 2).rem_euclid(turn) - turn / 2;
        let looks = lat.abs().max(lon.abs()) / LOOK_E7;
        for look in 1..=looks {
            let lat_e7 = i64::from(pair[0].lat_e7) + lat * look / (looks + 1);
            let lon_e7 = i64::from(pair[0].lon_e7) + lon * look / (looks + 1);
            let degrees = |e7: i64| i32::try_from(e7.div_euclid(i64::from(DEGREE_E7))).unwrap_or_default();
            squares.insert(Square::wrapped(degrees(lat_e7), degrees(lon_e7)));
        }
    }
    squares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_by_the_south_west_corner() {
        let name = |lat, lon| Square::of(LatLon::from_degrees(lat, lon)).hgt_name();
        assert_eq!(name(40.4635, -79.5182), "N40W080.hgt");
        assert_eq!(name(40.0, -80.0), "N40W080.hgt");
        assert_eq!(name(-0.5, 0.5), "S01E000.hgt");
        assert_eq!(name(-33.9, 151.2), "S34E151.hgt");
        assert_eq!(name(90.0, 180.0), "N89W180.hgt");
        let square = Square::of(LatLon::from_degrees(40.4635, -79.5182));
        assert_eq!(square.copernicus_name(10), "Copernicus_DSM_COG_10_N40_00_W080_00_DEM.tif");
    }

    #[test]
    fn a_line_needs_every_square_it_crosses() {
        let at = LatLon::from_degrees;
        let names =
            |places: &[LatLon]| squares_of(places).into_iter().map(Square::hgt_name).collect::<Vec<_>>();
        assert_eq!(names(&[at(40.5, -79.5)]), ["N40W080.hgt"]);
        assert_eq!(names(&[at(40.5, -79.5), at(40.5, -77.5)]), ["N40W080.hgt", "N40W079.hgt", "N40W078.hgt"]);
        assert_eq!(names(&[at(0.5, 179.5), at(0.5, -179.5)]), ["N00W180.hgt", "N00E179.hgt"]);
        assert!(names(&[]).is_empty());
    }
}
