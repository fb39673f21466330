//! One client of the TCP or the websocket door. Moves bytes between its stream and its serial session, and
//! sends its requests to the session of the craft.

#![allow(clippy::disallowed_methods, reason = "the doors wait for people and programs")]

use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

use tokio::sync::{mpsc, oneshot, watch};
use tokio_util::sync::CancellationToken;

use super::client_stream::ClientStream;
use super::endpoint_stats::EndpointStats;
use super::notices::{Notices, Stranger};
use super::proto::command_line::LineSource;
use super::proto::first_line::FirstLine;
use super::proto::serial_session::{SerialRequest, SerialSession};
use super::request::{ClientId, Request};
use super::seats::Seat;

/// The time after which a client that neither sends nor receives anything is closed.
const IDLE_TIMEOUT: Duration = Duration::from_secs(120);
/// The time within which a client must take its answers; otherwise it is closed.
const WRITE_TIMEOUT: Duration = Duration::from_secs(10);
/// The longest time that closing may take.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(1);
/// The time for a websocket client to process the announcement of a restart before its link is closed. A browser reports a
/// message after it has decoded it, and may report the end of the link first.
const RESTART_DELAY: Duration = Duration::from_secs(1);

/// The channels that all clients of the doors share.
#[derive(Debug, Clone)]
pub(super) struct SharedChannels {
    pub(super) requests: mpsc::Sender<Request>,
    pub(super) shutdown: CancellationToken,
    /// Changes each time the firmware restarts.
    pub(super) restarts: watch::Receiver<u64>,
}

/// The reason why a client is no longer served.
enum Stop {
    /// The session is gone, or the link must close.
    Ended,
    /// The firmware restarts at the request of this client, which was informed.
    Restarted,
    /// The client cannot be reached.
    Failed,
    /// The client does not take its answers in time.
    Deaf,
    /// The client sends neither MSP nor command lines.
    Foreign(Stranger),
    /// The client was silent, and its place went to another one.
    Evicted,
}

impl From<io::Error> for Stop {
    fn from(_: io::Error) -> Self {
        Self::Failed
    }
}

pub(super) struct Client {
    id: ClientId,
    seat: Seat,
    stream: ClientStream,
    channels: SharedChannels,
    notices: Notices,
    stats: Arc<EndpointStats>,
    first_line: FirstLine,
    session: SerialSession,
    arrived: Instant,
}

impl Client {
    pub(super) fn new(
        seat: Seat,
        stream: ClientStream,
        mut channels: SharedChannels,
        notices: Notices,
        stats: Arc<EndpointStats>,
    ) -> Self {
        // A restart before the client connected does not concern it.
        channels.restarts.mark_unchanged();
        Self {
            id: seat.client(),
            seat,
            stream,
            channels,
            notices,
            stats,
            first_line: FirstLine::default(),
            session: SerialSession::default(),
            arrived: Instant::now(),
        }
    }

    /// Serves the client until it disconnects, the firmware restarts or the doors close.
    pub(super) async fn serve(mut self) {
        let stop = self.exchange().await;
        let door = self.stream.door();
        match stop {
            Stop::Ended => {}
            Stop::Restarted => self.wait_for_end().await,
            Stop::Failed | Stop::Evicted => self.stats.error(),
            Stop::Deaf => {
                self.stats.error();
                self.notices.tell(format!(
                    "A client of the {door} door did not read its answers for {} s and was closed.",
                    WRITE_TIMEOUT.as_secs()
                ));
            }
            Stop::Foreign(stranger) => {
                self.stats.error();
                self.notices.count_stranger(door, stranger);
            }
        }
        if self.session.is_in_cli() {
            let _gone = self.channels.requests.send(Request::LeftCli { client: self.id }).await;
        }
        let _gone = tokio::time::timeout(CLOSE_TIMEOUT, self.stream.close()).await;
    }

    /// Reads requests and answers them until something ends the exchange.
    async fn exchange(&mut self) -> Stop {
        loop {
            let answered = self.answer_all().await;
            // Answers that were ready before the end are still sent.
            let flushed = self.flush().await;
            if let Err(stop) = answered.and(flushed) {
                return stop;
            }
            let due = self.session.due();
            let wait = due.map_or(IDLE_TIMEOUT, |due| due.saturating_sub(self.arrived.elapsed()));
            tokio::select! {
                () = self.channels.shutdown.cancelled() => return Stop::Ended,
                _ = self.channels.restarts.changed() => return Stop::Ended,
                () = self.seat.evicted() => return Stop::Evicted,
                () = tokio::time::sleep(wait) => {
                    if due.is_none() {
                        return Stop::Ended;
                    }
                }
                bytes = self.stream.read() => match bytes {
                    Ok(Some(bytes)) => {
                        self.stats.received(bytes.len());
                        match self.first_line.take(&bytes) {
                            Ok(bytes) => self.session.push(bytes),
                            Err(protocol) => return Stop::Foreign(Stranger::Began(protocol)),
                        }
                    }
                    Ok(None) => return Stop::Ended,
                    Err(error) => return error.into(),
                },
            }
        }
    }

    /// Answers all requests in the bytes received so far.
    async fn answer_all(&mut self) -> Result<(), Stop> {
        let before = self.session.dropped();
        while let Some(request) = self.session.next(self.arrived.elapsed()) {
            if matches!(
                request,
                SerialRequest::Msp(_) | SerialRequest::EnterCli { .. } | SerialRequest::Line { .. }
            ) {
                self.seat.keep();
            }
            match request {
                SerialRequest::Msp(frame) => {
                    self.stats.asked(frame.code);
                    let (code, payload) = (frame.code, frame.payload.clone());
                    let payload = self.request(|reply| Request::Msp { code, payload, reply }).await?;
                    self.session.reply(&frame, payload);
                }
                SerialRequest::EnterCli { interactive } => {
                    let client = self.id;
                    let admitted =
                        self.request(|reply| Request::EnterCli { client, interactive, reply }).await?;
                    self.session.admit(admitted, self.arrived.elapsed());
                }
                SerialRequest::Line { line, source } => self.run(line, source).await?,
                SerialRequest::Complete { line } => {
                    let completion = self.request(|reply| Request::Complete { line, reply }).await?;
                    self.session.complete(completion);
                }
                SerialRequest::Flush => self.flush().await?,
                SerialRequest::Restart => {
                    self.send(Request::Restart).await?;
                    return Err(Stop::Restarted);
                }
                SerialRequest::LeftCli => self.send(Request::LeftCli { client: self.id }).await?,
                SerialRequest::Ignored { word } => {
                    self.send(Request::Ignored { word }).await?;
                }
                SerialRequest::Foreign => return Err(Stop::Foreign(Stranger::WentOn)),
            }
        }
        if self.session.dropped() != before {
            self.stats.error();
        }
        Ok(())
    }

    async fn run(&mut self, line: String, source: LineSource) -> Result<(), Stop> {
        let client = self.id;
        let answer = self.request(|reply| Request::Cli { client, line, source, reply }).await?;
        if self.session.answer(&answer) { Err(Stop::Restarted) } else { Ok(()) }
    }

    /// Waits until the client ends the link, a while at most, if its messages may arrive after the end of the link.
    async fn wait_for_end(&mut self) {
        if !self.stream.is_websocket() {
            return;
        }
        let read = async { while let Ok(Some(_ignored)) = self.stream.read().await {} };
        tokio::select! {
            () = self.channels.shutdown.cancelled() => {}
            _ended = tokio::time::timeout(RESTART_DELAY, read) => {}
        }
    }

    async fn request<T>(&self, request: impl FnOnce(oneshot::Sender<T>) -> Request) -> Result<T, Stop> {
        let (reply, answer) = oneshot::channel();
        self.send(request(reply)).await?;
        tokio::select! {
            // A ready answer is delivered even while the doors close.
            biased;
            answer = answer => answer.map_err(|_| Stop::Ended),
            () = self.channels.shutdown.cancelled() => Err(Stop::Ended),
        }
    }

    async fn send(&self, request: Request) -> Result<(), Stop> {
        self.channels.requests.send(request).await.map_err(|_| Stop::Ended)
    }

    async fn flush(&mut self) -> Result<(), Stop> {
        let output = self.session.take_output();
        self.stats.sent(output.len());
        match tokio::time::timeout(WRITE_TIMEOUT, self.stream.write(output)).await {
            Ok(written) => Ok(written?),
            Err(_too_long) => Err(Stop::Deaf),
        }
    }
}
