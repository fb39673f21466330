//! Records the build time and the commit of the program, for the CLI's `version` and MSP. Compiles the library that is
//! preloaded into SITL executables.
#![allow(clippy::disallowed_methods, clippy::print_stdout, reason = "a build script looks around and prints")]

use std::env::var;
use std::path::PathBuf;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// The source of the preloaded library.
const LIBRARY: &str = "src/link/sitl_child/lockstep/preload/lib.rs";

fn main() {
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=.git/HEAD");
    println!("cargo:rerun-if-env-changed=SOURCE_DATE_EPOCH");
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let epoch = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|text| text.parse().ok()).unwrap_or(now);
    println!("cargo:rustc-env=BETADECK_BUILD_EPOCH={epoch}");
    println!("cargo:rustc-env=BETADECK_REVISION={}", revision().unwrap_or_else(|| "norevision".to_owned()));
    compile_preloaded_library();
}

/// Compiles the library that is preloaded into SITL executables, with the compiler of this build. The program includes it.
/// It is empty for systems on which it does not work.
fn compile_preloaded_library() {
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
    compiler.args([
        "-C",
        "panic=abort",
        "-C",
        "opt-level=3",
        "-C",
        "lto=fat",
        "-C",
        "strip=symbols",
        "-A",
        "dead_code",
    ]);
    compiler.arg("--target").arg(var("TARGET").unwrap_or_default());
    if let Ok(linker) = var("RUSTC_LINKER") {
        compiler.arg("-C").arg(format!("linker={linker}"));
    }
    let status = compiler.arg("-o").arg(&out).arg(LIBRARY).status().expect("the compiler can be started");
    assert!(status.success(), "{LIBRARY} cannot be compiled");
}

/// Returns the commit that is built, or `None` if there is no checkout.
fn revision() -> Option<String> {
    let output = Command::new("git").args(["rev-parse", "--short=9", "HEAD"]).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let revision = text.trim();
    (output.status.success() && !revision.is_empty()).then(|| revision.to_owned())
}
