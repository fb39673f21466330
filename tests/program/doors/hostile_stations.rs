//! Programs that mean harm, at the door of ground stations.
#![cfg(target_os = "linux")]

use std::io::{Read as _, Write as _};
use std::net::{TcpStream, UdpSocket};
use std::thread;

use betadeck::mavlink::message::{
    CommandLong, ManualControl, MissionCount, MissionItemInt, ParamSet, RcChannelsOverride,
};
use betadeck::mavlink::{Text, frame::Version};

use super::ground_station::{Station, frame_of, packet, serve};
use super::memory::peak_kib;

/// The number of frames, of all peers together.
const FRAMES: usize = 1_000_000;
/// The limit of the memory that they take, KiB: a fraction of the 50 MB that they are.
const BOUND_KIB: u64 = 8 * 1024;
/// Commands without a number in any field. A landing and a return have no fields that they need, so they are not hostile.
const COMMANDS: [u16; 9] = [22, 176, 178, 179, 192, 193, 224, 400, 511];

/// Returns frames of every kind that a door must not be harmed by.
fn hostile() -> Vec<Vec<u8>> {
    let nan = f32::NAN;
    let to = |count, sequence| MissionCount {
        count,
        target_system: 1,
        target_component: 1,
        mission_type: sequence,
        ..MissionCount::default()
    };
    let mut frames: Vec<Vec<u8>> = COMMANDS
        .iter()
        .map(|&command| {
            let [param1, param2, param3, param4, param5, param6, param7] = [nan; 7];
            let (target_system, target_component) = (1, 1);
            packet(
                0,
                CommandLong {
                    param1,
                    param2,
                    param3,
                    param4,
                    param5,
                    param6,
                    param7,
                    command,
                    target_system,
                    target_component,
                    confirmation: 0,
                },
            )
        })
        .collect();
    // Two uploads at once, of more items than there can be, and items that nobody asked for.
    frames.push(packet(1, to(u16::MAX, 0)));
    frames.push(frame_of(Version::V1, 254, 2, to(u16::MAX, 0)));
    let item = MissionItemInt {
        z: nan,
        param1: nan,
        seq: u16::MAX,
        command: 16,
        target_system: 1,
        target_component: 1,
        ..MissionItemInt::default()
    };
    frames.push(packet(3, item));
    frames.push(packet(
        4,
        ParamSet {
            param_value: nan,
            target_system: 1,
            target_component: 1,
            param_id: Text::new("AP_MAX_ANGLE"),
            param_type: 9,
        },
    ));
    frames.push(packet(
        5,
        RcChannelsOverride { target_system: 1, target_component: 1, ..RcChannelsOverride::default() },
    ));
    frames.push(packet(6, ManualControl { target: 1, z: i16::MIN, ..ManualControl::default() }));
    let good = packet(7, to(3, 0));
    let changed = |at: usize, value: u8| {
        let mut frame = good.clone();
        frame[at] = value;
        frame
    };
    // A wrong length, a frame of another kind, a signature that is not there, an unknown number, a wrong checksum.
    frames.extend([changed(1, 255), changed(1, 0), changed(2, 0xff), changed(2, 1), changed(7, 0x77)]);
    frames.push(changed(good.len() - 1, good[good.len() - 1] ^ 1));
    frames
}

#[test]
fn a_million_hostile_frames_leave_the_flight_and_the_memory_alone() {
    let listener = UdpSocket::bind("127.0.0.1:0").unwrap();
    let place = format!("udp:{}", listener.local_addr().unwrap().port());
    let (program, address) = serve(&["--mavlink-as", "px4", "--mavlink", &place]);
    let door = listener.recv_from(&mut [0; 2048]).unwrap().1;
    let mut station = Station::connect(address);
    station.uploads_a_square();
    let before = peak_kib(program.id());

    let frames = hostile();
    let half = FRAMES / 2 / frames.len();
    let bytes = frames.concat();
    let mut stream = TcpStream::connect(address).unwrap();
    let mut answers = stream.try_clone().unwrap();
    let reader = thread::spawn(move || while matches!(answers.read(&mut [0; 65_536]), Ok(1..)) {});
    let over_tcp = thread::spawn(move || {
        // The first bytes of a connection begin with a frame.
        for _ in 0..half {
            stream.write_all(&bytes).unwrap();
        }
        stream.shutdown(std::net::Shutdown::Both).unwrap();
    });
    let over_udp = thread::spawn(move || {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        for _ in 0..half {
            for frame in &frames {
                // The system drops datagrams that the door does not read.
                drop(socket.send_to(frame, door));
            }
        }
    });
    station.flies_the_square_and_returns();
    over_tcp.join().unwrap();
    over_udp.join().unwrap();
    reader.join().unwrap();
    let taken = peak_kib(program.id()) - before;
    assert!(taken < BOUND_KIB, "{taken} KiB");
    // The door still serves.
    station.command(22, 0.0, 8.0);
    station.says("arm first");
}
