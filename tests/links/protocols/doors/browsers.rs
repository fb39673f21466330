//! Web pages that try to command the craft: over TCP, where any page can send a request with bytes of its
//! choice, and over the websocket.

use betadeck::link::endpoint::EndpointKind;
use betadeck::link::{ListenConfig, Request};
use test_support::hex;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::tungstenite::http::HeaderValue;

use super::harness::{API_VERSION, Client, House};

/// Returns the commands of a hostile page: rename the craft, save, reboot.
fn commands() -> Vec<Vec<u8>> {
    let mut frames = hex::decode(API_VERSION);
    // SET_NAME "evil", EEPROM_WRITE, REBOOT.
    for (code, payload) in [(11, b"evil".as_slice()), (250, b""), (68, b"")] {
        use betadeck::msp::{Form, Frame};
        Frame::request(Form::V1, code, payload).encode(&mut frames);
    }
    let lines = b"\x02set craft_name = evil\nsave\n\x03".to_vec();
    vec![frames, lines, b"#\r\nset craft_name = evil\r\nsave\r\n".to_vec()]
}

fn request(line: &str, kind: &str, body: &[u8]) -> Vec<u8> {
    let head = format!(
        "{line}\r\nHost: 127.0.0.1:5761\r\nConnection: keep-alive\r\nContent-Length: {}\r\nContent-Type: {kind}\r\n\
         Origin: https://evil.example\r\nSec-Fetch-Mode: no-cors\r\n\r\n",
        body.len()
    );
    [head.as_bytes(), body].concat()
}

/// Returns the requests that a page can cause: with a raw body, with forms of all three encodings, without
/// any body.
fn requests() -> Vec<Vec<u8>> {
    let mut all = vec![request("GET /?%23 HTTP/1.1", "text/plain", b"")];
    for body in commands() {
        let multipart = [
            b"------x\r\nContent-Disposition: form-data; name=\"a\"\r\n\r\n".as_slice(),
            &body,
            b"\r\n------x--\r\n",
        ]
        .concat();
        all.extend([
            request("POST / HTTP/1.1", "text/plain;charset=UTF-8", &body),
            request("POST / HTTP/1.1", "application/octet-stream", &body),
            request("POST /save HTTP/1.1", "application/x-www-form-urlencoded", &[b"a=", &body[..]].concat()),
            request("POST / HTTP/1.1", "multipart/form-data; boundary=----x", &multipart),
            request("PUT / HTTP/1.1", "text/plain", &body),
            request("BREW * HTTP/1.0", "text/plain", &body),
            request("rubbish \x01 POST / HTTP/1.1", "text/plain", &body),
            request("\r\nPOST / HTTP/1.1", "text/plain", &body),
        ]);
        all.push([b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03".as_slice(), &body].concat());
    }
    all
}

/// Sends everything and returns the answers until the door closed.
async fn answers_to(house: &House, bytes: &[u8], pieces: usize) -> Vec<u8> {
    let mut stream = TcpStream::connect(house.address(EndpointKind::Tcp)).await.unwrap();
    stream.set_nodelay(true).unwrap();
    for piece in bytes.chunks(bytes.len().div_ceil(pieces)) {
        // The door may be closed by then.
        if stream.write_all(piece).await.is_err() {
            break;
        }
        tokio::task::yield_now().await;
    }
    let mut answers = Vec::new();
    let _reset = stream.read_to_end(&mut answers).await;
    answers
}

fn notices(house: &mut House) -> Vec<String> {
    std::iter::from_fn(|| house.others.try_recv().ok())
        .filter_map(|request| match request {
            Request::Notice(notice) => Some(notice),
            _ => None,
        })
        .collect()
}

#[tokio::test]
async fn a_web_page_cannot_command_the_craft_over_tcp() {
    let mut house = House::usual().await;
    let before = house.craft.lock().unwrap().configuration.clone();
    for request in requests() {
        for pieces in [1, 7] {
            let answers = answers_to(&house, &request, pieces).await;
            assert!(answers.is_empty(), "{} was answered {}", request.escape_ascii(), answers.escape_ascii());
        }
    }
    {
        let craft = house.craft.lock().unwrap();
        assert_eq!((craft.saves, craft.entered.len()), (0, 0));
        assert_eq!(craft.configuration, before);
    }
    // Clients that send MSP or type are served as before.
    house.tcp().await.assert_speaks_msp().await;
    house.tcp().await.enter_cli().await;
    // One notice for each kind, in the order in which the kinds came.
    for said in ["began like HTTP", "began with text", "began like TLS"] {
        let Some(Request::Notice(notice)) = house.others.recv().await else { panic!("no notice") };
        assert!(notice.contains("TCP door") && notice.contains(said), "{notice}");
    }
    assert_eq!(notices(&mut house), [] as [String; 0]);
}

#[tokio::test]
async fn a_notice_of_both_loopback_addresses_is_reported_once() {
    let mut house = House::usual().await;
    // The test needs IPv6.
    if std::net::TcpListener::bind("[::1]:0").is_err() {
        return;
    }
    let port = house.address(EndpointKind::Tcp).port();
    let mut clients = Vec::new();
    for _ in 0..32 {
        clients.push(house.tcp().await);
        clients.last_mut().unwrap().assert_speaks_msp().await;
    }
    for host in ["127.0.0.1", "::1", "127.0.0.1"] {
        let stream = TcpStream::connect((host, port)).await.unwrap();
        assert!(Client::Tcp(stream).is_closed().await);
    }
    assert_eq!(notices(&mut house), ["The TCP door serves 32 clients at once: another one was refused."]);
}

/// Returns `true` if a handshake with these headers is served.
async fn is_served(house: &House, headers: &[(&'static str, &str)]) -> bool {
    let address = house.address(EndpointKind::WebSocket);
    let mut request = format!("ws://{address}/").into_client_request().unwrap();
    for (name, value) in headers {
        request.headers_mut().insert(*name, HeaderValue::from_str(value).unwrap());
    }
    let stream = TcpStream::connect(address).await.unwrap();
    tokio_tungstenite::client_async(request, stream).await.is_ok()
}

#[tokio::test]
async fn a_name_that_was_made_to_point_to_this_machine_is_refused() {
    let mut house = House::open(ListenConfig {
        tcp_port: None,
        ws_port: Some(0),
        rc_port: None,
        allow_origin: vec!["http://craft.lan:8000".to_owned()],
        ..ListenConfig::default()
    })
    .await;
    let port = house.address(EndpointKind::WebSocket).port();
    for host in ["localhost", "[::1]:6761", "craft.lan", &format!("127.0.0.1:{port}")] {
        assert!(is_served(&house, &[("Host", host)]).await, "{host}");
    }
    let evil = format!("evil.example:{port}");
    assert!(!is_served(&house, &[("Host", &evil)]).await, "without an origin");
    assert!(!is_served(&house, &[("Host", &evil), ("Origin", &format!("http://{evil}"))]).await);
    assert!(!is_served(&house, &[("Host", &evil), ("Origin", "http://localhost")]).await);
    let notices = notices(&mut house);
    assert!(notices[0].contains(&format!("addressed this machine as \"{evil}\"")), "{notices:?}");
    assert_eq!(notices.len(), 2, "{notices:?}");
}

#[tokio::test]
async fn no_message_advises_to_allow_pages_without_an_origin() {
    let mut house = House::usual().await;
    for origin in ["null", "file://", "?"] {
        assert!(!is_served(&house, &[("Origin", origin)]).await, "{origin}");
    }
    let notices = notices(&mut house);
    assert_eq!(notices.len(), 1, "{notices:?}");
    assert!(notices[0].starts_with("A web page without an origin of its own"), "{notices:?}");
    assert!(!notices[0].contains("--allow-origin"), "{notices:?}");
}
