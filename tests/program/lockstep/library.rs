//! The executables into which the library can be loaded.

use std::path::Path;

use betadeck::link::lockstep::{NoLockstep, check_lockstep};

#[test]
fn a_program_of_this_machine_can_fly_in_simulated_time() {
    assert_eq!(check_lockstep(&std::env::current_exe().unwrap()), Ok(()));
}

#[test]
fn a_script_a_text_and_an_executable_of_another_machine_cannot() {
    let folder = tempfile::tempdir().unwrap();
    let check = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        check_lockstep(&file)
    };
    assert_eq!(check("script", b"#!/bin/sh\nexec betaflight_SITL.elf\n"), Err(NoLockstep::Foreign));
    assert_eq!(check("empty", b""), Err(NoLockstep::Foreign));
    let mut own = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    own[18] ^= 0x55;
    assert_eq!(check("other-processor", &own), Err(NoLockstep::Foreign));
}

#[test]
fn an_executable_without_a_loader_is_static_and_one_with_another_loader_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let own = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    let loader = b"ld-linux";
    let at = own.windows(loader.len()).position(|bytes| bytes == loader).unwrap();
    let mut musl = own.clone();
    musl[at..at + 8].copy_from_slice(b"ld-musl-");
    let mut without = own;
    // The table of segments has no entries.
    without[56..58].fill(0);
    for (bytes, expected) in [(musl, NoLockstep::OtherLibrary), (without, NoLockstep::Static)] {
        let file = folder.path().join("program");
        std::fs::write(&file, bytes).unwrap();
        assert_eq!(check_lockstep(&file), Err(expected));
    }
}

#[test]
fn a_file_that_cannot_be_read_is_left_to_its_start() {
    assert_eq!(check_lockstep(Path::new("/there/is/none")), Ok(()));
}
