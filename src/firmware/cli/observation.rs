//! Facts about the running firmware that commands print, as plain data.

use crate::firmware::Firmware;
use crate::geo::LatLon;
use crate::plan::FlightPlan;
use crate::telemetry::{ArmingFlags, NavTelemetry, Refusal};

/// The housekeeping rate, Hz.
const SYSTEM_HZ: u32 = 10;
/// The rate of receiver passes without frames, Hz.
const RX_IDLE_HZ: u32 = 20;

/// The facts about the running firmware for `status`, `env`, `tasks`, `version` and `waypoint status`.
#[derive(Debug, Clone, PartialEq, Default)]
#[doc(hidden)]
pub struct CliFacts {
    pub build: BuildInfo,
    /// `true` while the craft is armed. Many commands are refused then.
    pub armed: bool,
    pub arming_blocks: ArmingFlags,
    pub uptime_s: u64,
    pub storage: StorageFacts,
    pub gps: GpsFacts,
    pub battery: BatteryFacts,
    /// `true` while an earlier instant is shown. Clients cannot change anything then.
    pub rewound: bool,
    pub loops: LoopFacts,
    /// One row per task, in order of their numbers.
    pub tasks: Vec<TaskFacts>,
    pub smoothing: SmoothingFacts,
    pub nav: NavFacts,
    /// The altitude of the flying site above mean sea level, m.
    pub site_alt_m: f64,
}

impl CliFacts {
    /// Returns the facts at the present instant.
    pub(in crate::firmware) fn observe(firmware: &Firmware) -> Self {
        let signal = firmware.receiver().signal();
        let rx_hz = if signal { firmware.receiver().sources().rate_hz().round() as u32 } else { 0 };
        let battery = firmware.battery().sample();
        let [setpoint_hz, throttle_hz] =
            firmware.control.controller.smoothing_hz().map(|hz| hz.round() as u32);
        Self {
            build: firmware.setup.build.clone(),
            armed: firmware.is_armed(),
            arming_blocks: firmware.arming_blocks(),
            uptime_s: firmware.uptime().0 / 1_000_000,
            storage: firmware.setup.storage.clone(),
            gps: GpsFacts::observe(firmware),
            battery: BatteryFacts {
                voltage_v: battery.map_or(0.0, |sample| sample.voltage_v),
                cells: firmware.battery().cells(),
                state: firmware.battery().state().into(),
            },
            rewound: firmware.setup.rewound,
            loops: LoopFacts {
                cpu_load_percent: 0,
                cycle_time_us: 1_000_000 / firmware.setup.options.rate_hz.max(1),
                gyro_hz: firmware.setup.options.rate_hz,
                rx_hz,
                system_hz: SYSTEM_HZ,
            },
            tasks: tasks(firmware, rx_hz),
            smoothing: SmoothingFacts { rx_hz: signal.then_some(rx_hz), setpoint_hz, throttle_hz },
            nav: NavFacts {
                telemetry: firmware.nav().clone(),
                active_plan: firmware.active_plan().cloned(),
                refusal: firmware.navigation.last_refusal,
            },
            site_alt_m: firmware.setup.options.site_alt_m,
        }
    }
}

impl GpsFacts {
    fn observe(firmware: &Firmware) -> Self {
        if !firmware.parameters().gps {
            return GpsFacts::NotEnabled;
        }
        let gps = firmware.estimate().gps;
        if gps.messages == 0 {
            return GpsFacts::NotConnected;
        }
        let position = gps.solution.filter(|_| gps.fix).map(|sample| (sample.position, sample.alt_amsl_cm));
        GpsFacts::Connected(Some(GpsSolutionFacts { sats: gps.sats, hdop: gps.hdop, vdop: 0.0, position }))
    }
}

/// Returns the tasks with their nominal rates. A deterministic firmware has no run times to show.
fn tasks(firmware: &Firmware, rx_hz: u32) -> Vec<TaskFacts> {
    let rate = firmware.setup.options.rate_hz;
    let attitude_hz = (1_000_000 / firmware.parameters().estimator.attitude_us.max(1)) as u32;
    let pid = rate / u32::from(firmware.setup.boot.pid_denominator.max(1));
    [
        (0, "SYSTEM", SYSTEM_HZ),
        (1, "SYSTEM", 1000),
        (2, "GYRO", rate),
        (3, "FILTER", pid),
        (4, "PID", pid),
        (5, "ACC", rate),
        (6, "ATTITUDE", attitude_hz.min(rate)),
        (7, "RX", rx_hz.max(RX_IDLE_HZ)),
        (8, "SERIAL", 100),
        (9, "DISPATCH", 1000),
        (11, "BATTERY_CURRENT", 50),
        (12, "BATTERY_ALERTS", 5),
        (13, "GPS", 100),
        (14, "GPS_RESCUE", 100),
        (15, "ALTHOLD", 100),
        (16, "POSHOLD", 100),
        (17, "COMPASS", 40),
        (18, "BARO", 50),
        (19, "ALTITUDE", 100),
    ]
    .into_iter()
    .map(|(id, name, rate_hz)| TaskFacts { id, name, rate_hz, ..TaskFacts::default() })
    .collect()
}

/// The version and the build, as announced by `version`, `env` and MSP.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BuildInfo {
    /// The version of the program, such as `1.2.3`.
    pub version: String,
    /// The version of the MSP interface, such as `1.48`.
    pub api: String,
    /// The build date, `Mmm dd yyyy`.
    pub date: String,
    /// The build time, `hh:mm:ss`.
    pub time: String,
    /// The revision of the source.
    pub revision: String,
}

impl Default for BuildInfo {
    fn default() -> Self {
        Self {
            version: "2026.12.0-alpha".to_owned(),
            api: "1.49".to_owned(),
            date: "Jan 01 2026".to_owned(),
            time: "00:00:00".to_owned(),
            revision: "norevision".to_owned(),
        }
    }
}

/// The stored configuration as `status` shows it.
#[derive(Debug, Clone, PartialEq, Eq)]
#[doc(hidden)]
pub struct StorageFacts {
    /// The size of the stored image, bytes.
    pub used_bytes: usize,
    /// The space that a real vehicle has for it, bytes.
    pub capacity_bytes: usize,
    /// The problem found at boot, for the `CONFIG:` line.
    pub note: Option<String>,
    /// The reason why `save` cannot work: the file belongs to another firmware, or another process holds it.
    pub save_refusal: Option<String>,
}

impl Default for StorageFacts {
    fn default() -> Self {
        Self { used_bytes: 0, capacity_bytes: 32_768, note: None, save_refusal: None }
    }
}

/// The GPS as `status` shows it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[doc(hidden)]
pub enum GpsFacts {
    /// The feature is off.
    NotEnabled,
    /// No message was received yet.
    #[default]
    NotConnected,
    /// Messages arrive. The solution is present once they are healthy.
    Connected(Option<GpsSolutionFacts>),
}

#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[doc(hidden)]
pub struct GpsSolutionFacts {
    pub sats: u8,
    /// Horizontal dilution of precision; 0 = not reported.
    pub hdop: f64,
    /// Vertical dilution of precision; 0 = not reported.
    pub vdop: f64,
    /// Position and altitude above mean sea level, cm; `None` without a fix.
    pub position: Option<(LatLon, i32)>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[doc(hidden)]
pub struct BatteryFacts {
    /// Voltage, V.
    pub voltage_v: f64,
    pub cells: u8,
    /// `OK`, `WARNING`, `CRITICAL`, `NOT PRESENT` or `INIT`.
    pub state: &'static str,
}

impl Default for BatteryFacts {
    fn default() -> Self {
        Self { voltage_v: 0.0, cells: 0, state: "INIT" }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub struct LoopFacts {
    /// The processor load, percent.
    pub cpu_load_percent: u32,
    /// The period of the control loop, µs.
    pub cycle_time_us: u32,
    /// The rate of the gyro loop, Hz.
    pub gyro_hz: u32,
    /// The rate of RC frames, Hz.
    pub rx_hz: u32,
    /// The rate of housekeeping, Hz.
    pub system_hz: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub struct TaskFacts {
    pub id: u8,
    pub name: &'static str,
    /// The rate of the task, Hz.
    pub rate_hz: u32,
    /// The longest run, µs.
    pub max_us: u32,
    /// The average run, µs.
    pub avg_us: u32,
    /// The time spent since boot, ms.
    pub total_ms: u32,
}

/// The RC smoothing filters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[doc(hidden)]
pub struct SmoothingFacts {
    /// The measured frame rate, Hz; `None` without a signal.
    pub rx_hz: Option<u32>,
    /// The cutoff of setpoint and feed-forward, Hz.
    pub setpoint_hz: u32,
    /// The cutoff of the throttle, Hz.
    pub throttle_hz: u32,
}

#[derive(Debug, Clone, PartialEq, Default)]
#[doc(hidden)]
pub struct NavFacts {
    pub telemetry: NavTelemetry,
    /// The plan being flown, if any.
    pub active_plan: Option<FlightPlan>,
    /// The reason why the autopilot did not engage. It remains until the autopilot engages or the craft is armed again.
    pub refusal: Option<Refusal>,
}
