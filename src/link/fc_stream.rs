//! The byte stream to a remote flight controller. A task moves the bytes, reports changes of the connection
//! and reconnects by itself.
#![allow(clippy::disallowed_methods, reason = "a lost connection is tried again in wall time")]

mod place;
mod serial;
mod tcp;
mod udp;
mod ws;

use std::io::{self, ErrorKind};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncReadExt as _, AsyncWrite, AsyncWriteExt as _};
use tokio::sync::mpsc;
use tokio::time::Instant;

pub use place::{DEFAULT_BAUD, FcPlace, FcPlaceError};

/// The maximum number of pieces that may wait in each direction. A full queue towards the session stops the
/// reading.
const QUEUE: usize = 64;
/// The maximum number of bytes read from a stream at once.
const CHUNK: usize = 4096;
/// The pause before the first new attempt. It doubles with each failure.
const PAUSE_FIRST: Duration = Duration::from_millis(200);
/// The longest pause between two attempts.
const PAUSE_LONGEST: Duration = Duration::from_secs(2);

/// The most common reason for the end of a connection.
const CLOSED: &str = "the other end closed the connection";
/// The most likely reason for the end of a connection that has just been made.
const CLOSED_AT_ONCE: &str = "the other end closed the connection at once, as a server for a single client does: close \
                              the other program that is connected to it";

/// An event of the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StreamEvent {
    /// The connection is made and has carried nothing yet. Also sent after every loss.
    Connected,
    /// Bytes from the flight controller.
    Bytes(Vec<u8>),
    /// The connection is lost or could not be made, with the reason as part of a sentence. Another attempt
    /// follows by itself. The same reason is not reported again until a connection was made.
    Lost(String),
    /// A sentence for the user about the stream.
    Notice(String),
}

/// The session's end of the stream. The task at the other end ends when this is dropped.
#[derive(Debug)]
pub struct FcStream {
    /// Bytes to the flight controller. Bytes sent without a connection are dropped.
    pub to: mpsc::Sender<Vec<u8>>,
    /// Events from the flight controller.
    pub from: mpsc::Receiver<StreamEvent>,
    /// The address as the user writes it, such as `tcp:127.0.0.1:5761` or `serial:/dev/ttyACM0`.
    pub place: String,
    /// The capacity in bytes per second; `None` if it exceeds every need.
    pub bytes_per_s: Option<u32>,
}

impl FcStream {
    /// Opens the stream on the current tokio runtime. The first event reports whether a connection was made.
    pub fn open(place: FcPlace) -> Self {
        let (to, outgoing) = mpsc::channel(QUEUE);
        let (incoming, from) = mpsc::channel(QUEUE);
        let (shown, bytes_per_s) = (place.to_string(), place.bytes_per_s());
        tokio::spawn(keep_connected(place, outgoing, incoming));
        Self { to, from, place: shown, bytes_per_s }
    }
}

/// The end of a connection.
#[derive(Debug, PartialEq, Eq)]
enum Ended {
    /// The session no longer needs it.
    Dropped,
    /// It is lost, for this reason.
    Lost(String),
}

impl Ended {
    fn closed() -> Self {
        Self::Lost(CLOSED.to_owned())
    }
}

/// Connects, moves bytes, and connects again, until the session's end is dropped.
async fn keep_connected(place: FcPlace, mut to: mpsc::Receiver<Vec<u8>>, from: mpsc::Sender<StreamEvent>) {
    let mut pause = PAUSE_FIRST;
    let mut reported = None;
    loop {
        let begun = Instant::now();
        let attempt = tokio::select! {
            ended = connect(&place, &mut to, &from, &mut reported) => ended,
            () = from.closed() => return,
        };
        let Ended::Lost(reason) = attempt else { return };
        // A connection that closes at once counts as a failed attempt.
        pause = if begun.elapsed() > PAUSE_LONGEST { PAUSE_FIRST } else { pause };
        if reported.as_ref() != Some(&reason) {
            if from.send(StreamEvent::Lost(reason.clone())).await.is_err() {
                return;
            }
            reported = Some(reason);
        }
        tokio::select! {
            () = tokio::time::sleep(pause) => {}
            () = from.closed() => return,
        }
        pause = (pause * 2).min(PAUSE_LONGEST);
    }
}

/// Runs one connection, from the attempt to its end.
async fn connect(
    place: &FcPlace,
    to: &mut mpsc::Receiver<Vec<u8>>,
    from: &mpsc::Sender<StreamEvent>,
    reported: &mut Option<String>,
) -> Ended {
    let connection = match place {
        FcPlace::Serial { device, baud } => serial::open(device, *baud).map(Connection::Serial),
        FcPlace::Tcp { host, port } => tcp::connect(host, *port).await.map(Connection::Tcp),
        FcPlace::WebSocket(uri) => {
            ws::connect(uri).await.map(|socket| Connection::WebSocket(Box::new(socket)))
        }
        FcPlace::Udp(address) => udp::bind(*address).await.map(Connection::Udp),
        FcPlace::Mavlink(place) => return Box::pin(connect(place, to, from, reported)).await,
    };
    let connection = match connection {
        Ok(connection) => connection,
        Err(reason) => return Ended::Lost(reason),
    };
    // Drops bytes that were meant for the previous connection.
    while to.try_recv().is_ok() {}
    *reported = None;
    if from.send(StreamEvent::Connected).await.is_err() {
        return Ended::Dropped;
    }
    let (begun, mut heard) = (Instant::now(), false);
    let ended = match connection {
        Connection::Serial(port) => match pump(port, to, from, &mut heard).await {
            Ended::Lost(_) => Ended::Lost("it was unplugged".to_owned()),
            Ended::Dropped => Ended::Dropped,
        },
        Connection::Tcp(stream) => pump(stream, to, from, &mut heard).await,
        Connection::WebSocket(socket) => ws::pump(*socket, to, from, &mut heard).await,
        Connection::Udp(socket) => udp::pump(&socket, to, from).await,
    };
    match ended {
        Ended::Lost(why) if why == CLOSED && !heard && begun.elapsed() < PAUSE_LONGEST => {
            Ended::Lost(CLOSED_AT_ONCE.to_owned())
        }
        ended => ended,
    }
}

enum Connection {
    Serial(serial2_tokio::SerialPort),
    Tcp(tokio::net::TcpStream),
    /// Boxed because it is large.
    WebSocket(Box<ws::Socket>),
    Udp(tokio::net::UdpSocket),
}

/// Moves bytes until the connection is lost or the session no longer needs them. Sets `heard` once bytes have
/// arrived. Reading continues while a write is blocked.
async fn pump(
    stream: impl AsyncRead + AsyncWrite,
    to: &mut mpsc::Receiver<Vec<u8>>,
    from: &mpsc::Sender<StreamEvent>,
    heard: &mut bool,
) -> Ended {
    let (mut reader, mut writer) = tokio::io::split(stream);
    let read = async {
        let mut chunk = [0; CHUNK];
        loop {
            match reader.read(&mut chunk).await {
                Ok(0) => return Ended::closed(),
                Ok(count) => {
                    *heard = true;
                    if from.send(StreamEvent::Bytes(chunk[..count].to_vec())).await.is_err() {
                        return Ended::Dropped;
                    }
                }
                Err(error) => return Ended::Lost(reason(&error)),
            }
        }
    };
    let write = async {
        while let Some(bytes) = to.recv().await {
            if let Err(error) = writer.write_all(&bytes).await {
                return Ended::Lost(reason(&error));
            }
        }
        Ended::Dropped
    };
    tokio::select! {
        ended = read => ended,
        ended = write => ended,
        () = from.closed() => Ended::Dropped,
    }
}

/// Returns the system's error as part of a sentence.
fn reason(error: &io::Error) -> String {
    match error.kind() {
        ErrorKind::ConnectionRefused => "nothing listens there (connection refused)".to_owned(),
        ErrorKind::ConnectionReset
        | ErrorKind::BrokenPipe
        | ErrorKind::ConnectionAborted
        | ErrorKind::UnexpectedEof => CLOSED.to_owned(),
        _ => {
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or_default().to_owned()
        }
    }
}
