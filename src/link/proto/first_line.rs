//! Tells browsers from serial clients by the first line of a connection.
//!
//! Any web page can make a browser send a request to a port of this machine, with bytes of its choice in the body. So the
//! first line of a connection is looked at before any of it is interpreted: a request line of HTTP or a TLS hello ends the
//! connection. A serial client begins with an MSP frame, `#` or STX, and is not held up; what comes before these means
//! nothing to anybody and is dropped.

/// Opens the command line for a person.
const HASH: u8 = b'#';
/// Opens the command line for one batch of lines.
const STX: u8 = 0x02;
/// How the requests of MSP begin.
const MSP_STARTS: [&[u8]; 2] = [b"$M<", b"$X<"];
/// How a TLS hello begins: a handshake record of version 3.
const TLS_START: [u8; 2] = [0x16, 0x03];
/// What ends a request line, before the digits of the version.
const HTTP_VERSION: &[u8] = b" HTTP/";
/// As much of the line as is looked back at.
const TAIL: usize = HTTP_VERSION.len() + 1;
/// A first line that is longer is no request line: browsers send less.
const LINE_MAX: usize = 4 * 1024 * 1024;

/// What speaks where only MSP and the command line are understood.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, strum::Display)]
pub enum ForeignProtocol {
    /// A browser, or something that speaks like one.
    #[strum(to_string = "HTTP")]
    Http,
    /// The same, encrypted.
    #[strum(to_string = "TLS")]
    Tls,
}

/// What is known of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Nothing yet that a serial client would say.
    Unknown,
    /// A serial client, whose first line goes on.
    Serial,
    /// The first line is over.
    Over,
}

/// Looks at the first line of one connection. Holds at most a few bytes of it.
#[derive(Debug, Clone)]
pub struct FirstLine {
    stage: Stage,
    tail: arrayvec::ArrayVec<u8, TAIL>,
    length: usize,
}

impl Default for FirstLine {
    fn default() -> Self {
        Self { stage: Stage::Unknown, tail: arrayvec::ArrayVec::new(), length: 0 }
    }
}

impl FirstLine {
    /// Takes the next bytes of the connection; gives those that are for the serial session.
    ///
    /// # Errors
    /// When the connection is to be closed, and nothing that came is to be interpreted.
    pub fn take(&mut self, bytes: &[u8]) -> Result<Vec<u8>, ForeignProtocol> {
        let mut passed = Vec::new();
        let mut rest = bytes.iter();
        while self.stage != Stage::Over
            && let Some(&byte) = rest.next()
        {
            let was_serial = self.stage == Stage::Serial;
            self.look_at(byte)?;
            if was_serial {
                passed.push(byte);
            } else if self.stage == Stage::Serial {
                // The beginning of a frame may have come before.
                passed.extend_from_slice(self.start());
            }
        }
        passed.extend(rest);
        Ok(passed)
    }

    fn look_at(&mut self, byte: u8) -> Result<(), ForeignProtocol> {
        if matches!(byte, b'\r' | b'\n') && self.length == 0 {
            // A server skips empty lines before a request.
            return Ok(());
        }
        self.length += 1;
        if self.tail.is_full() {
            self.tail.remove(0);
        }
        self.tail.push(byte);
        if self.is_http() {
            return Err(ForeignProtocol::Http);
        }
        if self.length == TLS_START.len() && self.tail[..] == TLS_START {
            return Err(ForeignProtocol::Tls);
        }
        if byte == b'\n' || self.length > LINE_MAX {
            self.stage = Stage::Over;
        } else if self.stage == Stage::Unknown && !self.start().is_empty() {
            self.stage = Stage::Serial;
        }
        Ok(())
    }

    /// Whether the line is a request line, as far as it came. What is certain to come from a serial client may hold a
    /// blank and a slash.
    fn is_http(&self) -> bool {
        let tail = &self.tail[..];
        if let Some((digit, before)) = tail.split_last()
            && digit.is_ascii_digit()
            && before.ends_with(HTTP_VERSION)
        {
            return true;
        }
        self.stage == Stage::Unknown
            && matches!(tail, [.., method, b' ', b'/' | b'*'] if is_in_method(*method))
    }

    /// What the line ends with, when that is how a serial client begins.
    fn start(&self) -> &[u8] {
        let tail = &self.tail[..];
        match tail.last() {
            Some(&HASH | &STX) => &tail[tail.len() - 1..],
            _ => MSP_STARTS.into_iter().find(|start| tail.ends_with(start)).unwrap_or_default(),
        }
    }
}

/// A character that the name of a method may hold.
fn is_in_method(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || b"!#$%&'*+-.^_`|~".contains(&byte)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: &[u8] = b"$M<\x00\x01\x01";

    /// What is passed on of bytes that come in pieces of this size.
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
            "rubbish and more GET / HTTP/1.1",
            "\0\x01\x7f\tPOST / HTTP/1.1",
            "# GET / HTTP/1.1",
            "\x02POST craft HTTP/1.1",
        ] {
            requests.push([line.as_bytes(), b"\r\nHost: x\r\n\r\n", FRAME].concat());
        }
        requests.push([b"POST /".as_slice(), &[b'a'; 100_000], b" HTTP/1.1\r\n\r\n", FRAME].concat());
        for request in requests {
            assert_eq!(
                take(&request, request.len()),
                Err(ForeignProtocol::Http),
                "{}",
                request.escape_ascii()
            );
            assert_eq!(take(&request, 1), Err(ForeignProtocol::Http), "{}", request.escape_ascii());
        }
        // Without a blank line nothing of it was passed on before.
        let mut line = FirstLine::default();
        for piece in [b"PO".as_slice(), b"ST", b" "] {
            assert_eq!(line.take(piece), Ok(Vec::new()));
        }
        assert_eq!(line.take(b"/"), Err(ForeignProtocol::Http));
    }

    #[test]
    fn a_tls_hello_is_refused() {
        let hello = b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03$M<\x00\x01\x01";
        assert_eq!(take(hello, 100), Err(ForeignProtocol::Tls));
        assert_eq!(take(hello, 1), Err(ForeignProtocol::Tls));
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
            }
        }
    }

    #[test]
    fn what_means_nothing_is_dropped_until_a_serial_client_begins() {
        for before in [b"\r\n".as_slice(), b"\r", b"xyz", b"\0\0\xff", b"$", b"$M", b"$$M$X"] {
            let bytes = [before, FRAME].concat();
            for size in [1, 2, 100] {
                assert_eq!(take(&bytes, size).as_deref(), Ok(FRAME), "{}", bytes.escape_ascii());
            }
        }
        assert_eq!(take(b"hello\n#", 100).as_deref(), Ok(b"#".as_slice()));
    }

    #[test]
    fn megabytes_without_a_line_end_are_not_kept() {
        let mut line = FirstLine::default();
        for _ in 0..10 {
            assert_eq!(line.take(&[b'x'; 1 << 16]), Ok(Vec::new()));
        }
        assert_eq!(line.take(FRAME).as_deref(), Ok(FRAME));
    }
}
