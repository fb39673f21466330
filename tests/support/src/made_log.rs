//! Blackbox logs as a flight controller writes them, made without the product's own writer.

use std::fmt::Write as _;

/// The place of arming: latitude and longitude, degrees × 10⁷.
pub const HOME: (i32, i32) = (404_635_000, -795_182_000);
/// The time of the first frame on the craft's clock, µs.
pub const FIRST_US: u32 = 20_000_000;
/// The fields of a main frame: name and sign.
const MAIN: [(&str, bool); 18] = [
    ("loopIteration", false),
    ("time", false),
    ("rcCommand[0]", true),
    ("rcCommand[1]", true),
    ("rcCommand[2]", true),
    ("rcCommand[3]", false),
    ("vbatLatest", false),
    ("baroAlt", true),
    ("gyroADC[0]", true),
    ("gyroADC[1]", true),
    ("gyroADC[2]", true),
    ("imuQuaternion[0]", true),
    ("imuQuaternion[1]", true),
    ("imuQuaternion[2]", true),
    ("debug[0]", true),
    ("motor[0]", false),
    ("motor[1]", false),
    ("motor[2]", false),
];
/// The last motor, whose field some logs lack.
const FOURTH: (&str, bool) = ("motor[3]", false);
const SLOW: [(&str, bool); 5] = [
    ("flightModeFlags", false),
    ("stateFlags", false),
    ("failsafePhase", false),
    ("rxSignalReceived", false),
    ("rxFlightChannelsValid", false),
];
const GPS_HOME: [(&str, bool); 3] = [("GPS_home[0]", true), ("GPS_home[1]", true), ("GPS_home[2]", true)];
const GPS: [(&str, bool); 7] = [
    ("time", false),
    ("GPS_numSat", false),
    ("GPS_coord[0]", true),
    ("GPS_coord[1]", true),
    ("GPS_altitude", true),
    ("GPS_speed", false),
    ("GPS_ground_course", false),
];

/// A flight in a circle to the north and east of home, once in 40 s, which climbs to 30 m. ANGLE is on from second 4 on, and
/// AUTOPILOT from second 8 on.
#[derive(Debug, Clone, Copy)]
pub struct MadeLog {
    /// The length, s.
    pub seconds: u32,
    /// Main frames a second; a divisor of 1000000.
    pub hz: u32,
    pub has_gps: bool,
    /// The radius of the circle, m.
    pub radius_m: f64,
    /// The number of a byte after the header from which 40 bytes are damaged.
    pub damaged_at: Option<usize>,
    pub craft: &'static str,
}

impl Default for MadeLog {
    fn default() -> Self {
        Self { seconds: 20, hz: 200, has_gps: true, radius_m: 40.0, damaged_at: None, craft: "Test" }
    }
}

impl MadeLog {
    /// Returns the bytes of the log.
    pub fn bytes(self) -> Vec<u8> {
        let mut bytes = self.header().into_bytes();
        let begin = bytes.len();
        self.frames(&mut bytes);
        if let Some(at) = self.damaged_at {
            let damaged = bytes.iter_mut().skip(begin + at).take(40);
            damaged.for_each(|byte| *byte = b'?');
        }
        bytes
    }

    fn header(self) -> String {
        let mut text = format!("{}\nH Data version:2\n", betadeck_core::blackbox::FIRST_LINE);
        let main = [&MAIN[..], &[FOURTH]].concat();
        define(&mut text, 'I', &main, &[]);
        // No differences are written, but readers want their definition.
        let _ = writeln!(text, "H Field P predictor:{}", vec!["0"; main.len()].join(","));
        let _ = writeln!(text, "H Field P encoding:{}", vec!["0"; main.len()].join(","));
        define(&mut text, 'S', &SLOW, &[]);
        if self.has_gps {
            define(&mut text, 'H', &GPS_HOME, &[]);
            define(&mut text, 'G', &GPS, &[0, 0, 7, 7]);
        }
        text.push_str(
            "H Firmware type:Betaflight\nH Firmware revision:Betaflight 2026.12.0 (abcdef012) SITL\n",
        );
        text.push_str("H I interval:1\nH P interval:1/1\nH gyro_scale:0x3f800000\nH motorOutput:1000,2000\n");
        let _ =
            writeln!(text, "H Craft name:{}\nH Log start datetime:2026-05-01T10:00:00.000+00:00", self.craft);
        text
    }

    fn frames(self, bytes: &mut Vec<u8>) {
        let step_us = 1_000_000 / self.hz;
        for frame in 0..self.seconds * self.hz {
            let since_us = frame * step_us;
            let time_us = FIRST_US + since_us;
            let time_s = f64::from(since_us) / 1e6;
            self.main(bytes, frame, time_us, time_s);
            if frame == 0 {
                event(bytes, 0, &[time_us]);
                if self.has_gps {
                    frame_of(bytes, b'H', &[HOME.0.into(), HOME.1.into(), 4000], &GPS_HOME);
                }
            }
            for (second, modes) in [(0, 0b1), (4, 0b11), (8, 0b1000_0000_0011)] {
                if since_us == second * 1_000_000 {
                    frame_of(bytes, b'S', &[modes, 3, 0, 1, 1], &SLOW);
                }
            }
            if self.has_gps && since_us % 200_000 < step_us {
                let (n, e) = self.place(time_s);
                let coordinates = [(n / 0.0111) as i64, (e / 0.0085) as i64];
                let gps = [time_us.into(), 14, coordinates[0], coordinates[1], 4000, 628, 900];
                frame_of(bytes, b'G', &gps, &GPS);
            }
        }
        event(bytes, 15, &[4]);
        bytes.extend_from_slice(b"E\xffEnd of log\0");
    }

    /// Returns the place north and east of home, m.
    fn place(self, time_s: f64) -> (f64, f64) {
        let turn = time_s / 40.0 * std::f64::consts::TAU;
        (self.radius_m * turn.sin(), self.radius_m * (1.0 - turn.cos()))
    }

    fn main(self, bytes: &mut Vec<u8>, frame: u32, time_us: u32, time_s: f64) {
        let roll = (time_s * 0.5).sin() * 0.2;
        let values: [i64; MAIN.len() + 1] = [
            frame.into(),
            time_us.into(),
            (roll * 500.0) as i64,
            -60,
            12,
            1480,
            1580,
            (time_s * 300.0).min(3000.0) as i64,
            (time_s * 9.0).sin().mul_add(100.0, 0.0) as i64,
            0,
            0,
            (roll / 2.0 * 32_767.0) as i64,
            0,
            (time_s / 40.0 * 20_000.0) as i64 % 20_000,
            i64::from(frame % 500) - 250,
            1400,
            1420,
            1380,
            1410,
        ];
        frame_of(bytes, b'I', &values, &[&MAIN[..], &[FOURTH]].concat());
    }
}

/// Writes the definition of a frame whose fields are encoded as variable bytes.
fn define(text: &mut String, frame: char, fields: &[(&str, bool)], predictors: &[u8]) {
    let all = |each: &dyn Fn(usize) -> String| (0..fields.len()).map(each).collect::<Vec<_>>().join(",");
    let sign = |at: usize| u8::from(fields[at].1);
    for (word, line) in [
        ("name", all(&|at| fields[at].0.to_owned())),
        ("signed", all(&|at| sign(at).to_string())),
        ("predictor", all(&|at| predictors.get(at).copied().unwrap_or_default().to_string())),
        ("encoding", all(&|at| (1 - sign(at)).to_string())),
    ] {
        let _ = writeln!(text, "H Field {frame} {word}:{line}");
    }
}

fn frame_of(bytes: &mut Vec<u8>, letter: u8, values: &[i64], fields: &[(&str, bool)]) {
    bytes.push(letter);
    for (value, (_, is_signed)) in values.iter().zip(fields) {
        let value = *value as i32;
        let code = if *is_signed { (value << 1) as u32 ^ (value >> 31) as u32 } else { value as u32 };
        unsigned(bytes, code);
    }
}

fn event(bytes: &mut Vec<u8>, number: u8, values: &[u32]) {
    bytes.extend_from_slice(&[b'E', number]);
    values.iter().for_each(|value| unsigned(bytes, *value));
}

fn unsigned(bytes: &mut Vec<u8>, mut value: u32) {
    while value >= 0x80 {
        bytes.push(value as u8 | 0x80);
        value >>= 7;
    }
    bytes.push(value as u8);
}
