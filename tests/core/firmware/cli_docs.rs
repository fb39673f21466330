//! `docs/settings.md` is printed from the table of settings and must match it.

use std::fmt::Write as _;
use std::path::Path;

use betadeck_core::firmware::settings::{Kind, Role, SETTINGS, Scope, Setting, group_of, needs_restart};
use betadeck_core::telemetry::FirmwareProfile;

const INTRODUCTION: &str = "# Settings

Every setting of the vehicle, in the order of `dump`. `get NAME` shows a setting with its range, `set NAME = VALUE`
changes it, `save` keeps it.

*Live* settings change the behaviour of the vehicle or the values it reports. Settings marked *guide* or *master* do so in
that profile of the autopilot only (`ap_profile`, [autopilot.md](autopilot.md#the-profile-master)), and are carried in
the other one. *Carried* settings are checked, stored and printed, so that the configuration of a real craft stays
complete, but they have no effect here. `get` says so for those of the autopilot. A change takes effect at the next control step. Settings marked ↻ need `save`, which restarts the
firmware. Until then arming is blocked (REBOOT_REQD).

Names from other builds and releases are accepted too. Such a line is kept unchanged, and `dump` and `diff` print it
again. A value that current Betaflight refuses (`ap_position_cutoff` outside 10…50, `ap_velocity_drag_coeff` outside
0…100) is accepted with a notice. In the profile `master` it is refused, and the defaults of `ap_altitude_p` and
`ap_altitude_i` are 30.
";

fn values(setting: &Setting) -> String {
    match setting.kind {
        Kind::Number { min, max, .. } => format!("{min}…{max}"),
        Kind::Choice { words, .. } => words.join(" "),
        Kind::Array { default } => format!("{} numbers", default.len()),
        Kind::Text { max } => format!("text of up to {max} characters"),
        Kind::Port { .. } => "NONE or UART1…UART8".to_owned(),
    }
}

fn document() -> String {
    let mut text = INTRODUCTION.to_owned();
    let mut group = "";
    for setting in &SETTINGS {
        if group_of(setting) != group {
            group = group_of(setting);
            let profiles = match setting.scope {
                Scope::Master => String::new(),
                scope => format!(
                    "One value in each of {} profiles; `{} N` selects one.\n\n",
                    scope.instances(),
                    scope.word()
                ),
            };
            write!(text, "\n## {group}\n\n{profiles}| setting | values | default | | meaning |\n| --- | --- | --- | --- | --- |\n")
                .expect("a string");
        }
        let restart = if needs_restart(setting.name) { " ↻" } else { "" };
        let default = setting.display(&setting.default_value());
        writeln!(
            text,
            "| `{}` | {} | {default} | {}{restart} | {} |",
            setting.name,
            values(setting),
            setting.role,
            setting.help
        )
        .expect("a string");
    }
    text
}

#[test]
fn the_settings_page_is_up_to_date() {
    let page = test_support::path("docs/settings.md");
    let written = std::fs::read_to_string(&page).unwrap_or_default();
    let wanted = document();
    if written != wanted {
        let fresh = Path::new(env!("CARGO_TARGET_TMPDIR")).join("settings.md");
        std::fs::write(&fresh, wanted).expect("a temporary file");
        panic!("docs/settings.md is out of date: copy {} over it", fresh.display());
    }
}

#[test]
fn every_setting_is_described_in_one_sentence() {
    for setting in &SETTINGS {
        let help = setting.help;
        assert!(help.ends_with('.') && help.len() > 5 && help.len() < 110, "{}: {help:?}", setting.name);
        assert!(!help.contains(['|', '\n']), "{}", setting.name);
    }
    let count = |role: Role| SETTINGS.iter().filter(|setting| setting.role == role).count();
    assert_eq!((count(Role::Live), count(Role::Carry)), (229, 158));
    let only = |profile| count(Role::Only(profile));
    assert_eq!((only(FirmwareProfile::Guide), only(FirmwareProfile::Master)), (21, 13));
}
