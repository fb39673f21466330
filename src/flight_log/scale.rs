//! The units of a log's fields, by their names and the lines of the header.

use crate::blackbox::decode::{FirmwareName, Header, HeaderFinding};
use crate::blackbox::{Field, FrameKind, Predictor};
use crate::geo::GRAVITY;
use crate::math;

/// The greatest value of a part of a quaternion.
const QUATERNION_ONE: f64 = 32_767.0;
/// The reference voltage of the converter in old firmwares, mV, and its greatest value.
const ADC_MV: f64 = 3300.0;
const ADC_MAX: f64 = 4095.0;

/// A value in its unit: the number of the log times `factor`, plus `offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    pub(super) factor: f64,
    pub(super) offset: f64,
    pub(super) unit: &'static str,
}

impl Scale {
    /// The number of the log without a unit.
    pub(super) const RAW: Self = Self::of(1.0, "");

    const fn of(factor: f64, unit: &'static str) -> Self {
        Self { factor, offset: 0.0, unit }
    }

    /// Returns the digits after the point that the numbers of the log resolve.
    pub(super) fn decimals(&self) -> u8 {
        if self.factor.fract() == 0.0 {
            return 0;
        }
        // The logarithm of a power of ten may be a little above a whole number.
        (-math::log10(self.factor.abs()) - 1e-9).ceil().clamp(1.0, 8.0) as u8
    }

    /// Returns the value of a number of the log.
    pub(super) fn apply(&self, raw: f64) -> f64 {
        raw * self.factor + self.offset
    }
}

/// The numbers of a header that units depend on.
#[derive(Debug, Clone)]
pub(super) struct Scales {
    /// What is wrong with the header, and what is assumed.
    findings: Vec<HeaderFinding>,
    firmware: FirmwareName,
    version: (u32, u32, u32),
    /// °/s.
    gyro: f64,
    /// The number for 1 g.
    acc_1g: Option<f64>,
    /// The factor by which rates and sticks are logged.
    resolution: f64,
    vbat_scale: f64,
    /// The numbers for a motor that idles and one with full thrust.
    motors: (f64, f64),
    motor_poles: f64,
}

impl Scales {
    pub(super) fn of(header: &Header) -> Self {
        let mut findings = header.findings().to_vec();
        let has = |prefixes: &[&str]| {
            let fields = [FrameKind::Intra, FrameKind::Gps].into_iter().flat_map(|kind| header.fields(kind));
            fields.into_iter().any(|field| prefixes.iter().any(|prefix| field.name.starts_with(prefix)))
        };
        let mut assumed = |is_needed: bool, line: &str, what: &str| {
            if is_needed && findings.iter().all(|finding| finding.line() != line) {
                findings.push(header.finding(line, what));
            }
        };
        let number = |name: &str| header.number(name).map(f64::from);
        let positive = |name: &str| number(name).filter(|value| *value > 0.0);
        let bits = header.number("gyro_scale").or_else(|| header.number("gyro.scale"));
        let gyro = bits.map(|bits| f64::from(f32::from_bits(bits as u32))).filter(|scale| scale.is_normal());
        assumed(gyro.is_none() && has(&["gyro"]), "gyro_scale", "1 °/s for a step of the gyro is assumed");
        let acc_1g = positive("acc_1G");
        assumed(acc_1g.is_none() && has(&["accSmooth"]), "acc_1G", "the accelerometer has no unit");
        let motors = motor_range(header);
        let range = "1000 for idling motors and 2000 for full thrust are assumed";
        assumed(motors.is_none() && has(&["motor["]), "motorOutput", range);
        let motor_poles = positive("motor_poles");
        assumed(motor_poles.is_none() && has(&["eRPM"]), "motor_poles", "14 poles are assumed");
        let vbat_scale = positive("vbat_scale").or_else(|| positive("vbatscale"));
        let mut scales = Self {
            findings: Vec::new(),
            firmware: header.firmware,
            version: header.version,
            gyro: gyro.unwrap_or(1.0),
            acc_1g,
            resolution: if positive("blackbox_high_resolution").is_some() { 10.0 } else { 1.0 },
            vbat_scale: vbat_scale.unwrap_or(110.0),
            motors: motors.unwrap_or((1000.0, 2000.0)),
            motor_poles: motor_poles.unwrap_or(14.0),
        };
        let needs_scale = scales.counts_converter_steps() && has(&["vbat"]);
        assumed(vbat_scale.is_none() && needs_scale, "vbat_scale", "110 is assumed");
        scales.findings = findings;
        scales
    }

    /// Returns what is wrong with the header, and what is assumed.
    pub(super) fn findings(&self) -> &[HeaderFinding] {
        &self.findings
    }

    /// Returns `true` if the values of a field rest on an assumption.
    pub(super) fn is_assumed(&self, kind: FrameKind, field: &Field) -> bool {
        let name = field.name.split_once('[').map_or(field.name.as_str(), |(name, _)| name);
        let of_unit = match name {
            "loopIteration" => &["I interval", "P interval"][..],
            "gyroADC" | "gyroUnfilt" | "gyroRaw" => &["gyro_scale"],
            "accSmooth" => &["acc_1G"],
            "vbatLatest" | "vbat" => &["Firmware revision", "Firmware type", "vbat_scale"],
            "GPS_altitude" => &["Firmware revision", "Firmware type"],
            "flightModeFlags" => &["Firmware revision", "Firmware type"],
            "motor" => &["motorOutput"],
            "eRPM" => &["motor_poles"],
            _ => &[],
        };
        let of_prediction = match field.predictor {
            Predictor::MinThrottle => "minthrottle",
            Predictor::VbatReference => "vbatref",
            Predictor::MinMotor | Predictor::Motor0 => "motorOutput",
            Predictor::HomeCoordinate => "Field H",
            _ => "Data version",
        };
        let definition = format!("Field {} ", char::from(kind.letter()));
        self.findings
            .iter()
            .map(HeaderFinding::line)
            .any(|line| of_unit.contains(&line) || line == of_prediction || line.starts_with(&definition))
    }

    fn is_betaflight_from(&self, version: (u32, u32, u32)) -> bool {
        self.firmware == FirmwareName::Betaflight && self.version >= version
    }

    /// Returns the unit of a field; `None` for a number whose unit is unknown.
    pub(super) fn scale(&self, field: &Field) -> Option<Scale> {
        let (name, index) = match field.name.split_once('[') {
            Some((name, index)) => (name, index.trim_end_matches(']').parse::<usize>().unwrap_or_default()),
            None => (field.name.as_str(), 0),
        };
        let fine = 1.0 / self.resolution;
        Some(match (name, index) {
            ("time", _) => Scale::of(1.0, "µs"),
            ("gyroADC" | "gyroUnfilt" | "gyroRaw", _) => Scale::of(self.gyro * fine, "°/s"),
            ("accSmooth", _) => Scale::of(GRAVITY / self.acc_1g?, "m/s²"),
            ("setpoint", 3) => Scale::of(0.1, "%"),
            ("setpoint" | "axisRate", _) => Scale::of(fine, "°/s"),
            ("rcCommand", 3) => Scale::of(fine, "µs"),
            ("rcCommand", _) => Scale::of(fine, ""),
            ("rcData", _) => Scale::of(1.0, "µs"),
            ("imuQuaternion" | "quat", _) => Scale::of(1.0 / QUATERNION_ONE, ""),
            ("attitude", _) => Scale::of(0.1, "°"),
            ("vbatLatest" | "vbat", _) => self.voltage(),
            ("amperageLatest" | "amperage", _) => Scale::of(0.01, "A"),
            ("baroAlt" | "BaroAlt" | "navPos" | "navTgtPos" | "surfaceRaw", _) => Scale::of(0.01, "m"),
            ("navVel" | "navTgtVel" | "GPS_speed" | "GPS_velned" | "airSpeed", _) => Scale::of(0.01, "m/s"),
            ("rssi", _) => Scale::of(100.0 / 1023.0, "%"),
            ("motor", _) => {
                let (idle, full) = self.motors;
                let factor = 100.0 / (full - idle);
                Scale { factor, offset: -idle * factor, unit: "%" }
            }
            ("eRPM", _) => Scale::of(200.0 / self.motor_poles, "rpm"),
            ("GPS_coord" | "GPS_home", 0 | 1) => Scale::of(1e-7, "°"),
            ("GPS_altitude" | "GPS_home", _) => Scale::of(self.gps_altitude(), "m"),
            ("GPS_ground_course", _) => Scale::of(0.1, "°"),
            ("GPS_time", _) => Scale::of(1.0, "ms"),
            ("GPS_home_epoch", _) => Scale::of(1.0, "s"),
            _ => return None,
        })
    }

    /// Returns `true` if a voltage is logged in tenths.
    fn counts_tenths(&self) -> bool {
        self.firmware == FirmwareName::EmuFlight
            || self.is_betaflight_from((3, 1, 0))
            || self.firmware == FirmwareName::Cleanflight && self.version >= (2, 0, 0)
    }

    /// Returns `true` if a voltage is logged in hundredths.
    fn counts_hundredths(&self) -> bool {
        self.is_betaflight_from((4, 0, 0))
            || matches!(self.firmware, FirmwareName::Inav | FirmwareName::Rotorflight)
    }

    /// Returns `true` if a voltage is logged in steps of the converter.
    fn counts_converter_steps(&self) -> bool {
        !self.counts_tenths() && !self.counts_hundredths()
    }

    fn voltage(&self) -> Scale {
        let factor = if self.counts_hundredths() {
            0.01
        } else if self.counts_tenths() {
            0.1
        } else {
            ADC_MV / ADC_MAX * self.vbat_scale / 10_000.0
        };
        Scale::of(factor, "V")
    }

    /// Returns the metres of a number: newer firmwares count in decimetres.
    fn gps_altitude(&self) -> f64 {
        if self.is_betaflight_from((3, 4, 0)) || self.firmware == FirmwareName::Rotorflight {
            0.1
        } else {
            1.0
        }
    }
}

/// Returns the numbers for idle and for full thrust, if the header has them.
fn motor_range(header: &Header) -> Option<(f64, f64)> {
    let pair = |name: &str| {
        let (low, high) = header.value(name)?.split_once(',')?;
        Some((low.trim().parse().ok()?, high.trim().parse().ok()?))
    };
    let limits = header.number("minthrottle").zip(header.number("maxthrottle"));
    let range: Option<(f64, f64)> =
        pair("motorOutput").or(limits.map(|(low, high)| (low.into(), high.into())));
    range.filter(|(low, high)| high > low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_those_that_the_log_resolves() {
        let of = |factor| Scale::of(factor, "").decimals();
        assert_eq!([1.0, 100.0, 0.1, 0.01, 1e-7].map(of), [0, 0, 1, 2, 7]);
        assert_eq!([GRAVITY / 2048.0, 200.0 / 14.0, 1.0 / QUATERNION_ONE].map(of), [3, 1, 5]);
    }
}
