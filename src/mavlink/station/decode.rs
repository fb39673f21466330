//! Reads telemetry into a report.

use std::time::Duration;

use super::super::message::*;
use super::super::state::{BatteryState, GeoPosition, GpsState, NavigationState, RcState};
use super::super::value::{GpsFix, LandedState, MissionState};
use super::report::{CraftReport, CurrentItem, Firmware, Heard, SensorStatus};

impl CraftReport {
    /// Takes a message that arrived now. Other messages than telemetry are ignored.
    pub(super) fn take(&mut self, message: &Message, now: Duration) {
        let at = Arrival(now);
        match *message {
            Message::SysStatus(status) => self.sys_status(&status, at),
            Message::SystemTime(time) => {
                self.boot_time = at.some(Duration::from_millis(time.time_boot_ms.into()));
                if time.time_unix_usec > 0 {
                    self.unix_time = at.some(Duration::from_micros(time.time_unix_usec));
                }
            }
            Message::GpsRawInt(gps) => self.gps = at.some(gps_state(&gps)),
            Message::ScaledPressure(pressure) => {
                // INAV sends a temperature only.
                let pascal = f64::from(pressure.press_abs) * 100.0;
                self.pressure_pa =
                    Some(pascal).filter(|pascal| *pascal > 0.0).and_then(|pascal| at.some(pascal));
                self.temperature_c = at.some(f64::from(pressure.temperature) / 100.0);
            }
            Message::Attitude(attitude) => {
                let Attitude { roll, pitch, yaw, rollspeed, pitchspeed, yawspeed, .. } = attitude;
                self.attitude = at.finite([roll, pitch, yaw]);
                self.rates = at.finite([rollspeed, pitchspeed, yawspeed]);
                self.boot_time = at.some(Duration::from_millis(attitude.time_boot_ms.into()));
            }
            Message::AttitudeQuaternion(attitude) => {
                let AttitudeQuaternion { q1, q2, q3, q4, rollspeed, pitchspeed, yawspeed, .. } = attitude;
                self.attitude = at.finite(angles([q1, q2, q3, q4]));
                self.rates = at.finite([rollspeed, pitchspeed, yawspeed]);
            }
            Message::LocalPositionNed(local) => {
                self.local_ned = at.finite([local.x, local.y, local.z]);
                self.velocity_ned = at.finite([local.vx, local.vy, local.vz]);
            }
            Message::GlobalPositionInt(global) => self.global_position(&global, at),
            Message::RcChannels(rc) => {
                self.rc = at.some(RcState {
                    channels_us: rc.chan_raw.0,
                    count: rc.chancount.min(18),
                    rssi: rssi(rc.rssi),
                });
            }
            // Only crafts without RC_CHANNELS are read from the older message.
            Message::RcChannelsRaw(rc) if rc.port == 0 && self.rc.is_none_or(|rc| rc.value.count <= 8) => {
                let mut channels_us = [0; 18];
                channels_us[..8].copy_from_slice(&rc.chan_raw.0);
                self.rc = at.some(RcState { channels_us, count: 8, rssi: rssi(rc.rssi) });
            }
            Message::ServoOutputRaw(outputs) if outputs.port == 0 => {
                let mut outputs_us = [0; 16];
                outputs_us[..8].copy_from_slice(&outputs.servo_raw.0);
                outputs_us[8..].copy_from_slice(&outputs.servo9_to_16_raw);
                self.outputs_us = at.some(outputs_us);
            }
            Message::MissionCurrent(current) => {
                self.mission = at.some(CurrentItem {
                    seq: current.seq,
                    total: Some(current.total).filter(|total| ![0, u16::MAX].contains(total)),
                    state: MissionState::from_code(current.mission_state).unwrap_or(MissionState::Unknown),
                });
            }
            Message::HomePosition(home) => {
                self.home = at.some(position(home.latitude, home.longitude, home.altitude));
            }
            Message::NavControllerOutput(output) => {
                self.navigation = at.some(NavigationState {
                    distance: output.wp_dist.into(),
                    bearing: f64::from(output.target_bearing).to_radians(),
                    cross_track: output.xtrack_error.into(),
                    altitude_error: output.alt_error.into(),
                });
            }
            Message::VfrHud(hud) => {
                self.airspeed = at.number(hud.airspeed);
                self.ground_speed = at.number(hud.groundspeed);
                self.climb = at.number(hud.climb);
                self.throttle = at.some(f64::from(hud.throttle.min(100)) / 100.0);
                self.heading = at.some(f64::from(hud.heading).to_radians());
            }
            Message::BatteryStatus(battery) if battery.id == 0 => self.battery(&battery, at),
            Message::AutopilotVersion(version) => {
                let [major, minor, patch, _] = version.flight_sw_version.to_be_bytes();
                let capabilities = version.capabilities;
                self.firmware = at.some(Firmware { version: [major, minor, patch], capabilities });
            }
            Message::FenceStatus(fence) => self.is_fence_breached = at.some(fence.breach_status != 0),
            Message::Wind(wind) => {
                // The direction is that from which the wind comes.
                let (sin, cos) = f64::from(wind.direction).to_radians().sin_cos();
                let [speed, down] = [wind.speed, wind.speed_z].map(f64::from);
                self.wind_ned = at.finite([-speed * cos, -speed * sin, down]);
            }
            Message::WindCov(wind) => self.wind_ned = at.finite([wind.wind_x, wind.wind_y, wind.wind_z]),
            Message::ExtendedSysState(state) => {
                let landed = LandedState::from_code(state.landed_state);
                self.landed = landed
                    .filter(|landed| *landed != LandedState::Undefined)
                    .and_then(|landed| at.some(landed));
            }
            _ => {}
        }
    }

    fn sys_status(&mut self, status: &SysStatus, at: Arrival) {
        self.sensors = at.some(SensorStatus {
            present: status.onboard_control_sensors_present,
            enabled: status.onboard_control_sensors_enabled,
            healthy: status.onboard_control_sensors_health,
            load: f64::from(status.load) / 1000.0,
        });
        if status.voltage_battery == u16::MAX {
            return;
        }
        let drawn_mah = self.battery.and_then(|battery| battery.value.drawn_mah);
        self.battery = at.some(BatteryState {
            voltage: f64::from(status.voltage_battery) / 1000.0,
            current: hundredths(status.current_battery),
            drawn_mah,
            remaining: share(status.battery_remaining),
        });
    }

    fn battery(&mut self, battery: &BatteryStatus, at: Arrival) {
        let cells = battery.voltages.iter().filter(|cell| **cell != u16::MAX);
        let further = battery.voltages_ext.iter();
        let millivolts: f64 = cells.chain(further).map(|cell| f64::from(*cell)).sum();
        let before = self.battery.map(|battery| battery.value).unwrap_or_default();
        self.battery = at.some(BatteryState {
            voltage: if millivolts > 0.0 { millivolts / 1000.0 } else { before.voltage },
            current: hundredths(battery.current_battery),
            drawn_mah: Some(battery.current_consumed).filter(|drawn| *drawn >= 0).map(f64::from),
            remaining: share(battery.battery_remaining),
        });
    }

    fn global_position(&mut self, global: &GlobalPositionInt, at: Arrival) {
        self.boot_time = at.some(Duration::from_millis(global.time_boot_ms.into()));
        // A craft without a position sends zeros.
        if global.lat == 0 && global.lon == 0 {
            return;
        }
        self.position = at.some(position(global.lat, global.lon, global.alt));
        self.altitude_above_home = at.some(f64::from(global.relative_alt) / 1000.0);
        self.velocity_ned = at.some([global.vx, global.vy, global.vz].map(|speed| f64::from(speed) / 100.0));
        if let Some(heading) = known(global.hdg) {
            self.heading = at.some(heading.to_radians());
        }
    }
}

/// The time of arrival.
#[derive(Clone, Copy)]
struct Arrival(Duration);

impl Arrival {
    fn some<T>(self, value: T) -> Option<Heard<T>> {
        Some(Heard { value, at: self.0 })
    }

    /// Returns the numbers if all are finite.
    fn finite<const N: usize>(self, values: [impl Into<f64>; N]) -> Option<Heard<[f64; N]>> {
        let values = values.map(Into::into);
        values.iter().all(|value| value.is_finite()).then_some(Heard { value: values, at: self.0 })
    }

    fn number(self, value: f32) -> Option<Heard<f64>> {
        value.is_finite().then_some(Heard { value: value.into(), at: self.0 })
    }
}

fn position(lat: i32, lon: i32, alt: i32) -> GeoPosition {
    GeoPosition {
        lat_deg: f64::from(lat) / 1e7,
        lon_deg: f64::from(lon) / 1e7,
        alt_amsl: f64::from(alt) / 1000.0,
    }
}

fn gps_state(gps: &GpsRawInt) -> GpsState {
    GpsState {
        fix: GpsFix::from_code(gps.fix_type).unwrap_or(GpsFix::NoFix),
        position: position(gps.lat, gps.lon, gps.alt),
        hdop: known(gps.eph),
        vdop: known(gps.epv),
        speed: known(gps.vel),
        course: known(gps.cog).map(f64::to_radians),
        satellites: Some(gps.satellites_visible).filter(|count| *count != u8::MAX),
    }
}

/// Returns a number in hundredths, or `None` if it is not known.
fn known(hundredths: u16) -> Option<f64> {
    (hundredths != u16::MAX).then(|| f64::from(hundredths) / 100.0)
}

/// Returns a current in A, or `None` if it is not measured.
fn hundredths(current: i16) -> Option<f64> {
    (current != -1).then(|| f64::from(current) / 100.0)
}

fn share(percent: i8) -> Option<f64> {
    (0..=100).contains(&percent).then(|| f64::from(percent) / 100.0)
}

fn rssi(rssi: u8) -> Option<f64> {
    (rssi != u8::MAX).then(|| f64::from(rssi) / 254.0)
}

/// Returns roll, pitch and yaw of a quaternion.
fn angles(quaternion: [f32; 4]) -> [f64; 3] {
    let [w, x, y, z] = quaternion.map(f64::from);
    let roll = (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y));
    let pitch = (2.0 * (w * y - z * x)).clamp(-1.0, 1.0).asin();
    let yaw = (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z));
    [roll, pitch, yaw]
}
