//! Compiles the library that is preloaded into SITL executables, with the compiler of this build. The program includes it.
//! It is empty for systems on which it does not work.
#![allow(clippy::disallowed_methods, clippy::print_stdout, reason = "a build script looks around and prints")]

use std::env::var;
use std::path::PathBuf;
use std::process::Command;

/// The source of the preloaded library.
const LIBRARY: &str = "src/link/sitl_child/lockstep/preload/lib.rs";
/// All that the library is compiled from.
const SOURCES: [&str; 2] = ["src/link/sitl_child/lockstep/preload", "src/link/sitl_child/lockstep/frames.rs"];

fn main() {
    for source in SOURCES {
        println!("cargo:rerun-if-changed={source}");
    }
    let out = PathBuf::from(var("OUT_DIR").unwrap_or_default()).join("lockstep.so");
    let is =
        |name: &str, value: &str| var(format!("CARGO_CFG_TARGET_{name}")).is_ok_and(|found| found == value);
    if !(is("OS", "linux") && is("ENV", "gnu") && (is("ARCH", "x86_64") || is("ARCH", "aarch64"))) {
        std::fs::write(&out, []).expect("the directory for the output is writable");
        return;
    }
    let mut compiler = Command::new(var("RUSTC").unwrap_or_else(|_| "rustc".to_owned()));
    compiler.args(["--edition", "2024", "--crate-type", "cdylib", "--crate-name", "lockstep"]);
    // Without `lto` the library needs the unwinding of the standard library.
    for option in ["panic=abort", "opt-level=3", "lto=fat", "strip=symbols"] {
        compiler.args(["-C", option]);
    }
    compiler.args(["-A", "dead_code"]);
    compiler.arg("--target").arg(var("TARGET").unwrap_or_default());
    if let Ok(linker) = var("RUSTC_LINKER") {
        compiler.arg("-C").arg(format!("linker={linker}"));
    }
    let status = compiler.arg("-o").arg(&out).arg(LIBRARY).status().expect("the compiler can be started");
    assert!(status.success(), "{LIBRARY} cannot be compiled");
}
