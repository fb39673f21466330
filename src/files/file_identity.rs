//! Numbers that tell files with different contents apart.

use std::os::unix::fs::FileExt as _;
use std::path::Path;

use super::input_file;

/// The bytes at the beginning and at the end of a file that are looked at.
const LOOKED_AT: u64 = 64 << 10;
const CHECKSUM: crc::Crc<u64> = crc::Crc::<u64>::new(&crc::CRC_64_XZ);

/// Returns a number made from the length of a file, its beginning and its end. Another name of the file does not change it.
/// Returns `None` if the file cannot be read.
pub(crate) fn of(path: &Path) -> Option<u64> {
    let (file, size) = input_file::open_log(path).ok()?;
    let mut sum = CHECKSUM.digest();
    sum.update(&size.to_le_bytes());
    let mut part = vec![0; usize::try_from(size.min(LOOKED_AT)).ok()?];
    for offset in [0, size.saturating_sub(LOOKED_AT)] {
        file.read_exact_at(&mut part, offset).ok()?;
        sum.update(&part);
    }
    Some(sum.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_the_same_number_under_another_name_and_another_one_with_other_contents() {
        let directory = tempfile::tempdir().unwrap();
        let number = |name: &str, contents: &[u8]| {
            let path = directory.path().join(name);
            std::fs::write(&path, contents).unwrap();
            of(&path)
        };
        let long = vec![7; 200_000];
        let mut other_end = long.clone();
        other_end[199_999] = 8;
        let numbers =
            [number("a", &long), number("b", &other_end), number("c", &long[1..]), number("d", b"")];
        assert!(numbers.iter().all(Option::is_some));
        assert_eq!(number("e", &long), numbers[0]);
        for (at, one) in numbers.iter().enumerate() {
            assert!(!numbers[at + 1..].contains(one));
        }
        assert_eq!(of(&directory.path().join("missing")), None);
    }
}
