//! Reports about the vehicle: `version`, `status`, `env`, `tasks` and the small identity commands.

use super::super::settings::find;
use super::observation::{GpsFacts, TaskFacts};
use super::session::Session;

pub(super) const MCU: &str = "SIMULATOR";
/// The clock of the processor, MHz.
const CLOCK_MHZ: u32 = 500;
/// The serial number of the processor, in the three words that the reference simulator announces.
pub(super) const MCU_ID: &str = "000000000000000100000002";
/// The build options as numbers, as announced by MSP.
const BUILD_OPTIONS: [u16; 6] = [16422, 16427, 16412, 16415, 16425, 8235];

/// Returns the line of `version`.
pub(super) fn version_line(session: &Session<'_>) -> String {
    let build = &session.facts.build;
    format!(
        "# Betaflight / SITL (SITL) {} {} / {} ({}) MSP API: {}",
        build.version, build.date, build.time, build.revision, build.api
    )
}

pub(super) fn version(session: &mut Session<'_>, _rest: &str) {
    let line = version_line(session);
    session.line(line);
}

pub(super) fn mcu_id(session: &mut Session<'_>, _rest: &str) {
    session.line(format_args!("mcu_id {MCU_ID}"));
}

pub(super) fn options(session: &mut Session<'_>, _rest: &str) {
    for option in BUILD_OPTIONS {
        session.line(option);
    }
}

/// Returns the name of the magnetometer; `None` if it is switched off.
fn magnetometer(session: &Session<'_>) -> Option<String> {
    let name = session.configuration.settings.text("mag_hardware");
    (name != "NONE").then(|| name.to_owned())
}

pub(super) fn status(session: &mut Session<'_>, _rest: &str) {
    let facts = session.facts;
    session.line(format_args!("MCU: {MCU} CLK={CLOCK_MHZ}MHz"));
    session.line("STACK: 0b (0x00000000)");
    let storage = &facts.storage;
    session.raw(format_args!("CONFIG: CONFIGURED ({}b / {}b)", storage.used_bytes, storage.capacity_bytes));
    if let Some(note) = &storage.note {
        session.raw(format_args!(", {note}"));
    }
    session.line("\r\n\r\nDEVICES DETECTED:");
    session.line("GYRO: (1) VIRTUAL enabled");
    session.line("ACC: VIRTUAL");
    session.line("BARO: VIRTUAL");
    if let Some(name) = magnetometer(session) {
        session.line(format_args!("MAG: {name}"));
    }
    gps(session);
    session.line(format_args!("\r\nSystem Uptime: {} seconds", facts.uptime_s));
    let loops = &facts.loops;
    session.line(format_args!(
        "CPU:{}%, cycle time: {}, GYRO rate: {}, RX rate: {}, System rate: {}",
        loops.cpu_load_percent, loops.cycle_time_us, loops.gyro_hz, loops.rx_hz, loops.system_hz
    ));
    let battery = &facts.battery;
    session.line(format_args!(
        "Voltage: {:.2}V ({}S battery - {})",
        battery.voltage_v, battery.cells, battery.state
    ));
    session.reply.host_lines_at = Some(session.reply.text.len());
    if facts.rewound {
        session.line("Changes refused: an earlier instant is shown on the screen");
    }
    if let Some(refusal) = facts.nav.refusal {
        session.line(format_args!("Autopilot: {}", refusal.sentence()));
    }
    session.raw("Arming disable flags:");
    for flag in facts.arming_blocks.iter() {
        session.raw(format_args!(" {flag}"));
    }
    session.line("");
}

fn gps(session: &mut Session<'_>) {
    let provider = session.configuration.settings.text("gps_provider").to_owned();
    let solution = match session.facts.gps {
        GpsFacts::NotEnabled => {
            session.line("GPS: NOT ENABLED");
            return;
        }
        GpsFacts::NotConnected => {
            session.line(format_args!("GPS: NOT CONNECTED, {provider}"));
            return;
        }
        GpsFacts::Connected(solution) => solution,
    };
    session.line(format_args!("GPS: connected, {provider}"));
    let Some(solution) = solution else { return };
    session.raw(format_args!("  sats: {}", solution.sats));
    for (name, dilution) in [("hdop", solution.hdop), ("vdop", solution.vdop)] {
        if dilution > 0.0 {
            session.raw(format_args!(", {name}: {dilution:.2}"));
        }
    }
    match solution.position {
        Some((position, alt_cm)) => session.line(format_args!(
            ", pos: {} {}, alt: {:.2}m",
            crate::geo::Degrees7(position.lat_e7),
            crate::geo::Degrees7(position.lon_e7),
            f64::from(alt_cm) / 100.0
        )),
        None => session.line(", pos: no fix"),
    }
}

/// `env [prefix]`: prints the same facts as `NAME=VALUE` lines.
pub(super) fn env(session: &mut Session<'_>, prefix: &str) {
    let facts = session.facts;
    let on = |on: bool| if on { "ON" } else { "OFF" }.to_owned();
    let connected = matches!(facts.gps, GpsFacts::Connected(_));
    let text = str::to_owned;
    let mut rows = vec![
        ("FIRMWARE_NAME", text("Betaflight")),
        ("FIRMWARE_VERSION", facts.build.version.clone()),
        ("TARGET", text("SITL")),
        ("BOARD_IDENTIFIER", text("SITL")),
        ("BUILD_DATE", facts.build.date.clone()),
        ("BUILD_TIME", facts.build.time.clone()),
        ("GIT_REVISION", facts.build.revision.clone()),
        ("MSP_API_VERSION", facts.build.api.clone()),
        ("MCU", text(MCU)),
        ("CLK_MHZ", CLOCK_MHZ.to_string()),
        ("STACK_SIZE", text("0")),
        ("STACK_HIGH", text("0x00000000")),
        ("CONFIG_STATE", text("CONFIGURED")),
        ("CONFIG_SIZE", facts.storage.used_bytes.to_string()),
        ("CONFIG_MAX_SIZE", facts.storage.capacity_bytes.to_string()),
        ("GYRO_1_HW", text("VIRTUAL")),
        ("GYRO_COUNT", text("1")),
        ("ACC_HW", text("VIRTUAL")),
        ("BARO_HW", text("VIRTUAL")),
    ];
    rows.extend(magnetometer(session).map(|name| ("MAG_HW", name)));
    rows.extend([
        ("GPS_ENABLED", on(facts.gps != GpsFacts::NotEnabled)),
        ("GPS_CONNECTED", on(connected)),
        ("GPS_CONFIGURED", on(connected)),
        ("GPS_VERSION", text("unknown")),
        ("UPTIME_S", facts.uptime_s.to_string()),
        ("CPU_LOAD_PCT", facts.loops.cpu_load_percent.to_string()),
        ("CYCLE_TIME_US", facts.loops.cycle_time_us.to_string()),
        ("GYRO_RATE_HZ", facts.loops.gyro_hz.to_string()),
        ("RX_RATE_HZ", facts.loops.rx_hz.to_string()),
        ("SYSTEM_RATE_HZ", facts.loops.system_hz.to_string()),
        ("VOLTAGE_V", format!("{:.2}", facts.battery.voltage_v)),
        ("BATTERY_CELLS", facts.battery.cells.to_string()),
        ("BATTERY_STATE", facts.battery.state.to_owned()),
        ("ARMING_DISABLE_FLAGS", facts.arming_blocks.to_string()),
    ]);
    let prefix = prefix.to_ascii_uppercase();
    for (name, value) in rows.iter().filter(|(name, _)| name.starts_with(&prefix)) {
        session.line(format_args!("{name}={value}"));
    }
}

/// Formats tenths of a percent as `d.d%`.
fn percent(tenths: u64, width: usize) -> String {
    format!("{:>width$}.{}%", tenths / 10, tenths % 10)
}

fn load_tenths(task: &TaskFacts, run_us: u32) -> u64 {
    u64::from(run_us) * u64::from(task.rate_hz) / 1000
}

pub(super) fn tasks(session: &mut Session<'_>, _rest: &str) {
    let tasks = &session.facts.tasks;
    if !session.configuration.settings.flag("task_statistics") {
        session.line("Task list             rate/hz");
        for task in tasks {
            session.line(format_args!("{:02} - ({:>15}) {:>6}", task.id, task.name, task.rate_hz));
        }
        return;
    }
    session.line("Task list             rate/hz  max/us  avg/us maxload avgload  total/ms");
    for task in tasks {
        session.line(format_args!(
            "{:02} - ({:>15}) {:>6} {:>7} {:>7} {} {} {:>9}",
            task.id,
            task.name,
            task.rate_hz,
            task.max_us,
            task.avg_us,
            percent(load_tenths(task, task.max_us), 4),
            percent(load_tenths(task, task.avg_us), 4),
            task.total_ms
        ));
    }
    // A simulated scheduler checks nothing, so this row has no figures of its own.
    session.line(format_args!("Check Functions (RX, ...) {:>11} {:>7} {} {:>9}", 0, 0, percent(0, 12), 0));
    let total = tasks.iter().map(|task| load_tenths(task, task.avg_us)).sum();
    session.line(format_args!("Total {}", percent(total, 52)));
}

pub(super) fn rc_smoothing_info(session: &mut Session<'_>, _rest: &str) {
    let smoothing = session.facts.smoothing;
    match smoothing.rx_hz {
        Some(rate) => session.line(format_args!("# Detected Rx frequency: {rate}Hz")),
        None => session.line("# Detected Rx frequency: NO SIGNAL"),
    }
    let switch = session.configuration.settings.text("rc_smoothing").to_owned();
    session.line(format_args!("# RC Smoothing: {switch}"));
    if switch == "ON" {
        for (what, hz, setting) in [
            ("setpoint and FF", smoothing.setpoint_hz, "rc_smoothing_setpoint_cutoff"),
            ("throttle", smoothing.throttle_hz, "rc_smoothing_throttle_cutoff"),
        ] {
            let by = if session.configuration.settings.number(setting) == 0 { "auto" } else { "manual" };
            session.line(format_args!("# Active {what} cutoff: {hz}Hz ({by})"));
        }
    }
}

/// Sensor kinds without a setting of their own. The position of a name is its number in MSP messages.
const GYROS: &str = "NONE,AUTO,MPU6050,L3GD20,MPU6000,MPU6500,MPU9250,ICM20601,ICM20602,ICM20608G,ICM20649,ICM20689,\
ICM42605,ICM42688P,BMI160,BMI270,LSM6DSO,LSM6DSV16X,IIM42653,ICM45605,ICM45686,ICM40609D,IIM42652,LSM6DSK320X,ICM42622P,\
ICM42686P,ICM56686,VIRTUAL";
const RANGEFINDERS: &str = "NONE,HCSR04,TFMINI,TF02,MTF01,MTF02,MTF01P,MTF02P,TFNOVA,NOOPLOOP_F2,NOOPLOOP_F2P,\
NOOPLOOP_F2PH,NOOPLOOP_F,NOOPLOOP_FP,NOOPLOOP_F2MINI,UPT1";

/// `sensor_hardware [kind]`.
pub(super) fn sensor_hardware(session: &mut Session<'_>, wanted: &str) {
    let words = |name: &str| match find(name).map(|setting| setting.kind) {
        Some(super::super::settings::Kind::Choice { words, .. }) => words.join(","),
        _ => String::new(),
    };
    let kinds = [
        ("gyro", GYROS.to_owned()),
        ("acc", words("acc_hardware")),
        ("baro", words("baro_hardware")),
        ("mag", words("mag_hardware")),
        ("rangefinder", RANGEFINDERS.to_owned()),
        ("opticalflow", "NONE,MT,UPT1".to_owned()),
        ("pitot", "AUTO,NONE,MS4525".to_owned()),
    ];
    let mut found = false;
    for (kind, names) in kinds {
        if wanted.is_empty() || wanted.eq_ignore_ascii_case(kind) {
            session.line(format_args!("{kind}: {names}"));
            found = true;
        }
    }
    if !found {
        session.not_understood();
    }
}
