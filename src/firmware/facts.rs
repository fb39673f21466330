//! The figures that the command line prints.

use super::Firmware;
use super::cli::{
    BatteryFacts, CliFacts, GpsFacts, GpsSolutionFacts, LoopFacts, NavFacts, SmoothingFacts, TaskFacts,
};
use super::mode::Mode;

/// Housekeeping rate, Hz.
const SYSTEM_HZ: u32 = 10;
/// Rate of receiver passes without frames, Hz.
const RX_IDLE_HZ: u32 = 20;

/// Lowest automatic cutoff of the RC smoothing, Hz.
const SMOOTHING_MIN_HZ: f64 = 15.0;

impl Firmware {
    /// The figures that the command line prints.
    #[must_use]
    pub fn cli_facts(&self) -> CliFacts {
        let signal = self.rx.signal();
        let rx_hz = if signal { self.rx.sources().rate_hz().round() as u32 } else { 0 };
        let battery = self.battery.sample();
        CliFacts {
            build: self.build.clone(),
            armed: self.arming.armed(),
            arming_blocks: match self.arming.armed() {
                true => Vec::new(),
                false => self.arming.flags().iter().map(Into::into).collect(),
            },
            uptime_s: self.uptime().0 / 1_000_000,
            storage: self.storage.clone(),
            gps: self.gps_facts(),
            battery: BatteryFacts {
                voltage_v: battery.map_or(0.0, |sample| sample.voltage_v),
                cells: self.battery.cells(),
                state: self.battery.state().into(),
            },
            loops: LoopFacts {
                cpu_load_percent: 0,
                cycle_time_us: 1_000_000 / self.options.rate_hz.max(1),
                gyro_hz: self.options.rate_hz,
                rx_hz,
                system_hz: SYSTEM_HZ,
            },
            tasks: self.tasks(rx_hz),
            smoothing: SmoothingFacts {
                rx_hz: signal.then_some(rx_hz),
                setpoint_hz: self.smoothing_hz("rc_smoothing_setpoint_cutoff", "rc_smoothing_auto_factor"),
                throttle_hz: self
                    .smoothing_hz("rc_smoothing_throttle_cutoff", "rc_smoothing_auto_factor_throttle"),
            },
            nav: NavFacts {
                telemetry: self.navigator.telemetry().clone(),
                active_plan: self.active_plan().cloned(),
            },
        }
    }

    /// Cutoff of a smoothing filter: as set, or automatic from the frame rate.
    fn smoothing_hz(&self, manual: &str, factor: &str) -> u32 {
        let settings = &self.configuration.settings;
        let automatic = self.rx.sources().rate_hz() * 1.5 / (1.0 + settings.number(factor) as f64 / 10.0);
        match settings.number(manual) {
            0 => automatic.max(SMOOTHING_MIN_HZ).round() as u32,
            hz => hz.clamp(0, 1000) as u32,
        }
    }

    fn gps_facts(&self) -> GpsFacts {
        if !self.parameters.gps {
            return GpsFacts::NotEnabled;
        }
        let gps = self.estimate().gps;
        if gps.messages == 0 {
            return GpsFacts::NotConnected;
        }
        let position = gps.solution.filter(|_| gps.fix).map(|sample| (sample.position, sample.alt_amsl_cm));
        GpsFacts::Connected(Some(GpsSolutionFacts { sats: gps.sats, hdop: gps.hdop, vdop: 0.0, position }))
    }

    /// The tasks with their nominal rates; a deterministic firmware has no run times to show.
    fn tasks(&self, rx_hz: u32) -> Vec<TaskFacts> {
        let rate = self.options.rate_hz;
        let levelling = self.modes.has(Mode::Angle) || self.modes.has(Mode::Horizon);
        let attitude = if levelling { 500.min(rate) } else { 100 };
        [
            (0, "SYSTEM", SYSTEM_HZ),
            (1, "SYSTEM", 1000),
            (2, "GYRO", rate),
            (3, "FILTER", rate),
            (4, "PID", rate),
            (5, "ACC", rate),
            (6, "ATTITUDE", attitude),
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
}
