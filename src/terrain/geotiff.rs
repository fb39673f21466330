//! GeoTIFF tiles (Copernicus): one band of heights with the tags that place it.

use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;

use super::grid::{Grid, Samples};
use super::square::Square;
use super::{MAX_SIDE, TileError};

/// The key of the directory of geographic keys that says whether a pixel is an area or a point, and its value for a
/// point.
const RASTER_TYPE: u16 = 1025;
const IS_POINT: u16 = 2;
/// The largest decoded image and the largest part of it, bytes.
const MAX_IMAGE: usize = MAX_SIDE * MAX_SIDE * 8;

/// Reads the tile of a square degree.
///
/// # Errors
/// Fails if the bytes are not a GeoTIFF with one band of heights of the ground on this square.
pub fn decode(bytes: &[u8], square: Square) -> Result<Grid, TileError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = MAX_IMAGE;
    limits.intermediate_buffer_size = MAX_IMAGE;
    let mut image = Decoder::new(Cursor::new(bytes)).map_err(|error| problem(&error))?.with_limits(limits);
    let (cols, rows) = image.dimensions().map_err(|error| problem(&error))?;
    let (cols, rows) = (cols as usize, rows as usize);
    if rows > MAX_SIDE || cols > MAX_SIDE {
        return Err(TileError::TooLarge(rows, cols));
    }
    if rows < 2 || cols < 2 {
        return Err(TileError::Tiff(format!("{rows} × {cols} samples are no grid")));
    }
    let scale = image.get_tag_f64_vec(Tag::ModelPixelScaleTag).map_err(|error| problem(&error))?;
    let tie = image.get_tag_f64_vec(Tag::ModelTiepointTag).map_err(|error| problem(&error))?;
    let &[lon_step_deg, lat_step_deg, ..] = &scale[..] else {
        return Err(TileError::Tiff("its scale is missing".to_owned()));
    };
    let &[tie_col, tie_row, _, tie_lon, tie_lat, ..] = &tie[..] else {
        return Err(TileError::Tiff("its tie point is missing".to_owned()));
    };
    let keys = image.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    let is_point = keys.chunks_exact(4).skip(1).any(|key| key[0] == RASTER_TYPE && key[3] == IS_POINT);
    // The tie point is a corner of a pixel that is an area. Its height is that of its middle.
    let middle = if is_point { 0.0 } else { 0.5 };
    let north_deg = tie_lat + (tie_row - middle) * lat_step_deg;
    let west_deg = tie_lon + (middle - tie_col) * lon_step_deg;
    let void = image.get_tag_ascii_string(Tag::GdalNodata).ok();
    let void: Option<f64> =
        void.and_then(|text| text.trim_matches(|c: char| c == '\0' || c.is_whitespace()).parse().ok());
    let samples = samples(image.read_image().map_err(|error| problem(&error))?, void)?;
    let grid = Grid { rows, cols, north_deg, west_deg, lat_step_deg, lon_step_deg, samples };
    let count = match &grid.samples {
        Samples::Metres(metres) => metres.len(),
        Samples::Floats(metres) => metres.len(),
    };
    if count != rows * cols {
        return Err(TileError::Tiff("it has more than one band".to_owned()));
    }
    if is_on(&grid, square) { grid.checked() } else { Err(TileError::Elsewhere) }
}

fn problem(error: &tiff::TiffError) -> TileError {
    TileError::Tiff(error.to_string())
}

fn samples(image: DecodingResult, void: Option<f64>) -> Result<Samples, TileError> {
    let is_void = |metres: f64| void.is_some_and(|void| (metres - void).abs() <= 1e-6 * void.abs());
    match image {
        DecodingResult::F32(mut metres) => {
            for metres in metres.iter_mut().filter(|metres| is_void(f64::from(**metres))) {
                *metres = f32::NAN;
            }
            Ok(Samples::Floats(metres))
        }
        DecodingResult::I16(mut metres) => {
            for metres in metres.iter_mut().filter(|metres| is_void(f64::from(**metres))) {
                *metres = i16::MIN;
            }
            Ok(Samples::Metres(metres))
        }
        _ => Err(TileError::Tiff("its samples are neither 32-bit floats nor 16-bit numbers".to_owned())),
    }
}

/// Returns `true` if the samples cover the square, up to one sample at each edge.
fn is_on(grid: &Grid, square: Square) -> bool {
    let (lat_deg, lon_deg) = (f64::from(square.lat_deg), f64::from(square.lon_deg));
    let (south_deg, east_deg) = grid.place(grid.rows as i64 - 1, grid.cols as i64 - 1);
    let near = |a: f64, b: f64, step: f64| step > 0.0 && (a - b).abs() <= 1.01 * step;
    let (lat_step, lon_step) = (grid.lat_step_deg, grid.lon_step_deg);
    near(grid.north_deg, lat_deg + 1.0, lat_step)
        && near(south_deg, lat_deg, lat_step)
        && near(grid.west_deg, lon_deg, lon_step)
        && near(east_deg, lon_deg + 1.0, lon_step)
}

#[cfg(test)]
mod tests {
    use tiff::encoder::{TiffEncoder, colortype};

    use super::*;
    use crate::geo::LatLon;
    use crate::terrain::Tiles;

    const SQUARE: Square = Square { lat_deg: 40, lon_deg: -80 };

    /// Returns a tile with four rows and columns and the corners of the Copernicus tiles, of which each sample is its
    /// row times ten plus its column.
    fn tile(north_deg: f64, keys: &[u16]) -> Vec<u8> {
        tile_with(north_deg, keys, 0.0)
    }

    /// Returns the same tile with this first sample.
    fn tile_with(north_deg: f64, keys: &[u16], first: f32) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).unwrap();
        let mut image = encoder.new_image::<colortype::Gray32Float>(4, 4).unwrap();
        let half = if keys == POINT { 0.0 } else { 0.125 };
        let tags = image.encoder();
        tags.write_tag(Tag::ModelPixelScaleTag, &[0.25, 0.25, 0.0][..]).unwrap();
        let tie = [0.0, 0.0, 0.0, -80.0 - half, north_deg + half, 0.0];
        tags.write_tag(Tag::ModelTiepointTag, &tie[..]).unwrap();
        tags.write_tag(Tag::GeoKeyDirectoryTag, keys).unwrap();
        tags.write_tag(Tag::GdalNodata, "-9999").unwrap();
        let mut metres: Vec<f32> = (0..16).map(|index| (index / 4 * 10 + index % 4) as f32).collect();
        metres[15] = -9999.0;
        metres[0] = first;
        image.write_data(&metres).unwrap();
        bytes.into_inner()
    }

    const AREA: [u16; 8] = [1, 1, 0, 1, RASTER_TYPE, 0, 1, 1];
    const POINT: [u16; 8] = [1, 1, 0, 1, RASTER_TYPE, 0, 1, IS_POINT];

    #[test]
    fn the_middles_of_the_pixels_are_the_places_of_the_samples() {
        let mut tiles = Tiles::default();
        tiles.insert(SQUARE, decode(&tile(41.0, &AREA), SQUARE).unwrap());
        let at = |lat, lon| tiles.elevation(LatLon::from_degrees(lat, lon)).unwrap();
        assert!(at(40.999_999_9, -80.0).abs() < 0.01);
        assert!((at(40.75, -79.5) - 12.0).abs() < 0.01, "{}", at(40.75, -79.5));
        assert!((at(40.625, -79.625) - 16.5).abs() < 0.01);
        assert!((at(40.1, -79.5) - 32.0).abs() < 0.01, "beyond the last row, without a neighbour");
        assert!((at(40.26, -79.25) - 23.0).abs() < 0.01, "a void, north of which there is a height");
    }

    #[test]
    fn a_row_that_the_tile_lacks_is_that_of_its_neighbour() {
        let mut tiles = Tiles::default();
        tiles.insert(SQUARE, decode(&tile(41.0, &AREA), SQUARE).unwrap());
        let south = Square { lat_deg: 39, lon_deg: -80 };
        tiles.insert(south, decode(&tile(40.0, &AREA), south).unwrap());
        let at = |lat| tiles.elevation(LatLon::from_degrees(lat, -79.75)).unwrap();
        // From 31 in the last row to 1 in the first row of the neighbour.
        assert!((at(40.125) - 16.0).abs() < 0.01, "{}", at(40.125));
        assert!((at(40.000_000_1) - 1.0).abs() < 0.01);
    }

    #[test]
    fn a_tile_elsewhere_and_other_files_are_refused() {
        assert_eq!(decode(&tile(42.0, &AREA), SQUARE), Err(TileError::Elsewhere));
        for first in [-9998.0, 9000.6, 1e30] {
            let damaged = decode(&tile_with(41.0, &AREA, first), SQUARE);
            assert_eq!(damaged, Err(TileError::Height(first.round() as i32)), "a height of no ground");
        }
        let grid = decode(&tile(41.0, &POINT), SQUARE).unwrap();
        assert!((grid.north_deg - 41.0).abs() < 1e-9, "a point is at its place");
        for bytes in [&b""[..], b"II*\0", b"PK\x03\x04", &tile(41.0, &AREA)[..200]] {
            assert!(matches!(decode(bytes, SQUARE), Err(TileError::Tiff(_))));
        }
    }
}
