//! The stand-in follows the rules measured on the public executable. Otherwise it could not judge.

use super::stand_in::packet::{Gps, Packet};
use super::stand_in::receiver::{Receiver, Taken};
use super::wire;

const MS: u64 = 1000;

fn stamped(stamp_s: f64) -> Vec<u8> {
    let mut bytes = wire::bytes("W1", "sitl_gz");
    bytes[..8].copy_from_slice(&stamp_s.to_le_bytes());
    bytes
}

#[test]
fn it_reads_the_worked_packets_as_the_executable_was_seen_to() {
    let home = (40.4635, -79.51825);
    let read = |case| Packet::read(&wire::bytes(case, "sitl_gz")).unwrap().sensors(home);
    let level = read("W1");
    assert_eq!((level.acc, level.baro_pa), ([0, 0, 256], 101_325));
    // The executable counts in single precision.
    let near =
        |mag: [i32; 3], seen: [i32; 3]| mag.iter().zip(seen).all(|(count, seen)| (count - seen).abs() <= 1);
    assert!(near(level.mag, [2047, -72, -3547]) && near(read("W2").mag, [72, 2047, -3547]));
    let north = read("W3");
    assert_eq!((north.acc, north.baro_pa), ([-44, 0, 252], 101_084));
    assert!(near(north.mag, [2632, -72, -3138]));
    let Gps { lat, alt_cm, speed_cms, course_decideg, .. } = north.gps.unwrap();
    assert_eq!((lat, alt_cm, speed_cms, course_decideg), (404_639_502, 2000, 500, 0));
    // Yawing right by 0.5 rad/s.
    assert_eq!(read("W4").gyro[2], -469);
}

#[test]
fn a_pause_sets_the_time_base_an_old_stamp_is_dropped_and_a_packet_opens_the_gate_once() {
    let mut receiver = Receiver::new();
    assert_eq!(receiver.receive(&stamped(5.0), 501 * MS), Taken::Resync);
    assert!(receiver.sensors().is_none() && !receiver.mixer_sends());
    assert_eq!(receiver.receive(&stamped(5.001), 502 * MS), Taken::State);
    assert_eq!(receiver.receive(&stamped(5.002), 502 * MS), Taken::State);
    assert!(receiver.mixer_sends() && !receiver.mixer_sends());
    assert_eq!(receiver.receive(&stamped(4.9), 900 * MS), Taken::Old);
    assert_eq!(receiver.receive(&stamped(4.9), 1003 * MS), Taken::Resync);
    assert_eq!(receiver.receive(&stamped(4.9)[..143], 1004 * MS), Taken::Refused);
}

#[test]
fn the_centre_of_the_mirror_is_the_first_position_that_it_processes_even_one_off_the_globe() {
    let mut lost = wire::bytes("W1", "sitl_gz");
    for field in [14, 15] {
        lost[8 * field..8 * field + 8].copy_from_slice(&999.0_f64.to_le_bytes());
    }
    let mut receiver = Receiver::new();
    receiver.receive(&lost, 100 * MS);
    assert!(!receiver.has_fix(100 * MS));
    receiver.receive(&wire::bytes("W1", "sitl_gz"), 101 * MS);
    let gps = receiver.sensors().unwrap().gps.unwrap();
    assert!((f64::from(gps.lat) * 1e-7 - (1998.0 - 40.4635)).abs() > 1.0, "it does not fit: {gps:?}");
    assert!(receiver.has_fix(2600 * MS) && !receiver.has_fix(2602 * MS));
}

#[test]
fn its_clock_leaps_with_stamps_that_advance_out_of_step_and_keeps_time_with_one_that_stops() {
    let fly = |stamp: &dyn Fn(u64) -> f64| {
        let (mut receiver, mut packet, mut wall) = (Receiver::new(), stamped(0.0), 0);
        for k in 0..10_000_u64 {
            // Bursts: four packets at once, then a pause of four steps.
            wall = k / 4 * 4 * MS + k % 4 * 20;
            packet[..8].copy_from_slice(&stamp(k).to_le_bytes());
            receiver.receive(&packet, wall);
        }
        receiver.clock_us(wall) - wall as f64
    };
    assert!(fly(&|_| 1.0).abs() < 1.0);
    assert!(fly(&|k| k as f64 * 1e-3).abs() > 1e6, "the wall clock is no rate");
}
