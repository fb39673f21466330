//! The drop-in as seen by an external simulator, an RC script and a client of its serial port.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests may panic and wait")]

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::time::Duration;

use crate::protocols::at_rest::at_rest;
use betadeck::firmware::cli::BuildInfo;
use betadeck::firmware::{AttitudeSource, FirmwareOptions};
use betadeck::link::ListenConfig;
use betadeck::link::conventions::Dialect;
use betadeck::link::conventions::MotorOrder;
use betadeck::link::endpoint::EndpointKind;
use betadeck::link::proto::fdm_link::FdmLinkConfig;
use betadeck::link::proto::{rc, servo};
use betadeck::session::sitl::{OutputLine, Sitl, SitlConfig, SitlEnd, SitlError, SitlPorts};
use betadeck::signals::RcFrame;
use betadeck::storage::Store;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::{TcpStream, UdpSocket};
use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;

/// The time limit of every wait. Nothing in these tests takes this long unless it hangs.
const PATIENCE: Duration = Duration::from_secs(600);

/// A drop-in, with a simulator and a script connected to it.
struct Rig {
    fdm_door: SocketAddr,
    rc_door: SocketAddr,
    tcp_door: SocketAddr,
    motors: UdpSocket,
    raw: UdpSocket,
    sender: UdpSocket,
    said: mpsc::UnboundedReceiver<OutputLine>,
    stop: Option<oneshot::Sender<()>>,
    task: JoinHandle<SitlEnd>,
    stamp_ms: u64,
}

async fn socket() -> UdpSocket {
    UdpSocket::bind("127.0.0.1:0").await.unwrap()
}

async fn receive(socket: &UdpSocket) -> Vec<u8> {
    let mut buffer = [0; 200];
    let size = tokio::time::timeout(PATIENCE, socket.recv(&mut buffer)).await.unwrap().unwrap();
    buffer[..size].to_vec()
}

impl Rig {
    async fn new(exit_on_reboot: bool) -> Self {
        let (motors, raw) = (socket().await, socket().await);
        let config = SitlConfig {
            doors: ListenConfig { tcp_port: Some(0), ws_port: Some(0), ..ListenConfig::default() },
            motors_ip: IpAddr::V4(Ipv4Addr::LOCALHOST),
            ports: SitlPorts {
                raw: raw.local_addr().unwrap().port(),
                motors: motors.local_addr().unwrap().port(),
                fdm: 0,
                rc: 0,
            },
            firmware: FirmwareOptions {
                arm_assist: true,
                attitude: AttitudeSource::Truth,
                ..FirmwareOptions::default()
            },
            build: BuildInfo::default(),
            fdm: FdmLinkConfig::default(),
            motor_order: MotorOrder::Native,
            profile: None,
            exit_on_reboot,
        };
        let (says, said) = mpsc::unbounded_channel();
        let mut print = move |line| drop(says.send(line));
        let sitl = Sitl::open(config, Store::in_memory(), &mut print)
            .await
            .unwrap_or_else(|error| panic!("{error}"));
        let address = |door| sitl.address(door).unwrap();
        let (fdm_door, rc_door, tcp_door) =
            (address(EndpointKind::Fdm), address(EndpointKind::Rc), address(EndpointKind::Tcp));
        let (stop, stopped) = oneshot::channel::<()>();
        let task = tokio::spawn(async move {
            let (end, doors) = sitl
                .run(&mut print, &mut |_| {}, async {
                    let _gone = stopped.await;
                })
                .await;
            doors.close().await;
            end
        });
        let sender = socket().await;
        Self { fdm_door, rc_door, tcp_door, motors, raw, sender, said, stop: Some(stop), task, stamp_ms: 0 }
    }

    /// Runs one step of a simulator that waits for each answer. Returns the motors of the answer.
    async fn step(&mut self) -> [f32; 4] {
        self.stamp_ms += 1;
        let state = at_rest(self.stamp_ms as f64 * 1e-3);
        self.sender.send_to(&Dialect::SitlGz.encode(&state).to_bytes(), self.fdm_door).await.unwrap();
        let answer = receive(&self.motors).await;
        servo::decode(&answer).unwrap()
    }

    async fn send_rc(&self, throttle: u16, arm: u16) {
        let mut frame = RcFrame::SAFE;
        frame.channels[2] = throttle;
        frame.channels[4] = arm;
        self.sender.send_to(&rc::encode(0.0, &frame), self.rc_door).await.unwrap();
    }

    async fn client(&self) -> TcpStream {
        TcpStream::connect(self.tcp_door).await.unwrap()
    }

    async fn stop(mut self) -> SitlEnd {
        drop(self.stop.take());
        tokio::time::timeout(PATIENCE, self.task).await.unwrap().unwrap()
    }

    fn lines(&mut self) -> Vec<String> {
        std::iter::from_fn(|| self.said.try_recv().ok())
            .map(|said| match said {
                OutputLine::Out(line) | OutputLine::Err(line) => line,
            })
            .collect()
    }
}

async fn read_until(stream: &mut TcpStream, end: &[u8]) -> Vec<u8> {
    let mut all = Vec::new();
    while !all.ends_with(end) {
        let mut byte = [0];
        tokio::time::timeout(PATIENCE, stream.read_exact(&mut byte)).await.unwrap().unwrap();
        all.push(byte[0]);
    }
    all
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_simulator_and_a_script_arm_the_craft() {
    let mut rig = Rig::new(false).await;
    assert_eq!(receive(&rig.motors).await, [0; 16], "one packet at the start");
    assert_eq!(receive(&rig.raw).await.len(), 68);

    let mut client = rig.client().await;
    client.write_all(b"\x02aux 0 0 0 1700 2100 0 0\n\x03").await.unwrap();
    read_until(&mut client, b"\x03").await;

    // The first RC of the guide's script: throttle 1100 and ARM on from the first packet.
    let mut motors = [0.0; 4];
    for ms in 0..7000 {
        motors = rig.step().await;
        if ms % 20 == 0 && ms > 5500 {
            rig.send_rc(1100, 2000).await;
        }
    }
    assert!(motors.iter().all(|motor| *motor > 0.01), "{motors:?}");

    client.write_all(b"$M<\x00\x6a\x6a").await.unwrap();
    let mut reply = [0; 24];
    client.read_exact(&mut reply).await.unwrap();
    assert_eq!(reply[5..7], [2, 12], "fix, satellites");
    assert_eq!(i32::from_le_bytes(reply[7..11].try_into().unwrap()), 404_635_000);

    let lines = rig.lines();
    assert!(lines[0].starts_with("[SITL] The SITL will output to IP 127.0.0.1:"), "{lines:?}");
    assert!(lines.iter().any(|line| line.starts_with("[SITL] new fdm 144 t:0.001000 from 127.0.0.1:")));
    assert!(
        lines.iter().any(|line| line.starts_with("[SITL] new rc 40: t:0.000000 AETR: 1500 1500 1100 1500"))
    );
    assert!(lines.iter().any(|line| line == "New connection on UART1, 0"));
    let websocket = "[SITL] websocket for the Betaflight App: ws://127.0.0.1:";
    assert!(lines.iter().any(|line| line.starts_with(websocket) && !line.ends_with(":0")), "{lines:?}");
    assert_eq!(rig.stop().await, SitlEnd::Stopped);
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn a_save_restarts_the_firmware_and_keeps_what_was_saved() {
    let mut rig = Rig::new(false).await;
    receive(&rig.motors).await;
    for _ in 0..50 {
        rig.step().await;
    }
    let mut person = rig.client().await;
    person.write_all(b"#").await.unwrap();
    read_until(&mut person, b"\r\n# ").await;
    person.write_all(b"set ap_max_angle = 33\nsave\n").await.unwrap();
    read_until(&mut person, b"\r\nRebooting").await;
    assert_eq!(person.read(&mut [0]).await.unwrap(), 0, "the link closes");

    let mut again = rig.client().await;
    again.write_all(b"\x02get ap_max_angle\n\x03").await.unwrap();
    let answer = String::from_utf8(read_until(&mut again, b"\x03").await).unwrap();
    assert!(answer.contains("ap_max_angle = 33"), "{answer:?}");
    for _ in 0..50 {
        rig.step().await;
    }
    assert!(rig.lines().contains(&"[system]Reset!".to_owned()));
    rig.stop().await;
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn bad_packets_are_shown_by_status_and_at_the_end() {
    let mut rig = Rig::new(false).await;
    receive(&rig.motors).await;
    rig.step().await;
    rig.sender.send_to(&[0; 40], rig.fdm_door).await.unwrap();
    rig.sender.send_to(&[0; 7], rig.rc_door).await.unwrap();
    // The quaternion of this packet is no rotation.
    rig.sender.send_to(&[0; 144], rig.fdm_door).await.unwrap();
    let mut person = rig.client().await;
    let mut answer = String::new();
    let begun = tokio::time::Instant::now();
    while !answer.contains("\r\nBad packets: 3 (2 of a wrong size, 1 senseless)\r\n") {
        assert!(begun.elapsed() < PATIENCE, "{answer}");
        tokio::time::sleep(Duration::from_millis(100)).await;
        person.write_all(b"\x02status\n\x03").await.unwrap();
        answer = String::from_utf8(read_until(&mut person, b"\x03").await).unwrap();
    }
    drop(rig.stop.take());
    assert_eq!(tokio::time::timeout(PATIENCE, &mut rig.task).await.unwrap().unwrap(), SitlEnd::Stopped);
    let lines = rig.lines();
    let end = "[SITL] Bad packets: 3 (2 of a wrong size, 1 senseless).";
    assert!(lines.iter().any(|line| line == end), "{lines:?}");
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn it_can_end_at_a_restart() {
    let rig = Rig::new(true).await;
    let mut client = rig.client().await;
    client.write_all(b"$M<\x00\x44\x44").await.unwrap();
    assert_eq!(read_until(&mut client, &[0x45]).await, b"$M>\x01\x44\x00\x45");
    assert_eq!(tokio::time::timeout(PATIENCE, rig.task).await.unwrap().unwrap(), SitlEnd::Rebooted);
}

#[tokio::test]
async fn a_port_in_use_ends_it_with_the_way_out() {
    let taken = socket().await;
    let port = taken.local_addr().unwrap().port();
    let config = SitlConfig {
        doors: ListenConfig { tcp_port: Some(0), ws_port: None, ..ListenConfig::default() },
        motors_ip: IpAddr::V4(Ipv4Addr::LOCALHOST),
        ports: SitlPorts { raw: 9, motors: 9, fdm: port, rc: 0 },
        firmware: FirmwareOptions::default(),
        build: BuildInfo::default(),
        fdm: FdmLinkConfig::default(),
        motor_order: MotorOrder::Native,
        profile: None,
        exit_on_reboot: false,
    };
    let mut lines = Vec::new();
    let opened = Sitl::open(config, Store::in_memory(), &mut |said| lines.push(said)).await;
    let Err(error @ SitlError::Doors(_)) = opened.map(drop) else { panic!("it runs without its ports") };
    assert!(error.to_string().contains(&format!("UDP port {port} is in use")), "{error}");
    assert!(lines.contains(&OutputLine::Out(format!("[SITL] start UDP server @{port}...-1"))), "{lines:?}");
}
