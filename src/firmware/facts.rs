//! The figures that the command line prints.

use super::Firmware;
use super::cli::{
    BatteryFacts, CliFacts, GpsFacts, GpsSolutionFacts, LoopFacts, NavFacts, SmoothingFacts, TaskFacts,
};

/// Housekeeping rate, Hz.
const SYSTEM_HZ: u32 = 10;
/// Rate of receiver passes without frames, Hz.
const RX_IDLE_HZ: u32 = 20;

impl Firmware {
    /// The figures that the command line prints.
    #[must_use]
    pub fn cli_facts(&self) -> CliFacts {
        let signal = self.rx.signal();
        let rx_hz = if signal { self.rx.sources().rate_hz().round() as u32 } else { 0 };
        let battery = self.battery.sample();
        let [setpoint_hz, throttle_hz] = self.flight.smoothing_hz().map(|hz| hz.round() as u32);
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
            smoothing: SmoothingFacts { rx_hz: signal.then_some(rx_hz), setpoint_hz, throttle_hz },
            nav: NavFacts {
                telemetry: self.navigator.telemetry().clone(),
                active_plan: self.active_plan().cloned(),
            },
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
        let attitude_hz = (1_000_000 / self.parameters.estimator.attitude_us.max(1)) as u32;
        let pid = rate / u32::from(self.boot.pid_denominator.max(1));
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
}
