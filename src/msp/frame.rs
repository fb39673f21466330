//! The frames of MSP, the serial protocol of Betaflight's configurators: version 1, version 2, version 2 tunnelled
//! through version 1, and the jumbo form of replies that a version 1 size byte cannot hold.
//!
//! ```text
//! v1      '$' 'M' kind size code payload… xor            xor over size, code, payload
//! jumbo   '$' 'M' kind 255  code size:u16 payload… xor   xor over 255, code, size, payload
//! v2      '$' 'X' kind flags code:u16 size:u16 payload… crc8          crc over flags … payload
//! tunnel  '$' 'M' kind n 255 [flags code:u16 size:u16 payload… crc8] xor      n counts the brackets
//! ```
//!
//! All integers are little-endian. The CRC is CRC-8/DVB-S2. In a jumbo tunnel `n` is 255, and the `u16`
//! length of the brackets follows the five header bytes of version 2, before its payload.

mod decoder;

pub use decoder::{Decoder, Dropped};

/// The largest payload of a request. A longer one is dropped without an answer.
pub const MAX_REQUEST: usize = 192;

/// The largest payload of a reply that a [`Decoder::client`] accepts.
pub const MAX_REPLY: usize = 8192;

/// The version 1 code that marks a tunnelled version 2 frame.
const TUNNEL: u8 = 255;

/// The version 1 size byte that marks a jumbo frame.
const JUMBO: u8 = 255;

/// Bytes of a version 2 header after the direction: flags, code, size.
const V2_HEADER: usize = 5;

static DVB_S2: crc::Crc<u8> = crc::Crc::<u8>::new(&crc::CRC_8_DVB_S2);

/// The shape of a frame. A reply has the shape of its request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Form {
    /// Version 1, jumbo when the payload needs it.
    V1,
    /// Version 2.
    V2,
    /// Version 2 inside a version 1 frame.
    V2OverV1,
}

/// The kind of a frame, the character after the header.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// `<`: to the flight controller.
    Request,
    /// `>`: the reply.
    Reply,
    /// `!`: the reply when the request is unknown or refused.
    Error,
}

impl Kind {
    fn from_byte(byte: u8) -> Option<Self> {
        match byte {
            b'<' => Some(Self::Request),
            b'>' => Some(Self::Reply),
            b'!' => Some(Self::Error),
            _ => None,
        }
    }

    fn byte(self) -> u8 {
        match self {
            Self::Request => b'<',
            Self::Reply => b'>',
            Self::Error => b'!',
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame {
    /// The shape on the wire.
    pub form: Form,
    /// Request, reply or error.
    pub kind: Kind,
    /// The message code. Version 1 carries only the low byte.
    pub code: u16,
    pub payload: Vec<u8>,
}

impl Frame {
    pub fn request(form: Form, code: u16, payload: &[u8]) -> Self {
        Self { form, kind: Kind::Request, code, payload: payload.to_vec() }
    }

    /// Returns the answer to this frame: a reply with the payload, or an error for `None`.
    pub fn answer(&self, payload: Option<Vec<u8>>) -> Self {
        let kind = if payload.is_some() { Kind::Reply } else { Kind::Error };
        Self { form: self.form, kind, code: self.code, payload: payload.unwrap_or_default() }
    }

    /// Appends the frame's bytes to `out`. A payload above 65 529 bytes is truncated to that length, the
    /// maximum that the size fields of every form can express.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let payload = &self.payload[..self.payload.len().min(usize::from(u16::MAX) - V2_HEADER - 1)];
        match self.form {
            Form::V1 => encode_v1(self.kind, self.code as u8, payload, out),
            Form::V2 => encode_v2(self.kind, self.code, payload, out),
            Form::V2OverV1 => encode_tunnel(self.kind, self.code, payload, out),
        }
    }
}

fn xor(bytes: &[u8]) -> u8 {
    bytes.iter().fold(0, |sum, byte| sum ^ byte)
}

fn v2_header(code: u16, payload: &[u8]) -> [u8; V2_HEADER] {
    let [code_low, code_high] = code.to_le_bytes();
    let [size_low, size_high] = (payload.len() as u16).to_le_bytes();
    [0, code_low, code_high, size_low, size_high]
}

fn v2_crc(header: [u8; V2_HEADER], payload: &[u8]) -> u8 {
    let mut crc = DVB_S2.digest();
    crc.update(&header);
    crc.update(payload);
    crc.finalize()
}

fn encode_v1(kind: Kind, code: u8, payload: &[u8], out: &mut Vec<u8>) {
    out.extend([b'$', b'M', kind.byte()]);
    let checked = out.len();
    if payload.len() < usize::from(JUMBO) {
        out.extend([payload.len() as u8, code]);
    } else {
        out.extend([JUMBO, code]);
        out.extend((payload.len() as u16).to_le_bytes());
    }
    out.extend(payload);
    out.push(xor(&out[checked..]));
}

fn encode_v2(kind: Kind, code: u16, payload: &[u8], out: &mut Vec<u8>) {
    let header = v2_header(code, payload);
    out.extend([b'$', b'X', kind.byte()]);
    out.extend(header);
    out.extend(payload);
    out.push(v2_crc(header, payload));
}

fn encode_tunnel(kind: Kind, code: u16, payload: &[u8], out: &mut Vec<u8>) {
    let header = v2_header(code, payload);
    let body = V2_HEADER + payload.len() + 1;
    out.extend([b'$', b'M', kind.byte()]);
    let checked = out.len();
    if body < usize::from(JUMBO) {
        out.extend([body as u8, TUNNEL]);
        out.extend(header);
    } else {
        out.extend([JUMBO, TUNNEL]);
        out.extend(header);
        out.extend((body as u16).to_le_bytes());
    }
    out.extend(payload);
    out.push(v2_crc(header, payload));
    out.push(xor(&out[checked..]));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the bytes of a reply with a payload of this length.
    fn reply(form: Form, length: usize) -> Vec<u8> {
        let mut bytes = Vec::new();
        Frame { form, kind: Kind::Reply, code: 116, payload: vec![7; length] }.encode(&mut bytes);
        bytes
    }

    #[test]
    fn crc_check_value() {
        assert_eq!(DVB_S2.checksum(b"123456789"), 0xbc);
    }

    #[test]
    fn a_payload_of_254_is_plain_and_of_255_is_jumbo() {
        let plain = reply(Form::V1, 254);
        assert_eq!(&plain[..5], &[b'$', b'M', b'>', 254, 116]);
        assert_eq!(plain.len(), 5 + 254 + 1);
        let jumbo = reply(Form::V1, 255);
        assert_eq!(&jumbo[..7], &[b'$', b'M', b'>', 255, 116, 255, 0]);
        assert_eq!(jumbo.len(), 7 + 255 + 1);
    }

    #[test]
    fn a_jumbo_tunnel_names_the_length_of_its_body_after_the_inner_header() {
        let bytes = reply(Form::V2OverV1, 287);
        // 287 = 0x011f payload, 293 = 0x0125 with header and CRC.
        assert_eq!(&bytes[..12], &[b'$', b'M', b'>', 255, 255, 0, 116, 0, 0x1f, 1, 0x25, 1]);
        assert_eq!(bytes.len(), 12 + 287 + 2);
    }
}
