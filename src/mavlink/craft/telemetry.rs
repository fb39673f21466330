//! Makes the messages about the state of a craft.

use std::time::Duration;

use super::super::message::*;
use super::super::state::GeoPosition;
use super::super::value::{LandedState, MissionState, mode_flag, sensor, system_state, system_type};
use super::super::wire::Series;
use super::modes::{FlightMode, Identity};
use super::state::CraftState;

/// The version of a heartbeat.
const MAVLINK_VERSION: u8 = 3;
/// The numbers that mean "not known".
const UNKNOWN_U8: u8 = u8::MAX;
const UNKNOWN_U16: u16 = u16::MAX;

/// The sources of messages.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) identity: Identity,
    pub(super) state: &'a CraftState,
    /// The simulated time since boot.
    pub(super) sim: Duration,
    /// The number of mission items, without a home item.
    pub(super) mission_length: usize,
    /// `true` if the mission of this ground station has a home item before the first item.
    pub(super) has_home_item: bool,
}

impl Source<'_> {
    /// Returns a message, or `None` if its content is not known.
    pub(super) fn message(&self, id: u32) -> Option<Message> {
        let state = self.state;
        Some(match id {
            Heartbeat::ID => self.heartbeat().into(),
            SysStatus::ID => self.sys_status().into(),
            SystemTime::ID => SystemTime {
                time_unix_usec: state.unix_time?.as_micros() as u64,
                time_boot_ms: self.boot_ms(),
            }
            .into(),
            GpsRawInt::ID => self.gps()?.into(),
            ScaledPressure::ID => ScaledPressure {
                time_boot_ms: self.boot_ms(),
                press_abs: (state.pressure_pa? / 100.0) as f32,
                temperature: (state.temperature_c.unwrap_or_default() * 100.0) as i16,
                ..Default::default()
            }
            .into(),
            Attitude::ID => {
                let ([roll, pitch, yaw], [rollspeed, pitchspeed, yawspeed]) = self.attitude()?;
                let time_boot_ms = self.boot_ms();
                Attitude { time_boot_ms, roll, pitch, yaw, rollspeed, pitchspeed, yawspeed }.into()
            }
            AttitudeQuaternion::ID => self.quaternion()?.into(),
            LocalPositionNed::ID => {
                let ([x, y, z], [vx, vy, vz]) =
                    (state.local_ned?.map(|x| x as f32), state.velocity_ned?.map(|v| v as f32));
                LocalPositionNed { time_boot_ms: self.boot_ms(), x, y, z, vx, vy, vz }.into()
            }
            GlobalPositionInt::ID => self.global_position()?.into(),
            RcChannelsRaw::ID | RcChannels::ID => self.rc(id)?,
            ServoOutputRaw::ID => {
                let outputs = state.outputs_us?;
                let half = |begin: usize| std::array::from_fn(|at| outputs[begin + at]);
                ServoOutputRaw {
                    time_usec: self.sim.as_micros() as u32,
                    servo_raw: Series(half(0)),
                    port: 0,
                    servo9_to_16_raw: half(8),
                }
                .into()
            }
            MissionCurrent::ID => self.mission_current().into(),
            GpsGlobalOrigin::ID => {
                let (latitude, longitude, altitude) = wire_position(&state.home?);
                let time_usec = self.sim.as_micros() as u64;
                GpsGlobalOrigin { latitude, longitude, altitude, time_usec }.into()
            }
            HomePosition::ID => {
                let (latitude, longitude, altitude) = wire_position(&state.home?);
                HomePosition {
                    latitude,
                    longitude,
                    altitude,
                    q: [f32::NAN; 4],
                    time_usec: self.sim.as_micros() as u64,
                    ..Default::default()
                }
                .into()
            }
            NavControllerOutput::ID => self.navigation()?.into(),
            VfrHud::ID => self.hud()?.into(),
            BatteryStatus::ID => self.battery()?.into(),
            Wind::ID if self.identity == Identity::Ardupilot => {
                let [north, east, down] = state.wind_ned?;
                // The direction is that from which the wind comes.
                let direction = degrees((-east).atan2(-north)) as f32;
                Wind { direction, speed: north.hypot(east) as f32, speed_z: down as f32 }.into()
            }
            WindCov::ID if self.identity != Identity::Ardupilot => {
                let [wind_x, wind_y, wind_z] = state.wind_ned?.map(|speed| speed as f32);
                let (var_horiz, var_vert, wind_alt) = (f32::NAN, f32::NAN, f32::NAN);
                let time_usec = self.sim.as_micros() as u64;
                WindCov {
                    time_usec,
                    wind_x,
                    wind_y,
                    wind_z,
                    var_horiz,
                    var_vert,
                    wind_alt,
                    ..Default::default()
                }
                .into()
            }
            ExtendedSysState::ID => {
                ExtendedSysState { vtol_state: 0, landed_state: state.landed.map_or(0, LandedState::code) }
                    .into()
            }
            CurrentMode::ID => {
                let custom_mode = self.custom_mode()?;
                let standard_mode = state.mode?.standard().code();
                CurrentMode { custom_mode, intended_custom_mode: custom_mode, standard_mode }.into()
            }
            AvailableModesMonitor::ID => AvailableModesMonitor { seq: 1 }.into(),
            _ => return None,
        })
    }

    fn boot_ms(&self) -> u32 {
        self.sim.as_millis() as u32
    }

    fn custom_mode(&self) -> Option<u32> {
        let mode = self.state.mode?;
        let is_held = mode == FlightMode::PosHold && self.state.mission.state == MissionState::Paused;
        // A paused mission of PX4 is in the mode "Hold", which takes no sticks.
        let is_px4_hold = is_held && self.identity == Identity::Px4;
        Some(if is_px4_hold { super::modes::px4(4, 3) } else { self.identity.custom_mode(mode) })
    }

    fn heartbeat(&self) -> Heartbeat {
        let (state, mode) = (self.state, self.state.mode);
        let mut base_mode = mode_flag::MANUAL_INPUT | mode_flag::CUSTOM;
        if mode != Some(FlightMode::Acro) {
            base_mode |= mode_flag::STABILISE;
        }
        if mode.is_some_and(FlightMode::is_automatic) {
            base_mode |= mode_flag::GUIDED | mode_flag::AUTO;
        }
        if state.is_armed {
            base_mode |= mode_flag::ARMED;
        }
        let system_status = match (state.is_failsafe, state.is_armed) {
            (true, _) => system_state::CRITICAL,
            (false, true) => system_state::ACTIVE,
            (false, false) => system_state::STANDBY,
        };
        Heartbeat {
            custom_mode: self.custom_mode().unwrap_or_default(),
            r#type: system_type::QUADROTOR,
            autopilot: self.identity.autopilot(),
            base_mode,
            system_status,
            mavlink_version: MAVLINK_VERSION,
        }
    }

    fn sys_status(&self) -> SysStatus {
        let state = self.state;
        let present = state.sensors_present | sensor::READY_TO_ARM;
        let is_ready = state.is_ready_to_arm == Some(true);
        // MAVProxy reports a breach while the health bit of the fence is clear, even without a fence.
        let mut health = state.sensors_present & state.sensors_healthy | sensor::FENCE;
        health |= if is_ready { sensor::READY_TO_ARM } else { 0 };
        let battery = state.battery;
        SysStatus {
            onboard_control_sensors_present: present,
            onboard_control_sensors_enabled: present,
            onboard_control_sensors_health: health,
            load: (state.load.unwrap_or_default() * 1000.0) as u16,
            voltage_battery: battery.map_or(UNKNOWN_U16, |battery| (battery.voltage * 1000.0) as u16),
            current_battery: battery
                .and_then(|battery| battery.current)
                .map_or(-1, |current| (current * 100.0) as i16),
            battery_remaining: battery.and_then(|battery| battery.remaining).map_or(-1, percent),
            ..Default::default()
        }
    }

    fn gps(&self) -> Option<GpsRawInt> {
        let gps = self.state.gps?;
        let (lat, lon, alt) = wire_position(&gps.position);
        let hundredths = |value: Option<f64>| value.map_or(UNKNOWN_U16, |value| (value * 100.0) as u16);
        Some(GpsRawInt {
            time_usec: self.sim.as_micros() as u64,
            lat,
            lon,
            alt,
            eph: hundredths(gps.hdop),
            epv: hundredths(gps.vdop),
            vel: hundredths(gps.speed),
            cog: gps.course.map_or(UNKNOWN_U16, compass),
            fix_type: gps.fix.code(),
            satellites_visible: gps.satellites.unwrap_or(UNKNOWN_U8),
            ..Default::default()
        })
    }

    /// Returns angles and rates.
    fn attitude(&self) -> Option<([f32; 3], [f32; 3])> {
        let rates = self.state.rates.unwrap_or_default();
        Some((self.state.attitude?.map(|angle| angle as f32), rates.map(|rate| rate as f32)))
    }

    fn quaternion(&self) -> Option<AttitudeQuaternion> {
        let (_, [rollspeed, pitchspeed, yawspeed]) = self.attitude()?;
        let [(sr, cr), (sp, cp), (sy, cy)] = self.state.attitude?.map(|angle| (angle / 2.0).sin_cos());
        let [q1, q2, q3, q4] = [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
        .map(|part| part as f32);
        let (time_boot_ms, repr_offset_q) = (self.boot_ms(), [0.0; 4]);
        Some(AttitudeQuaternion {
            time_boot_ms,
            q1,
            q2,
            q3,
            q4,
            rollspeed,
            pitchspeed,
            yawspeed,
            repr_offset_q,
        })
    }

    fn global_position(&self) -> Option<GlobalPositionInt> {
        let state = self.state;
        let position = state.position?;
        let (lat, lon, alt) = wire_position(&position);
        let [vx, vy, vz] = state.velocity_ned.unwrap_or_default().map(|speed| (speed * 100.0) as i16);
        let relative = state.altitude_above_home.or(state.home.map(|home| position.alt_amsl - home.alt_amsl));
        Some(GlobalPositionInt {
            time_boot_ms: self.boot_ms(),
            lat,
            lon,
            alt,
            relative_alt: (relative.unwrap_or_default() * 1000.0) as i32,
            vx,
            vy,
            vz,
            hdg: state.attitude.map_or(UNKNOWN_U16, |[_, _, yaw]| compass(yaw)),
        })
    }

    fn rc(&self, id: u32) -> Option<Message> {
        let rc = self.state.rc?;
        let used = usize::from(rc.count).min(rc.channels_us.len());
        let channel = |at: usize| if at < used { rc.channels_us[at] } else { UNKNOWN_U16 };
        let rssi = rc.rssi.map_or(UNKNOWN_U8, |rssi| (rssi * 254.0).clamp(0.0, 254.0) as u8);
        let time_boot_ms = self.boot_ms();
        Some(if id == RcChannels::ID {
            let chan_raw = Series(std::array::from_fn(channel));
            RcChannels { time_boot_ms, chan_raw, chancount: used as u8, rssi }.into()
        } else {
            RcChannelsRaw { time_boot_ms, chan_raw: Series(std::array::from_fn(channel)), port: 0, rssi }
                .into()
        })
    }

    fn mission_current(&self) -> MissionCurrent {
        let progress = self.state.mission;
        let length = self.mission_length.min(usize::from(UNKNOWN_U16 - 1)) as u16;
        let is_flown = self.state.mode == Some(FlightMode::Autopilot);
        MissionCurrent {
            seq: progress.current.unwrap_or_default().saturating_add(u16::from(self.has_home_item)),
            // The definition of the message excludes a home item from the total.
            total: if length == 0 { UNKNOWN_U16 } else { length },
            mission_state: progress.state.code(),
            mission_mode: if is_flown { 1 } else { 2 },
            ..Default::default()
        }
    }

    fn navigation(&self) -> Option<NavControllerOutput> {
        let navigation = self.state.navigation?;
        let bearing = degrees(navigation.bearing).round() as i16;
        let [roll, pitch, _] = self.state.attitude.unwrap_or_default().map(|angle| degrees(angle) as f32);
        Some(NavControllerOutput {
            nav_roll: roll,
            nav_pitch: pitch,
            alt_error: navigation.altitude_error as f32,
            xtrack_error: navigation.cross_track as f32,
            nav_bearing: bearing,
            target_bearing: bearing,
            wp_dist: navigation.distance as u16,
            ..Default::default()
        })
    }

    fn hud(&self) -> Option<VfrHud> {
        let state = self.state;
        let [north, east, down] = state.velocity_ned?;
        let ground_speed = north.hypot(east);
        Some(VfrHud {
            airspeed: state.airspeed.unwrap_or_default() as f32,
            groundspeed: ground_speed as f32,
            alt: state.position?.alt_amsl as f32,
            climb: -down as f32,
            heading: state.attitude.map_or(0, |[_, _, yaw]| (compass(yaw) / 100) as i16),
            throttle: (state.throttle.unwrap_or_default() * 100.0).round() as u16,
        })
    }

    fn battery(&self) -> Option<BatteryStatus> {
        let battery = self.state.battery?;
        let mut voltages = [UNKNOWN_U16; 10];
        voltages[0] = (battery.voltage * 1000.0) as u16;
        Some(BatteryStatus {
            current_consumed: battery.drawn_mah.map_or(-1, |drawn| drawn as i32),
            energy_consumed: -1,
            temperature: i16::MAX,
            voltages,
            current_battery: battery.current.map_or(-1, |current| (current * 100.0) as i16),
            battery_remaining: battery.remaining.map_or(-1, percent),
            ..Default::default()
        })
    }
}

/// Returns latitude and longitude in 1e-7°, and altitude in mm.
pub(super) fn wire_position(position: &GeoPosition) -> (i32, i32, i32) {
    let whole = |degrees: f64| (degrees * 1e7).round() as i32;
    (whole(position.lat_deg), whole(position.lon_deg), (position.alt_amsl * 1000.0).round() as i32)
}

fn percent(share: f64) -> i8 {
    (share * 100.0).clamp(0.0, 100.0).round() as i8
}

fn degrees(angle: f64) -> f64 {
    angle.to_degrees().rem_euclid(360.0)
}

/// Returns a direction in 0.01°, below 360°.
fn compass(angle: f64) -> u16 {
    (degrees(angle) * 100.0).round() as u16 % 36_000
}

#[cfg(test)]
mod tests;
