//! A complete connection as a door sees it: its first line, then MSP, text and garbage in any order.
//! [`PAUSE`] in the bytes marks a quiet moment.

use std::time::Duration;

use betadeck::link::proto::command_line::{Completion, LineReply};
use betadeck::link::proto::first_line::{FirstLine, ForeignProtocol};
use betadeck::link::proto::serial_session::{SerialRequest, SerialSession};
use betadeck::msp::{Kind, MAX_REQUEST};

/// The mark of a quiet moment. It is long enough for a `#` before it to open the command line.
const PAUSE: &[u8] = &[0x1e, 0x1e];
/// The length of the quiet moment.
const QUIET: Duration = Duration::from_millis(150);

/// The result of a connection.
#[derive(Debug, PartialEq, Default)]
struct Outcome {
    asks: Vec<SerialRequest>,
    output: Vec<u8>,
    refused: Option<ForeignProtocol>,
}

/// Sends the bytes in one piece, byte by byte and in pieces. The outcome is the same, and no stranger is
/// served.
pub fn run(data: &[u8]) {
    first_line(data);
    binary_data_is_never_interpreted(data);
    for admits in [true, false] {
        let whole = connect(data, usize::MAX, admits);
        for piece in [1, 2, 7] {
            let in_pieces = connect(data, piece, admits);
            if whole.refused.is_some() {
                // The part of a request line before the version may have arrived alone.
                let ended = [Some(&SerialRequest::Foreign), Some(&SerialRequest::Restart)];
                assert!(in_pieces.refused.is_some() || ended.contains(&in_pieces.asks.last()));
            } else {
                assert_eq!(in_pieces, whole, "in pieces of {piece}, command line open: {admits}");
            }
        }
    }
}

/// Checks that the first byte that is no blank decides, and that a request line of HTTP is never passed on.
fn first_line(data: &[u8]) {
    let first = data.iter().find(|byte| !b"\r\n ".contains(byte));
    let begins_serial = first.is_none_or(|first| matches!(first, b'$' | b'#' | 0x02));
    match FirstLine::default().take(data) {
        Ok(passed) => {
            assert!(begins_serial && data.ends_with(passed), "only blanks are dropped");
            assert_eq!(passed.first(), first);
        }
        Err(ForeignProtocol::Http) => {}
        Err(protocol) => assert!(!begins_serial, "{protocol:?}"),
    }
    let line: Vec<u8> = data.iter().copied().take_while(|byte| *byte != b'\n').take(1000).collect();
    let request = [&line[..], b" / HTTP/1.1\r\n", data].concat();
    assert!(FirstLine::default().take(&request).is_err(), "a request is taken for a serial client");
}

/// Checks that nothing is served after a byte that is neither MSP nor text, whatever follows it.
fn binary_data_is_never_interpreted(data: &[u8]) {
    let stun = [b"\x00\x64\x00\x01", data].concat();
    assert_eq!(
        connect(&stun, usize::MAX, true),
        Outcome { refused: Some(ForeignProtocol::Binary), ..Outcome::default() }
    );
    let after_msp = connect(&[b"$M<\x00\x01\x01\n", &stun[..]].concat(), usize::MAX, true);
    assert!(matches!(&after_msp.asks[..], [SerialRequest::Msp(_), SerialRequest::Foreign]));
}

fn connect(data: &[u8], piece: usize, admits: bool) -> Outcome {
    let (mut line, mut session) = (FirstLine::default(), SerialSession::default());
    let (mut outcome, mut now) = (Outcome::default(), Duration::ZERO);
    for burst in bursts(data) {
        for bytes in burst.chunks(piece.min(burst.len().max(1))) {
            match line.take(bytes) {
                Ok(bytes) => session.push(bytes),
                Err(protocol) => {
                    outcome.refused = Some(protocol);
                    return outcome;
                }
            }
            if !answer(&mut session, &mut outcome, now, admits) {
                return outcome;
            }
        }
        now += QUIET;
        if !answer(&mut session, &mut outcome, now, admits) {
            return outcome;
        }
    }
    outcome
}

/// Answers every request. Returns `false` if the connection must be closed.
fn answer(session: &mut SerialSession, outcome: &mut Outcome, now: Duration, admits: bool) -> bool {
    while let Some(ask) = session.next(now) {
        let mut goes_on = true;
        match &ask {
            SerialRequest::Msp(frame) => {
                assert!(frame.kind == Kind::Request && frame.payload.len() <= MAX_REQUEST);
                session.reply(frame, Some(Vec::new()));
            }
            SerialRequest::EnterCli { .. } => {
                assert_eq!(session.next(now), Some(ask.clone()), "it is asked until it is answered");
                session.admit(admits, now);
            }
            SerialRequest::Line { .. } => {
                assert!(admits || !session.is_in_cli());
                goes_on = !session.answer(&LineReply { text: "ok\r\n".to_owned(), ..LineReply::default() });
            }
            SerialRequest::Complete { .. } => session.complete(Completion::default()),
            SerialRequest::Foreign => {
                session.push(b"$M<\x00\x01\x01#");
                assert_eq!(session.next(now + QUIET), None, "nothing more is interpreted");
                goes_on = false;
            }
            SerialRequest::Restart => goes_on = false,
            SerialRequest::Ignored { word } => assert!(!word.is_empty() && word.is_ascii()),
            SerialRequest::LeftCli | SerialRequest::Flush => {}
        }
        if ask != SerialRequest::Flush {
            outcome.asks.push(ask);
        }
        outcome.output.extend(session.take_output());
        if !goes_on {
            return false;
        }
    }
    outcome.output.extend(session.take_output());
    true
}

/// Returns the bytes between pauses.
fn bursts(data: &[u8]) -> Vec<&[u8]> {
    let mut bursts = Vec::new();
    let mut rest = data;
    while let Some(at) = rest.windows(PAUSE.len()).position(|window| window == PAUSE) {
        bursts.push(&rest[..at]);
        rest = &rest[at + PAUSE.len()..];
    }
    bursts.push(rest);
    bursts
}
