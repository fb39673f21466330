//! Facts about the running firmware for messages, as plain data.

use nalgebra::{UnitQuaternion, Vector3};

use crate::firmware::Firmware;
use crate::firmware::blackbox::FlashFacts;
use crate::firmware::cli::BuildInfo;
use crate::firmware::modes::BoxSet;
use crate::geo::distance_bearing;
use crate::math;
use crate::msp::{BatteryReading, HomeVector, RawGps};
use crate::signals::{MOTORS, PerMotor, RC_CHANNELS};
use crate::telemetry::{ArmingFlags, ModeFlags};

/// Figures of the running firmware.
#[derive(Debug, Clone, PartialEq)]
#[doc(hidden)]
pub struct MspFacts {
    pub build: BuildInfo,
    pub armed: bool,
    pub modes: ModeFlags,
    /// The boxes that are switched on.
    pub switches: BoxSet,
    pub arming_blocks: ArmingFlags,
    /// `true` if a change needs a restart.
    pub reboot_required: bool,
    /// The period of the control loop, µs.
    pub cycle_time_us: u32,
    /// The period of the rate loop, µs.
    pub pid_cycle_time_us: u32,
    /// The processor load, percent.
    pub cpu_load_percent: u32,
    /// The rate of the gyro loop, Hz.
    pub gyro_hz: u32,
    /// `true` if a magnetometer is present.
    pub has_mag: bool,
    /// The specific force, FLU, m/s².
    pub specific_force_flu: Vector3<f64>,
    /// The body rates, FLU, rad/s.
    pub rate_flu: Vector3<f64>,
    /// The magnetic field, FLU, sensor counts.
    pub mag_flu: Vector3<f64>,
    /// The attitude, body FLU → world ENU.
    pub attitude: UnitQuaternion<f64>,
    /// The roll angle, degrees, right positive.
    pub roll_deg: f64,
    /// The pitch angle, degrees, nose **up** positive.
    pub pitch_deg: f64,
    /// The heading, degrees clockwise from north.
    pub heading_deg: f64,
    /// The estimated altitude above the arming point, m; before the first arming, the altitude above mean sea level.
    pub altitude_m: f64,
    /// The climb rate, m/s.
    pub climb_mps: f64,
    /// The battery, if its voltage is measured.
    pub battery: Option<BatteryReading>,
    /// The signal strength, 0…1023.
    pub rssi: u16,
    /// The channels in use, µs: roll, pitch, **yaw, throttle**, AUX1 ….
    pub channels: [u16; RC_CHANNELS],
    /// The motor outputs M1…M4, µs.
    pub motors_us: PerMotor<u16>,
    pub gps: RawGps,
    /// The distance and direction of home, seen from the craft; zeros without a home.
    pub home: HomeVector,
    /// The flash memory for logs.
    pub flash: FlashFacts,
    /// The time of day, if it was set.
    pub clock: Option<UtcTime>,
}

impl Default for MspFacts {
    /// Returns a disarmed craft at rest, level, facing north, that has received nothing.
    fn default() -> Self {
        Self {
            build: BuildInfo::default(),
            armed: false,
            modes: ModeFlags::NONE,
            switches: BoxSet::NONE,
            arming_blocks: ArmingFlags::NONE,
            reboot_required: false,
            cycle_time_us: 1000,
            pid_cycle_time_us: 1000,
            cpu_load_percent: 0,
            gyro_hz: 1000,
            has_mag: true,
            specific_force_flu: Vector3::new(0.0, 0.0, crate::geo::GRAVITY),
            rate_flu: Vector3::zeros(),
            mag_flu: Vector3::zeros(),
            attitude: UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::FRAC_PI_2),
            roll_deg: 0.0,
            pitch_deg: 0.0,
            heading_deg: 0.0,
            altitude_m: 0.0,
            climb_mps: 0.0,
            battery: None,
            rssi: 0,
            channels: [1500; RC_CHANNELS],
            motors_us: [1000; MOTORS],
            gps: RawGps::default(),
            home: HomeVector::default(),
            flash: FlashFacts::default(),
            clock: None,
        }
    }
}

impl MspFacts {
    /// Returns the facts at the present instant. `clock` is the time of day, if it was set.
    pub(super) fn observe(firmware: &Firmware, clock: Option<UtcTime>) -> Self {
        let estimate = firmware.estimate();
        let rates = estimate.rates;
        Self {
            build: firmware.setup.build.clone(),
            armed: firmware.is_armed(),
            modes: firmware.modes(),
            switches: firmware.boxes(),
            arming_blocks: firmware.arming_blocks(),
            reboot_required: firmware.parameters().arming.reboot_required,
            cycle_time_us: firmware.setup.step_us(),
            pid_cycle_time_us: firmware.setup.loop_us(),
            cpu_load_percent: 0,
            gyro_hz: firmware.setup.options.rate_hz,
            has_mag: firmware.configuration().settings.text("mag_hardware") != "NONE",
            specific_force_flu: estimate.force_flu,
            rate_flu: Vector3::new(rates.roll, rates.pitch_down, -rates.yaw),
            mag_flu: firmware.parameters().estimator.field_flu(&firmware.sensing.mag_flu),
            attitude: estimate.attitude,
            roll_deg: estimate.roll_rad.to_degrees(),
            pitch_deg: -estimate.pitch_down_rad.to_degrees(),
            heading_deg: estimate.heading_rad.to_degrees(),
            altitude_m: altitude_m(firmware),
            climb_mps: estimate.shown_climb_mps,
            battery: battery(firmware),
            rssi: firmware.receiver().rssi(&firmware.parameters().rx),
            channels: *firmware.receiver().channels(),
            motors_us: firmware
                .control
                .controller
                .state()
                .motors_us
                .map(|pulse| pulse.round().clamp(0.0, 2500.0) as u16),
            gps: gps(firmware),
            home: home(firmware),
            flash: firmware.setup.flash,
            clock,
        }
    }
}

/// Returns the altitude above home. Before the first arming there is no home, so it returns the GPS altitude.
fn altitude_m(firmware: &Firmware) -> f64 {
    let above_home = firmware.estimate().shown_alt_m;
    match firmware.gps_view() {
        Some(gps) if !firmware.safety.arming.ever_armed() => gps.alt_amsl_m,
        _ => above_home,
    }
}

fn battery(firmware: &Firmware) -> Option<BatteryReading> {
    let sample = firmware.battery().sample()?;
    let cells = firmware.battery().cells();
    Some(BatteryReading {
        cells: (cells > 0).then_some(cells),
        voltage_v: sample.voltage_v,
        drawn_mah: sample.drawn_mah,
        current_a: sample.current_a,
        state: Some(firmware.battery().state()),
        ..BatteryReading::default()
    })
}

fn gps(firmware: &Firmware) -> RawGps {
    let gps = &firmware.estimate().gps;
    let solution = gps.solution.unwrap_or_default();
    let (east, north) = (solution.vel_enu.x, solution.vel_enu.y);
    let view = firmware.gps_view().unwrap_or_default();
    RawGps {
        fix: firmware.gps_fix(),
        sats: gps.sats,
        position: view.position,
        alt_amsl_m: view.alt_amsl_m,
        ground_speed_mps: view.ground_speed_mps,
        course_deg: math::atan2(east, north).to_degrees(),
        dop: (gps.hdop > 0.0).then_some(gps.hdop),
    }
}

/// Returns the distance and direction of home, seen from the craft; zeros without a home.
fn home(firmware: &Firmware) -> HomeVector {
    let gps = &firmware.estimate().gps;
    let place = gps.solution.filter(|_| firmware.gps_fix()).map(|solution| solution.position);
    let (distance_m, bearing_rad) =
        place.zip(firmware.home()).map_or((0.0, 0.0), |(place, home)| distance_bearing(place, home));
    let toggle = gps.messages & 1 == 1;
    HomeVector { distance_m, bearing_deg: bearing_rad.to_degrees(), toggle }
}

/// A time of day.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct UtcTime {
    /// The seconds since 1970, UTC.
    pub unix_s: u32,
    /// The milliseconds of the second.
    pub millis: u16,
}

impl UtcTime {
    /// Returns year, month and day in the Gregorian calendar, by years that begin in March (Hinnant,
    /// "chrono-compatible low-level date algorithms").
    pub fn date(self) -> (u32, u32, u32) {
        // The days since 0000-03-01.
        let days = self.unix_s / 86_400 + 719_468;
        let era = days / 146_097;
        let day_of_era = days % 146_097;
        let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
        let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
        let month_from_march = (5 * day_of_year + 2) / 153;
        let day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
        let month = if month_from_march < 10 { month_from_march + 3 } else { month_from_march - 9 };
        (era * 400 + year_of_era + u32::from(month <= 2), month, day)
    }
}
