//! A board that answers MSP and framed command lines.

use crate::msp::{Decoder, Frame, code};

/// The boxes: ARM, FAILSAFE, GPS RESCUE, AUTOPILOT.
const BOXES: [u8; 4] = [0, 27, 46, 56];
/// ARM on AUX1 and GPS RESCUE on AUX3, both above 1700 µs.
const MODE_RANGES: [u8; 8] = [0, 0, 32, 48, 46, 2, 32, 48];

/// The position, degrees × 10⁷ and metres above sea level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub(super) lat: i32,
    pub(super) lon: i32,
    pub(super) alt_m: u16,
}

pub(super) struct Board {
    pub(super) place: Place,
    pub(super) armed: bool,
    /// The pulse of the channel that arms, µs.
    pub(super) arm_us: u16,
    pub(super) silent: bool,
    /// The firmware variant; `None` refuses the request.
    pub(super) variant: Option<&'static [u8]>,
    /// The output for its autopilot settings.
    pub(super) settings: &'static str,
    /// `true` if it has a setting of firmware whose altitudes are above home.
    pub(super) from_home: bool,
    /// `true` if its command line also opens while armed.
    pub(super) answers_in_flight: bool,
    /// The lines that it ran.
    pub(super) lines: Vec<String>,
    pub(super) decoder: Decoder,
    /// The line that is being typed.
    pub(super) line: Option<Vec<u8>>,
}

impl Board {
    pub(super) fn at(place: Place) -> Self {
        Self {
            place,
            armed: false,
            arm_us: 1000,
            silent: false,
            variant: Some(b"BTFL"),
            settings: "ap_waypoint_arrival_radius = 500\r\n",
            from_home: false,
            answers_in_flight: false,
            lines: Vec::new(),
            decoder: Decoder::server(),
            line: None,
        }
    }

    /// Returns its answer to these bytes.
    pub(super) fn answer(&mut self, bytes: &[u8]) -> Vec<u8> {
        let mut output = Vec::new();
        if self.silent {
            return output;
        }
        for &byte in bytes {
            if let Some(line) = &mut self.line {
                line.push(byte);
                if byte == 0x03 {
                    let line = String::from_utf8_lossy(&self.line.take().unwrap_or_default()).into_owned();
                    let line = line.trim_end_matches(['\n', '\x03']);
                    output.extend(self.run(line).bytes());
                    output.push(0x03);
                }
            } else if byte == 0x02 && self.decoder.is_between_frames() {
                if !self.armed || self.answers_in_flight {
                    self.line = Some(Vec::new());
                    output.push(0x02);
                }
            } else if let Some(frame) = self.decoder.push(byte) {
                frame.answer(self.payload(&frame)).encode(&mut output);
            }
        }
        output
    }

    fn run(&mut self, line: &str) -> String {
        self.lines.push(line.to_owned());
        match line {
            "get ap_" if self.from_home => format!("{}ap_velocity_p = 30\r\n", self.settings),
            "get ap_" => self.settings.to_owned(),
            "waypoint list" => String::new(),
            _ => format!("{line}\r\n"),
        }
    }

    fn payload(&self, frame: &Frame) -> Option<Vec<u8>> {
        let Place { lat, lon, alt_m } = self.place;
        Some(match frame.code {
            code::API_VERSION => vec![0, 1, 49],
            code::FC_VARIANT => self.variant?.to_vec(),
            code::FC_VERSION => vec![4, 5, 0],
            code::BOARD_INFO => b"TEST\0\0\0\0\x04TEST".to_vec(),
            code::BUILD_INFO => [&b"Nov 22 202611:00:530000000"[..], &[0x2b, 0x40]].concat(),
            code::MODE_RANGES => MODE_RANGES.to_vec(),
            code::MOTOR => [1500_u16; 4].map(u16::to_le_bytes).concat(),
            code::RC => {
                let mut channels = [1500_u16; 16];
                channels[4] = self.arm_us;
                channels.map(u16::to_le_bytes).concat()
            }
            code::RAW_GPS => {
                let head = [&[2, 12][..], &lat.to_le_bytes(), &lon.to_le_bytes()].concat();
                [&head[..], &alt_m.to_le_bytes(), &[0; 6]].concat()
            }
            code::BOXIDS => BOXES.to_vec(),
            code::STATUS_EX => {
                let modes = u32::from(self.armed).to_le_bytes();
                let head = [&[0xe8, 3, 0, 0, 0x2f, 0][..], &modes, &[0, 10, 0, 4, 0, 0, 30]].concat();
                [&head[..], &[0; 10]].concat()
            }
            _ => return None,
        })
    }
}
