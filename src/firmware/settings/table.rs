//! The table of all settings, in the order of `set` and `dump`.

use super::{Kind, Role, Scope, Setting, Width};

mod autopilot;
mod blackbox;
mod control_loop;
mod gps;
mod hardware;
mod holds;
mod motors;
mod pid_profile;
mod power;
mod profiles;
mod receiver;
mod sensors;
mod system;
mod words;

use words::{ACC_HARDWARE, BAUD, DEBUG_MODE, OFF_ON};

/// The serial ports that a port setting can name. The position is the value.
pub const PORT_NAMES: [&str; 9] =
    ["NONE", "UART1", "UART2", "UART3", "UART4", "UART5", "UART6", "UART7", "UART8"];

/// Settings that are documented together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    pub title: &'static str,
    /// The scope of its settings.
    pub scope: Scope,
    /// The settings in order.
    pub settings: &'static [Setting],
}

impl Group {
    const fn new(title: &'static str, scope: Scope, settings: &'static [Setting]) -> Self {
        Self { title, scope, settings }
    }
}

/// All groups in table order.
pub(super) const GROUPS: [&Group; 33] = [
    &sensors::GYRO,
    &sensors::ACCELEROMETER,
    &sensors::MAGNETOMETER,
    &sensors::BAROMETER,
    &receiver::RECEIVER,
    &blackbox::BLACKBOX,
    &motors::MOTORS,
    &motors::THROTTLE_CORRECTION,
    &receiver::FAILSAFE,
    &sensors::BOARD,
    &power::POWER,
    &profiles::BATTERY_PROFILE,
    &motors::MIXER,
    &motors::REVERSIBLE_MOTORS,
    &profiles::RATE_PROFILE,
    &system::SYSTEM,
    &sensors::ATTITUDE,
    &system::ARMING,
    &gps::GPS,
    &gps::GPS_RESCUE,
    &receiver::STICKS,
    &holds::HOLD,
    &control_loop::CONTROL_LOOP,
    &pid_profile::PID_PROFILE,
    &control_loop::SIMPLIFIED_FILTER,
    &system::MAINTENANCE,
    &hardware::HARDWARE,
    &hardware::SERIAL_PORTS,
    &system::STATISTICS,
    &system::IDENTITY,
    &holds::ALTITUDE,
    &autopilot::AUTOPILOT,
    &system::USER_BOXES,
];

const COUNT: usize = {
    let mut count = 0;
    let mut at = 0;
    while at < GROUPS.len() {
        count += GROUPS[at].settings.len();
        at += 1;
    }
    count
};

/// Every setting, in the order of `set` and `dump`.
pub static SETTINGS: [Setting; COUNT] = flatten();

/// The positions in [`SETTINGS`], sorted by name.
static BY_NAME: [u16; COUNT] = sort_by_name();

/// The old names of settings that were only renamed.
const MOVED: [(&str, &str); 5] = [
    ("name", "craft_name"),
    ("position_alt_source", "altitude_source"),
    ("level_limit", "angle_limit"),
    ("angle_level_strength", "angle_p_gain"),
    ("dshot_idle_value", "motor_idle"),
];

/// Returns the setting of this name, or of this old name, in any case.
pub fn find(name: &str) -> Option<&'static Setting> {
    let moved = MOVED.iter().find(|(old, _)| old.eq_ignore_ascii_case(name)).map(|(_, new)| *new);
    let name = moved.unwrap_or(name);
    let folded = |name: &'static str| name.bytes().map(|byte| byte.to_ascii_lowercase());
    let wanted = || name.bytes().map(|byte| byte.to_ascii_lowercase());
    let at = BY_NAME.binary_search_by(|&at| folded(SETTINGS[at as usize].name).cmp(wanted())).ok()?;
    SETTINGS.get(usize::from(*BY_NAME.get(at)?))
}

/// Returns the heading under which a setting is documented.
pub fn group_of(setting: &Setting) -> &'static str {
    let holds = |group: &&&Group| group.settings.iter().any(|row| row.name == setting.name);
    GROUPS.iter().find(holds).map_or("", |group| group.title)
}

/// Returns all settings in the order of `dump`, each with the heading under which it is documented.
pub fn grouped() -> impl Iterator<Item = (&'static str, &'static Setting)> {
    let headings =
        GROUPS.into_iter().flat_map(|group| std::iter::repeat_n(group.title, group.settings.len()));
    std::iter::zip(headings, &SETTINGS)
}

/// Returns `true` if a change takes effect only after a restart of the firmware. All other settings are live from the
/// next step.
pub fn needs_restart(name: &str) -> bool {
    const NAMES: [&str; 5] =
        ["gps_provider", "pid_process_denom", "motor_pwm_protocol", "mag_hardware", "max_aux_channels"];
    NAMES.contains(&name) || name.starts_with("msp_uart_")
}

/// Returns the number of settings in one instance of a scope.
pub(super) const fn slots(scope: Scope) -> usize {
    let mut count = 0;
    let mut at = 0;
    while at < GROUPS.len() {
        if GROUPS[at].scope as u8 == scope as u8 {
            count += GROUPS[at].settings.len();
        }
        at += 1;
    }
    count
}

const fn flatten() -> [Setting; COUNT] {
    let mut all = [GROUPS[0].settings[0]; COUNT];
    let mut used = [0; 4];
    let mut at = 0;
    let mut group = 0;
    while group < GROUPS.len() {
        let mut row = 0;
        while row < GROUPS[group].settings.len() {
            let scope = GROUPS[group].scope;
            all[at] = GROUPS[group].settings[row];
            all[at].scope = scope;
            all[at].slot = used[scope as usize];
            used[scope as usize] += 1;
            at += 1;
            row += 1;
        }
        group += 1;
    }
    all
}

/// Sorts by a bottom-up merge sort, because the sorts of the standard library do not run at compile time.
const fn sort_by_name() -> [u16; COUNT] {
    let mut order = [0; COUNT];
    let mut at = 0;
    while at < COUNT {
        order[at] = at as u16;
        at += 1;
    }
    let mut run = 1;
    while run < COUNT {
        let mut merged = order;
        let mut start = 0;
        while start < COUNT {
            let middle = if start + run < COUNT { start + run } else { COUNT };
            let end = if middle + run < COUNT { middle + run } else { COUNT };
            let (mut left, mut right, mut out) = (start, middle, start);
            while out < end {
                let take_left = right >= end
                    || (left < middle
                        && !sorts_before(
                            SETTINGS[order[right] as usize].name,
                            SETTINGS[order[left] as usize].name,
                        ));
                if take_left {
                    merged[out] = order[left];
                    left += 1;
                } else {
                    merged[out] = order[right];
                    right += 1;
                }
                out += 1;
            }
            start = end;
        }
        order = merged;
        run *= 2;
    }
    order
}

const fn sorts_before(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() {
        let (x, y) = (a[at].to_ascii_lowercase(), b[at].to_ascii_lowercase());
        if x != y {
            return x < y;
        }
        at += 1;
    }
    a.len() < b.len()
}

const fn row(name: &'static str, width: Width, kind: Kind, role: Role, help: &'static str) -> Setting {
    Setting { name, scope: Scope::Master, width, kind, role, hardware: false, help, slot: 0 }
}

const fn number(
    name: &'static str,
    width: Width,
    min: i64,
    max: i64,
    default: i64,
    role: Role,
    help: &'static str,
) -> Setting {
    row(name, width, Kind::Number { min, max, default }, role, help)
}

const fn choice(
    name: &'static str,
    width: Width,
    words: &'static [&'static str],
    default: i64,
    role: Role,
    help: &'static str,
) -> Setting {
    row(name, width, Kind::Choice { words, default }, role, help)
}

const fn switch(name: &'static str, width: Width, default: bool, role: Role, help: &'static str) -> Setting {
    row(name, width, Kind::Choice { words: OFF_ON, default: default as i64 }, role, help)
}

const fn array(
    name: &'static str,
    width: Width,
    default: &'static [i64],
    role: Role,
    help: &'static str,
) -> Setting {
    row(name, width, Kind::Array { default }, role, help)
}

const fn text(name: &'static str, max: usize, role: Role, help: &'static str) -> Setting {
    row(name, Width::U8, Kind::Text { max }, role, help)
}

const fn port(name: &'static str, default: i64, role: Role, help: &'static str) -> Setting {
    row(name, Width::I8, Kind::Port { default }, role, help)
}

impl Setting {
    /// Marks a row that the `hardware` scope of dump and diff prints.
    const fn hardware(mut self) -> Self {
        self.hardware = true;
        self
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Settings, Value};
    use super::*;

    #[test]
    fn every_name_is_found_in_any_case_and_is_no_other_builds_name() {
        assert_eq!(COUNT, 421);
        for setting in &SETTINGS {
            let found = find(&setting.name.to_ascii_uppercase()).map(|found| found.name);
            assert_eq!(found, Some(setting.name));
            assert_eq!(super::super::foreign_name(setting.name), None);
        }
        assert_eq!(find("ap_max_angl").map(|setting| setting.name), None);
        assert_eq!(find("").map(|setting| setting.name), None);
    }

    #[test]
    fn every_setting_stands_under_its_heading() {
        let rows: Vec<_> = grouped().collect();
        assert_eq!(rows.len(), COUNT);
        for (heading, setting) in rows {
            assert_eq!(heading, group_of(setting), "{}", setting.name);
        }
    }

    #[test]
    fn defaults_are_allowed_values() {
        let mut settings = Settings::default();
        for setting in &SETTINGS {
            let default = setting.display(&setting.default_value());
            assert_eq!(settings.assign(setting, &default), Ok(()), "{}", setting.name);
            if let Kind::Number { min, max, .. } = setting.kind {
                let (low, high) = setting.width.bounds();
                assert!(low <= min && max <= high, "{}", setting.name);
            }
        }
        assert_eq!(settings, Settings::default());
    }

    #[test]
    fn old_names_lead_to_the_new_ones() {
        for (old, new) in MOVED {
            assert_eq!(find(old).map(|setting| setting.name), Some(new));
        }
    }

    #[test]
    fn disputed_ranges_and_defaults_are_the_decided_ones() {
        let number = |name: &str| find(name).map(|setting| (setting.kind, setting.default_value()));
        let kind = |min, max, default| Some((Kind::Number { min, max, default }, Value::Number(default)));
        assert_eq!(number("ap_position_cutoff"), kind(1, 250, 30));
        assert_eq!(number("ap_altitude_p"), kind(0, 200, 15));
        assert_eq!(number("ap_altitude_i"), kind(0, 200, 20));
        assert_eq!(number("ap_velocity_drag_coeff"), kind(0, 1000, 50));
        assert_eq!(number("ap_max_velocity"), kind(100, 5000, 500));
        assert_eq!(number("ap_l1_turn_rate"), kind(0, 90, 0));
        assert_eq!(number("ap_velocity_p"), kind(0, 200, 50));
    }
}
