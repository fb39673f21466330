//! The running firmware behind the messages.

use super::{
    Access, BatteryReading, BatteryState, GpsReading, HomeReading, MspAction, MspFacts, Outcome, UtcTime,
};
use crate::firmware::config::{Feature, correct};
use crate::firmware::{Firmware, battery};
use crate::geo::distance_bearing;
use crate::signals::{RC_CHANNELS, RcSource};
use nalgebra::Vector3;

/// Full signal strength.
const RSSI_MAX: u16 = 1023;

impl Firmware {
    /// Answers a message and carries out what it asks of the firmware itself. Storing, restarting and the time of day
    /// are left to the owner: the outcome says so. `clock` is the time of day, when somebody set it.
    pub fn run_msp(&mut self, code: u16, request: &[u8], clock: Option<UtcTime>) -> Outcome {
        let facts = self.msp_facts(clock);
        let had_gps = self.configuration.features.has(Feature::Gps);
        let outcome = super::handle(code, request, &mut self.configuration, &facts);
        let writes = super::table::find(code).is_some_and(|message| message.access == Access::Write);
        if writes && outcome.reply.is_some() && changes_configuration(outcome.action) {
            self.refresh();
        }
        match outcome.action {
            Some(MspAction::Save) => {
                correct(&mut self.configuration);
                self.tell_lost_gps(had_gps);
            }
            Some(MspAction::RawRc(frame)) => self.receive_rc(&frame, RcSource::Msp),
            Some(MspAction::MotorTest(motors)) => {
                for (motor, output_us) in (0..).zip(motors) {
                    self.flight.test_motor(Some(motor), output_us);
                }
            }
            Some(MspAction::CalibrateAcc) => self.calibrate_accelerometer(),
            Some(MspAction::CalibrateMag) => self.calibrate_magnetometer(),
            Some(MspAction::RunawayPrevention(on)) => self.parameters.runaway.enabled &= on,
            Some(MspAction::HoldHeading(deg)) => self.flight.hold_heading(f64::from(deg).to_radians()),
            // Nothing here to feed: positions come from the simulator.
            Some(MspAction::RawGps { .. }) => {}
            Some(MspAction::Reboot | MspAction::SaveAndReboot | MspAction::SetClock { .. }) | None => {}
        }
        outcome
    }

    /// The figures that messages tell.
    #[must_use]
    pub fn msp_facts(&self, clock: Option<UtcTime>) -> MspFacts {
        let estimate = self.estimate();
        let rates = estimate.rates;
        MspFacts {
            build: self.build.clone(),
            armed: self.is_armed(),
            modes: self.modes,
            switches: self.boxes,
            arming_blocks: if self.is_armed() { 0 } else { self.arming_flags().bits() },
            reboot_required: self.parameters.arming.reboot_required,
            cycle_time_us: 1_000_000 / self.options.rate_hz.max(1),
            cpu_load_percent: 0,
            gyro_hz: self.options.rate_hz,
            has_mag: self.configuration.settings.text("mag_hardware") != "NONE",
            specific_force_flu: estimate.force_flu,
            rate_flu: Vector3::new(rates.roll, rates.pitch, -rates.yaw),
            mag_flu: self.mag_flu - self.parameters.estimator.mag_offset_flu,
            attitude: estimate.attitude,
            roll_deg: estimate.roll_rad.to_degrees(),
            pitch_deg: -estimate.pitch_rad.to_degrees(),
            heading_deg: estimate.heading_rad.to_degrees(),
            altitude_m: estimate.shown_alt_m,
            climb_mps: estimate.shown_climb_mps,
            battery: self.battery_reading(),
            rssi: self.rssi(),
            channels: *self.rx.channels(),
            motors_us: self.flight.state().motors_us.map(|pulse| pulse.round().clamp(0.0, 2500.0) as u16),
            gps: self.gps_reading(),
            home: self.home_reading(),
            clock,
        }
    }

    fn battery_reading(&self) -> Option<BatteryReading> {
        let sample = self.battery.sample()?;
        Some(BatteryReading {
            voltage_v: sample.voltage_v,
            current_a: sample.current_a,
            drawn_mah: sample.drawn_mah,
            cells: self.battery.cells(),
            state: match self.battery.state() {
                battery::BatteryState::Init => BatteryState::Starting,
                battery::BatteryState::NotPresent => BatteryState::NotPresent,
                battery::BatteryState::Ok => BatteryState::Ok,
                battery::BatteryState::Warning => BatteryState::Warning,
                battery::BatteryState::Critical => BatteryState::Critical,
            },
        })
    }

    /// A channel's position when one is set aside for it, else whether there is a signal.
    fn rssi(&self) -> u16 {
        let channel = usize::try_from(self.configuration.settings.number("rssi_channel")).unwrap_or(0);
        match channel.checked_sub(1).filter(|&channel| channel < RC_CHANNELS) {
            Some(channel) => {
                let above = self.rx.channels()[channel].clamp(1000, 2000) - 1000;
                (u32::from(above) * u32::from(RSSI_MAX) / 1000) as u16
            }
            None if self.rx.signal() => RSSI_MAX,
            None => 0,
        }
    }

    fn gps_reading(&self) -> GpsReading {
        let gps = &self.estimate().gps;
        let solution = gps.solution.unwrap_or_default();
        let (east, north) = (solution.vel_enu.x, solution.vel_enu.y);
        GpsReading {
            fix: self.gps_fix(),
            sats: gps.sats,
            position: solution.position,
            alt_amsl_m: f64::from(solution.alt_amsl_cm) / 100.0,
            ground_speed_mps: east.hypot(north),
            course_deg: east.atan2(north).to_degrees(),
            dop: gps.hdop,
            solution: gps.messages as u8,
        }
    }

    fn home_reading(&self) -> Option<HomeReading> {
        let place = self.estimate().gps.solution.filter(|_| self.gps_fix())?.position;
        let (distance_m, bearing_rad) = distance_bearing(place, self.home()?);
        Some(HomeReading { distance_m, bearing_deg: bearing_rad.to_degrees() })
    }
}

/// Whether a message that was carried out may have changed a setting.
fn changes_configuration(action: Option<MspAction>) -> bool {
    !matches!(
        action,
        Some(
            MspAction::RawRc(_)
                | MspAction::MotorTest(_)
                | MspAction::RawGps { .. }
                | MspAction::HoldHeading(_)
        )
    )
}
