//! The check that this machine can start a file, before the attempt.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use crate::process::error::AppError;

/// The bytes of an ELF header up to the machine.
const HEADER: usize = 20;
/// The first bytes of each ELF file.
const MAGIC: [u8; 4] = [0x7f, b'E', b'L', b'F'];
/// Machines with their number in an ELF header, their name in Rust and their usual name.
const MACHINES: [(u16, &str, &str); 6] = [
    (3, "x86", "x86 (32 bits)"),
    (40, "arm", "ARM (32 bits)"),
    (62, "x86_64", "x86-64"),
    (183, "aarch64", "ARM64"),
    (8, "mips", "MIPS"),
    (243, "riscv64", "RISC-V"),
];

/// Returns the absolute path of the executable, if this machine can start it.
///
/// # Errors
/// Returns the reason why not, with exit code 3.
pub(super) fn find(path: &Path) -> Result<PathBuf, AppError> {
    let name = path.display();
    let problem = |why: String| AppError::environment(format!("--firmware {name}: {why}"));
    let found = path.canonicalize().map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => problem(format!(
            "there is no such file{}: name a betaflight_SITL.elf that you have built, or write embedded or attach",
            guess(path)
        )),
        _ => problem(format!("it cannot be reached: {error}")),
    })?;
    if !found.is_file() {
        return Err(problem("it is not a file: name the executable itself, betaflight_SITL.elf".to_owned()));
    }
    if rustix::fs::access(&found, rustix::fs::Access::EXEC_OK).is_err() {
        return Err(problem(format!("it is not executable: chmod +x {name}, if it is a SITL build")));
    }
    let mut header = Vec::with_capacity(HEADER);
    // For a file that may be executed but not read, the start shows the result.
    if let Ok(file) = File::open(&found)
        && file.take(HEADER as u64).read_to_end(&mut header).is_ok()
        && let Some(why) = other_machine(&header, std::env::consts::ARCH)
    {
        return Err(problem(why));
    }
    Ok(found)
}

/// Returns a suggestion for a word that is not a file.
fn guess(path: &Path) -> String {
    let word = path.to_str().unwrap_or_default();
    match crate::text::did_you_mean::closest(word, ["embedded", "attach"]) {
        Some(meant) => format!(", did you mean {meant}?"),
        None => String::new(),
    }
}

/// Returns the reason why an ELF file with this header cannot run on `here`, as half a sentence. Other files are left
/// to the system.
fn other_machine(header: &[u8], here: &str) -> Option<String> {
    let (magic, rest) = header.split_at_checked(MAGIC.len())?;
    // The byte order is in the sixth byte, the machine in the nineteenth and twentieth.
    let (order, machine) = (*rest.get(1)?, [*rest.get(14)?, *rest.get(15)?]);
    if magic != MAGIC {
        return None;
    }
    let machine = if order == 2 { u16::from_be_bytes(machine) } else { u16::from_le_bytes(machine) };
    let name_of = |arch: &str| MACHINES.iter().find(|(_, own, _)| *own == arch).map(|(_, _, name)| *name);
    let (_, arch, name) = MACHINES.iter().find(|(number, ..)| *number == machine)?;
    // A 64-bit system may run programs of its 32-bit kind.
    let runs = *arch == here || matches!((*arch, here), ("x86", "x86_64") | ("arm", "aarch64"));
    (!runs).then(|| {
        format!("it is built for {name}, this machine is {}: build it here", name_of(here).unwrap_or(here))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    fn header(order: u8, machine: [u8; 2]) -> Vec<u8> {
        let mut header = vec![0; HEADER];
        header[..4].copy_from_slice(&MAGIC);
        header[5] = order;
        header[18..].copy_from_slice(&machine);
        header
    }

    #[test]
    fn a_file_for_another_machine_is_named() {
        assert_eq!(other_machine(&header(1, [62, 0]), "x86_64"), None);
        assert_eq!(other_machine(&header(1, [3, 0]), "x86_64"), None);
        assert_eq!(
            other_machine(&header(1, [183, 0]), "x86_64").unwrap(),
            "it is built for ARM64, this machine is x86-64: build it here"
        );
        assert_eq!(
            other_machine(&header(1, [40, 0]), "x86_64").unwrap(),
            "it is built for ARM (32 bits), this machine is x86-64: build it here"
        );
        assert!(other_machine(&header(2, [0, 8]), "aarch64").unwrap().contains("MIPS"));
        assert_eq!(other_machine(b"#!/bin/sh\nexec something", "x86_64"), None);
        assert_eq!(other_machine(&[0x7f, b'E', b'L'], "x86_64"), None);
        assert_eq!(other_machine(&[], "x86_64"), None);
    }

    #[test]
    fn what_cannot_be_started_is_reported_in_one_sentence() {
        let directory = tempfile::tempdir().expect("a directory");
        let refusal = |name: &str| {
            let error = find(&directory.path().join(name)).expect_err(name);
            assert_eq!(error.code, 3);
            error.to_string()
        };
        assert!(refusal("none.elf").contains("there is no such file: name a betaflight_SITL.elf"));
        assert!(refusal("").contains("it is not a file"));
        let plain = directory.path().join("plain");
        std::fs::write(&plain, header(1, [62, 0])).expect("written");
        assert!(refusal("plain").contains("it is not executable: chmod +x"));
        let other = directory.path().join("other");
        std::fs::write(&other, header(2, [0, 8])).expect("written");
        std::fs::set_permissions(&other, PermissionsExt::from_mode(0o755)).expect("executable");
        assert!(refusal("other").contains("it is built for MIPS"));
        let error = find(Path::new("embeded")).expect_err("no file").to_string();
        assert!(error.contains("no such file, did you mean embedded?: "), "{error}");
    }

    #[test]
    fn this_program_itself_can_be_started() {
        let own = std::env::current_exe().expect("a path");
        assert_eq!(find(&own).expect("startable"), own.canonicalize().expect("a path"));
    }
}
