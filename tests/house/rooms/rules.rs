//! Ways around the table of rooms, and ways from the core to the world outside it.

use crate::rooms::paths::{Named, named, tokens};
use crate::rooms::source::{SourceFile, files};

/// Files above the core that are pure, too: all of these folders but for these files.
const PURE: [&str; 3] = ["fc", "link/proto", "mavlink"];
const NOT_PURE: [&str; 4] = ["fc/feed.rs", "fc/kept_flight.rs", "fc/remote_link.rs", "fc/stepped.rs"];

/// Modules of `std` that reach the world outside the program.
const OUTSIDE: [&str; 6] = ["env", "fs", "net", "os", "process", "thread"];

/// Types that make a `static` a variable.
const VARIABLES: [&str; 8] =
    ["Cell", "LazyLock", "Mutex", "OnceCell", "OnceLock", "RefCell", "RwLock", "UnsafeCell"];

/// Returns `true` for a file without files, sockets, threads, the clock and global state: all of the core, and the
/// protocols above it.
pub(crate) fn is_pure(file: &SourceFile) -> bool {
    let is_protocol = PURE.iter().any(|folder| file.name.starts_with(folder));
    file.is_of_the_core() || is_protocol && !NOT_PURE.contains(&file.name.as_str())
}

/// Returns what a file does to get around the table of rooms.
fn detours(file: &SourceFile) -> Vec<String> {
    let room = file.room();
    let file = file.product();
    let all = named(&file);
    let is_foreign = |named: &Named| named.is_ours && named.room().0 != room;
    let mut found = Vec::new();
    for named in &all {
        let path = named.path.join("::");
        match named.path.last().map(String::as_str) {
            Some("*") if is_foreign(named) && named.path.len() <= 2 => {
                found.push(format!("{}: imports all of {path}", file.name));
            }
            _ if named.is_passed_on && is_foreign(named) => {
                found.push(format!("{}: passes {path} on", file.name));
            }
            // `use crate::sim::World; pub use World;`
            _ if named.is_passed_on && !named.is_ours => {
                let first = named.path.first();
                let source = all.iter().find(|other| is_foreign(other) && Some(&other.name) == first);
                found.extend(
                    source.map(|source| format!("{}: passes {} on", file.name, source.path.join("::"))),
                );
            }
            _ => {}
        }
    }
    found
}

/// Returns the ways from a file to files, sockets, threads, the clock and global state.
fn ways_out(file: &SourceFile) -> Vec<String> {
    let file = file.product();
    let mut found = Vec::new();
    for named in named(&file).iter().filter(|named| !named.is_ours) {
        let path: Vec<&str> = named.path.iter().map(String::as_str).collect();
        let is_out = match path[..] {
            ["std", module, ..] if OUTSIDE.contains(&module) => true,
            ["std", "time", "Instant" | "SystemTime", ..] | ["std"] | ["std", "*"] | ["std", "time", "*"] => {
                true
            }
            ["std", "io", "stdin" | "stdout" | "stderr", ..] => true,
            ["tokio" | "rustix" | "tempfile", ..] => true,
            _ => false,
        };
        if is_out {
            found.push(format!("{}: uses {}", file.name, path.join("::")));
        }
    }
    let tokens = tokens(&file.text);
    for (index, token) in tokens.iter().enumerate() {
        let is_lifetime = index > 0 && ["&", "+", ":", "<", ","].contains(&tokens[index - 1].as_str());
        let declared: Vec<&str> =
            tokens[index..].iter().take_while(|token| *token != "=").map(String::as_str).take(40).collect();
        let is_variable = declared.iter().any(|word| VARIABLES.contains(word) || word.starts_with("Atomic"));
        if token == "thread_local"
            || token == "static" && !is_lifetime && (is_variable || declared.contains(&"mut"))
        {
            found.push(format!("{}: has global state: {}", file.name, declared.join(" ")));
        }
    }
    found
}

#[test]
fn no_file_gets_around_the_table_of_rooms() {
    let found: Vec<String> = files().iter().flat_map(detours).collect();
    assert!(found.is_empty(), "{found:#?}");
}

#[test]
fn the_core_reaches_nothing_outside_the_program() {
    let found: Vec<String> = files().iter().filter(|file| is_pure(file)).flat_map(ways_out).collect();
    assert!(found.is_empty(), "{found:#?}");
}

fn file(text: &str) -> SourceFile {
    SourceFile { name: "sim/x.rs".to_owned(), text: text.to_owned() }
}

#[test]
fn every_known_detour_is_found() {
    for text in [
        "use crate::*;",
        "use crate::ui::*;",
        "use super::super::ui::*;",
        "use crate::{geo, ui::*};",
        "pub use crate::firmware::Firmware;",
        "pub(crate) use super::super::firmware::{Firmware as Fc};",
        "use crate::firmware::Firmware; pub use Firmware;",
        "use crate::firmware::Firmware as Fc; pub use Fc as Other;",
        "pub type Fc = crate::firmware::Firmware;",
    ] {
        assert_eq!(detours(&file(text)).len(), 1, "{text}");
    }
    for text in
        ["use super::*;", "pub use crate::sim::World;", "use crate::ui::State;", "pub use world::World;"]
    {
        assert_eq!(detours(&file(text)), [""; 0], "{text}");
    }
}

#[test]
fn every_known_way_out_is_found() {
    for text in [
        "use std::fs;",
        "use std::{collections::BTreeMap, net::UdpSocket};",
        "fn f() { std::thread::spawn(g); }",
        "let now = std::time::Instant::now();",
        "use std::time::*;",
        "use tokio::net;",
        "fn f() { tokio::spawn(g); }",
        "let text = ::std::fs::read(name);",
        "let line = std::io::stdin().lines();",
        "use std::os::unix::net::UnixStream;",
        "static mut COUNT: u32 = 0;",
        "static COUNT: std::sync::atomic::AtomicU32 = AtomicU32::new(0);",
        "static ALL: Mutex<Vec<u32>> = Mutex::new(Vec::new());",
        "thread_local! { static A: u32 = 0; }",
    ] {
        assert!(!ways_out(&file(text)).is_empty(), "{text}");
    }
    for text in [
        "use std::time::Duration;",
        "static TABLE: [u16; 3] = [1, 2, 3];",
        "fn f() -> &'static str { \"std::fs\" }",
        "impl<S: Send + 'static> Late for Box<S> { fn f(&self, of: &Cell<S>) {} }",
        "#[cfg(test)]\nmod tests { use std::fs; }",
    ] {
        assert_eq!(ways_out(&file(text)), [""; 0], "{text}");
    }
}
