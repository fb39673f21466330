//! The serial port of the stand-in: lines of the tests, and the part of MSP and of the command line that a ground station
//! needs to know a firmware.

use betadeck::msp::{Decoder, Frame, code};

const STX: u8 = 0x02;
const ETX: u8 = 0x03;
/// The boxes: ARM, FAILSAFE.
const BOXES: [u8; 2] = [0, 27];
/// ARM on AUX1 above 1700 µs.
const MODE_RANGES: [u8; 4] = [0, 0, 32, 48];
/// The bits of the arming disable flags THROTTLE and ARM_SWITCH.
const BLOCKED: u32 = 1 << 7 | 1 << 29;

/// The current meaning of the bytes.
#[derive(Default, PartialEq)]
enum Mode {
    #[default]
    Frames,
    Framed,
    Prompt,
}

/// An effect of a byte.
pub(crate) enum Effect {
    Send(Vec<u8>),
    /// A line of a test.
    Line(String),
    /// A line of the command line that ends the program.
    Save,
}

pub(crate) struct SerialPort {
    decoder: Decoder,
    mode: Mode,
    line: Vec<u8>,
}

impl Default for SerialPort {
    fn default() -> Self {
        Self { decoder: Decoder::server(), mode: Mode::default(), line: Vec::new() }
    }
}

impl SerialPort {
    /// Takes a byte. `rc` is the newest RC packet.
    pub(crate) fn take(&mut self, byte: u8, rc: &[u8; 40]) -> Option<Effect> {
        let is_frame = !self.decoder.is_between_frames() || byte == b'$';
        match (&self.mode, byte) {
            (Mode::Frames, _) if self.line.is_empty() && is_frame => {
                let frame = self.decoder.push(byte)?;
                Some(Effect::Send(test_support::msp_bytes(&frame.answer(payload(&frame, rc)))))
            }
            (Mode::Frames, STX) => {
                self.mode = Mode::Framed;
                Some(Effect::Send(vec![STX]))
            }
            (Mode::Frames, b'#') if self.line.is_empty() => {
                self.mode = Mode::Prompt;
                Some(Effect::Send(b"\r\nEntering CLI Mode\r\n\r\n# ".to_vec()))
            }
            (Mode::Framed, ETX) => {
                self.mode = Mode::Frames;
                Some(if self.take_line() == "save" { Effect::Save } else { Effect::Send(vec![ETX]) })
            }
            (Mode::Prompt, b'\n') => {
                let line = self.take_line();
                if line == "exit noreboot" {
                    self.mode = Mode::Frames;
                    return Some(Effect::Send(
                        b"exit noreboot\r\n\r\n# leaving CLI mode, no reboot\r\n".to_vec(),
                    ));
                }
                Some(Effect::Send(format!("{line}\r\n{}\r\n# ", answer_at_prompt(&line)).into_bytes()))
            }
            (Mode::Frames, b'\n') => Some(Effect::Line(self.take_line())),
            _ => {
                self.line.push(byte);
                None
            }
        }
    }

    fn take_line(&mut self) -> String {
        String::from_utf8(std::mem::take(&mut self.line)).unwrap().trim().to_owned()
    }
}

/// Returns the answer to a line at the prompt, which differs from every answer of another firmware.
pub(crate) fn answer_at_prompt(line: &str) -> String {
    format!("the stand-in does not know {line}")
}

fn payload(frame: &Frame, rc: &[u8; 40]) -> Option<Vec<u8>> {
    let channel = |at: usize| u16::from_le_bytes([rc[8 + 2 * at], rc[9 + 2 * at]]);
    Some(match frame.code {
        code::API_VERSION => vec![0, 1, 49],
        code::FC_VARIANT => b"BTFL".to_vec(),
        code::BOXIDS => BOXES.to_vec(),
        code::MODE_RANGES => MODE_RANGES.to_vec(),
        // Roll, pitch, yaw, throttle.
        code::RC => [0, 1, 3, 2].into_iter().chain(4..16).flat_map(|at| channel(at).to_le_bytes()).collect(),
        code::STATUS_EX => {
            let is_blocked = channel(4) > 1700 && channel(2) > 1050;
            let flags = if is_blocked { BLOCKED } else { 0 };
            let mut status = vec![0; 27];
            status[16] = 30;
            status[17..21].copy_from_slice(&flags.to_le_bytes());
            status
        }
        _ => return None,
    })
}
