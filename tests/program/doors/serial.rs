//! A person who types at the command line over TCP.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};

use super::program::PATIENCE;

const PROMPT: &[u8] = b"\r\n# ";

pub(crate) struct Terminal(TcpStream);

impl Terminal {
    pub(crate) fn open(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream.set_nodelay(true).unwrap();
        let mut terminal = Self(stream);
        terminal.0.write_all(b"#").unwrap();
        terminal.read_to(PROMPT);
        terminal
    }

    fn read_to(&mut self, end: &[u8]) -> String {
        let mut all = Vec::new();
        while !all.ends_with(end) {
            let mut byte = [0];
            self.0.read_exact(&mut byte).unwrap();
            all.push(byte[0]);
        }
        String::from_utf8(all).unwrap()
    }

    /// Types lines, each after the prompt of the one before. No line may be refused. Returns the answer to
    /// the last. [`Terminal::save`] types a bare `save`.
    pub(crate) fn type_lines(&mut self, text: &str) -> String {
        let mut answer = String::new();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && *line != "save") {
            self.0.write_all(format!("{line}\n").as_bytes()).unwrap();
            answer = self.read_to(PROMPT);
            assert!(!answer.contains("ERROR"), "{line}: {answer}");
        }
        answer
    }

    /// Types `save`. The craft reboots and closes the link.
    pub(crate) fn save(mut self) {
        self.0.write_all(b"save\n").unwrap();
        let mut rest = Vec::new();
        self.0.read_to_end(&mut rest).unwrap();
        let rest = String::from_utf8(rest).unwrap();
        assert!(rest.contains("# saving") && rest.ends_with("Rebooting"), "{rest:?}");
    }
}
