//! `.hgt` tiles (SRTM): big-endian 16-bit metres in a square, rows from the north, edges shared with the neighbours.

use super::TileError;
use super::grid::{Grid, Samples};
use super::square::Square;

/// The sides of `.hgt` tiles, samples: one and three arc seconds.
pub const HGT_SIDES: [usize; 2] = [3601, 1201];

/// Reads a tile whose side is one of `sides`.
///
/// # Errors
/// Fails if the length is not that of a tile, or if a height is none of the ground.
pub fn decode(bytes: &[u8], square: Square, sides: &[usize]) -> Result<Grid, TileError> {
    let side = sides.iter().copied().find(|&side| side > 1 && bytes.len() == side * side * 2);
    let side = side.ok_or(TileError::Length(bytes.len()))?;
    // The void of the format, −32768, is that of the grid.
    let metres = bytes.chunks_exact(2).map(|pair| i16::from_be_bytes([pair[0], pair[1]])).collect();
    let step_deg = 1.0 / (side - 1) as f64;
    let grid = Grid {
        rows: side,
        cols: side,
        north_deg: f64::from(square.lat_deg) + 1.0,
        west_deg: f64::from(square.lon_deg),
        lat_step_deg: step_deg,
        lon_step_deg: step_deg,
        samples: Samples::Metres(metres),
    };
    grid.checked()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::terrain::Tiles;

    const SQUARE: Square = Square { lat_deg: 40, lon_deg: -80 };

    fn tiles(rows: &[[i16; 3]; 3]) -> Tiles {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|metres| metres.to_be_bytes()).collect();
        let mut tiles = Tiles::default();
        tiles.insert(SQUARE, decode(&bytes, SQUARE, &[3]).unwrap());
        tiles
    }

    #[test]
    fn heights_are_interpolated_between_four_samples_from_the_north() {
        let tiles = tiles(&[[100, 200, 300], [0, 100, 200], [-100, 0, 100]]);
        let at = |lat, lon| tiles.elevation(LatLon::from_degrees(lat, lon)).unwrap();
        for (lat, lon, metres) in [
            (40.0, -80.0, -100.0),
            (40.999_999_9, -80.0, 100.0),
            (40.5, -79.5, 100.0),
            (40.75, -79.75, 150.0 - 50.0 + 25.0 - 25.0),
            (40.25, -79.999_999_9, -50.0),
            (40.5, -79.000_000_1, 200.0),
        ] {
            assert!((at(lat, lon) - metres).abs() < 0.01, "{lat} {lon}: {}", at(lat, lon));
        }
        assert_eq!(tiles.elevation(LatLon::from_degrees(41.5, -79.5)), None, "no such tile");
    }

    #[test]
    fn the_nearest_valid_sample_replaces_a_void_and_nothing_is_taken_for_zero() {
        let void = i16::MIN;
        let near = tiles(&[[void, 200, 300], [void, 100, 200], [void, 50, 100]]);
        assert_eq!(near.elevation(LatLon::from_degrees(40.05, -79.95)), Some(50.0));
        let unknown = tiles(&[[void; 3]; 3]);
        assert_eq!(unknown.elevation(LatLon::from_degrees(40.5, -79.5)), None);
        let mut bytes = [0x80_u8, 0].repeat(81);
        bytes[..2].copy_from_slice(&7_i16.to_be_bytes());
        let mut far = Tiles::default();
        far.insert(SQUARE, decode(&bytes, SQUARE, &[9]).unwrap());
        assert_eq!(far.elevation(LatLon::from_degrees(40.75, -79.75)), Some(7.0), "2.8 samples away");
        assert_eq!(far.elevation(LatLon::from_degrees(40.5, -79.75)), None, "farther than three samples");
    }

    #[test]
    fn a_tile_with_a_height_that_no_ground_has_is_damaged() {
        for (metres, is_ground) in
            [(-500, true), (9000, true), (-501, false), (9001, false), (i16::MAX, false)]
        {
            let mut bytes = [0_u8; 18];
            bytes[8..10].copy_from_slice(&i16::to_be_bytes(metres));
            let decoded = decode(&bytes, SQUARE, &[3]);
            assert_eq!(decoded.is_ok(), is_ground, "{metres}");
            if let Err(error) = decoded {
                let expected = format!(
                    "it is damaged: it has a height of {metres} m, and the ground lies between -500 and 9000 m"
                );
                assert_eq!(error.to_string(), expected);
            }
        }
    }

    #[test]
    fn a_file_of_another_length_is_no_tile() {
        let error = decode(&[0; 100], SQUARE, &HGT_SIDES).unwrap_err();
        assert!(error.to_string().starts_with("100 bytes are no .hgt tile"), "{error}");
        let grid = decode(&vec![0; 1201 * 1201 * 2], SQUARE, &HGT_SIDES).unwrap();
        assert_eq!((grid.rows, grid.cols), (1201, 1201));
        let fine = decode(&vec![0; 25_934_402], SQUARE, &HGT_SIDES).unwrap();
        assert_eq!(fine.rows, 3601);
    }
}
