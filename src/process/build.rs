//! The version of the program, and the commit that it is built from.

use std::sync::OnceLock;

static BUILD: OnceLock<Build> = OnceLock::new();

/// The commit that is built. Only the executable knows it, so that a commit does not compile the library again.
#[derive(Debug, Clone, Copy)]
pub struct Build {
    /// The beginning of its hash.
    pub revision: &'static str,
    /// Its time, seconds since 1970.
    pub time_s: u64,
}

impl Build {
    /// Records the build of this process. The first one counts.
    pub(crate) fn record(self) {
        BUILD.get_or_init(|| self);
    }

    /// Returns the build of this process.
    pub(crate) fn get() -> Self {
        BUILD.get().copied().unwrap_or(Self { revision: "norevision", time_s: 0 })
    }
}

/// Returns the version and the revision.
pub(crate) fn version() -> String {
    format!("{} ({})", env!("CARGO_PKG_VERSION"), Build::get().revision)
}
