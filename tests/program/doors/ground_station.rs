//! A MAVLink ground station at the door, which speaks by the protocol of the crate `betadeck-mavlink`.

use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, TcpStream, UdpSocket};
use std::time::{Duration, Instant};

use betadeck::mavlink::frame::{Frame, FrameReader, Version};
use betadeck::mavlink::message::{CommandLong, Message, ParamSet};
use betadeck::mavlink::state::GeoPosition;
use betadeck::mavlink::station::{Event, Order, StationOptions, StationProtocol, TransferEnd};
use betadeck::mavlink::value::MissionKind;
use betadeck::mavlink::{MissionItem, Text};

use super::program::{PATIENCE, Program};

const ARM: u16 = 400;
const TAKE_OFF: u16 = 22;

/// Starts a session at twenty times real time with a door for ground stations. Returns the address of the door.
pub(super) fn serve(more: &[&str]) -> (Program, SocketAddr) {
    serve_at("20", more)
}

/// Does the same as [`serve`] at another speed.
pub(super) fn serve_at(speed: &str, more: &[&str]) -> (Program, SocketAddr) {
    let mut program = start(speed, &[&["--mavlink", "tcp:0"], more].concat());
    let address = program.wait("address of the door", |line| {
        line.split("MAVLink: listens on ").nth(1)?.split(',').next()?.parse().ok()
    });
    (program, address)
}

/// Starts a session.
fn start(speed: &str, more: &[&str]) -> Program {
    let options = "serve --fresh --ws-port 0 --tcp-port 0 --udp-ports 0,0,0,0 --speed";
    let arguments = options.split(' ').chain([speed]).chain(more.iter().copied()).collect::<Vec<_>>();
    Program::start(&arguments)
}

/// A ground station that is connected to the door.
pub(super) struct Station {
    stream: TcpStream,
    protocol: StationProtocol,
    began: Instant,
    texts: String,
    sequence: u8,
}

impl Station {
    pub(super) fn connect(address: SocketAddr) -> Self {
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
    pub(super) fn says(&mut self, words: &str) {
        self.until(words, |_, event| match event {
            Event::Text(text) => text.text.contains(words).then_some(()),
            _ => None,
        });
    }

    /// Sends a command that the protocol of a station does not have.
    pub(super) fn command(&mut self, command: u16, param1: f32, param7: f32) {
        self.sequence = self.sequence.wrapping_add(1);
        let message = CommandLong {
            command,
            param1,
            param7,
            target_system: 1,
            target_component: 1,
            ..CommandLong::default()
        };
        self.stream.write_all(&packet(self.sequence, message)).unwrap();
    }

    /// Waits for the position of a craft with a fix.
    fn position(&mut self) -> GeoPosition {
        self.until("position with a fix", |protocol, _| {
            let report = protocol.report();
            report.gps.as_ref().filter(|heard| heard.value.satellites.is_some_and(|count| count > 5))?;
            report.position.as_ref().map(|heard| heard.value)
        })
    }

    /// Uploads a mission over two corners to a landing, and reads it back.
    pub(super) fn uploads_a_square(&mut self) {
        let here = self.position();
        let items = vec![
            item(16, 4000, 0, 12.0, &here),
            item(16, 4000, 5000, 12.0, &here),
            item(21, 0, 5000, 0.0, &here),
        ];
        self.protocol.upload(MissionKind::Mission, items.clone()).unwrap();
        assert_eq!(self.transfer(), TransferEnd::Sent(MissionKind::Mission), "{}", self.texts);
        self.says("LAND is that of the ground");
        self.protocol.download(MissionKind::Mission).unwrap();
        let TransferEnd::Received { items: back, .. } = self.transfer() else { panic!("no items") };
        let places = |items: &[MissionItem]| {
            items.iter().map(|item| (item.command, item.x, item.y)).collect::<Vec<_>>()
        };
        assert_eq!(places(&back), places(&items));
    }

    /// Arms, takes off, flies the mission to its second item, and returns home.
    pub(super) fn flies_the_square_and_returns(&mut self) {
        self.arm();
        self.command(TAKE_OFF, 0.0, 8.0);
        self.until("8 m", |protocol, _| {
            protocol.report().altitude_above_home.as_ref().filter(|heard| heard.value > 7.5).map(|_| ())
        });
        self.command(ARM, 0.0, 0.0);
        self.says("would fall");
        self.protocol.order(&Order::StartMission).unwrap();
        self.until("the second item", |_, event| (*event == Event::ItemReached(1)).then_some(()));
        self.protocol.order(&Order::ReturnHome).unwrap();
        self.is_armed(false);
        let home = self.protocol.report().local_ned.as_ref().map(|heard| heard.value).unwrap();
        assert!(home[0].hypot(home[1]) < 5.0, "{home:?}");
    }

    fn transfer(&mut self) -> TransferEnd {
        self.until("end of the transfer", |_, event| match event {
            Event::Transfer(end) => Some(end.clone()),
            _ => None,
        })
    }
}

/// Returns the bytes of a message from a ground station.
pub(super) fn packet(sequence: u8, message: impl Into<Message>) -> Vec<u8> {
    frame_of(Version::V2, 255, sequence, message)
}

/// Does the same as [`packet`] for a version of the protocol and a system.
pub(super) fn frame_of(version: Version, system: u8, sequence: u8, message: impl Into<Message>) -> Vec<u8> {
    Frame { version, sequence, system, component: 190, message: message.into() }.encode().unwrap()
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
    station.uploads_a_square();
    station.command(TAKE_OFF, 0.0, 8.0);
    station.says("arm first");
    station.flies_the_square_and_returns();
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

#[test]
fn a_ground_station_draws_the_fence_as_a_circle_around_home_and_takes_it_away() {
    let (_program, address) = serve(&[]);
    let mut station = Station::connect(address);
    let here = station.position();
    let circle = MissionItem { params: [180.0, 0.0, 0.0, 0.0], ..item(5003, 0, 0, 0.0, &here) };
    station.protocol.upload(MissionKind::Fence, vec![circle]).unwrap();
    assert_eq!(station.transfer(), TransferEnd::Sent(MissionKind::Fence), "{}", station.texts);
    let radius = |station: &mut Station| {
        station.protocol.download(MissionKind::Fence).unwrap();
        let TransferEnd::Received { items, .. } = station.transfer() else { panic!("no items") };
        items.first().map(|item| item.params[0])
    };
    assert_eq!(radius(&mut station), Some(180.0));

    station.protocol.upload(MissionKind::Fence, vec![item(5001, 0, 0, 0.0, &here); 3]).unwrap();
    assert!(matches!(station.transfer(), TransferEnd::Refused(..)));
    station.says("a polygon");
    assert_eq!(radius(&mut station), Some(180.0), "the fence is unchanged");

    station.protocol.upload(MissionKind::Fence, Vec::new()).unwrap();
    assert_eq!(station.transfer(), TransferEnd::Sent(MissionKind::Fence), "{}", station.texts);
    assert_eq!(radius(&mut station), None);
}

#[test]
fn a_web_page_cannot_reach_the_door_by_a_datagram_with_a_frame_inside() {
    let listener = UdpSocket::bind("127.0.0.1:0").unwrap();
    listener.set_read_timeout(Some(PATIENCE)).unwrap();
    let place = format!("udp:{}", listener.local_addr().unwrap().port());
    let _program = start("20", &["--mavlink", &place]);
    let (mut buffer, mut reader) = ([0; 2048], FrameReader::default());
    let (length, door) = listener.recv_from(&mut buffer).unwrap();
    assert!(reader.next_frame(&mut &buffer[..length]).is_some(), "the door sends frames of its own accord");

    let set = |param_id: &str, param_value| ParamSet {
        param_value,
        target_system: 1,
        target_component: 1,
        param_id: Text::new(param_id),
        param_type: 9,
    };
    // A request of WebRTC begins with 0x0001 and has a user name that the page chooses.
    let mut request = b"\x00\x01\x00\x50\x21\x12\xa4\x42wwwwwwwwwwww\x00\x06\x00\x40".to_vec();
    request.extend(packet(0, set("AP_MAX_ANGLE", 17.0)));
    let page = UdpSocket::bind("127.0.0.1:0").unwrap();
    page.send_to(&request, door).unwrap();

    // The answer to a later change shows that the request was read, and had its time to have an effect. A change may come
    // before the settings of the craft are known, so it is repeated until it is answered.
    listener.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    let mut reported = Vec::new();
    let mut change = |name: &str, number: f32| {
        let began = Instant::now();
        let mut sent = None;
        while !reported.contains(&(Text::new(name), number)) {
            assert!(began.elapsed() < PATIENCE, "no change of {name}");
            if sent.is_none_or(|sent: Instant| sent.elapsed() > Duration::from_millis(200)) {
                listener.send_to(&packet(0, set(name, number)), door).unwrap();
                sent = Some(Instant::now());
            }
            let Ok((length, _)) = listener.recv_from(&mut buffer) else { continue };
            let mut bytes = &buffer[..length];
            while let Some(frame) = reader.next_frame(&mut bytes) {
                if let Message::ParamValue(value) = frame.message {
                    reported.push((value.param_id, value.param_value));
                }
            }
        }
    };
    change("AP_MAX_ANGLE", 33.0);
    page.send_to(&request, door).unwrap();
    change("AP_WP_RADIUS", 400.0);
    change("AP_WP_RADIUS", 450.0);
    assert!(!reported.contains(&(Text::new("AP_MAX_ANGLE"), 17.0)), "{reported:?}");
    // No earlier value is reported in between.
    let radii = reported.iter().filter(|(name, _)| *name == Text::new("AP_WP_RADIUS"));
    let mut radii = radii.map(|(_, number)| *number).collect::<Vec<_>>();
    radii.dedup();
    assert_eq!(radii, [400.0, 450.0]);
}
