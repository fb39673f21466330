//! Decodes MSP bytes, in pieces of any size, into frames.

use super::{DVB_S2, Form, Frame, JUMBO, Kind, MAX_REPLY, MAX_REQUEST, TUNNEL, V2_HEADER};

/// The numbers of dropped frames, by cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Dropped {
    /// The XOR or CRC did not match.
    pub checksum: u64,
    /// The size was above the limit.
    pub oversized: u64,
    /// The bytes began like a frame but were none.
    pub malformed: u64,
}

/// The expected meaning of the next byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Expect {
    Dollar,
    Version,
    Kind,
    V1Size,
    V1Code,
    JumboLow,
    JumboHigh,
    V2Header(usize),
    Payload,
    V2Crc,
    V1Xor,
}

/// Turns a byte stream into frames. A damaged frame is dropped, and the decoder waits for the next `$`. It
/// holds at most one payload up to its limit. The payload grows as bytes arrive and is never allocated from
/// an announced size.
#[derive(Debug, Clone)]
pub struct Decoder {
    is_server: bool,
    limit: usize,
    expect: Expect,
    form: Form,
    kind: Kind,
    code: u16,
    v1_size: u8,
    size: usize,
    jumbo_low: u8,
    header: [u8; V2_HEADER],
    payload: Vec<u8>,
    xor: u8,
    dropped: Dropped,
    /// The bytes that may still arrive of the last frame that was dropped for its size.
    oversized_rest: usize,
}

impl Decoder {
    /// Creates a decoder for the flight controller's side. It accepts requests up to [`MAX_REQUEST`] and
    /// silently consumes replies that an echoing line sends back.
    pub fn server() -> Self {
        Self::new(true, MAX_REQUEST)
    }

    /// Creates a decoder for the configurator's side. It accepts replies and errors up to [`MAX_REPLY`].
    pub fn client() -> Self {
        Self::new(false, MAX_REPLY)
    }

    fn new(is_server: bool, limit: usize) -> Self {
        Self {
            is_server,
            limit,
            expect: Expect::Dollar,
            form: Form::V1,
            kind: Kind::Request,
            code: 0,
            v1_size: 0,
            size: 0,
            jumbo_low: 0,
            header: [0; V2_HEADER],
            payload: Vec::new(),
            xor: 0,
            dropped: Dropped::default(),
            oversized_rest: 0,
        }
    }

    /// Returns `true` if the next byte is between frames.
    pub fn is_between_frames(&self) -> bool {
        self.expect == Expect::Dollar
    }

    /// Returns the numbers of frames dropped so far.
    pub fn dropped(&self) -> Dropped {
        self.dropped
    }

    /// Returns the bytes that may still arrive of the last frame that was dropped for its size: payload and
    /// checksums.
    pub fn oversized_rest(&self) -> usize {
        self.oversized_rest
    }

    /// Takes one byte. Returns a frame if the byte completes one.
    pub fn push(&mut self, byte: u8) -> Option<Frame> {
        if !matches!(self.expect, Expect::V1Xor | Expect::Dollar | Expect::Version | Expect::Kind) {
            self.xor ^= byte;
        }
        match self.expect {
            Expect::Dollar => {
                if byte == b'$' {
                    self.expect = Expect::Version;
                }
            }
            Expect::Version => match byte {
                b'M' => self.begin(Form::V1),
                b'X' => self.begin(Form::V2),
                b'$' => {}
                _ => self.malformed(),
            },
            Expect::Kind => match Kind::from_byte(byte) {
                Some(Kind::Error) if self.is_server => self.malformed(),
                Some(kind) => {
                    self.kind = kind;
                    self.expect = if self.form == Form::V1 { Expect::V1Size } else { Expect::V2Header(0) };
                }
                None => self.malformed(),
            },
            Expect::V1Size => self.v1_size(byte),
            Expect::V1Code => self.v1_code(byte),
            Expect::JumboLow => {
                self.jumbo_low = byte;
                self.expect = Expect::JumboHigh;
            }
            Expect::JumboHigh => self.jumbo_high(byte),
            Expect::V2Header(at) => self.v2_header(at, byte),
            Expect::Payload => {
                self.payload.push(byte);
                if self.payload.len() == self.size {
                    self.expect = self.after_payload();
                }
            }
            Expect::V2Crc => return self.v2_crc(byte),
            Expect::V1Xor => return self.finish(byte == self.xor),
        }
        None
    }

    fn begin(&mut self, form: Form) {
        self.form = form;
        self.xor = 0;
        self.payload.clear();
        self.expect = Expect::Kind;
    }

    fn malformed(&mut self) {
        self.dropped.malformed += 1;
        self.expect = Expect::Dollar;
    }

    fn oversized(&mut self) {
        self.dropped.oversized += 1;
        self.oversized_rest = self.size + 2;
        self.expect = Expect::Dollar;
    }

    fn v1_size(&mut self, byte: u8) {
        self.v1_size = byte;
        self.size = usize::from(byte);
        // Only replies are jumbo.
        if self.is_server && self.size > self.limit {
            self.oversized();
        } else {
            self.expect = Expect::V1Code;
        }
    }

    fn v1_code(&mut self, byte: u8) {
        self.code = u16::from(byte);
        if byte == TUNNEL {
            self.form = Form::V2OverV1;
            if self.size <= V2_HEADER {
                self.malformed();
            } else {
                self.expect = Expect::V2Header(0);
            }
        } else if self.v1_size == JUMBO {
            self.expect = Expect::JumboLow;
        } else {
            self.expect_payload();
        }
    }

    fn jumbo_high(&mut self, byte: u8) {
        let announced = usize::from(u16::from_le_bytes([self.jumbo_low, byte]));
        if self.form == Form::V2OverV1 {
            // The inner size is known already. This one also counts header and CRC.
            if announced == V2_HEADER + self.size + 1 {
                self.expect_payload();
            } else {
                self.malformed();
            }
        } else {
            self.size = announced;
            self.expect_payload();
        }
    }

    fn v2_header(&mut self, at: usize, byte: u8) {
        self.header[at] = byte;
        if at + 1 < V2_HEADER {
            self.expect = Expect::V2Header(at + 1);
            return;
        }
        let [_, code_low, code_high, size_low, size_high] = self.header;
        self.code = u16::from_le_bytes([code_low, code_high]);
        self.size = usize::from(u16::from_le_bytes([size_low, size_high]));
        if self.size > self.limit {
            self.oversized();
        } else if self.form == Form::V2OverV1 && self.v1_size == JUMBO {
            self.expect = Expect::JumboLow;
        } else if self.form == Form::V2OverV1 && usize::from(self.v1_size) != V2_HEADER + self.size + 1 {
            self.malformed();
        } else {
            self.expect_payload();
        }
    }

    fn expect_payload(&mut self) {
        if self.size > self.limit {
            self.oversized();
        } else if self.size == 0 {
            self.expect = self.after_payload();
        } else {
            self.expect = Expect::Payload;
        }
    }

    fn after_payload(&self) -> Expect {
        if self.form == Form::V1 { Expect::V1Xor } else { Expect::V2Crc }
    }

    fn v2_crc(&mut self, byte: u8) -> Option<Frame> {
        let mut crc = DVB_S2.digest();
        crc.update(&self.header);
        crc.update(&self.payload);
        let matches = crc.finalize() == byte;
        if matches && self.form == Form::V2OverV1 {
            self.expect = Expect::V1Xor;
            return None;
        }
        self.finish(matches)
    }

    fn finish(&mut self, checksum_matches: bool) -> Option<Frame> {
        self.expect = Expect::Dollar;
        if !checksum_matches {
            self.dropped.checksum += 1;
            return None;
        }
        if self.is_server != (self.kind == Kind::Request) {
            return None;
        }
        let payload = std::mem::take(&mut self.payload);
        Some(Frame { form: self.form, kind: self.kind, code: self.code, payload })
    }
}
