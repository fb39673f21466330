#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| betadeck_fuzz::screen::run(data));
