//! Packed `.hgt` tiles: `.hgt.zip` and `.hgt.gz`.

use std::io::{Cursor, Read};

use flate2::read::GzDecoder;
use zip::ZipArchive;

use super::{MAX_SIDE, Square, TileError};

/// The size of the largest `.hgt` tile, bytes.
const MOST: u64 = (MAX_SIDE * MAX_SIDE * 2) as u64;
/// The most members of an archive. Their list takes memory before it can be counted.
const MAX_MEMBERS: usize = 100;

/// Returns the `.hgt` tile of a square in the bytes of a file, which may be a ZIP archive or packed by gzip.
///
/// # Errors
/// Fails if the file cannot be unpacked, has only tiles of other squares, or is too large for a tile.
pub fn unpacked_hgt(bytes: Vec<u8>, square: Square) -> Result<Vec<u8>, TileError> {
    if bytes.starts_with(b"PK\x03\x04") {
        return of_archive(&bytes, square);
    }
    if bytes.starts_with(&[0x1f, 0x8b]) {
        return read(GzDecoder::new(bytes.as_slice()));
    }
    Ok(bytes)
}

fn of_archive(bytes: &[u8], square: Square) -> Result<Vec<u8>, TileError> {
    if bytes.windows(4).filter(|bytes| bytes == b"PK\x01\x02").count() > MAX_MEMBERS {
        return Err(problem(&format!("the archive has more than {MAX_MEMBERS} members")));
    }
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(|error| problem(&error))?;
    let wanted = square.hgt_name();
    let mut tiles = Vec::new();
    for index in 0..archive.len() {
        let member = archive.by_index(index).map_err(|error| problem(&error))?;
        let Ok(path) = member.name() else { continue };
        let name = path.rsplit(['/', '\\']).next().unwrap_or_default();
        if name.eq_ignore_ascii_case(&wanted) {
            return read(member);
        }
        // macOS adds a hidden file for each one.
        if name.to_ascii_lowercase().ends_with(".hgt") && !name.starts_with('.') {
            tiles.push(index);
        }
    }
    match tiles[..] {
        [] => Err(problem(&"the archive has no .hgt file")),
        [only] => read(archive.by_index(only).map_err(|error| problem(&error))?),
        _ => Err(problem(&format!(
            "the archive has {} .hgt files and none is {wanted}: add that file, or give it alone",
            tiles.len()
        ))),
    }
}

fn read(tile: impl Read) -> Result<Vec<u8>, TileError> {
    let mut unpacked = Vec::new();
    // The sizes in the file may be wrong, so they give no room.
    tile.take(MOST + 1).read_to_end(&mut unpacked).map_err(|error| problem(&error))?;
    if unpacked.len() as u64 > MOST {
        return Err(problem(&"it is larger than a tile"));
    }
    Ok(unpacked)
}

fn problem(error: &dyn std::fmt::Display) -> TileError {
    TileError::Packed(error.to_string())
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;

    const SQUARE: Square = Square { lat_deg: 40, lon_deg: -80 };

    fn zipped(members: &[(&str, &[u8])]) -> Vec<u8> {
        let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
        for &(name, contents) in [("README.txt", &b"SRTM"[..])].iter().chain(members) {
            archive.start_file(name, SimpleFileOptions::default()).unwrap();
            archive.write_all(contents).unwrap();
        }
        archive.finish().unwrap().into_inner()
    }

    fn gzipped(contents: &[u8]) -> Vec<u8> {
        let mut packed = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        packed.write_all(contents).unwrap();
        packed.finish().unwrap()
    }

    #[test]
    fn a_tile_is_read_from_an_archive_and_from_gzip() {
        let tile: Vec<u8> = (0..1201 * 1201 * 2).map(|index| (index % 251) as u8).collect();
        for packed in [
            zipped(&[("data/n40w080.HGT", &tile)]),
            zipped(&[("tile.hgt", &tile)]),
            gzipped(&tile),
            tile.clone(),
        ] {
            assert!(unpacked_hgt(packed, SQUARE).unwrap() == tile);
        }
    }

    #[test]
    fn an_archive_of_several_tiles_gives_that_of_the_square() {
        let (other, tile, hidden) =
            (("N39W080.hgt", &[1; 8][..]), ("a/n40w080.hgt", &[2; 8][..]), "._N40W080.hgt");
        let unpacked = |members: &[(&str, &[u8])]| unpacked_hgt(zipped(members), SQUARE);
        assert_eq!(unpacked(&[other, tile]).unwrap(), tile.1);
        assert_eq!(unpacked(&[(hidden, b"x"), tile]).unwrap(), tile.1);
        assert_eq!(unpacked(&[(hidden, b"x"), ("tile.hgt", tile.1)]).unwrap(), tile.1);
        assert_eq!(
            unpacked(&[other, ("N41W080.hgt", other.1)]).unwrap_err().to_string(),
            "it cannot be unpacked: the archive has 2 .hgt files and none is N40W080.hgt: add that file, or give it alone"
        );
    }

    #[test]
    fn a_packed_file_without_a_tile_is_named() {
        let say = |bytes: Vec<u8>| unpacked_hgt(bytes, SQUARE).unwrap_err().to_string();
        assert_eq!(say(zipped(&[("a.txt", b"")])), "it cannot be unpacked: the archive has no .hgt file");
        let bomb = vec![0; MOST as usize + 1];
        for packed in [zipped(&[("a.hgt", &bomb)]), gzipped(&bomb)] {
            assert_eq!(say(packed), "it cannot be unpacked: it is larger than a tile");
        }
        for bytes in [&b"PK\x03\x04"[..], &[0x1f, 0x8b, 8]] {
            assert!(say(bytes.to_vec()).starts_with("it cannot be unpacked: "));
        }
        let many: Vec<u8> = [&b"PK\x03\x04"[..], &b"PK\x01\x02".repeat(101)].concat();
        assert!(say(many).contains("more than 100 members"));
    }
}
