//! The ground from elevation tiles: reading them, and the height at a place.
//!
//! A tile covers one square degree. Its samples are heights above sea level. Only differences are used, because the sea
//! level of a tile and that of a receiver may differ by many metres: the ground above home at p is T(p) − T(home).
//!
//! The room does no I/O: it takes the bytes of files and gives the names of the files that a plan needs.

mod geotiff;
mod grid;
mod hgt;
mod packed;
mod relief;
mod square;
mod tiles;

pub use geotiff::decode as decode_geotiff;
pub use grid::{Grid, Samples};
pub use hgt::{HGT_SIDES, decode as decode_hgt};
pub use packed::unpacked_hgt;
pub use relief::{HOME_UNKNOWN, Relief};
pub use square::{Square, squares_of};
pub use tiles::{Spot, Tiles};

/// The largest side of a tile, samples.
pub const MAX_SIDE: usize = 3601;

/// The lowest and the highest ground, m: the shore of the Dead Sea and Mount Everest, with room for mines and errors.
const LOWEST_M: f64 = -500.0;
const HIGHEST_M: f64 = 9000.0;

/// The reason why bytes are not a tile.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TileError {
    /// A length that no tile has.
    #[error("{0} bytes are no .hgt tile: one has 3601 × 3601 or 1201 × 1201 samples of 2 bytes")]
    Length(usize),
    /// A packed file that cannot be read.
    #[error("it cannot be unpacked: {0}")]
    Packed(String),
    /// Not a GeoTIFF, or one with a content that is not read.
    #[error("no readable GeoTIFF: {0}")]
    Tiff(String),
    /// The tags place the samples elsewhere than the name of the file.
    #[error("its samples are not those of the square degree that its name says")]
    Elsewhere,
    /// A height that no ground has.
    #[error(
        "it is damaged: it has a height of {0} m, and the ground lies between {LOWEST_M} and {HIGHEST_M} m"
    )]
    Height(i32),
    /// More samples than a tile has.
    #[error("{0} × {1} samples are more than a tile has ({MAX_SIDE} × {MAX_SIDE})")]
    TooLarge(usize, usize),
}
