//! Packets of scripts and simulators at the UDP doors.

use std::time::{Duration, Instant};
use test_support::hex;

use betadeck::link::conventions::MotorOrder;
use betadeck::link::endpoint::{EndpointKind, EndpointState, Transport};
use betadeck::link::proto::fdm_link::FdmLinkConfig;
use betadeck::link::proto::{rc, servo};
use betadeck::link::{ExternalSimulator, MotorPort, Request, Sent};
use betadeck::signals::{MotorCommand, RcFrame};
use betadeck::telemetry::LinkState;
use tokio::net::UdpSocket;

use super::harness::{House, PATIENCE};

#[tokio::test]
async fn rc_and_states_arrive_and_other_sizes_are_counted() {
    let mut house = House::usual().await;
    let script = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let rc_door = house.address(EndpointKind::Rc);
    let mut frame = RcFrame::SAFE;
    frame.channels[4] = 2000;
    script.send_to(&[0; 39], rc_door).await.unwrap();
    let mut datagram = rc::encode(1.5, &frame).to_vec();
    datagram.extend([9, 9]);
    script.send_to(&datagram, rc_door).await.unwrap();
    let Some(Request::Rc { stamp_s, frame: received, .. }) = house.others.recv().await else {
        panic!("no RC")
    };
    assert_eq!((stamp_s, received), (1.5, frame));

    script.send_to(&[0; 143], house.address(EndpointKind::Fdm)).await.unwrap();
    script.send_to(&[1; 296], house.address(EndpointKind::Fdm)).await.unwrap();
    let Some(Request::Fdm { datagram, .. }) = house.others.recv().await else { panic!("no state") };
    assert_eq!(datagram.len(), 296);
    for view in house.doors.status().iter().filter(|view| view.kind.transport() == Transport::Udp) {
        let EndpointState::Packets(stats) = view.state else { panic!("{view:?}") };
        assert_eq!((stats.packets, stats.wrong_size), (1, 1), "{view:?}");
    }
}

fn worked() -> serde_json::Value {
    let vectors: serde_json::Value = serde_json::from_str(include_str!("../../../vectors/sim.json")).unwrap();
    vectors["wire"].clone()
}

fn bytes_of(case: &serde_json::Value) -> Vec<u8> {
    hex::decode(case["hex"].as_str().unwrap())
}

#[tokio::test]
async fn worked_rc_and_state_packets_arrive_as_they_were_sent() {
    let mut house = House::usual().await;
    let sender = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let wire = worked();
    for case in wire["rc"].as_array().unwrap() {
        let bytes = bytes_of(case);
        sender.send_to(&bytes, house.address(EndpointKind::Rc)).await.unwrap();
        let Some(Request::Rc { stamp_s, frame, .. }) = house.others.recv().await else { panic!("no RC") };
        assert_eq!(rc::encode(stamp_s, &frame).to_vec(), bytes, "{}", case["id"]);
        let channels: Vec<u64> = frame.channels.iter().map(|pulse| u64::from(*pulse)).collect();
        assert_eq!(serde_json::json!(channels), case["channels"], "{}", case["id"]);
    }
    for case in wire["fdm"].as_array().unwrap() {
        for dialect in ["sitl_gz", "gz_plugin_first18", "legacy"] {
            let bytes = bytes_of(&case[dialect]);
            sender.send_to(&bytes, house.address(EndpointKind::Fdm)).await.unwrap();
            let Some(Request::Fdm { datagram, .. }) = house.others.recv().await else { panic!("no state") };
            assert_eq!(datagram, bytes, "{} {dialect}", case["id"]);
        }
    }
}

#[tokio::test]
async fn every_size_of_the_table_is_judged_at_its_door() {
    const BEHIND: f64 = 77.0;
    let mut house = House::usual().await;
    let sender = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let wire = worked();
    for rule in wire["size_rules"].as_array().unwrap() {
        let (kind, case) = match rule["port"].as_u64().unwrap() {
            9003 => (EndpointKind::Fdm, &wire["fdm"][0]["sitl_gz"]),
            9004 => (EndpointKind::Rc, &wire["rc"][0]),
            // The motor ports receive nothing.
            _ => continue,
        };
        let good = bytes_of(case);
        let mut datagram = good.clone();
        datagram.resize(rule["bytes"].as_u64().unwrap() as usize, 0);
        // The first datagram has been judged once the second one arrives.
        let mut behind = good;
        behind[..8].copy_from_slice(&BEHIND.to_le_bytes());
        for bytes in [&datagram, &behind] {
            sender.send_to(bytes, house.address(kind)).await.unwrap();
        }
        let mut taken = 0;
        loop {
            let stamp_s = match house.others.recv().await {
                Some(Request::Rc { stamp_s, .. }) => stamp_s,
                Some(Request::Fdm { datagram, .. }) => f64::from_le_bytes(datagram[..8].try_into().unwrap()),
                other => panic!("{other:?} instead of a packet"),
            };
            if stamp_s == BEHIND {
                break;
            }
            taken += 1;
        }
        assert_eq!(taken == 1, rule["accepted"].as_bool().unwrap(), "{rule}");
    }
}

#[tokio::test]
async fn worked_motor_packets_leave_as_they_should() {
    use std::net::UdpSocket as Std;
    let (servo_socket, raw_socket) = (Std::bind("127.0.0.1:0").unwrap(), Std::bind("127.0.0.1:0").unwrap());
    servo_socket.set_read_timeout(Some(PATIENCE)).unwrap();
    raw_socket.set_read_timeout(Some(PATIENCE)).unwrap();
    let port = MotorPort::open(servo_socket.local_addr().unwrap(), raw_socket.local_addr().unwrap()).unwrap();
    let numbers = |case: &serde_json::Value| -> Vec<f32> {
        case["values"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap() as f32).collect()
    };
    let mut packet = [0; 100];
    let wire = worked();
    for case in wire["servo"].as_array().unwrap() {
        let motors: [f32; 4] = numbers(case).try_into().unwrap();
        let pulses = motors.map(|motor| (1000.0 + 1000.0 * f64::from(motor)).round() as f32);
        assert_eq!(port.send_servo(pulses), Sent::Sent);
        let size = servo_socket.recv(&mut packet).unwrap();
        assert_eq!(hex::encode(&packet[..size]), case["hex"], "{}", case["id"]);
    }
    for case in wire["servo_raw"].as_array().unwrap() {
        port.send_raw(numbers(case)[..4].try_into().unwrap());
        assert_eq!(raw_socket.recv(&mut packet).unwrap(), 68);
        // This craft has no servos after its motors.
        let motors = 4 + 4 * 4;
        assert_eq!(packet[..motors], bytes_of(case)[..motors], "{}", case["id"]);
        assert_eq!(packet[motors..68], [0; 48], "{}", case["id"]);
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
    let wire: serde_json::Value = serde_json::from_str(include_str!("../../../vectors/sim.json")).unwrap();
    let mut state = hex::decode(wire["wire"]["fdm"][0]["sitl_gz"]["hex"].as_str().unwrap());
    let mut buffer = [0; 100];
    let mut ticks = 0;
    for step in 0..300_u32 {
        let size = servo_socket.recv(&mut buffer).unwrap();
        assert_eq!(size, 16);
        assert_eq!(raw_socket.recv(&mut buffer).unwrap(), 68);
        state[..8].copy_from_slice(&(10.0 + f64::from(step) * 1e-3).to_le_bytes());
        // The time of the link, independent of the speed of this machine.
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
    assert_eq!(simulator.status(start).kind, EndpointKind::Motors);
}
