//! MSP from a client's point of view. The answers are read by separate code.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use betadeck::msp::{Form, Frame};

use super::program::PATIENCE;

/// The arming disable flag of a craft without RC.
const RX_LOSS: u32 = 1 << 2;

/// Returns the bytes of a request.
pub(crate) fn request(code: u8, payload: &[u8]) -> Vec<u8> {
    let size = u8::try_from(payload.len()).unwrap();
    let sum = payload.iter().fold(size ^ code, |sum, byte| sum ^ byte);
    [b"$M<", &[size, code][..], payload, &[sum]].concat()
}

/// Returns the bytes of a version 2 request, for codes that do not fit in a byte.
pub(crate) fn request_v2(code: u16, payload: &[u8]) -> Vec<u8> {
    test_support::msp_bytes(&Frame::request(Form::V2, code, payload))
}

/// Takes a complete answer from the front of `bytes`. Returns its code, and its payload unless it is an
/// error.
pub(crate) fn take_answer(bytes: &mut Vec<u8>) -> Option<(u16, Option<Vec<u8>>)> {
    if bytes.starts_with(b"$X") {
        let &[_, _, kind, _, code_low, code_high, size_low, size_high, ..] = &bytes[..] else { return None };
        let end = 8 + usize::from(u16::from_le_bytes([size_low, size_high]));
        bytes.get(end)?;
        let payload = (kind == b'>').then(|| bytes[8..end].to_vec());
        bytes.drain(..=end);
        return Some((u16::from_le_bytes([code_low, code_high]), payload));
    }
    let (&size, &code) = (bytes.get(3)?, bytes.get(4)?);
    assert_eq!(&bytes[..2], b"$M");
    let (start, size) = match size {
        255 => (7, usize::from(u16::from_le_bytes([*bytes.get(5)?, *bytes.get(6)?]))),
        size => (5, usize::from(size)),
    };
    let sum = *bytes.get(start + size)?;
    assert_eq!(bytes[3..start + size].iter().fold(0, |sum, byte| sum ^ byte), sum, "checksum");
    let payload = (bytes[2] == b'>').then(|| bytes[start..start + size].to_vec());
    bytes.drain(..=start + size);
    Some((u16::from(code), payload))
}

/// Sends a request over a byte stream and reads the answer.
pub(crate) fn ask(stream: &mut (impl Read + Write), code: u8, payload: &[u8]) -> Option<Vec<u8>> {
    stream.write_all(&request(code, payload)).unwrap();
    let (answered, payload) = read_answer(stream);
    assert_eq!(answered, u16::from(code));
    payload
}

/// Sends a version 2 request over a byte stream and reads the answer.
pub(crate) fn ask_v2(stream: &mut (impl Read + Write), code: u16, payload: &[u8]) -> Option<Vec<u8>> {
    stream.write_all(&request_v2(code, payload)).unwrap();
    let (answered, payload) = read_answer(stream);
    assert_eq!(answered, code);
    payload
}

fn read_answer(stream: &mut impl Read) -> (u16, Option<Vec<u8>>) {
    let mut bytes = Vec::new();
    loop {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        bytes.push(byte[0]);
        if let Some(answer) = take_answer(&mut bytes) {
            return answer;
        }
    }
}

/// Waits until only the missing RC blocks arming. The start is then over and there is a fix.
pub(crate) fn wait_until_ready(door: SocketAddr) {
    let mut stream = TcpStream::connect(door).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let start = Instant::now();
    loop {
        let status = ask(&mut stream, 101, &[]).unwrap();
        let blocks = u32::from_le_bytes(status[17..21].try_into().unwrap());
        let has_fix = ask(&mut stream, 106, &[]).unwrap()[0] != 0;
        if blocks == RX_LOSS && has_fix {
            return;
        }
        assert!(start.elapsed() < PATIENCE, "arming is blocked by {blocks:#x}, fix: {has_fix}");
        std::thread::sleep(Duration::from_millis(50));
    }
}
