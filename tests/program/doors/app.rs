//! The App over its websocket: its connection, its polling, and its use of the command line.

use std::net::{SocketAddr, TcpStream};

use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::http::HeaderValue;
use tokio_tungstenite::tungstenite::{Error, Message, WebSocket};

use super::msp;
use super::program::PATIENCE;

/// GET_TEXT.
const TEXT: u16 = 0x3006;

pub(crate) struct App {
    socket: WebSocket<TcpStream>,
    bytes: Vec<u8>,
}

impl App {
    pub(crate) fn open(address: SocketAddr) -> Self {
        let mut request = format!("ws://{address}/").into_client_request().unwrap();
        let headers = request.headers_mut();
        headers.insert("Origin", HeaderValue::from_static("https://app.betaflight.com"));
        headers.insert("Sec-WebSocket-Protocol", HeaderValue::from_static("binary"));
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_nodelay(true).unwrap();
        let (socket, response) = tokio_tungstenite::tungstenite::client(request, stream).unwrap();
        assert_eq!(response.headers()["Sec-WebSocket-Protocol"], "binary");
        Self { socket, bytes: Vec::new() }
    }

    pub(crate) fn send(&mut self, bytes: Vec<u8>) {
        self.socket.send(Message::Binary(bytes.into())).unwrap();
    }

    /// Sends bytes that may be refused.
    pub(crate) fn try_send(&mut self, bytes: Vec<u8>) -> Result<(), Error> {
        self.socket.send(Message::Binary(bytes.into()))
    }

    pub(crate) fn receive(&mut self) {
        match self.socket.read().unwrap() {
            Message::Binary(bytes) => self.bytes.extend_from_slice(&bytes),
            other => panic!("{other:?} instead of bytes"),
        }
    }

    /// Returns the next answer: the code and, unless it is an error, the payload.
    pub(crate) fn answer(&mut self) -> (u16, Option<Vec<u8>>) {
        loop {
            if let Some(answer) = msp::take_answer(&mut self.bytes) {
                return answer;
            }
            self.receive();
        }
    }

    pub(crate) fn ask(&mut self, code: u16, payload: &[u8]) -> Option<Vec<u8>> {
        self.send(match u8::try_from(code) {
            Ok(code) => msp::request(code, payload),
            Err(_) => msp::request_v2(code, payload),
        });
        let (answered, payload) = self.answer();
        assert_eq!(answered, code);
        payload
    }

    pub(crate) fn expect(&mut self, code: u16) -> Vec<u8> {
        self.ask(code, &[]).unwrap_or_else(|| panic!("{code} is refused"))
    }

    /// Does the same as the App before its first tab opens.
    pub(crate) fn connect(address: SocketAddr) -> Self {
        let mut app = Self::open(address);
        assert_eq!(app.expect(1), [0, 1, 49]);
        assert_eq!(app.expect(2), b"BTFL");
        assert!(app.expect(3)[0] >= 10, "the layout with a text");
        let build = app.expect(5);
        assert!(build.ends_with(&8235_u16.to_le_bytes()), "the last build option in {build:?}");
        for code in [4, 101, 160] {
            assert!(!app.expect(code).is_empty(), "{code}");
        }
        for text in [5, 2, 1] {
            // A refused text is an empty one.
            app.ask(TEXT, &[text]);
        }
        assert_eq!(app.ask(99, &[1, 0]), Some(Vec::new()));
        assert_eq!(app.ask(246, &[0, 0, 0, 0x6a, 0, 0]), Some(Vec::new()));
        let together = [36, 32, 80, 70, 79];
        together.into_iter().for_each(|code| app.send(msp::request(code, &[])));
        for code in together {
            assert_eq!(app.answer().0, u16::from(code), "answered in order");
        }
        app
    }

    /// Runs one round of the poll that every tab makes. Returns `true` if there is a GPS.
    pub(crate) fn poll(&mut self) -> bool {
        for code in [110, 130, 116] {
            assert!(!self.expect(code).is_empty(), "{code}");
        }
        let has_gps = self.expect(150)[4] & (1 << 3) != 0;
        if has_gps {
            assert!(self.expect(106).len() >= 16);
        }
        has_gps
    }

    /// Sends a line as the Flight Plan tab does. Returns the lines of the answer.
    pub(crate) fn line(&mut self, line: &str) -> Vec<String> {
        self.send([&[2], line.as_bytes(), b"\n\x03"].concat());
        while self.bytes.last() != Some(&3) {
            self.receive();
        }
        let answer = String::from_utf8(std::mem::take(&mut self.bytes)).unwrap();
        let answer = answer.strip_prefix('\u{2}').unwrap().strip_suffix('\u{3}').unwrap();
        let lines = answer.split('\n').map(|line| line.trim_end_matches('\r').to_owned());
        lines.filter(|line| !line.is_empty()).collect()
    }

    pub(crate) fn plan(&mut self) -> Vec<String> {
        let mut lines = self.line("waypoint list");
        lines.retain(|line| line.starts_with("waypoint insert ") && line.split(' ').count() == 10);
        lines
    }

    /// Reads until the other side has closed the connection in the ordinary way.
    pub(crate) fn wait_for_close(mut self) {
        loop {
            match self.socket.read() {
                Ok(_) => {}
                Err(Error::ConnectionClosed) => break,
                Err(error) => panic!("{error} instead of a close"),
            }
        }
    }

    /// Closes the connection and waits for the answer.
    pub(crate) fn close(mut self) {
        self.socket.close(None).unwrap();
        self.wait_for_close();
    }
}
