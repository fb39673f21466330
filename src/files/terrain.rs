//! Reads the elevation tiles that a plan needs.
#![allow(clippy::disallowed_methods, reason = "the composition root reads the environment")]

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::input_file;
use crate::args::TerrainArgs;
use crate::files::directories;
use crate::flight::FlightSetup;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::process::error::AppError;
use crate::terrain::{
    Grid, HGT_SIDES, HOME_UNKNOWN, Square, Tiles, decode_geotiff, decode_hgt, squares_of, unpacked_hgt,
};

/// The largest number of tiles. Nine of the largest ones take 470 MB.
const MAX_TILES: usize = 9;

/// The extensions of packed `.hgt` tiles.
const PACKED: [&str; 2] = [".zip", ".gz"];

/// The directories of the tiles, the first one first.
#[derive(Debug, Clone, Default)]
pub(crate) struct TerrainFiles {
    directories: Vec<PathBuf>,
}

impl TerrainFiles {
    /// Returns the directory of the option, and that of the user if it exists.
    ///
    /// # Errors
    /// Fails if the directory of the option is not one.
    pub(crate) fn new(args: &TerrainArgs) -> Result<Self, AppError> {
        let mut directories = Vec::new();
        if let Some(directory) = &args.directory {
            if !directory.is_dir() {
                let name = directory.display();
                return Err(AppError::input(format!("--terrain {name}: there is no such directory")));
            }
            directories.push(directory.clone());
        }
        let own = directories::directories().ok().map(|own| own.terrain());
        directories.extend(own.filter(|own| own.is_dir()));
        Ok(Self { directories })
    }

    /// Returns `true` if there is a directory.
    pub(crate) fn is_somewhere(&self) -> bool {
        !self.directories.is_empty()
    }

    /// Reads the tiles under a plan that is flown from this home. Adds a sentence for each one that is missing or
    /// cannot be read to `notices`, and one if they do not know the ground at home. Returns `None` if there are none.
    pub(crate) fn read(
        &self,
        home: LatLon,
        plan: &FlightPlan,
        notices: &mut Vec<String>,
    ) -> Option<Arc<Tiles>> {
        let tiles = self.read_more(&Tiles::default(), home, plan, notices)?;
        if tiles.elevation(home).is_none() {
            notices.push(HOME_UNKNOWN.to_owned());
        }
        Some(Arc::new(tiles))
    }

    /// Does the same as [`Self::read`], and keeps the tiles that are there. Returns `None` if nothing changes.
    pub(crate) fn read_more(
        &self,
        there: &Tiles,
        home: LatLon,
        plan: &FlightPlan,
        notices: &mut Vec<String>,
    ) -> Option<Tiles> {
        let first = self.directories.first()?;
        let squares = squares_of(&places(home, plan));
        let mut wanted: Vec<Square> = squares.iter().copied().filter(|square| !there.has(*square)).collect();
        let room = MAX_TILES.saturating_sub(there.squares().count());
        if wanted.len() > room {
            notices.push(format!(
                "The plan crosses {} elevation tiles. Only {MAX_TILES} are read; the ground under the others is \
                 unknown.",
                squares.len()
            ));
            // Those nearest to home first.
            let at = Square::of(home);
            wanted.sort_by_key(|square| {
                (square.lat_deg - at.lat_deg).abs().max((square.lon_deg - at.lon_deg).abs())
            });
            wanted.truncate(room);
        }
        let mut tiles = there.clone();
        for square in wanted {
            let before = notices.len();
            match self.tile(square, notices) {
                Some(grid) => tiles.insert(square, grid),
                // The file is there, and its problem is named.
                None if notices.len() > before => {}
                None => notices.push(format!(
                    "No elevation tile {} (or {}) in {}: the ground there is unknown.",
                    square.hgt_name(),
                    square.copernicus_name(10),
                    first.display()
                )),
            }
        }
        (tiles.squares().count() > there.squares().count()).then_some(tiles)
    }

    /// Reads the first readable file of a tile.
    fn tile(&self, square: Square, notices: &mut Vec<String>) -> Option<Grid> {
        let hgt = square.hgt_name();
        let packed = PACKED.map(|extension| format!("{hgt}{extension}"));
        let names = [hgt, square.copernicus_name(10), square.copernicus_name(30)].into_iter().chain(packed);
        let names: Vec<String> = names.collect();
        let paths = self.directories.iter().flat_map(|folder| names.iter().map(|name| folder.join(name)));
        paths.filter(|path| path.exists()).find_map(|path| {
            read(&path, square)
                .map_err(|problem| notices.push(format!("Elevation tile not read: {problem}.")))
                .ok()
        })
    }
}

/// Returns the start of a flight with the tiles that its plan needs.
pub(crate) fn with_terrain(
    mut setup: FlightSetup,
    args: &TerrainArgs,
    notices: &mut Vec<String>,
) -> Result<FlightSetup, AppError> {
    let (home, _) = setup.boot_home();
    let home = LatLon::from_degrees(home.lat_deg, home.lon_deg);
    setup.world.terrain = TerrainFiles::new(args)?.read(home, &setup.plan.plan, notices);
    Ok(setup)
}

/// Returns the places of a plan in flight order, from home, with the way home from each of them.
fn places(home: LatLon, plan: &FlightPlan) -> Vec<LatLon> {
    let there = plan.waypoints.iter().filter(|waypoint| waypoint.kind.uses_position());
    let there: Vec<LatLon> =
        there.map(|waypoint| waypoint.position).filter(|place| place.is_on_globe()).collect();
    let mut places = vec![home];
    places.extend(&there);
    places.extend(there.iter().flat_map(|&place| [home, place]));
    places
}

fn read(path: &Path, square: Square) -> Result<Grid, String> {
    let name = path.display();
    let bytes = input_file::read_tile(path).map_err(|error| error.to_string())?;
    let is_tiff = path.extension().is_some_and(|extension| extension == "tif");
    let grid = if is_tiff {
        decode_geotiff(&bytes, square)
    } else {
        unpacked_hgt(bytes, square).and_then(|bytes| decode_hgt(&bytes, square, &HGT_SIDES))
    };
    grid.map_err(|error| format!("{name}: {error}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Waypoint;

    fn plan(places: &[(f64, f64)]) -> FlightPlan {
        let mut plan = FlightPlan::default();
        plan.waypoints.extend(places.iter().map(|&(lat_deg, lon_deg)| Waypoint {
            position: LatLon::from_degrees(lat_deg, lon_deg),
            ..Waypoint::default()
        }));
        plan
    }

    #[test]
    fn only_the_tiles_of_the_plan_are_read_and_missing_ones_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let constant: Vec<u8> = 300_i16.to_be_bytes().repeat(1201 * 1201);
        for name in ["N40W080.hgt", "N41W080.hgt"] {
            std::fs::write(folder.path().join(name), &constant).unwrap();
        }
        std::fs::write(folder.path().join("N40W079.hgt"), b"short").unwrap();
        let files = TerrainFiles { directories: vec![folder.path().to_owned()] };
        let home = LatLon::from_degrees(40.4635, -79.5182);
        let mut notices = Vec::new();
        let tiles = files.read(home, &plan(&[(40.47, -79.52)]), &mut notices).unwrap();
        assert_eq!(tiles.squares().map(Square::hgt_name).collect::<Vec<_>>(), ["N40W080.hgt"]);
        assert_eq!(tiles.elevation(home), Some(300.0));
        assert_eq!(notices, [""; 0]);

        let farther = files.read_more(&tiles, home, &plan(&[(40.47, -78.5), (40.47, -77.5)]), &mut notices);
        assert_eq!(farther, None);
        assert!(notices[0].starts_with("Elevation tile not read:"), "{notices:?}");
        assert!(notices[0].ends_with(
            "N40W079.hgt: 5 bytes are no .hgt tile: one has 3601 × 3601 or 1201 × 1201 samples of 2 bytes."
        ));
        assert!(
            notices[1].starts_with(
                "No elevation tile N40W078.hgt (or Copernicus_DSM_COG_10_N40_00_W078_00_DEM.tif)"
            ),
            "{notices:?}"
        );
        assert_eq!(notices.len(), 2);
    }

    #[test]
    fn a_packed_tile_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let constant: Vec<u8> = 300_i16.to_be_bytes().repeat(1201 * 1201);
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        std::io::Write::write_all(&mut packed, &constant).unwrap();
        std::fs::write(folder.path().join("N40W080.hgt.gz"), packed.finish().unwrap()).unwrap();
        let files = TerrainFiles { directories: vec![folder.path().to_owned()] };
        let home = LatLon::from_degrees(40.4635, -79.5182);
        let mut notices = Vec::new();
        let tiles = files.read(home, &plan(&[(40.47, -79.52)]), &mut notices).unwrap();
        assert_eq!((tiles.elevation(home), notices), (Some(300.0), Vec::new()));
    }

    #[test]
    fn unknown_ground_at_home_is_reported() {
        let folder = tempfile::tempdir().unwrap();
        let voids = i16::MIN.to_be_bytes().repeat(1201 * 1201);
        std::fs::write(folder.path().join("N40W080.hgt"), voids).unwrap();
        let files = TerrainFiles { directories: vec![folder.path().to_owned()] };
        let home = LatLon::from_degrees(40.4635, -79.5182);
        let mut notices = Vec::new();
        assert!(files.read(home, &plan(&[(40.47, -79.52)]), &mut notices).is_some());
        assert_eq!(notices, [HOME_UNKNOWN]);
    }

    #[test]
    fn a_plan_around_the_world_reads_no_more_than_nine_tiles() {
        let folder = tempfile::tempdir().unwrap();
        let files = TerrainFiles { directories: vec![folder.path().to_owned()] };
        let mut notices = Vec::new();
        let home = LatLon::from_degrees(40.5, -79.5);
        assert_eq!(files.read(home, &plan(&[(40.5, 80.0), (-60.0, 10.0)]), &mut notices), None);
        assert_eq!(notices.len(), 1 + MAX_TILES, "{notices:?}");
        assert!(notices[0].contains("Only 9 are read") && notices[1].contains("N40W080.hgt"), "{notices:?}");
    }
}
