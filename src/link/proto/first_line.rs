//! Separates serial clients from everything else by the first bytes of a connection.
//!
//! Any web page can make a browser connect to a port of this machine: an HTTP request carries bytes of the
//! page's choice, and WebRTC sends STUN messages that contain random bytes. So the first byte that is not
//! blank decides before any byte is interpreted: a serial client begins with the `$` of an MSP frame, `#` or
//! STX. Anything else ends the connection, and so does a first line that turns out to be an HTTP request
//! line.

/// Opens the command line for a person.
const HASH: u8 = b'#';
/// Opens the command line for one batch of lines.
const STX: u8 = 0x02;
/// The first byte of an MSP frame.
const DOLLAR: u8 = b'$';
/// The first byte of a TLS hello: the type of a handshake record.
const TLS_HANDSHAKE: u8 = 0x16;
/// The end of a request line, before the digits of the version.
const HTTP_VERSION: &[u8] = b" HTTP/";
/// The number of recent bytes that are kept for comparison.
const TAIL: usize = HTTP_VERSION.len() + 1;
/// The longest request line. Browsers send less.
const LINE_MAX: usize = 4 * 1024 * 1024;

/// A protocol that serial clients do not speak, as far as the beginning of the connection shows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ForeignProtocol {
    /// An HTTP request, or a word in capitals, which cannot be distinguished from one.
    Http,
    Tls,
    /// Binary data, such as the STUN messages of WebRTC.
    Binary,
    /// Text without the `#` that opens the command line.
    Text,
}

impl ForeignProtocol {
    /// Returns the protocol of a connection that begins with this byte. No serial client begins with it.
    fn of(first: u8) -> Self {
        match first {
            TLS_HANDSHAKE => Self::Tls,
            b'A'..=b'Z' => Self::Http,
            b'!'..=b'~' | b'\t' => Self::Text,
            _ => Self::Binary,
        }
    }
}

/// The progress of a first line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Only blanks have arrived.
    Blank,
    /// A serial client, whose first line continues.
    Serial,
    /// The first line has ended.
    Over,
}

/// Examines the first line of one connection. Keeps at most a few bytes of it.
#[derive(Debug, Clone)]
pub struct FirstLine {
    stage: Stage,
    tail: arrayvec::ArrayVec<u8, TAIL>,
    length: usize,
}

impl Default for FirstLine {
    fn default() -> Self {
        Self { stage: Stage::Blank, tail: arrayvec::ArrayVec::new(), length: 0 }
    }
}

impl FirstLine {
    /// Takes the next bytes of the connection. Returns the bytes for the serial session, without the blanks
    /// before them.
    ///
    /// # Errors
    /// Returns the foreign protocol if the connection must be closed and none of its bytes may be
    /// interpreted.
    pub fn take<'a>(&mut self, bytes: &'a [u8]) -> Result<&'a [u8], ForeignProtocol> {
        let mut rest = bytes;
        while self.stage == Stage::Blank
            && let Some((&first, after)) = rest.split_first()
        {
            match first {
                b'\r' | b'\n' | b' ' => rest = after,
                DOLLAR | HASH | STX => self.stage = Stage::Serial,
                _ => return Err(ForeignProtocol::of(first)),
            }
        }
        for &byte in rest {
            if self.stage != Stage::Serial {
                break;
            }
            self.look_at(byte)?;
        }
        Ok(rest)
    }

    fn look_at(&mut self, byte: u8) -> Result<(), ForeignProtocol> {
        self.length += 1;
        if byte.is_ascii_digit() && self.tail.ends_with(HTTP_VERSION) {
            return Err(ForeignProtocol::Http);
        }
        if self.tail.is_full() {
            self.tail.remove(0);
        }
        self.tail.push(byte);
        if byte == b'\n' || self.length > LINE_MAX {
            self.stage = Stage::Over;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: &[u8] = b"$M<\x00\x01\x01";

    /// Returns the bytes that are passed on when they arrive in pieces of this size.
    fn take(bytes: &[u8], size: usize) -> Result<Vec<u8>, ForeignProtocol> {
        let mut line = FirstLine::default();
        let pieces: Result<Vec<_>, _> = bytes.chunks(size).map(|piece| line.take(piece)).collect();
        Ok(pieces?.concat())
    }

    #[test]
    fn requests_of_browsers_are_refused_before_a_byte_is_interpreted() {
        let mut requests: Vec<Vec<u8>> = Vec::new();
        for line in [
            "GET / HTTP/1.1",
            "POST / HTTP/1.1",
            "OPTIONS * HTTP/1.1",
            "BREW /pot?a=$M< HTTP/1.1",
            "CONNECT craft.example:443 HTTP/1.1",
            "GET http://127.0.0.1:5761/ HTTP/1.1",
            "PRI * HTTP/2.0",
            "\r\n\r\nPOST / HTTP/1.0",
            "# GET / HTTP/1.1",
            "\x02POST craft HTTP/1.1",
            " $GET / HTTP/1.1",
        ] {
            requests.push([line.as_bytes(), b"\r\nHost: x\r\n\r\n", FRAME].concat());
        }
        for request in requests {
            for size in [1, request.len()] {
                let taken = take(&request, size);
                assert_eq!(taken, Err(ForeignProtocol::Http), "{}", request.escape_ascii());
            }
        }
        assert_eq!(FirstLine::default().take(b"P"), Err(ForeignProtocol::Http), "the first byte decides");
    }

    #[test]
    fn a_first_byte_that_no_serial_client_sends_is_refused() {
        for byte in 0..=u8::MAX {
            let taken = FirstLine::default().take(&[byte, b'#']).map(<[u8]>::len);
            let expected = match byte {
                b'$' | b'#' | 0x02 => Ok(2),
                b'\r' | b'\n' | b' ' => Ok(1),
                0x16 => Err(ForeignProtocol::Tls),
                b'A'..=b'Z' => Err(ForeignProtocol::Http),
                b'\t' | b'!'..=b'~' => Err(ForeignProtocol::Text),
                _ => Err(ForeignProtocol::Binary),
            };
            assert_eq!(taken, expected, "{byte:#x}");
        }
    }

    #[test]
    fn blanks_before_a_stranger_do_not_let_it_in() {
        for (bytes, protocol) in [
            (b"\r\n \0\x64".as_slice(), ForeignProtocol::Binary),
            (b"\n\x16\x03\x01", ForeignProtocol::Tls),
            (b"  hello #", ForeignProtocol::Text),
        ] {
            for size in [1, 2, 100] {
                assert_eq!(take(bytes, size), Err(protocol), "{}", bytes.escape_ascii());
            }
        }
    }

    #[test]
    fn serial_clients_are_passed_on_at_once() {
        for bytes in [
            FRAME,
            b"$X<\x00\x01\x00\x00\x00\x00\x6e",
            b"#",
            b"#\r\nstatus\r\n",
            b"# a note / HTTP is not meant\nset name = a /b\n",
            b"\x02get name\n\x03",
            b"$M<\x00\x01\x01\nGET / HTTP/1.1\r\n",
        ] {
            for size in [1, 2, 100] {
                assert_eq!(take(bytes, size).as_deref(), Ok(bytes), "{}", bytes.escape_ascii());
                let after_blanks = [b" \r\n\r\n", bytes].concat();
                assert_eq!(take(&after_blanks, size).as_deref(), Ok(bytes), "{}", bytes.escape_ascii());
            }
        }
    }
}
