//! The commit that is built, for the executable. A build script would make each commit compile the whole library again; the
//! files that a macro includes concern only the crate that calls it.
#![allow(clippy::disallowed_methods, reason = "a macro looks around while the program is compiled")]

use std::path::{Path, PathBuf};
use std::process::Command;

use proc_macro::TokenStream;

/// Files of a checkout of which at least one changes with each commit, in a linked worktree, too. `HEAD` itself names a
/// branch and stays the same.
const CHANGED_BY_A_COMMIT: [&str; 3] = ["HEAD", "logs/HEAD", "reftable/tables.list"];

/// Returns the beginning of the commit's hash and the time of the build in seconds since 1970, as `(&str, u64)`. The time is
/// `SOURCE_DATE_EPOCH`, otherwise the time of the commit. Without a checkout the revision is `norevision` and the time 0.
#[proc_macro]
pub fn revision(_: TokenStream) -> TokenStream {
    let folder = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let head = git(&folder, &["show", "--no-patch", "--no-show-signature", "--format=%H %ct", "HEAD"]);
    // The beginning has a fixed length: git itself abbreviates less in a clone with more objects.
    let commit = head
        .as_deref()
        .and_then(|head| head.split_once(' '))
        .and_then(|(hash, time)| Some((hash.get(..9)?, time.parse().ok()?)));
    let (hash, time): (_, u64) = commit.unwrap_or(("norevision", 0));
    let time = std::env::var("SOURCE_DATE_EPOCH").ok().and_then(|time| time.parse().ok()).unwrap_or(time);
    let mut code = String::from("const _: Option<&str> = option_env!(\"SOURCE_DATE_EPOCH\");");
    for name in CHANGED_BY_A_COMMIT {
        let path = git(&folder, &["rev-parse", "--git-path", name]).map(|path| folder.join(path));
        if let Some(path) = path.filter(|path| path.is_file()) {
            code += &format!("const _: &[u8] = include_bytes!({path:?});");
        }
    }
    format!("{{ {code} ({hash:?}, {time}_u64) }}").parse().unwrap_or_default()
}

/// Returns the output of git in a folder, or `None` if git fails.
fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").current_dir(folder).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
