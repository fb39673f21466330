//! The names of the craft, the pilot and the profiles.

use super::{Call, Refused};
use crate::firmware::config::KeptLine;
use crate::firmware::settings::Scope;

/// The pilot's name. This vehicle has no setting for it, so it is kept like the settings of other builds.
const PILOT_NAME: &str = "pilot_name";
/// The most characters of the pilot's name.
const PILOT_NAME_MAX: usize = 16;

/// Returns the setting for a text type, if any, and its maximum length.
fn setting_of(kind: u8) -> Option<(&'static str, usize)> {
    match kind {
        2 => Some(("craft_name", 16)),
        3 => Some(("profile_name", 8)),
        4 => Some(("rateprofile_name", 8)),
        11 => Some(("battery_profile_name", 8)),
        _ => None,
    }
}

const PILOT: u8 = 1;

pub(super) fn name(call: &mut Call<'_>) {
    let name = call.configuration.settings.text("craft_name");
    call.reply.bytes(name.as_bytes());
}

pub(super) fn set_name(call: &mut Call<'_>) -> Result<(), Refused> {
    let name = clean(call.request.all(), 16);
    call.configuration.settings.set_text("craft_name", &name).map_err(|_| Refused)
}

pub(super) fn get_text(call: &mut Call<'_>) -> Result<(), Refused> {
    let kind = call.request.u8();
    let text = match setting_of(kind) {
        Some((name, _)) => call.configuration.settings.text(name),
        None if kind == PILOT => {
            let mut kept = call.configuration.kept.iter();
            kept.find(|line| line.name == PILOT_NAME).map_or("", |line| line.text.as_str())
        }
        // There is no build key and no release name.
        None => return Err(Refused),
    };
    call.reply.u8(kind);
    call.reply.prefixed(text);
    Ok(())
}

pub(super) fn set_text(call: &mut Call<'_>) -> Result<(), Refused> {
    let kind = call.request.u8();
    let text = call.request.prefixed();
    if kind == PILOT {
        let text = clean(text, PILOT_NAME_MAX);
        let line = KeptLine { scope: Scope::Master, instance: 0, name: PILOT_NAME.to_owned(), text };
        return call.configuration.kept.keep(line).then_some(()).ok_or(Refused);
    }
    let (name, max) = setting_of(kind).ok_or(Refused)?;
    call.configuration.settings.set_text(name, &clean(text, max)).map_err(|_| Refused)
}

/// Returns the characters of a name that can be stored and typed, at most `max`.
fn clean(text: &[u8], max: usize) -> String {
    let printable = text.iter().filter(|&&byte| (b' '..=b'~').contains(&byte) && byte != b'#');
    let text: String = printable.take(max).map(|&byte| char::from(byte)).collect();
    let text = text.trim();
    if text == "-" { String::new() } else { text.to_owned() }
}
