//! Small logs with the fields that have a meaning, written apart from the product's own writer.

/// A file of logs that grows.
#[derive(Debug, Default)]
pub(super) struct Maker {
    pub(super) bytes: Vec<u8>,
}

/// The main fields with their sign and their value in a frame of [`Maker::main`], besides those that change.
const MAIN: [(&str, bool, i32); 17] = [
    ("gyroADC[1]", true, -20),
    ("gyroADC[2]", true, 30),
    ("accSmooth[0]", true, 0),
    ("accSmooth[1]", true, 1024),
    ("accSmooth[2]", true, 2048),
    ("rcCommand[0]", true, 100),
    ("rcCommand[1]", true, -100),
    ("rcCommand[2]", true, 5),
    ("rcCommand[3]", false, 1500),
    ("setpoint[0]", true, 11),
    ("setpoint[1]", true, 12),
    ("setpoint[2]", true, 13),
    ("setpoint[3]", true, 456),
    ("vbatLatest", false, 1620),
    ("amperageLatest", true, 3600),
    ("motor[0]", false, 1100),
    ("motor[1]", false, 2000),
];

/// Returns the lines of a log with main, slow, GPS and home frames.
pub(super) fn header() -> String {
    let defined = |frame: char, fields: &[(&str, bool)], predictors: &[u8]| {
        let join = |each: &dyn Fn(usize) -> String| (0..fields.len()).map(each).collect::<Vec<_>>().join(",");
        let sign = |at: usize| u8::from(fields[at].1);
        let names = join(&|at| fields[at].0.to_owned());
        let signs = join(&|at| sign(at).to_string());
        let predictor = join(&|at| predictors.get(at).copied().unwrap_or_default().to_string());
        let encodings = join(&|at| (1 - sign(at)).to_string());
        let rest = format!("H Field {frame} predictor:{predictor}\nH Field {frame} encoding:{encodings}\n");
        (format!("H Field {frame} name:{names}\nH Field {frame} signed:{signs}\n"), rest)
    };
    let changing = [("loopIteration", false), ("time", false), ("gyroADC[0]", true), ("baroAlt", true)];
    let main: Vec<(&str, bool)> =
        changing.into_iter().chain(MAIN.iter().map(|(name, signed, _)| (*name, *signed))).collect();
    let slow =
        ["flightModeFlags", "stateFlags", "failsafePhase", "rxSignalReceived", "rxFlightChannelsValid"];
    let gps = [
        ("time", false),
        ("GPS_numSat", false),
        ("GPS_coord[0]", true),
        ("GPS_coord[1]", true),
        ("GPS_altitude", true),
        ("GPS_speed", false),
        ("GPS_ground_course", false),
    ];
    let (names, rest) = defined('I', &main, &[]);
    let (inter, _) = (rest.replace("Field I", "Field P"), ());
    let mut text = format!("{}\nH Data version:2\n{names}{rest}{inter}", crate::blackbox::FIRST_LINE);
    for (frame, fields, predictors) in [
        ('S', &slow.map(|name| (name, false))[..], &[][..]),
        ('H', &[("GPS_home[0]", true), ("GPS_home[1]", true), ("GPS_home[2]", true)], &[]),
        ('G', &gps, &[0, 0, 7, 7]),
    ] {
        let (names, rest) = defined(frame, fields, predictors);
        text.push_str(&names);
        text.push_str(&rest);
    }
    text + "H Firmware revision:Betaflight 4.5.2 (024f8e13d) SITL\nH Firmware type:Betaflight\nH I interval:1\n\
        H gyro_scale:0x3f800000\nH acc_1G:2048\nH motorOutput:1000,2000\n"
}

impl Maker {
    pub(super) fn begin(&mut self, lines: &str) -> &mut Self {
        self.raw(lines.as_bytes())
    }

    pub(super) fn raw(&mut self, bytes: &[u8]) -> &mut Self {
        self.bytes.extend_from_slice(bytes);
        self
    }

    pub(super) fn unsigned(&mut self, mut value: u32) -> &mut Self {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
        self
    }

    pub(super) fn signed(&mut self, value: i32) -> &mut Self {
        self.unsigned((value << 1) as u32 ^ (value >> 31) as u32)
    }

    /// Writes a whole main frame.
    pub(super) fn main(
        &mut self,
        iteration: u32,
        time_us: u32,
        roll_rate: i32,
        baro_alt_cm: i32,
    ) -> &mut Self {
        self.raw(b"I").unsigned(iteration).unsigned(time_us).signed(roll_rate).signed(baro_alt_cm);
        for (_, signed, value) in MAIN {
            if signed {
                self.signed(value);
            } else {
                self.unsigned(value as u32);
            }
        }
        self
    }

    /// Writes boxes, states, the failsafe phase and the two flags of the receiver.
    pub(super) fn slow(&mut self, values: [u32; 5]) -> &mut Self {
        values.into_iter().fold(self.raw(b"S"), |maker, value| maker.unsigned(value))
    }

    pub(super) fn home(&mut self, lat_e7: i32, lon_e7: i32, alt_dm: i32) -> &mut Self {
        self.raw(b"H").signed(lat_e7).signed(lon_e7).signed(alt_dm)
    }

    /// Writes a GPS frame with a place relative to the home of `long`.
    #[allow(clippy::too_many_arguments, reason = "the fields of the frame")]
    pub(super) fn gps(
        &mut self,
        time_us: u32,
        sats: u32,
        lat_e7: i32,
        lon_e7: i32,
        alt_dm: i32,
        speed_cmps: u32,
        course_ddeg: u32,
    ) -> &mut Self {
        self.raw(b"G")
            .unsigned(time_us)
            .unsigned(sats)
            .signed(lat_e7 - 404_640_000)
            .signed(lon_e7 + 795_175_000);
        self.signed(alt_dm).unsigned(speed_cmps).unsigned(course_ddeg)
    }

    /// Writes an event with its number and its payload.
    pub(super) fn event(&mut self, bytes: &[u8]) -> &mut Self {
        self.raw(b"E").raw(bytes)
    }

    pub(super) fn end(&mut self) -> &mut Self {
        self.event(b"\xffEnd of log\0")
    }
}
