//! The configuration on disk: created, saved, damaged, foreign and locked.

use std::path::Path;

use betadeck::firmware::config::Configuration;
use betadeck::firmware::storage::{ImageError, decode, encode};
use betadeck::storage::{FILE_NAME, Store};

fn named(name: &str) -> Configuration {
    let mut configuration = Configuration::default();
    configuration.settings.set_text("craft_name", name).expect("a short name");
    configuration
}

fn name_of(configuration: &Configuration) -> &str {
    configuration.settings.text("craft_name")
}

fn open(directory: &Path) -> Store {
    Store::open(directory, false).expect("a store")
}

#[test]
fn the_first_boot_stores_the_defaults() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut store = open(&directory.path().join("deeper"));
    let loaded = store.load();
    assert!(loaded.first_boot && loaded.findings.is_empty());
    assert_eq!(loaded.configuration, Configuration::default());
    let image = std::fs::read(directory.path().join("deeper").join(FILE_NAME)).expect("a file");
    assert_eq!(decode(&image).expect("a good image"), (Configuration::default(), Vec::new()));
    assert_eq!(store.facts().used_bytes, image.len());
    assert!(image.len() < store.facts().capacity_bytes, "{} bytes", image.len());
}

#[test]
fn a_damaged_file_is_kept_and_the_previous_copy_used() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join(FILE_NAME);
    let mut store = open(directory.path());
    store.save(&named("older")).expect("saved");
    store.save(&named("newer")).expect("saved");
    drop(store);
    let mut image = std::fs::read(&file).expect("a file");
    let middle = image.len() / 2;
    image[middle] ^= 1;
    std::fs::write(&file, &image).expect("written");

    let mut store = open(directory.path());
    let loaded = store.load();
    assert_eq!(name_of(&loaded.configuration), "older");
    assert_eq!(loaded.findings.len(), 2, "{:?}", loaded.findings);
    assert!(store.facts().note.is_some());
    assert_eq!(std::fs::read(directory.path().join("eeprom.bin.bad")).expect("kept"), image);

    drop(store);
    assert_eq!(
        name_of(&open(directory.path()).load().configuration),
        "older",
        "the copy is not lost by looking at it"
    );
    let mut store = open(directory.path());
    store.load();
    store.save(&named("newest")).expect("saved");
    assert_eq!(store.facts().note, None);
    std::fs::write(&file, b"").expect("written");
    drop(store);
    assert_eq!(name_of(&open(directory.path()).load().configuration), "older");
    assert!(directory.path().join("eeprom.bin.bad.2").exists());
}

#[test]
fn without_a_good_copy_the_defaults_are_used_and_reported() {
    let directory = tempfile::tempdir().expect("a directory");
    std::fs::write(directory.path().join(FILE_NAME), b"rubbish").expect("written");
    let loaded = open(directory.path()).load();
    assert_eq!(loaded.configuration, Configuration::default());
    assert!(!loaded.first_boot && !loaded.findings.is_empty());
    assert!(directory.path().join("eeprom.bin.bad").exists());
}

#[test]
fn the_file_of_another_firmware_is_left_alone() {
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join(FILE_NAME);
    let foreign = [&[0xb2, 0xbe][..], &[7; 100]].concat();
    std::fs::write(&file, &foreign).expect("written");
    let mut store = open(directory.path());
    let loaded = store.load();
    assert_eq!(loaded.configuration, Configuration::default());
    let refusal = store.save(&named("mine")).expect_err("refused").to_string();
    assert!(refusal.contains("eeprom.bin") && refusal.contains("move it away"), "{refusal}");
    assert_eq!(store.facts().save_refusal, Some(refusal));
    assert_eq!(std::fs::read(&file).expect("there"), foreign);

    drop(store);
    let mut store = Store::open(directory.path(), true).expect("a store");
    store.load();
    store.save(&named("mine")).expect("saved");
    assert_eq!(name_of(&store.load().configuration), "mine");
}

#[test]
fn the_file_of_a_later_version_is_left_alone() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut image = encode(&named("future"));
    image[4] = 2;
    let length = image.len() - 4;
    let checksum = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&image[..length]);
    image[length..].copy_from_slice(&checksum.to_le_bytes());
    assert_eq!(decode(&image), Err(ImageError::LaterFormat { found: 2 }));
    std::fs::write(directory.path().join(FILE_NAME), &image).expect("written");
    let mut store = open(directory.path());
    store.load();
    assert!(store.save(&named("mine")).is_err());
}

#[test]
fn a_second_store_in_the_directory_reads_but_does_not_save() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut first = open(directory.path());
    first.save(&named("first")).expect("saved");
    let mut second = open(directory.path());
    assert_eq!(name_of(&second.load().configuration), "first");
    let refusal = second.save(&named("second")).expect_err("refused").to_string();
    assert!(refusal.contains("another betadeck"), "{refusal}");
    drop(first);
    let mut third = open(directory.path());
    third.save(&named("third")).expect("saved");
}

#[test]
fn memory_survives_a_restart_of_the_firmware() {
    let mut store = Store::in_memory();
    assert!(store.load().first_boot);
    store.save(&named("kept")).expect("saved");
    assert_eq!(name_of(&store.load().configuration), "kept");
}

#[test]
fn records_of_other_versions_are_stored_again() {
    let mut configuration = named("mine");
    configuration.unknown_records.push("setting\tap_from_the_future\t7".to_owned());
    configuration.unknown_records.push("hologram\t1\t2".to_owned());
    let (read, findings) = decode(&encode(&configuration)).expect("a good image");
    assert_eq!((read, findings), (configuration, Vec::new()));
}
