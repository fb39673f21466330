//! The firmware that wrote a log.

use super::finding::HeaderFinding;
use super::lines::Lines;

/// The version of a firmware: major, minor, patch.
pub type Version = (u32, u32, u32);

/// The firmware that wrote a log. `Display` gives its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display, strum::EnumIter, strum::IntoStaticStr)]
pub enum FirmwareName {
    Betaflight,
    Cleanflight,
    #[strum(to_string = "INAV")]
    Inav,
    EmuFlight,
    Rotorflight,
    /// A firmware that this program does not know.
    #[strum(to_string = "unknown firmware")]
    Unknown,
}

/// Returns the firmware that a header names, and adds what is assumed of it. Forks of Cleanflight write their own name only into
/// the revision.
pub(super) fn of(lines: &Lines, findings: &mut Vec<HeaderFinding>) -> (FirmwareName, Version) {
    use strum::IntoEnumIterator as _;
    let revision = lines.value("Firmware revision").unwrap_or_default();
    let (word, rest) = revision.trim_start().split_once(' ').unwrap_or((revision, ""));
    let called =
        |name: &str| FirmwareName::iter().find(|known| <&str>::from(known).eq_ignore_ascii_case(name));
    let (name, version) = match called(word) {
        Some(name) => (Some(name), version(rest)),
        None => (called(lines.value("Firmware type").unwrap_or_default()), (0, 0, 0)),
    };
    if name.is_none() {
        findings.push(HeaderFinding::of(
            lines,
            "Firmware type",
            "the units of an unknown firmware are assumed",
        ));
    }
    // Cleanflight before 2.0 wrote only the hash of its source.
    let is_hash = !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_hexdigit());
    let needs_version = match name {
        Some(FirmwareName::Betaflight) => true,
        Some(FirmwareName::Cleanflight) => !is_hash,
        _ => false,
    };
    if revision.is_empty() || needs_version && version == (0, 0, 0) {
        let assumed = "the units of an unknown version are assumed, and modes have no names";
        findings.push(HeaderFinding::of(lines, "Firmware revision", assumed));
    }
    (name.unwrap_or(FirmwareName::Unknown), version)
}

/// Returns the version at the start of a text such as `4.5.2 (024f8e13d)` or `2026.12.0-alpha`.
fn version(text: &str) -> Version {
    let end = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(text.len());
    let mut parts = text[..end].split('.').map(|part| part.parse().unwrap_or_default());
    let mut next = || parts.next().unwrap_or_default();
    (next(), next(), next())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(revision: &str, kind: &str) -> (FirmwareName, Version) {
        let text = format!("H Firmware type:{kind}\nH Firmware revision:{revision}\n");
        of(&Lines::read(text.as_bytes()).unwrap().0, &mut Vec::new())
    }

    #[test]
    fn firmwares_have_names_and_versions() {
        use FirmwareName::*;
        assert_eq!(named("Betaflight 2026.12.0-alpha (rev) SITL", "Betaflight"), (Betaflight, (2026, 12, 0)));
        assert_eq!(named("Betaflight 4.5.2 (024f8e13d) STM32F7X2", "Cleanflight"), (Betaflight, (4, 5, 2)));
        assert_eq!(named("INAV 7.1 (x) Y", "Cleanflight"), (Inav, (7, 1, 0)));
        assert_eq!(named("EmuFlight 0.4.1", "Cleanflight"), (EmuFlight, (0, 4, 1)));
        assert_eq!(named("c49bd40", "Cleanflight"), (Cleanflight, (0, 0, 0)));
        assert_eq!(named("", "Baseflight"), (Unknown, (0, 0, 0)));
    }
}
