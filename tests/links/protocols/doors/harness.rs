//! Open doors, a craft that answers as the session does, and programs that connect to them.

use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::Duration;
use test_support::hex;

use betadeck::firmware::cli::{CliAction, CliContext, CliFacts, CliMode, CliReply, Interpreter, complete};
use betadeck::firmware::config::{Configuration, ModeCondition};
use betadeck::firmware::msp::{MspAction, MspFacts, handle};
use betadeck::geo::LatLon;
use betadeck::link::endpoint::{EndpointKind, EndpointState, EndpointStatus};
use betadeck::link::proto::command_line::{Completion, LineSource};
use betadeck::link::{ListenConfig, Listeners, Request, RestartSignal};
use betadeck::msp::RawGps;
use betadeck::plan::{Altitude, HoldPattern, LegSpeed, Seconds, Waypoint, WaypointType};
use futures_util::{SinkExt, StreamExt};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::http::HeaderValue;
use tokio_tungstenite::tungstenite::{Error, Message};

/// The time limit of every wait. Nothing in these tests takes this long unless it hangs.
pub(crate) const PATIENCE: Duration = Duration::from_secs(600);

pub(crate) const API_VERSION: &str = "244d3c000101";
pub(crate) const API_REPLY: &str = "244d3e030100013132";
pub(crate) const GREETING: &str = "\r\nEntering CLI Mode, type 'exit' to reboot, or 'help'\r\n\r\n# ";

/// The craft that the doors serve.
#[derive(Debug, Default)]
pub(crate) struct Craft {
    pub(crate) configuration: Configuration,
    pub(crate) msp: MspFacts,
    pub(crate) cli: CliFacts,
    pub(crate) saves: u32,
    pub(crate) left_cli: u32,
    pub(crate) entered: Vec<bool>,
}

pub(crate) type Shared = Arc<Mutex<Craft>>;

/// Returns the craft of the captured exchanges.
pub(crate) fn captured_craft() -> Craft {
    let mut craft = Craft::default();
    let settings = &mut craft.configuration.settings;
    settings.set_text("craft_name", "SITLQUAD").unwrap();
    settings.set_number("small_angle", 180).unwrap();
    for (slot, box_id) in [0, 56, 1, 46].into_iter().enumerate() {
        craft.configuration.modes[slot] = ModeCondition {
            box_id,
            aux_channel: slot as u8,
            start_us: 1700,
            end_us: 2100,
            ..ModeCondition::default()
        };
    }
    let first = Waypoint {
        position: LatLon::new(-274_973_051, 1_530_000_000),
        altitude: Altitude::above_home(40.0),
        speed: LegSpeed::from_mps(5.0),
        ..Waypoint::default()
    };
    let second = Waypoint {
        position: LatLon::new(-274_973_051, 1_530_015_191),
        altitude: Altitude::above_home(50.0),
        duration: Seconds::new(5.0),
        kind: WaypointType::Hold,
        pattern: HoldPattern::Orbit,
        ..first
    };
    craft.configuration.plan.waypoints.extend([first, second]);
    craft.msp.cycle_time_us = 939;
    craft.msp.heading_deg = 358.0;
    craft.msp.channels[3..10].fill(1000);
    craft.msp.gps = RawGps {
        fix: true,
        sats: 12,
        position: LatLon::new(-275_000_000, 1_530_000_000),
        alt_amsl_m: 30.0,
        ..RawGps::default()
    };
    craft.msp.build.date = "Nov 21 2026".to_owned();
    craft.msp.build.time = "02:51:34".to_owned();
    craft.msp.build.revision = "301d01a".to_owned();
    craft
}

/// Answers requests until the doors are closed.
pub(crate) async fn answer_requests(
    craft: Shared,
    mut requests: mpsc::Receiver<Request>,
    restart_signal: RestartSignal,
    others: mpsc::Sender<Request>,
) {
    while let Some(request) = requests.recv().await {
        let mut restart = false;
        match request {
            Request::Msp { code, payload, reply, .. } => {
                let craft = &mut *craft.lock().unwrap();
                let outcome = handle(code, &payload, &mut craft.configuration, &craft.msp);
                craft.saves += u32::from(outcome.action == Some(MspAction::Save));
                restart = matches!(outcome.action, Some(MspAction::Reboot | MspAction::SaveAndReboot));
                let _gone = reply.send(outcome.reply);
            }
            Request::EnterCli { interactive, reply, .. } => {
                let mut craft = craft.lock().unwrap();
                craft.entered.push(interactive);
                let _gone = reply.send(!craft.msp.armed);
            }
            Request::Complete { line, reply } => {
                let found = complete(&line);
                let tail = found.tail(&line).to_owned();
                let _gone = reply.send(Completion { tail, words: found.candidates });
            }
            Request::Cli { line, source, reply, .. } => {
                let mut interpreter = Interpreter::new(match source {
                    LineSource::Prompt => CliMode::Interactive,
                    LineSource::Framed => CliMode::Framed,
                    LineSource::Message => CliMode::Message,
                });
                let craft = &mut *craft.lock().unwrap();
                let mut context = CliContext { configuration: &mut craft.configuration, facts: &craft.cli };
                let answer: CliReply = interpreter.run(&line, &mut context);
                craft.saves += u32::from(answer.actions.contains(&CliAction::Save));
                restart = answer.actions.contains(&CliAction::Restart { close_links: true });
                let _gone = reply.send(answer.into());
            }
            Request::LeftCli { .. } => craft.lock().unwrap().left_cli += 1,
            Request::Ignored { .. } => {}
            Request::Restart => restart = true,
            other @ (Request::Rc { .. } | Request::Fdm { .. } | Request::Notice(_)) => {
                let _nobody_looks = others.try_send(other);
            }
        }
        if restart {
            restart_signal.send();
        }
    }
}

/// Open doors that serve a craft.
pub(crate) struct House {
    pub(crate) doors: Listeners,
    pub(crate) craft: Shared,
    pub(crate) others: mpsc::Receiver<Request>,
}

impl House {
    pub(crate) async fn open(config: ListenConfig) -> Self {
        let (requests, inbox) = mpsc::channel(64);
        let (doors, views) = Listeners::open(&config, requests).await;
        let closed =
            |view: &EndpointStatus| matches!(view.state, EndpointState::Busy | EndpointState::Closed);
        assert!(!views.iter().any(closed), "{views:?}");
        let craft = Arc::new(Mutex::new(captured_craft()));
        let (others_in, others) = mpsc::channel(256);
        tokio::spawn(answer_requests(Arc::clone(&craft), inbox, doors.restart_signal(), others_in));
        Self { doors, craft, others }
    }

    pub(crate) async fn usual() -> Self {
        Self::open(ListenConfig {
            tcp_port: Some(0),
            ws_port: Some(0),
            rc_port: Some(0),
            fdm_port: Some(0),
            ..ListenConfig::default()
        })
        .await
    }

    pub(crate) fn address(&self, kind: EndpointKind) -> SocketAddr {
        self.doors.address(kind).unwrap()
    }

    pub(crate) async fn tcp(&self) -> Client {
        Client::Tcp(TcpStream::connect(self.address(EndpointKind::Tcp)).await.unwrap())
    }

    pub(crate) async fn websocket(&self) -> Client {
        let (socket, protocol) = self.handshake(None, Some("binary")).await.unwrap();
        assert_eq!(protocol.as_deref(), Some("binary"));
        Client::WebSocket(Box::new(socket))
    }

    /// Connects a websocket. Returns it with the chosen sub-protocol.
    pub(crate) async fn handshake(
        &self,
        origin: Option<&str>,
        protocol: Option<&str>,
    ) -> Result<(WebSocketStream<TcpStream>, Option<String>), Error> {
        self.handshake_at(EndpointKind::WebSocket, "/", origin, protocol).await
    }

    /// Does the same at this port, with this path.
    pub(crate) async fn handshake_at(
        &self,
        kind: EndpointKind,
        path: &str,
        origin: Option<&str>,
        protocol: Option<&str>,
    ) -> Result<(WebSocketStream<TcpStream>, Option<String>), Error> {
        let address = self.address(kind);
        let mut request = format!("ws://{address}{path}").into_client_request().unwrap();
        if let Some(origin) = origin {
            request.headers_mut().insert("Origin", HeaderValue::from_str(origin).unwrap());
        }
        if let Some(protocol) = protocol {
            request.headers_mut().insert("Sec-WebSocket-Protocol", HeaderValue::from_str(protocol).unwrap());
        }
        let stream = TcpStream::connect(address).await.unwrap();
        let (socket, response) = tokio_tungstenite::client_async(request, stream).await?;
        let chosen = response.headers().get("Sec-WebSocket-Protocol");
        Ok((socket, chosen.map(|value| value.to_str().unwrap().to_owned())))
    }
}

/// A program that is connected to the craft.
pub(crate) enum Client {
    Tcp(TcpStream),
    WebSocket(Box<WebSocketStream<TcpStream>>),
}

impl Client {
    pub(crate) async fn send(&mut self, bytes: &[u8]) {
        match self {
            Self::Tcp(stream) => stream.write_all(bytes).await.unwrap(),
            Self::WebSocket(socket) => socket.send(Message::Binary(bytes.to_vec().into())).await.unwrap(),
        }
    }

    /// Returns the next bytes, or an empty vector if the link was closed.
    pub(crate) async fn receive(&mut self) -> Vec<u8> {
        let receive = async {
            match self {
                Self::Tcp(stream) => {
                    let mut chunk = [0; 65_536];
                    let count = stream.read(&mut chunk).await.unwrap_or(0);
                    chunk[..count].to_vec()
                }
                Self::WebSocket(socket) => match socket.next().await {
                    Some(Ok(Message::Binary(bytes))) => bytes.to_vec(),
                    Some(Ok(Message::Close(_)) | Err(_)) | None => Vec::new(),
                    Some(Ok(other)) => panic!("{other:?} instead of binary"),
                },
            }
        };
        tokio::time::timeout(PATIENCE, receive).await.unwrap()
    }

    /// Returns exactly this many bytes.
    pub(crate) async fn receive_exactly(&mut self, count: usize) -> Vec<u8> {
        let mut all = Vec::new();
        while all.len() < count {
            let more = self.receive().await;
            assert!(!more.is_empty(), "closed after {}", hex::encode(&all));
            all.extend(more);
        }
        assert_eq!(all.len(), count, "{}", hex::encode(&all));
        all
    }

    /// Returns the text up to and including `end`.
    pub(crate) async fn receive_until(&mut self, end: &str) -> String {
        let mut all = Vec::new();
        while !all.ends_with(end.as_bytes()) {
            let more = self.receive().await;
            assert!(!more.is_empty(), "closed after {:?}", String::from_utf8_lossy(&all));
            all.extend(more);
        }
        String::from_utf8(all).unwrap()
    }

    /// Returns `true` if the server closes the link and sends nothing more.
    pub(crate) async fn is_closed(&mut self) -> bool {
        self.receive().await.is_empty()
    }

    pub(crate) async fn assert_speaks_msp(&mut self) {
        self.send(&hex::decode(API_VERSION)).await;
        assert_eq!(hex::encode(&self.receive_exactly(9).await), API_REPLY);
    }

    pub(crate) async fn enter_cli(&mut self) {
        self.send(b"#").await;
        assert_eq!(self.receive_until("# ").await, GREETING);
    }
}
