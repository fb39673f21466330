//! The serial port of the stand-in: MSP, and the command line with both framings. Its state outlives a client: a
//! command line that one client leaves open is open for the next.

use super::cli::{Done, Memory};
use super::msp::{self, Front, Request};
use super::receiver::Receiver;

/// The time after `#` without a `$` at which the prompt opens, µs.
const PROMPT_US: u64 = 100_000;
const GREETING: &str = "\r\nEntering CLI Mode, type 'exit' to reboot, or 'help'\r\n\r\n# ";
/// Boxes in the order of the mode bits: ARM, ANGLE, ALTHOLD, FAILSAFE, POS HOLD, GPS RESCUE, AUTOPILOT.
const BOXES: [u8; 7] = [0, 1, 3, 27, 11, 46, 56];
/// The arming disable flag BOOTGRACE, set for the first 5 s.
const BOOT_GRACE: u32 = 1 << 9;
const RX_LOSS: u32 = 1 << 2;
const CLI: u32 = 1 << 13;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Msp,
    /// `#` arrived at this time, µs, and no `$` since.
    Asked(u64),
    Framed,
    Prompt,
}

#[derive(Debug)]
pub(crate) struct Serial {
    mode: Mode,
    input: Vec<u8>,
    line: String,
    output: Vec<u8>,
    /// `true` once a command line was open: no arming until the next start.
    was_in_cli: bool,
    pub(crate) memory: Memory,
    /// The last RC channels, and their time, µs.
    pub(crate) rc: Option<([u16; 16], u64)>,
    reboots: bool,
}

impl Serial {
    pub(crate) fn new(memory: Memory) -> Self {
        Self {
            mode: Mode::Msp,
            input: Vec::new(),
            line: String::new(),
            output: Vec::new(),
            was_in_cli: false,
            memory,
            rc: None,
            reboots: false,
        }
    }

    /// Takes bytes of the client and returns the output. Answers at most one message, as the real executable does in
    /// its 10 ms.
    pub(crate) fn turn(&mut self, came: &[u8], receiver: &Receiver, wall_us: u64) -> Vec<u8> {
        self.input.extend(came);
        if let Mode::Asked(since) = self.mode {
            if self.input.contains(&b'$') {
                self.mode = Mode::Msp;
            } else if wall_us >= since + PROMPT_US {
                self.mode = Mode::Prompt;
                self.was_in_cli = true;
                self.output.extend(GREETING.bytes());
            }
        }
        while !self.input.is_empty() && !self.reboots {
            match self.mode {
                Mode::Asked(_) => break,
                Mode::Msp => {
                    if !self.read_msp(receiver, wall_us) {
                        break;
                    }
                }
                Mode::Framed | Mode::Prompt => {
                    let byte = self.input.remove(0);
                    self.type_byte(byte);
                }
            }
        }
        std::mem::take(&mut self.output)
    }

    /// Returns `true` if a line or a message has ended the program.
    pub(crate) fn reboots(&self) -> bool {
        self.reboots
    }

    /// Takes the first item of the input. Returns `false` if more bytes are needed or the turn is over.
    fn read_msp(&mut self, receiver: &Receiver, wall_us: u64) -> bool {
        match self.input[0] {
            0x02 => {
                self.input.remove(0);
                if !self.is_armed(wall_us) {
                    self.mode = Mode::Framed;
                    self.output.push(0x02);
                }
            }
            b'#' => {
                self.input.remove(0);
                if !self.is_armed(wall_us) {
                    self.mode = Mode::Asked(wall_us);
                }
            }
            b'$' => match msp::front(&self.input) {
                Front::Partial => return false,
                Front::Damaged(size) => drop(self.input.drain(..size)),
                Front::Request(request, size) => {
                    self.input.drain(..size);
                    let payload = self.payload(&request, receiver, wall_us);
                    self.output.extend(msp::answer(&request, payload.as_deref()));
                    return false;
                }
            },
            _ => drop(self.input.remove(0)),
        }
        true
    }

    fn type_byte(&mut self, byte: u8) {
        let prompt = self.mode == Mode::Prompt;
        match byte {
            0x03 if !prompt => {
                self.output.push(0x03);
                self.line.clear();
                self.mode = Mode::Msp;
            }
            b'\n' | b'\r' => {
                let line = std::mem::take(&mut self.line);
                if prompt {
                    self.output.extend(b"\r\n");
                }
                self.run(&line, prompt);
            }
            0x20..0x7f => {
                self.line.push(char::from(byte));
                if prompt {
                    self.output.push(byte);
                }
            }
            _ => {}
        }
    }

    fn run(&mut self, line: &str, prompt: bool) {
        let line = line.trim();
        if prompt && line == "exit noreboot" {
            self.output.extend(b"\r\n# leaving CLI mode, no reboot\r\n");
            self.mode = Mode::Msp;
            return;
        }
        if !line.is_empty() {
            match self.memory.run(line) {
                Done::Answered(text) => self.output.extend(text.bytes()),
                Done::Reboots(text) => {
                    self.output.extend(text.bytes());
                    self.reboots = true;
                    return;
                }
            }
        }
        if prompt {
            self.output.extend(b"\r\n# ");
        }
    }

    fn is_armed(&self, wall_us: u64) -> bool {
        self.is_on(0, wall_us) && self.blocks(wall_us) == 0
    }

    /// Returns `true` if a switch has turned on this box.
    fn is_on(&self, id: u16, wall_us: u64) -> bool {
        let Some((channels, _)) = self.rc.filter(|_| self.hears_rc(wall_us)) else { return false };
        let on = |[with, channel, start, end]: &[u16; 4]| {
            let pulse = channels[(4 + usize::from(*channel)).min(15)];
            *with == id && (*start..*end).contains(&pulse)
        };
        self.memory.modes.iter().any(on)
    }

    fn hears_rc(&self, wall_us: u64) -> bool {
        self.rc.is_some_and(|(_, at)| wall_us.saturating_sub(at) < 150_000)
    }

    fn blocks(&self, wall_us: u64) -> u32 {
        let flag = |set: bool, flag: u32| if set { flag } else { 0 };
        flag(wall_us < 5_500_000, BOOT_GRACE)
            | flag(!self.hears_rc(wall_us), RX_LOSS)
            | flag(self.was_in_cli, CLI)
    }

    fn payload(&mut self, request: &Request, receiver: &Receiver, wall_us: u64) -> Option<Vec<u8>> {
        let sensors = receiver.sensors();
        Some(match request.code {
            1 => vec![0, 1, 49],
            2 => b"BTFL".to_vec(),
            3 => [&[26, 12, 0, 15][..], b"2026.12.0-alpha"].concat(),
            4 => [&b"SITL\0\0\0\0\x04SITL"[..], &[0; 34], &[0xfe, 1, 0xe8, 3], &[0; 6]].concat(),
            5 => {
                let plans: &[u8] = if self.memory.has_plans { &[0x2b, 0x40] } else { &[] };
                [&b"Nov 22 202611:00:530000000"[..], &[0x26, 0x40], plans, &[0x1c, 0x40]].concat()
            }
            68 => {
                self.reboots = true;
                vec![0]
            }
            101 | 150 => self.status(wall_us),
            105 => {
                let rc = self.rc.map_or([1500; 16], |(channels, _)| channels);
                // Yaw comes before throttle here.
                let order = [0, 1, 3, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];
                order.iter().flat_map(|&channel| rc[channel].to_le_bytes()).collect()
            }
            106 => position(receiver, wall_us),
            108 => {
                let (roll, pitch, yaw) = sensors?.attitude.euler_angles();
                let heading = (-yaw.to_degrees()).rem_euclid(360.0).round() as i16 % 360;
                let tenths = [roll, pitch].map(|angle| (angle.to_degrees() * 10.0).round() as i16);
                [tenths[0], tenths[1], heading].iter().flat_map(|number| number.to_le_bytes()).collect()
            }
            116 => b"ARM;ANGLE;ALTHOLD;FAILSAFE;POS HOLD;GPS RESCUE;AUTOPILOT;".to_vec(),
            119 => BOXES.to_vec(),
            34 => {
                let steps = |us: u16| ((us - 900) / 25) as u8;
                let slot = |[id, channel, start, end]: &[u16; 4]| {
                    [*id as u8, *channel as u8, steps(*start), steps(*end)]
                };
                self.memory.modes.iter().flat_map(slot).collect()
            }
            0x3012 => {
                let Done::Answered(text) =
                    self.memory.run(std::str::from_utf8(&request.payload).ok()?.trim())
                else {
                    // As a message, `save` stores without a reboot.
                    return Some(b"\x0c\0\0\r\n# saving\r\n".to_vec());
                };
                let size = (text.len().min(2048) as u16).to_le_bytes();
                [&size[..], &[u8::from(text.len() > 509)], &text.as_bytes()[..text.len().min(509)]].concat()
            }
            _ => return None,
        })
    }

    fn status(&self, wall_us: u64) -> Vec<u8> {
        let bits = BOXES.iter().enumerate().map(|(bit, &id)| {
            let on = if id == 0 { self.is_armed(wall_us) } else { self.is_on(u16::from(id), wall_us) };
            u32::from(on) << bit
        });
        let (modes, blocks) = (bits.sum::<u32>(), self.blocks(wall_us));
        let modes = modes.to_le_bytes();
        [
            &[0xe8, 3, 0, 0, 0x2f, 0][..],
            &modes,
            &[0, 10, 0, 4, 0, 0, 30],
            &blocks.to_le_bytes(),
            &[0, 0, 0, 4, 3, 0],
        ]
        .concat()
    }
}

fn position(receiver: &Receiver, wall_us: u64) -> Vec<u8> {
    let fix = if receiver.has_fix(wall_us) { [2, 12] } else { [0, 0] };
    let gps = receiver.sensors().and_then(|sensors| sensors.gps);
    let (lat, lon, alt_m, speed, course) = gps.map_or((0, 0, 0, 0, 0), |gps| {
        let small = |number: i32| number.clamp(0, 65535) as u16;
        (gps.lat, gps.lon, small(gps.alt_cm / 100), small(gps.speed_cms), small(gps.course_decideg))
    });
    let tail = [alt_m, speed, course, 10].map(u16::to_le_bytes).concat();
    [&fix[..], &lat.to_le_bytes(), &lon.to_le_bytes(), &tail].concat()
}
