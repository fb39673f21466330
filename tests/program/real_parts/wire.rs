//! The link's packets against reference packets. Encoder and decoder are written independently (L-1, L-2).

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::fdm::{Packet, State, mirrored};
use betadeck::link::proto::{rc, servo};
use betadeck::signals::RcFrame;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use serde_json::Value;
use test_support::hex;

use super::stand_in::packet;

const CASES: [&str; 5] = ["W1", "W2", "W3", "W4", "W5"];

fn wire() -> Value {
    let vectors: Value = serde_json::from_str(include_str!("../../vectors/sim.json")).unwrap();
    vectors["wire"].clone()
}

fn case(id: &str) -> Value {
    let wire = wire();
    let cases = wire["fdm"].as_array().unwrap();
    cases.iter().find(|case| case["id"] == id).unwrap_or_else(|| panic!("no case {id}")).clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// Returns the bytes of a reference packet.
pub(crate) fn bytes(id: &str, dialect: &str) -> Vec<u8> {
    hex::decode(case(id)[dialect]["hex"].as_str().unwrap())
}

fn state(case: &Value) -> State {
    let truth = &case["true"];
    let vector = |name: &str| Vector3::from_column_slice(&numbers(&truth[name]));
    let q = numbers(&truth["q_body_flu_to_enu_wxyz"]);
    let home = numbers(&wire()["home_lat_lon_alt"]);
    let number = |name: &str| truth[name].as_f64().unwrap();
    State {
        stamp_s: case["sitl_gz"]["values"][0].as_f64().unwrap(),
        rate_flu: vector("omega_flu"),
        specific_force_flu: vector("specific_force_flu"),
        attitude: UnitQuaternion::new_unchecked(Quaternion::new(q[0], q[1], q[2], q[3])),
        vel_enu: vector("vel_enu"),
        lon_deg: mirrored(home[1], number("lon_deg")),
        lat_deg: mirrored(home[0], number("lat_deg")),
        alt_m: number("alt_m"),
        pressure_pa: 0.0,
    }
}

#[test]
fn an_executable_that_reads_our_packets_finds_the_craft_where_and_how_it_is() {
    let home = numbers(&wire()["home_lat_lon_alt"]);
    for id in CASES {
        let case = case(id);
        let truth = state(&case);
        let sent = Dialect::SitlGz.encode(&truth).to_bytes();
        let read = packet::Packet::read(&sent).unwrap().sensors((home[0], home[1]));
        // East-north-up → north-west-up.
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -std::f64::consts::FRAC_PI_2);
        assert!(read.attitude.angle_to(&(turn * truth.attitude)) < 1e-9, "{id}");
        let felt = truth.specific_force_flu * (256.0 / 9.80665);
        assert!(
            read.acc.iter().zip(felt.iter()).all(|(count, felt)| (f64::from(*count) - felt).abs() <= 1.0)
        );
        let rate = truth.rate_flu * (57.29578 * 16.4);
        assert!(
            read.gyro.iter().zip(rate.iter()).all(|(count, rate)| (f64::from(*count) - rate).abs() <= 1.0)
        );
        let gps = read.gps.unwrap();
        let place = |name: &str| case["true"][name].as_f64().unwrap() * 1e7;
        assert!((f64::from(gps.lat) - place("lat_deg")).abs() <= 1.0, "{id}: {gps:?}");
        assert!((f64::from(gps.lon) - place("lon_deg")).abs() <= 1.0, "{id}: {gps:?}");
        assert_eq!(gps.alt_cm, (truth.alt_m * 100.0) as i32, "{id}");
    }
}

#[test]
fn every_dialect_finds_its_own_state_again() {
    for id in CASES {
        for dialect in [Dialect::SitlGz, Dialect::GzPlugin, Dialect::Legacy] {
            let sent = state(&case(id));
            let bytes = dialect.encode(&sent).to_bytes();
            let found = dialect.decode(&Packet::parse(&bytes).unwrap(), dialect.usual_gravity());
            let close = |a: Vector3<f64>, b: Vector3<f64>| (a - b).amax() <= 1e-12;
            assert!(
                close(found.rate_flu, sent.rate_flu) && close(found.vel_enu, sent.vel_enu),
                "{id} {dialect:?}"
            );
            assert!(close(found.specific_force_flu, sent.specific_force_flu), "{id} {dialect:?}");
            assert!(found.attitude.angle_to(&sent.attitude) < 1e-9, "{id} {dialect:?}");
            assert!(
                (found.lat_deg - sent.lat_deg).abs() <= 1e-9 && (found.lon_deg - sent.lon_deg).abs() <= 1e-9
            );
        }
    }
}

#[test]
fn motor_and_rc_packets_are_what_other_programs_read_and_write() {
    let wire = wire();
    let float = |bytes: &[u8], at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
    for case in wire["servo"].as_array().unwrap() {
        let bytes = hex::decode(case["hex"].as_str().unwrap());
        let values = servo::decode(&bytes).unwrap();
        assert_eq!(values, [0, 4, 8, 12].map(|at| float(&bytes, at)), "{}", case["id"]);
        assert_eq!(
            servo::encode(values.map(|value| 1000.0 + 1000.0 * value)).to_vec(),
            bytes,
            "{}",
            case["id"]
        );
    }
    for case in wire["servo_raw"].as_array().unwrap() {
        let bytes = hex::decode(case["hex"].as_str().unwrap());
        let count = u16::from_le_bytes([bytes[0], bytes[1]]);
        let pulses: Vec<f32> = (0..16).map(|at| float(&bytes, 4 + 4 * at)).collect();
        assert_eq!(servo::encode_raw(count, &pulses).to_vec(), bytes, "{}", case["id"]);
    }
    for case in wire["rc"].as_array().unwrap() {
        let bytes = hex::decode(case["hex"].as_str().unwrap());
        let channels = std::array::from_fn(|at| u16::from_le_bytes([bytes[8 + 2 * at], bytes[9 + 2 * at]]));
        let stamp_s = f64::from_le_bytes(bytes[..8].try_into().unwrap());
        assert_eq!(rc::decode(&bytes), Some((stamp_s, RcFrame { channels })), "{}", case["id"]);
        assert_eq!(rc::encode(stamp_s, &RcFrame { channels }).to_vec(), bytes, "{}", case["id"]);
    }
}
