//! Connections of web pages over WebRTC, of other programs that use neither MSP nor the command line, and of
//! clients that send nothing.

use betadeck::link::Request;
use betadeck::link::endpoint::EndpointKind;
use test_support::hex;
use tokio::io::AsyncWriteExt;
use tokio::net::TcpStream;

use super::harness::{API_REPLY, API_VERSION, Client, House};

/// The most clients of a door.
const CLIENTS_MAX: usize = 32;

/// Returns a STUN request of ICE over TCP up to a `#` in its HMAC: the length of the message, its header,
/// attributes, and as much of the HMAC as one packet carries.
fn stun_up_to_hash() -> Vec<u8> {
    let mut bytes = hex::decode("0064000100502112a44200112233445566778899aabb");
    bytes.extend(hex::decode("00060009613a62636465666700000000"));
    bytes.extend(hex::decode("0008001400ff8001"));
    bytes.push(b'#');
    bytes
}

async fn say(house: &House, door: EndpointKind, bytes: &[u8]) -> Client {
    let mut client = match door {
        EndpointKind::WebSocket => house.websocket().await,
        _ => house.tcp().await,
    };
    client.send(bytes).await;
    client
}

async fn next_notice(house: &mut House) -> String {
    match house.others.recv().await {
        Some(Request::Notice(notice)) => notice,
        other => panic!("{other:?} instead of a notice"),
    }
}

#[tokio::test]
async fn a_web_page_with_webrtc_neither_opens_the_command_line_nor_reboots_the_craft() {
    let house = House::usual().await;
    for door in [EndpointKind::Tcp, EndpointKind::WebSocket] {
        let mut page = say(&house, door, &stun_up_to_hash()).await;
        // The door closes at once. An open door would greet after the quiet time, and then take the length of
        // the next message as Ctrl-D.
        let answer = page.receive().await;
        assert_eq!(answer.escape_ascii().to_string(), "", "{door:?}");
    }
    let craft = house.craft.lock().unwrap();
    assert_eq!((craft.saves, craft.entered.len()), (0, 0));
}

#[tokio::test]
async fn only_msp_the_command_line_and_blanks_begin_a_connection() {
    let house = House::usual().await;
    let version = hex::decode(API_VERSION);
    for door in [EndpointKind::Tcp, EndpointKind::WebSocket] {
        for byte in 0..=u8::MAX {
            let mut client = say(&house, door, &[byte]).await;
            match byte {
                b'$' => {
                    client.send(&version[1..]).await;
                    assert_eq!(hex::encode(&client.receive_exactly(9).await), API_REPLY);
                }
                b'\r' | b'\n' | b' ' => {
                    client.send(&version).await;
                    assert_eq!(hex::encode(&client.receive_exactly(9).await), API_REPLY, "{byte:#x}");
                }
                b'#' => assert!(client.receive_until("# ").await.contains("Entering CLI Mode")),
                0x02 => assert_eq!(client.receive().await, [0x02]),
                _ => assert!(client.is_closed().await, "{byte:#x}"),
            }
        }
    }
}

#[tokio::test]
async fn a_client_of_msp_that_goes_on_with_binary_rubbish_is_closed_before_a_hash_in_it_counts() {
    let house = House::usual().await;
    for door in [EndpointKind::Tcp, EndpointKind::WebSocket] {
        for rubbish in [stun_up_to_hash(), b"\xff#".to_vec(), b"$M\x00#".to_vec()] {
            let mut client = say(&house, door, &hex::decode(API_VERSION)).await;
            assert_eq!(hex::encode(&client.receive_exactly(9).await), API_REPLY);
            client.send(&rubbish).await;
            let answer = client.receive().await;
            assert_eq!(answer.escape_ascii().to_string(), "", "{door:?} {}", rubbish.escape_ascii());
        }
    }
    assert!(house.craft.lock().unwrap().entered.is_empty());
}

#[tokio::test]
async fn text_between_messages_is_ignored_as_before() {
    let house = House::usual().await;
    for door in [EndpointKind::Tcp, EndpointKind::WebSocket] {
        let mut client = say(&house, door, &hex::decode(API_VERSION)).await;
        assert_eq!(hex::encode(&client.receive_exactly(9).await), API_REPLY);
        client.send("waypoint clear\r\n\tset name = Höhe über Grund\n\x1b[A\x7f".as_bytes()).await;
        client.assert_speaks_msp().await;
    }
}

#[tokio::test]
async fn half_finished_handshakes_do_not_shut_the_websocket() {
    let house = House::usual().await;
    let mut half = Vec::new();
    for _ in 0..2 * CLIENTS_MAX {
        let mut stream = TcpStream::connect(house.address(EndpointKind::WebSocket)).await.unwrap();
        stream.write_all(b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: webso").await.unwrap();
        half.push(stream);
    }
    house.websocket().await.assert_speaks_msp().await;
}

#[tokio::test]
async fn connections_that_say_nothing_shut_no_door_and_those_that_spoke_stay() {
    let house = House::usual().await;
    let mut served = [house.tcp().await, house.websocket().await];
    for client in &mut served {
        client.assert_speaks_msp().await;
    }
    let mut silent = Vec::new();
    for _ in 0..3 * CLIENTS_MAX {
        silent.push((house.tcp().await, house.websocket().await));
    }
    house.tcp().await.assert_speaks_msp().await;
    house.websocket().await.assert_speaks_msp().await;
    for client in &mut served {
        client.assert_speaks_msp().await;
    }
}

#[tokio::test]
async fn a_flood_of_strangers_gives_one_notice_with_their_number() {
    let mut house = House::usual().await;
    for _ in 0..80 {
        assert!(say(&house, EndpointKind::Tcp, &stun_up_to_hash()).await.is_closed().await);
    }
    let notice = next_notice(&mut house).await;
    assert!(notice.contains("TCP door") && notice.contains("WebRTC"), "{notice}");
    let number = notice.split(' ').next().and_then(|word| word.parse::<u32>().ok());
    assert!(notice.starts_with("A connection ") || number.is_some_and(|number| number <= 80), "{notice}");
    for _ in 0..80 {
        assert!(say(&house, EndpointKind::Tcp, &stun_up_to_hash()).await.is_closed().await);
    }
    // The next notice reports a different event.
    assert!(say(&house, EndpointKind::Tcp, b"GET / HTTP/1.1\r\n\r\n").await.is_closed().await);
    let notice = next_notice(&mut house).await;
    assert!(notice.contains("HTTP"), "{notice}");
}
