//! Clients of the TCP and the websocket door.

use std::time::{Duration, Instant};
use test_support::hex;

use betadeck::link::endpoint::EndpointKind;
use betadeck::link::endpoint::{ClientStats, EndpointState};
use betadeck::link::{ListenConfig, Listeners, Request};
use betadeck::msp::HomeVector;
use betadeck::telemetry::Mode;
use futures_util::SinkExt;
use tokio::io::AsyncWriteExt;
use tokio::net::TcpStream;
use tokio::sync::mpsc;
use tokio_tungstenite::tungstenite::http::StatusCode;
use tokio_tungstenite::tungstenite::{Error, Message};

use super::harness::{API_REPLY, API_VERSION, Client, GREETING, House, PATIENCE};

async fn captured_exchanges(house: &House, client: &mut Client) {
    for line in include_str!("../../../vectors/msp.tsv").lines().filter(|line| !line.starts_with('#')) {
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
                facts.home = HomeVector { distance_m: 0.2, bearing_deg: 89.3, toggle: true };
            }
        }
        // This exchange closes the link: see `a_reboot_answers_closes_and_lets_in_again`.
        if number == 42 {
            continue;
        }
        if number == 49 {
            client.send(&hex::decode(cells[2])).await;
            while house.craft.lock().unwrap().entered.last() != Some(&true) {
                // The request to open the command line comes after the line has been quiet for long enough.
                tokio::time::sleep(Duration::from_millis(5)).await;
            }
            client.assert_speaks_msp().await;
            continue;
        }
        // The next answer shows that this one was silent.
        let expected = cells[3].trim_start_matches('-').to_owned() + API_REPLY;
        client.send(&hex::decode(cells[2])).await;
        client.send(&hex::decode(API_VERSION)).await;
        assert_eq!(
            hex::encode(&client.receive_exactly(expected.len() / 2).await),
            expected,
            "{number} {}",
            cells[1]
        );
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
    for byte in hex::decode("02776179706f696e74206c6973740a03") {
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
        client.send(&hex::decode("244d3c004444")).await;
        assert_eq!(hex::encode(&client.receive_exactly(7).await), "244d3e01440045");
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
    app.send(b"\x02save noreboot\n\x03").await;
    assert_eq!(app.receive_until("\x03").await, "\x02\r\n# saving\r\n\x03");
    app.assert_speaks_msp().await;
    assert_eq!(house.craft.lock().unwrap().saves, 3);
}

#[tokio::test]
async fn a_browser_reads_that_the_craft_reboots_before_its_link_ends() {
    let house = House::usual().await;
    let mut app = house.websocket().await;
    app.enter_cli().await;
    app.send(b"exit\n").await;
    assert!(app.receive_until("Rebooting").await.ends_with("unsaved changes lost\r\n\r\nRebooting"));
    // A browser decodes a message on another thread, and reports the end of a link at once.
    let end = tokio::time::timeout(Duration::from_millis(30), app.receive()).await;
    assert!(end.is_err(), "the link ended right after the message");
    // A restart of the client's own does not disturb the firmware again.
    app.send(&hex::decode("244d3c004444")).await;
    assert!(app.is_closed().await);
    house.websocket().await.assert_speaks_msp().await;
}

#[tokio::test]
async fn megabytes_without_a_line_end_are_one_line_at_most() {
    let house = House::usual().await;
    for websocket in [false, true] {
        let mut client = if websocket { house.websocket().await } else { house.tcp().await };
        client.enter_cli().await;
        for _ in 0..40 {
            client.send(&[b'x'; 1 << 16]).await;
        }
        client.send(b"\n").await;
        let echo = client.receive_until("\r\n# ").await;
        assert!(echo.len() < 1000, "{} bytes come back", echo.len());
        assert!(echo.contains("UNKNOWN COMMAND"), "{echo:?}");
    }
}

#[tokio::test]
async fn a_message_full_of_tabs_is_answered_in_pieces() {
    let house = House::usual().await;
    let mut client = house.websocket().await;
    client.enter_cli().await;
    client.send(&[b'\t'; 2000]).await;
    client.send(b"version\n").await;
    let (mut pieces, mut last) = (0, Vec::new());
    while !String::from_utf8_lossy(&last).contains("MSP API") {
        last = client.receive().await;
        assert!(!last.is_empty() && last.len() < 1_000_000, "{} bytes", last.len());
        pieces += 1;
    }
    assert!(pieces > 5, "{pieces} pieces");
}

#[tokio::test]
async fn two_clients_do_not_disturb_each_other() {
    let house = House::usual().await;
    let (mut person, mut app) = (house.tcp().await, house.websocket().await);
    person.enter_cli().await;
    app.assert_speaks_msp().await;
    person.send(b"ver").await;
    app.send(&hex::decode("244d3c00")).await;
    person.send(b"sion\n").await;
    app.send(&hex::decode("0101")).await;
    assert_eq!(hex::encode(&app.receive_exactly(9).await), API_REPLY);
    assert!(person.receive_until("\r\n# ").await.contains("MSP API: 1.49"));
}

#[tokio::test]
async fn a_client_that_goes_away_inside_the_command_line_leaves_no_session() {
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
        use betadeck::msp::{Form, Frame};
        test_support::msp_bytes(&Frame::request(Form::V2, 0x3012, payload))
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
    let mut house = House::open(ListenConfig {
        tcp_port: None,
        ws_port: Some(0),
        rc_port: None,
        allow_origin: vec!["https://my.page".to_owned()],
        ..ListenConfig::default()
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
    assert!(house.others.try_recv().is_err(), "reported once");
}

#[tokio::test]
async fn the_app_connects_by_a_websocket_to_the_tcp_port_too_under_the_same_rules() {
    let mut house = House::usual().await;
    for kind in [EndpointKind::Tcp, EndpointKind::WebSocket] {
        for origin in [None, Some("https://master.app.betaflight.com"), Some("tauri://localhost")] {
            for path in ["/", "/serial", "/serial?baud=115200"] {
                let (socket, protocol) =
                    house.handshake_at(kind, path, origin, Some("binary")).await.unwrap();
                assert_eq!(protocol.as_deref(), Some("binary"));
                let mut client = Client::WebSocket(Box::new(socket));
                client.send(&hex::decode(API_VERSION)).await;
                assert!(client.receive().await.starts_with(b"$M>"), "{kind:?} {origin:?} {path}");
            }
        }
        let Err(Error::Http(response)) =
            house.handshake_at(kind, "/", Some("https://evil.example"), None).await
        else {
            panic!("a stranger was served at {kind:?}")
        };
        assert_eq!(response.status(), StatusCode::FORBIDDEN);
        let Some(Request::Notice(notice)) = house.others.recv().await else { panic!("no notice") };
        assert!(notice.contains("https://evil.example"), "{notice}");
    }
}

#[tokio::test]
async fn a_client_that_begins_slowly_or_with_letters_of_a_handshake_loses_no_bytes() {
    let house = House::usual().await;
    let mut client = house.tcp().await;
    for byte in hex::decode(API_VERSION) {
        client.send(&[byte]).await;
    }
    assert!(client.receive().await.starts_with(b"$M>"));
    // Nothing but a command line or MSP is served, also if it begins as a handshake does.
    for start in ["G", "GET", "GE#", "GET\t/"] {
        let mut stranger = house.tcp().await;
        stranger.send(start.as_bytes()).await;
        stranger.send(b"X#\r\n").await;
        assert!(stranger.receive().await.is_empty(), "{start}");
    }
}

#[tokio::test]
async fn a_door_that_is_full_turns_the_next_away_with_a_notice() {
    let mut house = House::usual().await;
    let mut clients = Vec::new();
    for _ in 0..32 {
        clients.push(house.tcp().await);
        clients.last_mut().unwrap().assert_speaks_msp().await;
    }
    for _ in 0..3 {
        assert!(house.tcp().await.is_closed().await);
    }
    let Some(Request::Notice(notice)) = house.others.recv().await else { panic!("no notice") };
    assert_eq!(notice, "The TCP door serves 32 clients at once: another one was refused.");
    assert!(house.others.try_recv().is_err(), "reported once");
    house.websocket().await.assert_speaks_msp().await;
    drop(clients.pop());
    while house.doors.clients(EndpointKind::Tcp) >= 32 {
        tokio::task::yield_now().await;
    }
    house.tcp().await.assert_speaks_msp().await;
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
    // One client connects and sends nothing, one never finishes its handshake, one never reads its answers,
    // and one sends more than a message may hold.
    let _silent = house.tcp().await;
    let mut half = TcpStream::connect(house.address(EndpointKind::WebSocket)).await.unwrap();
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
    let config = ListenConfig {
        tcp_port: Some(port),
        ws_port: Some(0),
        rc_port: Some(taken_udp.local_addr().unwrap().port()),
        ..ListenConfig::default()
    };
    let (doors, views) = Listeners::open(&config, requests).await;
    let problems: Vec<String> = doors.problems().map(ToString::to_string).collect();
    assert_eq!(
        problems[0],
        format!(
            "TCP port {port} is in use: stop the program that uses it, or choose another with --tcp-port (0 = any \
             free one)"
        )
    );
    assert!(problems[1].contains("--udp-ports"), "{problems:?}");
    let states: Vec<_> = views.iter().map(|view| (view.kind, view.state)).collect();
    let listening = EndpointState::Clients(ClientStats::default());
    assert_eq!(
        states,
        [
            (EndpointKind::WebSocket, listening),
            (EndpointKind::Tcp, EndpointState::Busy),
            (EndpointKind::Rc, EndpointState::Busy)
        ]
    );
    assert!(doors.address(EndpointKind::WebSocket).unwrap().ip().is_loopback());
    doors.close().await;
}

#[tokio::test]
async fn doors_show_who_is_there() {
    let house = House::usual().await;
    let mut client = house.tcp().await;
    client.assert_speaks_msp().await;
    let view = house.doors.status().into_iter().find(|view| view.kind == EndpointKind::Tcp).unwrap();
    let stats = ClientStats {
        clients: 1,
        last_message: Some(1),
        received_bytes: 6,
        sent_bytes: 9,
        ..ClientStats::default()
    };
    assert_eq!(view.state, EndpointState::Clients(stats));
    house.doors.close().await;
    assert!(client.is_closed().await);
}

#[tokio::test]
async fn the_websocket_listens_on_both_loopback_addresses() {
    let house = House::usual().await;
    let port = house.address(EndpointKind::WebSocket).port();
    // The test needs IPv6.
    if std::net::TcpListener::bind("[::1]:0").is_ok() {
        assert!(TcpStream::connect(("::1", port)).await.is_ok());
    }
}
