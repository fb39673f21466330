//! Records the build time and the commit of the program, for the CLI's `version` and MSP.
#![allow(clippy::disallowed_methods, clippy::print_stdout, reason = "a build script looks around and prints")]

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

fn main() {
    println!("cargo:rerun-if-changed=src");
    println!("cargo:rerun-if-changed=.git/HEAD");
    println!("cargo:rerun-if-env-changed=SOURCE_DATE_EPOCH");
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let epoch = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|text| text.parse().ok()).unwrap_or(now);
    println!("cargo:rustc-env=BETADECK_BUILD_EPOCH={epoch}");
    println!("cargo:rustc-env=BETADECK_REVISION={}", revision().unwrap_or_else(|| "norevision".to_owned()));
}

/// Returns the commit that is built, or `None` if there is no checkout.
fn revision() -> Option<String> {
    let output = Command::new("git").args(["rev-parse", "--short=9", "HEAD"]).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    let revision = text.trim();
    (output.status.success() && !revision.is_empty()).then(|| revision.to_owned())
}
