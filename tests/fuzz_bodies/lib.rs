//! The bodies of the fuzz targets. Their checks must hold for any bytes. `fuzz/` runs them under libFuzzer,
//! `tests/links/fuzz_corpus.rs` on the stored corpora and on mutations of them.
#![allow(unreachable_pub, reason = "a library of the fuzz crate, a module of the tests")]

pub mod airframe;
pub mod betaloop;
pub mod blackbox;
pub mod cli;
pub mod configuration;
mod craft;
pub mod door;
pub mod eeprom;
pub mod fc_client;
pub mod fdm;
pub mod history;
pub mod journal;
pub mod msp_stream;
pub mod plan_file;
pub mod rc;
pub mod recording;
pub mod scenario;
pub mod screen;
pub mod servo;
pub mod settings_file;
