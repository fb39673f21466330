//! The lines that the SITL executable prints about its links, which scripts wait for.

use std::net::SocketAddr;

use crate::geo::LatLon;
use crate::signals::RcFrame;
use crate::telemetry::{ArmingFlags, Refusal};

use crate::link::proto::fdm;

/// The result of opening a link, as printed by the executable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(i8)]
pub(super) enum OpenResult {
    Done = 0,
    /// The port could not be bound.
    BindFailed = -1,
    /// There is no socket.
    NoSocket = -2,
}

/// The ports of the links.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SitlPorts {
    pub raw: u16,
    pub motors: u16,
    pub fdm: u16,
    pub rc: u16,
}

impl Default for SitlPorts {
    fn default() -> Self {
        Self { raw: 9001, motors: 9002, fdm: 9003, rc: 9004 }
    }
}

/// Returns the first line, printed before any link is open. `ip` is the address to which motors are sent.
pub(super) fn output_line(ip: &str, ports: SitlPorts) -> String {
    format!(
        "[SITL] The SITL will output to IP {ip}:{} (Gazebo) and {ip}:{} (RealFlightBridge)",
        ports.motors, ports.raw
    )
}

/// Returns the lines about the motor links, then about state and RC, with the results of opening them.
pub(super) fn link_lines(
    ip: &str,
    ports: SitlPorts,
    motors: OpenResult,
    fdm: OpenResult,
    rc: OpenResult,
) -> [String; 4] {
    let (motors, fdm, rc) = (motors as i8, fdm as i8, rc as i8);
    [
        format!("[SITL] init PwmOut UDP link to gazebo {ip}:{}...{motors}", ports.motors),
        format!("[SITL] init PwmOut UDP link to RF9 {ip}:{}...{motors}", ports.raw),
        format!("[SITL] start UDP server @{}...{fdm}", ports.fdm),
        format!("[SITL] start UDP server @{}...{rc}", ports.rc),
    ]
}

/// Returns the line about the first state datagram, with the simulator's clock, s, and the sender.
pub(super) fn first_fdm_line(stamp_s: f64, from: SocketAddr) -> String {
    format!("[SITL] new fdm {} t:{stamp_s:.6} from {}:{}", fdm::SIZE, from.ip(), from.port())
}

/// Returns the line about the first RC datagram.
pub(super) fn first_rc_line(stamp_s: f64, frame: &RcFrame) -> String {
    let [c1, c2, c3, c4, c5, c6, c7, c8, ..] = frame.channels;
    format!("[SITL] new rc 40: t:{stamp_s:.6} AETR: {c1} {c2} {c3} {c4} AUX1-4: {c5} {c6} {c7} {c8}")
}

/// The contents of the once-a-second line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FlightLine {
    /// The firmware's time, ms.
    pub t_ms: u64,
    /// Ground speed, m/s.
    pub speed_mps: f64,
    pub position: LatLon,
    /// Altitude, m.
    pub alt_m: f64,
    /// Roll, pitch and heading, degrees, with the signs of the craft's own messages.
    pub attitude_deg: [f64; 3],
}

impl std::fmt::Display for FlightLine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [roll, pitch, yaw] = self.attitude_deg;
        let LatLon { lat_e7, lon_e7 } = self.position;
        write!(f, "[SITL] t={}ms  spd={:.2}m/s  pos=({lat_e7},{lon_e7})  ", self.t_ms, self.speed_mps)?;
        write!(f, "alt={:.2}m  att=({roll:.1},{pitch:.1},{yaw:.1})", self.alt_m)
    }
}

/// Returns the once-a-second line while arming is blocked.
pub(super) fn blocked_line(t_ms: u64, reasons: ArmingFlags) -> String {
    format!("[SITL] t={t_ms}ms Arming disabled: {reasons}")
}

/// Returns the line that the autopilot does not engage, or keeps waiting, with the reason.
pub(super) fn refused_line(t_ms: u64, refusal: Refusal) -> String {
    format!("[SITL] t={t_ms}ms Autopilot refused: {}", refusal.sentence())
}

/// The line about a restart of the firmware.
pub(super) const RESET_LINE: &str = "[system]Reset!";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::ArmingFlag;

    #[test]
    fn start_lines_are_those_that_scripts_wait_for() {
        let ports = SitlPorts::default();
        assert_eq!(
            output_line("127.0.0.1", ports),
            "[SITL] The SITL will output to IP 127.0.0.1:9002 (Gazebo) and 127.0.0.1:9001 (RealFlightBridge)"
        );
        assert_eq!(
            link_lines("127.0.0.1", ports, OpenResult::Done, OpenResult::BindFailed, OpenResult::Done),
            [
                "[SITL] init PwmOut UDP link to gazebo 127.0.0.1:9002...0",
                "[SITL] init PwmOut UDP link to RF9 127.0.0.1:9001...0",
                "[SITL] start UDP server @9003...-1",
                "[SITL] start UDP server @9004...0",
            ]
        );
    }

    #[test]
    fn flight_lines() {
        let line = FlightLine {
            t_ms: 12_345,
            speed_mps: 4.996,
            position: LatLon::new(404_635_000, -795_182_500),
            alt_m: 50.0,
            attitude_deg: [0.04, -1.0, 359.96],
        };
        assert_eq!(
            line.to_string(),
            "[SITL] t=12345ms  spd=5.00m/s  pos=(404635000,-795182500)  alt=50.00m  att=(0.0,-1.0,360.0)"
        );
        assert_eq!(
            blocked_line(7, [ArmingFlag::RxLoss, ArmingFlag::Cli].into_iter().collect()),
            "[SITL] t=7ms Arming disabled: RXLOSS CLI"
        );
        assert_eq!(
            refused_line(7, Refusal::NoPlan),
            "[SITL] t=7ms Autopilot refused: No waypoints: upload a plan."
        );
        assert_eq!(
            first_rc_line(1.5, &RcFrame::SAFE),
            "[SITL] new rc 40: t:1.500000 AETR: 1500 1500 1000 1500 AUX1-4: 1000 1000 1000 1000"
        );
    }
}
