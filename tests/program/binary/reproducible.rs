//! Builds in different folders.

use std::path::Path;

use memchr::memmem;

use crate::binary::support::PROGRAM;

/// Returns the bytes of a 64-bit little-endian ELF file that are loaded. Those for debuggers may name folders.
fn loaded(program: &Path) -> Vec<u8> {
    const LOADED: usize = 1;
    const ENTRY: usize = 56;
    let bytes = std::fs::read(program).expect("an executable");
    let number = |at: usize, size: usize| {
        bytes[at..at + size].iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte))
    };
    let entries = (0..number(56, 2)).map(|index| number(32, 8) + index * ENTRY);
    let parts = entries.filter(|&entry| number(entry, 4) == LOADED);
    parts.flat_map(|entry| &bytes[number(entry + 8, 8)..][..number(entry + 32, 8)]).copied().collect()
}

#[test]
fn the_executable_names_no_folder_of_its_build() {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().and_then(Path::to_str).expect("a folder");
    let own = loaded(&std::env::current_exe().expect("an executable"));
    let program = loaded(Path::new(PROGRAM));
    for folder in [env!("CARGO_MANIFEST_DIR"), target] {
        let finds = |bytes: &[u8]| memmem::find(bytes, folder.as_bytes());
        assert!(finds(&own).is_some(), "this test itself names {folder}");
        assert_eq!(finds(&program), None, "{folder} makes builds in other folders differ");
    }
}
