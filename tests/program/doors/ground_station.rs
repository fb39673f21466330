//! A MAVLink ground station at the door, which speaks by the protocol of the crate `betadeck-mavlink`.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use betadeck::mavlink::MissionItem;
use betadeck::mavlink::frame::{Frame, Version};
use betadeck::mavlink::message::CommandLong;
use betadeck::mavlink::state::GeoPosition;
use betadeck::mavlink::station::{Event, Order, StationOptions, StationProtocol, TransferEnd};
use betadeck::mavlink::value::MissionKind;

use super::program::{PATIENCE, Program};

const ARM: u16 = 400;
const TAKE_OFF: u16 = 22;

/// Starts a session at twenty times real time with a door for ground stations. Returns the address of the door.
fn serve(more: &[&str]) -> (Program, SocketAddr) {
    let options = "serve --fresh --ws-port 0 --tcp-port 0 --udp-ports 0,0,0,0 --mavlink tcp:0 --speed 20";
    let arguments = options.split(' ').chain(more.iter().copied()).collect::<Vec<_>>();
    let mut program = Program::start(&arguments);
    let address = program.wait("address of the door", |line| {
        line.split("MAVLink: listens on ").nth(1)?.split(',').next()?.parse().ok()
    });
    (program, address)
}

/// A ground station that is connected to the door.
struct Station {
    stream: TcpStream,
    protocol: StationProtocol,
    began: Instant,
    texts: String,
    sequence: u8,
}

impl Station {
    fn connect(address: SocketAddr) -> Self {
        let stream = TcpStream::connect(address).unwrap();
        stream.set_read_timeout(Some(Duration::from_millis(5))).unwrap();
        let protocol = StationProtocol::new(StationOptions::default());
        Self { stream, protocol, began: Instant::now(), texts: String::new(), sequence: 0 }
    }

    /// Moves bytes until `wanted` returns a value.
    fn until<T>(&mut self, what: &str, mut wanted: impl FnMut(&StationProtocol, &Event) -> Option<T>) -> T {
        let mut buffer = [0; 4096];
        while self.began.elapsed() < PATIENCE {
            match self.stream.read(&mut buffer) {
                Ok(0) => panic!("the door closed before {what}: {}", self.texts),
                Ok(length) => self.protocol.receive(self.began.elapsed(), &buffer[..length]),
                Err(error) => {
                    assert!(matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut), "{error}");
                }
            }
            self.protocol.advance(self.began.elapsed());
            while let Some(bytes) = self.protocol.poll_transmit() {
                self.stream.write_all(&bytes).unwrap();
            }
            while let Some(event) = self.protocol.poll_event() {
                if let Event::Text(text) = &event {
                    self.texts += &format!("{}\n", text.text);
                }
                if let Some(found) = wanted(&self.protocol, &event) {
                    return found;
                }
            }
            // Telemetry is no event.
            if let Some(found) = wanted(&self.protocol, &Event::LinkRestored) {
                return found;
            }
        }
        panic!("no {what}: {}", self.texts)
    }

    fn is_armed(&mut self, armed: bool) {
        self.until("arming", |protocol, _| {
            protocol.report().presence.as_ref().filter(|heard| heard.value.is_armed == armed).map(|_| ())
        });
    }

    /// Arms the craft as soon as it lets itself be armed.
    fn arm(&mut self) {
        loop {
            self.command(ARM, 1.0, 0.0);
            let asked = Instant::now();
            let is_armed = self.until("an answer", |protocol, _| {
                let is_armed = protocol.report().presence.as_ref().is_some_and(|heard| heard.value.is_armed);
                (is_armed || asked.elapsed() > Duration::from_millis(300)).then_some(is_armed)
            });
            if is_armed {
                return;
            }
        }
    }

    /// Waits for a text.
    fn says(&mut self, words: &str) {
        self.until(words, |_, event| match event {
            Event::Text(text) => text.text.contains(words).then_some(()),
            _ => None,
        });
    }

    /// Sends a command that the protocol of a station does not have.
    fn command(&mut self, command: u16, param1: f32, param7: f32) {
        self.sequence = self.sequence.wrapping_add(1);
        let message = CommandLong {
            command,
            param1,
            param7,
            target_system: 1,
            target_component: 1,
            ..CommandLong::default()
        };
        let frame = Frame {
            version: Version::V2,
            sequence: self.sequence,
            system: 255,
            component: 190,
            message: message.into(),
        };
        self.stream.write_all(&frame.encode().unwrap()).unwrap();
    }

    fn transfer(&mut self) -> TransferEnd {
        self.until("end of the transfer", |_, event| match event {
            Event::Transfer(end) => Some(end.clone()),
            _ => None,
        })
    }
}

fn item(command: u16, north_e7: i32, east_e7: i32, alt_m: f32, home: &GeoPosition) -> MissionItem {
    MissionItem {
        frame: 3,
        command,
        params: [0.0, 0.0, 0.0, f32::NAN],
        x: (home.lat_deg * 1e7).round() as i32 + north_e7,
        y: (home.lon_deg * 1e7).round() as i32 + east_e7,
        z: alt_m,
        is_current: false,
        autocontinue: true,
    }
}

#[test]
fn a_ground_station_uploads_a_mission_reads_it_back_and_flies_it_home() {
    let (_program, address) = serve(&["--mavlink-as", "px4"]);
    let mut station = Station::connect(address);
    let here = station.until("position with a fix", |protocol, _| {
        let report = protocol.report();
        report.gps.as_ref().filter(|heard| heard.value.satellites.is_some_and(|count| count > 5))?;
        report.position.as_ref().map(|heard| heard.value)
    });
    let items = vec![
        item(16, 4000, 0, 12.0, &here),
        item(16, 4000, 5000, 12.0, &here),
        item(21, 0, 5000, 0.0, &here),
    ];
    station.protocol.upload(MissionKind::Mission, items.clone()).unwrap();
    assert_eq!(station.transfer(), TransferEnd::Sent(MissionKind::Mission), "{}", station.texts);
    station.says("LAND is that of the ground");
    station.protocol.download(MissionKind::Mission).unwrap();
    let TransferEnd::Received { items: back, .. } = station.transfer() else { panic!("no items") };
    let places =
        |items: &[MissionItem]| items.iter().map(|item| (item.command, item.x, item.y)).collect::<Vec<_>>();
    assert_eq!(places(&back), places(&items));

    station.command(TAKE_OFF, 0.0, 8.0);
    station.says("arm first");
    station.arm();
    station.command(TAKE_OFF, 0.0, 8.0);
    station.until("8 m", |protocol, _| {
        protocol.report().altitude_above_home.as_ref().filter(|heard| heard.value > 7.5).map(|_| ())
    });
    station.command(ARM, 0.0, 0.0);
    station.says("would fall");
    station.protocol.order(&Order::StartMission).unwrap();
    station.until("the second item", |_, event| (*event == Event::ItemReached(1)).then_some(()));
    station.protocol.order(&Order::ReturnHome).unwrap();
    station.is_armed(false);
    let home = station.protocol.report().local_ned.as_ref().map(|heard| heard.value).unwrap();
    assert!(home[0].hypot(home[1]) < 5.0, "{home:?}");
}

#[test]
fn a_web_page_cannot_reach_the_door_of_ground_stations_and_noise_changes_nothing() {
    let (_program, address) = serve(&[]);
    let mut page = TcpStream::connect(address).unwrap();
    page.write_all(b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n").unwrap();
    page.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut answer = Vec::new();
    // The door may also reset the connection.
    drop(page.read_to_end(&mut answer));
    assert!(!answer.starts_with(b"HTTP"));

    let mut station = Station::connect(address);
    let noise: Vec<u8> = (0..100_000_u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    station.stream.write_all(&[&[0xfd][..], &noise].concat()).unwrap();
    station.is_armed(false);
    // The end of the noise may look like the begin of a frame, which swallows what follows.
    station.arm();
}
