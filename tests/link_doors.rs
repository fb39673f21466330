//! The doors over real sockets, with a desk behind them that answers as the session does. Ports come from the system.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use std::net::SocketAddr;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use betadeck::firmware::cli::{CliAction, CliContext, CliFacts, CliReply};
use betadeck::firmware::config::{Configuration, ModeCondition};
use betadeck::firmware::mode::Mode;
use betadeck::firmware::msp::{GpsReading, HomeReading, MspAction, MspFacts, handle};
use betadeck::geo::LatLon;
use betadeck::link::proto::fdm_link::{FdmLinkConfig, LinkState};
use betadeck::link::proto::servo::MotorOrder;
use betadeck::link::proto::{rc, servo};
use betadeck::link::{
    CliAnswer, DoorKind, Doors, DoorsConfig, ExternalSimulator, MotorPort, Request, RestartBell, Sent,
};
use betadeck::plan::{HoldPattern, Waypoint, WaypointType};
use betadeck::signals::{MotorCommand, RcFrame};
use futures_util::{SinkExt, StreamExt};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpStream, UdpSocket};
use tokio::sync::mpsc;
use tokio_tungstenite::WebSocketStream;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::http::{HeaderValue, StatusCode};
use tokio_tungstenite::tungstenite::{Error, Message};

/// Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(20);

const API_VERSION: &str = "244d3c000101";
const API_REPLY: &str = "244d3e030100013132";
const GREETING: &str = "\r\nEntering CLI Mode, type 'exit' to reboot, or 'help'\r\n\r\n# ";

fn unhex(text: &str) -> Vec<u8> {
    (0..text.len() / 2).map(|i| u8::from_str_radix(&text[2 * i..2 * i + 2], 16).unwrap()).collect()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The craft behind the doors.
#[derive(Debug, Default)]
struct Craft {
    configuration: Configuration,
    msp: MspFacts,
    cli: CliFacts,
    saves: u32,
    left_cli: u32,
    entered: Vec<bool>,
}

type Shared = Arc<Mutex<Craft>>;

/// The craft of the captured exchanges.
fn captured_craft() -> Craft {
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
        alt_cm: 4000,
        speed_cms: 500,
        ..Waypoint::default()
    };
    let second = Waypoint {
        position: LatLon::new(-274_973_051, 1_530_015_191),
        alt_cm: 5000,
        duration_ds: 50,
        kind: WaypointType::Hold,
        pattern: HoldPattern::Orbit,
        ..first
    };
    craft.configuration.plan.waypoints.extend([first, second]);
    craft.msp.cycle_time_us = 939;
    craft.msp.heading_deg = 358.0;
    craft.msp.channels[3..10].fill(1000);
    craft.msp.gps = GpsReading {
        fix: true,
        sats: 12,
        position: LatLon::new(-275_000_000, 1_530_000_000),
        alt_amsl_m: 30.0,
        ..GpsReading::default()
    };
    craft.msp.build.date = "Nov 21 2026".to_owned();
    craft.msp.build.time = "02:51:34".to_owned();
    craft.msp.build.revision = "301d01a".to_owned();
    craft
}

/// Answers requests until the doors are gone.
async fn desk(
    craft: Shared,
    mut requests: mpsc::Receiver<Request>,
    bell: RestartBell,
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
            Request::Cli { line, mut interpreter, reply, .. } => {
                let craft = &mut *craft.lock().unwrap();
                let mut context = CliContext { configuration: &mut craft.configuration, facts: &craft.cli };
                let answer: CliReply = interpreter.run(&line, &mut context);
                craft.saves += u32::from(answer.actions.contains(&CliAction::Save));
                restart = answer.actions.contains(&CliAction::Restart { close_links: true });
                let _gone = reply.send(CliAnswer { interpreter, reply: answer });
            }
            Request::LeftCli { .. } => craft.lock().unwrap().left_cli += 1,
            Request::Restart { .. } => restart = true,
            other @ (Request::Rc { .. } | Request::Fdm { .. } | Request::Notice(_)) => {
                let _nobody_looks = others.try_send(other);
            }
        }
        if restart {
            bell.ring();
        }
    }
}

/// Open doors with a desk.
struct House {
    doors: Doors,
    craft: Shared,
    others: mpsc::Receiver<Request>,
}

impl House {
    async fn open(config: DoorsConfig) -> Self {
        let (requests, inbox) = mpsc::channel(64);
        let (doors, views) = Doors::open(&config, requests).await;
        assert!(views.iter().all(|view| !view.fault), "{views:?}");
        let craft = Arc::new(Mutex::new(captured_craft()));
        let (others_in, others) = mpsc::channel(256);
        tokio::spawn(desk(Arc::clone(&craft), inbox, doors.restart_bell(), others_in));
        Self { doors, craft, others }
    }

    async fn usual() -> Self {
        Self::open(DoorsConfig {
            tcp_port: Some(0),
            ws_port: Some(0),
            rc_port: Some(0),
            fdm_port: Some(0),
            ..DoorsConfig::default()
        })
        .await
    }

    fn address(&self, kind: DoorKind) -> SocketAddr {
        self.doors.address(kind).unwrap()
    }

    async fn tcp(&self) -> Client {
        Client::Tcp(TcpStream::connect(self.address(DoorKind::Tcp)).await.unwrap())
    }

    async fn websocket(&self) -> Client {
        let (socket, protocol) = self.handshake(None, Some("binary")).await.unwrap();
        assert_eq!(protocol.as_deref(), Some("binary"));
        Client::WebSocket(Box::new(socket))
    }

    /// A websocket and the sub-protocol that was chosen.
    async fn handshake(
        &self,
        origin: Option<&str>,
        protocol: Option<&str>,
    ) -> Result<(WebSocketStream<TcpStream>, Option<String>), Error> {
        let address = self.address(DoorKind::WebSocket);
        let mut request = format!("ws://{address}/").into_client_request().unwrap();
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

/// A program that speaks with the craft.
enum Client {
    Tcp(TcpStream),
    WebSocket(Box<WebSocketStream<TcpStream>>),
}

impl Client {
    async fn send(&mut self, bytes: &[u8]) {
        match self {
            Self::Tcp(stream) => stream.write_all(bytes).await.unwrap(),
            Self::WebSocket(socket) => socket.send(Message::Binary(bytes.to_vec().into())).await.unwrap(),
        }
    }

    /// The next bytes; none when the link was closed.
    async fn receive(&mut self) -> Vec<u8> {
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

    /// Exactly this many bytes.
    async fn receive_exactly(&mut self, count: usize) -> Vec<u8> {
        let mut all = Vec::new();
        while all.len() < count {
            let more = self.receive().await;
            assert!(!more.is_empty(), "closed after {}", hex(&all));
            all.extend(more);
        }
        assert_eq!(all.len(), count, "{}", hex(&all));
        all
    }

    /// Text up to and including `end`.
    async fn receive_until(&mut self, end: &str) -> String {
        let mut all = Vec::new();
        while !all.ends_with(end.as_bytes()) {
            let more = self.receive().await;
            assert!(!more.is_empty(), "closed after {:?}", String::from_utf8_lossy(&all));
            all.extend(more);
        }
        String::from_utf8(all).unwrap()
    }

    /// Whether the server closes the link and sends nothing more.
    async fn is_closed(&mut self) -> bool {
        self.receive().await.is_empty()
    }

    async fn assert_speaks_msp(&mut self) {
        self.send(&unhex(API_VERSION)).await;
        assert_eq!(hex(&self.receive_exactly(9).await), API_REPLY);
    }

    async fn enter_cli(&mut self) {
        self.send(b"#").await;
        assert_eq!(self.receive_until("# ").await, GREETING);
    }
}

async fn captured_exchanges(house: &House, client: &mut Client) {
    for line in include_str!("vectors/msp.tsv").lines().filter(|line| !line.starts_with('#')) {
        let cells: Vec<&str> = line.split('\t').collect();
        let number: u32 = cells[0].parse().unwrap();
        {
            let facts = &mut house.craft.lock().unwrap().msp;
            facts.cycle_time_us = match number {
                22 => 947,
                43 => 964,
                _ => 939,
            };
            if number >= 43 {
                facts.armed = true;
                facts.modes.set(Mode::Arm, true);
                facts.motors_us = [1055; 4];
                facts.gps.solution = 1;
                facts.home = Some(HomeReading { distance_m: 0.2, bearing_deg: 89.3 });
            }
        }
        // The last would close the link, and a lone # is answered by time.
        if number == 42 || number == 49 {
            continue;
        }
        // Silence is seen by what comes next.
        let expected = cells[3].trim_start_matches('-').to_owned() + API_REPLY;
        client.send(&unhex(cells[2])).await;
        client.send(&unhex(API_VERSION)).await;
        assert_eq!(hex(&client.receive_exactly(expected.len() / 2).await), expected, "{number} {}", cells[1]);
    }
}

#[tokio::test]
async fn every_captured_exchange_over_tcp() {
    let house = House::usual().await;
    captured_exchanges(&house, &mut house.tcp().await).await;
    assert_eq!(house.craft.lock().unwrap().saves, 1);
}

#[tokio::test]
async fn every_captured_exchange_over_the_websocket() {
    let house = House::usual().await;
    captured_exchanges(&house, &mut house.websocket().await).await;
}

#[tokio::test]
async fn one_byte_at_a_time() {
    let house = House::usual().await;
    let mut client = house.websocket().await;
    for byte in unhex("02776179706f696e74206c6973740a03") {
        client.send(&[byte]).await;
    }
    let answer = client.receive_until("\x03").await;
    assert!(answer.starts_with("\x02waypoint clear\r\n"), "{answer:?}");
    client.assert_speaks_msp().await;
}

#[tokio::test]
async fn a_reboot_answers_closes_and_lets_in_again() {
    let house = House::usual().await;
    for websocket in [false, true] {
        let mut client = if websocket { house.websocket().await } else { house.tcp().await };
        client.send(&unhex("244d3c004444")).await;
        assert_eq!(hex(&client.receive_exactly(7).await), "244d3e01440045");
        assert!(client.is_closed().await);
        house.tcp().await.assert_speaks_msp().await;
        house.websocket().await.assert_speaks_msp().await;
    }
}

#[tokio::test]
async fn the_greeting_is_one_message_and_the_command_line_echoes() {
    let house = House::usual().await;
    let mut client = house.websocket().await;
    client.send(b"#").await;
    assert_eq!(String::from_utf8(client.receive().await).unwrap(), GREETING);
    client.send(b"# 0.1234\n").await;
    assert_eq!(client.receive_until("\r\n# ").await, "# 0.1234\r\n\r\n# ");
    client.send(b"get ap_max_angle\r\n").await;
    let answer = client.receive_until("\r\n# ").await;
    assert!(answer.starts_with("get ap_max_angle\r\nap_max_angle = 50\r\n"), "{answer:?}");
    client.send(b"exit noreboot\n").await;
    let left = client.receive_until("no reboot\r\n").await;
    assert!(left.ends_with("# leaving CLI mode, no reboot\r\n"), "{left:?}");
    client.assert_speaks_msp().await;
    let craft = house.craft.lock().unwrap();
    assert_eq!((craft.entered.as_slice(), craft.left_cli), ([true].as_slice(), 1));
}

#[tokio::test]
async fn an_interactive_save_reboots_and_a_framed_one_keeps_the_link() {
    let house = House::usual().await;
    let mut person = house.tcp().await;
    person.enter_cli().await;
    person.send(b"save\n").await;
    assert_eq!(person.receive_until("Rebooting").await, "save\r\n\r\n# saving\r\n\r\nRebooting");
    assert!(person.is_closed().await);

    let mut app = house.websocket().await;
    app.send(b"\x02save\n\x03").await;
    assert_eq!(app.receive_until("\x03").await, "\x02\r\n# saving\r\n\x03");
    app.assert_speaks_msp().await;
    assert_eq!(house.craft.lock().unwrap().saves, 2);
}

#[tokio::test]
async fn two_clients_do_not_disturb_each_other() {
    let house = House::usual().await;
    let (mut person, mut app) = (house.tcp().await, house.websocket().await);
    person.enter_cli().await;
    app.assert_speaks_msp().await;
    person.send(b"ver").await;
    app.send(&unhex("244d3c00")).await;
    person.send(b"sion\n").await;
    app.send(&unhex("0101")).await;
    assert_eq!(hex(&app.receive_exactly(9).await), API_REPLY);
    assert!(person.receive_until("\r\n# ").await.contains("MSP API: 1.49"));
}

#[tokio::test]
async fn a_client_that_goes_away_inside_the_command_line_leaves_nothing_behind() {
    let house = House::usual().await;
    let mut client = house.tcp().await;
    client.enter_cli().await;
    drop(client);
    house.tcp().await.assert_speaks_msp().await;
    let start = Instant::now();
    while house.craft.lock().unwrap().left_cli == 0 {
        assert!(start.elapsed() < PATIENCE);
        tokio::task::yield_now().await;
    }
}

#[tokio::test]
async fn the_command_line_in_messages_pages_through_its_output() {
    let house = House::usual().await;
    let mut client = house.tcp().await;
    let ask = |payload: &[u8]| {
        use betadeck::link::proto::msp::{Form, Frame};
        Frame::request(Form::V2, 0x3012, payload).to_bytes()
    };
    client.send(&ask(b"help")).await;
    let first = client.receive_exactly(9 + 3 + 512).await;
    let total = usize::from(u16::from_le_bytes([first[8], first[9]]));
    assert_eq!((total, first[10]), (2048, 1), "cut");
    client.send(&ask(b"help\x00\x00\x02")).await;
    let second = client.receive_exactly(9 + 3 + 512).await;
    assert_ne!(first[11..], second[11..]);
    client.send(&ask(b"bl")).await;
    assert_eq!(client.receive_exactly(9 + 3).await[8..11], [0, 0, 2], "refused");
}

#[tokio::test]
async fn web_pages_of_strangers_are_turned_away_with_a_notice() {
    let mut house = House::open(DoorsConfig {
        tcp_port: None,
        ws_port: Some(0),
        rc_port: None,
        allow_origin: vec!["https://my.page".to_owned()],
        ..DoorsConfig::default()
    })
    .await;
    for origin in
        [None, Some("http://localhost:8080"), Some("https://app.betaflight.com"), Some("https://my.page")]
    {
        assert!(house.handshake(origin, Some("binary")).await.is_ok(), "{origin:?}");
    }
    for _ in 0..2 {
        let Err(Error::Http(response)) = house.handshake(Some("https://evil.example"), None).await else {
            panic!("a stranger was served")
        };
        assert_eq!(response.status(), StatusCode::FORBIDDEN);
    }
    let Some(Request::Notice(notice)) = house.others.recv().await else { panic!("no notice") };
    assert!(notice.contains("--allow-origin https://evil.example"), "{notice}");
    assert!(house.others.try_recv().is_err(), "told once");
}

#[tokio::test]
async fn sub_protocols_are_answered_as_offered() {
    let house = House::usual().await;
    let chosen = async |offered| house.handshake(None, offered).await.unwrap().1;
    assert_eq!(chosen(None).await, None);
    assert_eq!(chosen(Some("chat, binary")).await.as_deref(), Some("binary"));
}

#[tokio::test]
async fn one_client_of_bad_manners_does_not_hold_up_the_others() {
    let house = House::usual().await;
    // One that connects and says nothing, one that never finishes its handshake, one that never reads its answers,
    // one that sends more than a message may hold.
    let _silent = house.tcp().await;
    let mut half = TcpStream::connect(house.address(DoorKind::WebSocket)).await.unwrap();
    half.write_all(b"GET / HTTP/1.1\r\nHost: x\r\n").await.unwrap();
    let mut deaf = house.tcp().await;
    deaf.enter_cli().await;
    let dump: Vec<u8> = b"dump all\n".repeat(400);
    deaf.send(&dump).await;
    let mut big = house.websocket().await;
    if let Client::WebSocket(socket) = &mut big {
        let _may_be_cut_off = socket.send(Message::Binary(vec![b'x'; 300_000].into())).await;
    }
    assert!(big.is_closed().await);
    for _ in 0..50 {
        house.tcp().await.assert_speaks_msp().await;
    }
    house.websocket().await.assert_speaks_msp().await;
}

#[tokio::test]
async fn a_busy_port_is_named_with_the_way_out() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let taken_udp = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    let (requests, _inbox) = mpsc::channel(1);
    let config = DoorsConfig {
        tcp_port: Some(port),
        ws_port: Some(0),
        rc_port: Some(taken_udp.local_addr().unwrap().port()),
        ..DoorsConfig::default()
    };
    let (doors, views) = Doors::open(&config, requests).await;
    let problems: Vec<String> = doors.problems().map(ToString::to_string).collect();
    assert_eq!(
        problems[0],
        format!(
            "TCP port {port} is in use: stop the program that has it, or choose another with --tcp-port (0 = any \
             free one)"
        )
    );
    assert!(problems[1].contains("--udp-ports"), "{problems:?}");
    let words: Vec<_> = views.iter().map(|view| (view.name, view.state.as_str(), view.fault)).collect();
    assert_eq!(words, [("ws", "listening", false), ("tcp", "busy", true), ("udp rc", "busy", true)]);
    assert!(doors.address(DoorKind::WebSocket).unwrap().ip().is_loopback());
    doors.close().await;
}

#[tokio::test]
async fn doors_show_who_is_there() {
    let house = House::usual().await;
    let mut client = house.tcp().await;
    client.assert_speaks_msp().await;
    let view = house.doors.views().into_iter().find(|view| view.name == "tcp").unwrap();
    assert_eq!(view.state, "1 client, API_VERSION, 6 B in, 9 B out");
    house.doors.close().await;
    assert!(client.is_closed().await);
}

#[tokio::test]
async fn the_websocket_listens_on_both_loopback_addresses() {
    let house = House::usual().await;
    let port = house.address(DoorKind::WebSocket).port();
    // A machine without IPv6 has nothing to test here.
    if std::net::TcpListener::bind("[::1]:0").is_ok() {
        assert!(TcpStream::connect(("::1", port)).await.is_ok());
    }
}

#[tokio::test]
async fn rc_and_states_arrive_and_other_sizes_are_counted() {
    let mut house = House::usual().await;
    let script = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let rc_door = house.address(DoorKind::Rc);
    let mut frame = RcFrame::SAFE;
    frame.channels[4] = 2000;
    script.send_to(&[0; 39], rc_door).await.unwrap();
    let mut datagram = rc::encode(1.5, &frame).to_vec();
    datagram.extend([9, 9]);
    script.send_to(&datagram, rc_door).await.unwrap();
    let Some(Request::Rc { stamp_s, frame: received, from, .. }) = house.others.recv().await else {
        panic!("no RC")
    };
    assert_eq!((stamp_s, received, from), (1.5, frame, script.local_addr().unwrap()));

    script.send_to(&[0; 143], house.address(DoorKind::Fdm)).await.unwrap();
    script.send_to(&[1; 296], house.address(DoorKind::Fdm)).await.unwrap();
    let Some(Request::Fdm { datagram, .. }) = house.others.recv().await else { panic!("no state") };
    assert_eq!(datagram.len(), 296);
    for view in house.doors.views().iter().filter(|view| view.name.starts_with("udp")) {
        assert!(view.state.contains("1 packets") && view.state.contains("1 of wrong size"), "{view:?}");
    }
}

#[tokio::test]
async fn motors_that_nobody_takes_are_noticed() {
    let vacant = std::net::UdpSocket::bind("127.0.0.1:0").unwrap().local_addr().unwrap();
    let port = MotorPort::open(vacant, vacant).unwrap();
    assert_eq!(port.send_servo([1000.0; 4]), Sent::Refused);
    let simulator = std::net::UdpSocket::bind(vacant).unwrap();
    assert_eq!(port.send_servo([1502.5; 4]), Sent::Sent);
    let mut datagram = [0; 100];
    let size = simulator.recv(&mut datagram).unwrap();
    assert_eq!(servo::decode(&datagram[..size]), Some([0.502; 4]));
}

#[tokio::test]
async fn a_simulator_is_answered_packet_by_packet() {
    use std::net::UdpSocket as Std;
    let (servo_socket, raw_socket) = (Std::bind("127.0.0.1:0").unwrap(), Std::bind("127.0.0.1:0").unwrap());
    servo_socket.set_read_timeout(Some(PATIENCE)).unwrap();
    raw_socket.set_read_timeout(Some(PATIENCE)).unwrap();
    let port = MotorPort::open(servo_socket.local_addr().unwrap(), raw_socket.local_addr().unwrap()).unwrap();
    let start = Instant::now();
    let mut simulator = ExternalSimulator::start(FdmLinkConfig::default(), MotorOrder::Legacy, port, start);
    assert_eq!(simulator.state(start), LinkState::Waiting);
    let wire: serde_json::Value = serde_json::from_str(include_str!("vectors/sim.json")).unwrap();
    let mut state = unhex(wire["wire"]["fdm"][0]["sitl_gz"]["hex"].as_str().unwrap());
    let mut buffer = [0; 100];
    let mut ticks = 0;
    for step in 0..300_u32 {
        let size = servo_socket.recv(&mut buffer).unwrap();
        assert_eq!(size, 16);
        assert_eq!(raw_socket.recv(&mut buffer).unwrap(), 68);
        state[..8].copy_from_slice(&(10.0 + f64::from(step) * 1e-3).to_le_bytes());
        // Time as the link sees it, whatever this machine is doing.
        let at = start + Duration::from_millis(u64::from(step));
        simulator.receive(&state, at, |sensors, due| {
            assert!(sensors.truth_attitude.is_some());
            ticks += due;
            MotorCommand([0.1, 0.2, 0.3, 0.4])
        });
        simulator.poll(at);
    }
    assert_eq!(ticks, 299);
    assert_eq!(servo_socket.recv(&mut buffer).unwrap(), 16);
    assert_eq!(servo::decode(&buffer[..16]), Some([0.2, 0.3, 0.4, 0.1]));
    servo_socket.set_nonblocking(true).unwrap();
    assert!(servo_socket.recv(&mut buffer).is_err(), "one answer a packet");
    assert_eq!(simulator.view(start).name, "udp motors");
}
