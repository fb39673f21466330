//! Settings by name, for clients that do not use the command line.

use super::{Call, Refused};
use crate::firmware::settings::{Kind, PORT_NAMES, Scope, Setting, beyond_current_firmware, find};
use crate::msp::PaddedReader;

/// Sets with `name = value` or reads with `name`. Replies with `name = value`.
pub(super) fn setting(call: &mut Call<'_>) -> Result<(), Refused> {
    let text = std::str::from_utf8(call.request.all()).map_err(|_| Refused)?.trim_matches(['\0', ' ']);
    let (name, value) = match text.split_once('=') {
        Some((name, value)) => (name.trim(), Some(value.trim())),
        None => (text, None),
    };
    let setting = find(name).ok_or(Refused)?;
    let settings = &mut call.configuration.settings;
    if let Some(value) = value {
        settings.assign(setting, value).map_err(|_| Refused)?;
    }
    let is_written = value.is_some();
    let value = setting.display(settings.active_value(setting).ok_or(Refused)?).to_string();
    if is_written {
        call.notice = beyond_current_firmware(setting, &value);
    }
    call.reply.bytes(format!("{} = {value}", setting.name).as_bytes());
    Ok(())
}

/// Describes a setting in lines of text, starting at an offset, after their total length.
pub(super) fn setting_info(call: &mut Call<'_>) -> Result<(), Refused> {
    let request = call.request.all();
    let (name, offset) = match request.iter().position(|&byte| byte == 0) {
        Some(end) => {
            let mut rest = PaddedReader::new(&request[end + 1..]);
            (&request[..end], usize::from(rest.u16()))
        }
        None => (request, 0),
    };
    let name = std::str::from_utf8(name).map_err(|_| Refused)?;
    let text = describe(&call.configuration.settings.resolved(find(name.trim()).ok_or(Refused)?));
    call.reply.u16(text.len() as i64);
    call.reply.bytes(text.as_bytes().get(offset..).unwrap_or_default());
    Ok(())
}

fn describe(setting: &Setting) -> String {
    let group = match setting.scope {
        Scope::Master => 0,
        Scope::Profile => 1,
        Scope::RateProfile => 2,
        Scope::BatteryProfile => 3,
    };
    let mut lines = vec![format!("pgn={group}"), format!("type={}", setting.width)];
    match setting.kind {
        Kind::Number { min, max, .. } => lines.extend([format!("min={min}"), format!("max={max}")]),
        Kind::Choice { words, .. } => lines.push(format!("values={}", words.join(","))),
        Kind::Array { default } => lines.push(format!("length={}", default.len())),
        Kind::Text { max } => lines.extend(["min=1".to_owned(), format!("max={max}")]),
        Kind::Port { .. } => {
            lines.push(format!("values={}", PORT_NAMES.join(",")));
        }
    }
    lines.push(format!("default={}", setting.display(&setting.default_value())));
    lines.iter().map(|line| format!("{line}\n")).collect()
}
