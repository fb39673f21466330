//! KMZ: a ZIP archive with a KML document. The names of its members are never used as paths.

use std::io::{Cursor, Read as _, Write as _};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

/// The most members of an archive.
const MAX_MEMBERS: usize = 100;
/// The largest unpacked size as a multiple of the packed size.
const MAX_RATIO: u64 = 200;

/// Returns `true` if the contents begin as a ZIP archive.
pub(in crate::plan::format) fn is_archive(contents: &[u8]) -> bool {
    contents.starts_with(b"PK\x03\x04")
}

/// Returns the first KML document of an archive, of at most `most` bytes.
///
/// # Errors
///
/// Returns the reason.
pub(in crate::plan::format) fn unpacked(contents: &[u8], most: usize) -> Result<Vec<u8>, String> {
    // The list of the members takes memory, so its entries are counted before.
    let entries = contents.windows(4).filter(|bytes| bytes == b"PK\x01\x02").count();
    if entries > MAX_MEMBERS {
        return Err(format!("the archive has more than {MAX_MEMBERS} members"));
    }
    let unreadable = |error: &dyn std::fmt::Display| format!("the archive cannot be read: {error}");
    let mut archive = ZipArchive::new(Cursor::new(contents)).map_err(|error| unreadable(&error))?;
    for index in 0..archive.len() {
        let member = archive.by_index_raw(index).map_err(|error| unreadable(&error))?;
        let is_kml = member.name().is_ok_and(|name| name.to_ascii_lowercase().ends_with(".kml"));
        let (is_encrypted, packed, size) = (member.encrypted(), member.compressed_size(), member.size());
        drop(member);
        if !is_kml {
            continue;
        }
        if is_encrypted {
            return Err("the archive is encrypted".to_owned());
        }
        let ratio = packed.saturating_mul(MAX_RATIO);
        let limit = ratio.min(most as u64);
        let too_large = || {
            if ratio < most as u64 {
                format!("the document is packed more than {MAX_RATIO} times")
            } else {
                format!("the document has more than {} MiB", most >> 20)
            }
        };
        // The size in the archive may be wrong, so it gives no room.
        if size > limit {
            return Err(too_large());
        }
        let member = archive.by_index(index).map_err(|error| unreadable(&error))?;
        let mut document = Vec::new();
        member.take(limit + 1).read_to_end(&mut document).map_err(|error| unreadable(&error))?;
        if document.len() as u64 > limit {
            return Err(too_large());
        }
        return Ok(document);
    }
    Err("the archive has no KML document".to_owned())
}

/// Returns an archive with one document. The same document gives the same bytes.
///
/// # Errors
///
/// Returns the reason.
pub(in crate::plan::format) fn packed(document: &str) -> Result<Vec<u8>, String> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    archive
        .start_file("doc.kml", options)
        .and_then(|()| archive.write_all(document.as_bytes()).map_err(Into::into))
        .and_then(|()| archive.finish())
        .map(Cursor::into_inner)
        .map_err(|error| format!("the archive cannot be written: {error}"))
}
