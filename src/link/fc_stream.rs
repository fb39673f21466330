//! The byte stream to a flight controller that runs outside: bytes and changes of the connection, moved by a task that
//! connects again by itself.

use tokio::sync::mpsc;

/// What comes from the stream.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StreamEvent {
    /// Connected, with nothing said yet. Also after every loss.
    Connected,
    /// Bytes from the flight controller.
    Bytes(Vec<u8>),
    /// The connection is gone, or none could be made: why, as a part of a sentence. Another attempt follows by itself.
    Lost(String),
}

/// The session's end of the stream. The task at the other end ends when this is dropped.
#[derive(Debug)]
pub struct FcStream {
    /// Bytes to the flight controller; what is sent while there is no connection is dropped.
    pub to: mpsc::Sender<Vec<u8>>,
    /// What comes from it.
    pub from: mpsc::Receiver<StreamEvent>,
    /// Where it leads, as the user writes it: `tcp:127.0.0.1:5761`, `serial:/dev/ttyACM0`.
    pub place: String,
    /// Bytes a second that it carries; `None` = more than anybody asks for.
    pub bytes_per_s: Option<u32>,
}
