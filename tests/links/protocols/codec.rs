//! The wire formats, tested with captured and computed bytes, any splitting, and hostile input.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use std::time::Duration;
use test_support::{hex, msp_bytes};

use betadeck::link::conventions::Dialect;
use betadeck::link::proto::command_line::{Completion, LineReply};
use betadeck::link::proto::fdm::{self, Gravity, Packet, PacketError, State};
use betadeck::link::proto::line_editor::MAX_LINE;
use betadeck::link::proto::serial_session::{SerialRequest, SerialSession};
use betadeck::link::proto::{rc, servo};
use betadeck::msp::{Decoder, Dropped, Form, Frame, Kind};
use betadeck::signals::RcFrame;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use proptest::prelude::*;
use serde_json::Value;

/// Returns the number, request and reply of every captured exchange.
fn exchanges() -> Vec<(u32, Vec<u8>, Vec<u8>)> {
    include_str!("../../vectors/msp.tsv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let cells: Vec<&str> = line.split('\t').collect();
            (cells[0].parse().unwrap(), hex::decode(cells[2]), hex::decode(cells[3].trim_start_matches('-')))
        })
        .collect()
}

fn decode_all(mut decoder: Decoder, bytes: &[u8]) -> (Vec<Frame>, Decoder) {
    let frames = bytes.iter().filter_map(|&byte| decoder.push(byte)).collect();
    (frames, decoder)
}

#[test]
fn captured_replies_decode_and_encode_to_the_same_bytes() {
    let mut seen = 0;
    for (number, request, reply) in exchanges() {
        if request[0] != b'$' || reply.is_empty() {
            continue;
        }
        let (frames, decoder) = decode_all(Decoder::client(), &reply);
        assert!(decoder.is_between_frames(), "{number}: the reply is complete");
        let encoded: Vec<u8> = frames.iter().flat_map(msp_bytes).collect();
        assert_eq!(encoded, reply, "{number}");
        let (asked, _) = decode_all(Decoder::server(), &request);
        assert_eq!(asked.len(), frames.len(), "{number}");
        for (asked, answered) in asked.iter().zip(&frames) {
            assert_eq!((asked.form, asked.code), (answered.form, answered.code), "{number}");
            assert_ne!(answered.kind, Kind::Request);
        }
        seen += 1;
    }
    assert_eq!(seen, 41);
}

#[test]
fn a_bad_checksum_and_a_reply_are_silent() {
    for (number, request, reply) in exchanges() {
        if request[0] == b'$' && reply.is_empty() {
            let (frames, decoder) = decode_all(Decoder::server(), &request);
            assert!(frames.is_empty() && decoder.is_between_frames(), "{number}");
        }
    }
}

fn any_frame(kind: Kind, limit: usize) -> impl Strategy<Value = Frame> {
    let form = prop_oneof![Just(Form::V1), Just(Form::V2), Just(Form::V2OverV1)];
    (form, any::<u16>(), prop::collection::vec(any::<u8>(), 0..=limit)).prop_map(
        move |(form, code, payload)| {
            let code = if form == Form::V1 { code % 255 } else { code };
            Frame { form, kind, code, payload }
        },
    )
}

proptest! {
    #[test]
    fn requests_survive_the_wire(frame in any_frame(Kind::Request, 186)) {
        prop_assert_eq!(decode_all(Decoder::server(), &msp_bytes(&frame)).0, vec![frame]);
    }

    #[test]
    fn replies_survive_the_wire(frame in any_frame(Kind::Reply, 1000)) {
        prop_assert_eq!(decode_all(Decoder::client(), &msp_bytes(&frame)).0, vec![frame]);
    }

    #[test]
    fn any_split_finds_the_same(
        frames in prop::collection::vec(any_frame(Kind::Request, 40), 1..4),
        noise in prop::collection::vec(prop_oneof![any::<u8>(), Just(0x02), Just(0x03), Just(b'#'), Just(b'\n')], 0..20),
        cuts in prop::collection::vec(0_usize..300, 0..6),
    ) {
        let mut stream = noise;
        for frame in &frames {
            frame.encode(&mut stream);
        }
        let whole = found_in(&[&stream]);
        let mut cuts: Vec<usize> = cuts.into_iter().map(|cut| cut.min(stream.len())).collect();
        cuts.sort_unstable();
        let mut pieces = Vec::new();
        let mut start = 0;
        for cut in cuts {
            pieces.push(&stream[start..cut]);
            start = cut;
        }
        pieces.push(&stream[start..]);
        prop_assert_eq!(found_in(&pieces), whole);
    }

    #[test]
    fn garbage_between_frames_costs_none_of_them(
        frames in prop::collection::vec(any_frame(Kind::Request, 186), 1..6),
        garbage in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..40), 6),
    ) {
        let mut stream = Vec::new();
        for (frame, garbage) in frames.iter().zip(&garbage) {
            // Garbage that begins like a frame could be one, so `$` is removed.
            stream.extend(garbage.iter().filter(|byte| **byte != b'$'));
            frame.encode(&mut stream);
        }
        let (found, decoder) = decode_all(Decoder::server(), &stream);
        prop_assert_eq!(found, frames);
        prop_assert_eq!(decoder.dropped(), Dropped::default());
    }

    #[test]
    fn a_truncated_frame_costs_at_most_what_it_announced(
        frame in any_frame(Kind::Request, 186),
        cut in 1_usize..200,
    ) {
        let mut stream = msp_bytes(&frame);
        stream.truncate(stream.len().saturating_sub(cut).max(1));
        // Zeros complete the announced frame, and are no frame themselves.
        stream.extend(vec![0_u8; 200]);
        let good = Frame::request(Form::V1, 1, &[]);
        good.encode(&mut stream);
        let (found, decoder) = decode_all(Decoder::server(), &stream);
        prop_assert_eq!(found.last(), Some(&good));
        prop_assert!(decoder.is_between_frames());
    }

    #[test]
    fn an_oversized_frame_is_dropped_before_its_payload(
        form in prop_oneof![Just(Form::V1), Just(Form::V2), Just(Form::V2OverV1)],
        code in any::<u8>(),
        size in 193_usize..1000,
    ) {
        let code = u16::from(code % 255);
        let mut stream = msp_bytes(&Frame::request(form, code, &vec![0; size]));
        let good = Frame::request(Form::V2, 101, &[]);
        good.encode(&mut stream);
        let (found, decoder) = decode_all(Decoder::server(), &stream);
        prop_assert_eq!(found, vec![good]);
        prop_assert_eq!(decoder.dropped().oversized, 1);
    }

    #[test]
    fn whatever_comes_little_is_kept_and_sent(
        pieces in prop::collection::vec(
            (prop_oneof![any::<u8>(), Just(b'x'), Just(b'#'), Just(0x02), Just(b'\n'), Just(b'$')], 1_usize..5000),
            0..40,
        ),
    ) {
        let mut session = SerialSession::default();
        for (k, (byte, count)) in (1..).zip(pieces) {
            // These bytes request the list of possible completions.
            let byte = if matches!(byte, b'\t' | b'?') { b'x' } else { byte };
            session.push(&vec![byte; count]);
            let now = Duration::from_secs(k);
            let mut sent = 0;
            while let Some(ask) = session.next(now) {
                match &ask {
                    SerialRequest::Msp(frame) => session.reply(frame, None),
                    SerialRequest::Flush => sent += session.take_output().len(),
                    SerialRequest::EnterCli { .. } => session.admit(true, now),
                    SerialRequest::Line { line, .. } => {
                        prop_assert!(line.len() <= MAX_LINE);
                        let _stays = session.answer(&LineReply::default());
                    }
                    SerialRequest::Complete { .. } => session.complete(Completion::default()),
                    SerialRequest::Restart
                    | SerialRequest::LeftCli
                    | SerialRequest::Ignored { .. }
                    | SerialRequest::Foreign => {}
                }
            }
            // The session sends only echo and error frames for the received bytes.
            sent += session.take_output().len();
            prop_assert!(sent <= 40 * count + 2000, "{} bytes for {} times {}", sent, count, byte);
        }
    }

    #[test]
    fn a_damaged_frame_does_not_cost_the_next_but_one(
        bytes in prop::collection::vec(any::<u8>(), 0..64),
    ) {
        // At worst the damage announces a frame of 192 bytes that swallows the next bytes.
        let mut stream = bytes;
        stream.extend(vec![0_u8; 260]);
        let good = Frame::request(Form::V2, 101, &[]);
        good.encode(&mut stream);
        let (frames, _) = decode_all(Decoder::server(), &stream);
        prop_assert_eq!(frames.last(), Some(&good));
    }

    #[test]
    fn datagrams_of_noise_do_no_harm(bytes in prop::collection::vec(any::<u8>(), 0..1500)) {
        let accepted = Packet::parse(&bytes);
        prop_assert!(bytes.len() >= fdm::SIZE || accepted == Err(PacketError::TooShort));
        if let Ok(packet) = accepted {
            for dialect in [Dialect::SitlGz, Dialect::GzPlugin, Dialect::Legacy] {
                assert_sane(&dialect.decode(&packet, dialect.usual_gravity()));
            }
        }
        prop_assert_eq!(rc::decode(&bytes).is_some(), bytes.len() >= rc::SIZE);
        prop_assert!(servo::decode(&bytes).is_none() || bytes.len() >= servo::SIZE);
    }
}

/// Returns every request in a client's stream and the output, when nothing is armed and every line is
/// answered with "ok".
fn found_in(pieces: &[&[u8]]) -> (Vec<SerialRequest>, Vec<u8>) {
    let mut session = SerialSession::default();
    let mut all = Vec::new();
    let now = Duration::from_secs(1);
    for piece in pieces {
        session.push(piece);
        while let Some(ask) = session.next(now) {
            match &ask {
                SerialRequest::Msp(frame) => session.reply(frame, Some(Vec::new())),
                SerialRequest::EnterCli { .. } => session.admit(true, now),
                SerialRequest::Line { .. } => {
                    let reply = LineReply { text: "ok\r\n".to_owned(), ..LineReply::default() };
                    assert!(!session.answer(&reply));
                }
                SerialRequest::Complete { .. } => session.complete(Completion::default()),
                SerialRequest::Flush
                | SerialRequest::Restart
                | SerialRequest::LeftCli
                | SerialRequest::Ignored { .. }
                | SerialRequest::Foreign => {}
            }
            all.push(ask);
        }
    }
    (all, session.take_output())
}

fn assert_sane(state: &State) {
    assert!(state.rate_flu.iter().chain(state.specific_force_flu.iter()).all(|value| value.is_finite()));
    assert!((state.attitude.norm() - 1.0).abs() < 1e-9);
    assert!(state.pressure_pa.is_finite());
}

/// Returns the files of `tests/corpus/NAME`, sorted.
fn corpus(name: &str) -> Vec<(String, Vec<u8>)> {
    let folder = test_support::path("tests/corpus").join(name);
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            (path.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read(&path).unwrap())
        })
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

#[test]
fn the_decoder_finds_the_good_frame_after_every_stored_damage() {
    for (name, bytes) in corpus("msp") {
        let (frames, decoder) = decode_all(Decoder::server(), &bytes);
        assert!(decoder.is_between_frames(), "{name}");
        assert_eq!(frames.last(), Some(&Frame::request(Form::V1, 1, &[])), "{name}");
    }
}

#[test]
fn stored_state_datagrams_are_judged_as_named() {
    let refused = [
        ("fast-rate.bin", PacketError::Rate),
        ("hard-hit.bin", PacketError::Acceleration),
        ("huge-altitude.bin", PacketError::OutOfThisWorld),
        ("huge-velocity.bin", PacketError::OutOfThisWorld),
        ("inf-rate.bin", PacketError::NotFinite),
        ("nan-stamp.bin", PacketError::NotFinite),
        ("short.bin", PacketError::TooShort),
        ("zero-quaternion.bin", PacketError::Quaternion),
    ];
    for (name, bytes) in corpus("fdm") {
        let expected = refused.iter().find(|(file, _)| *file == name).map(|(_, why)| *why);
        assert_eq!(Packet::parse(&bytes).err(), expected, "{name}");
    }
}

fn wire() -> Value {
    let vectors: Value = serde_json::from_str(include_str!("../../vectors/sim.json")).unwrap();
    vectors["wire"].clone()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn bytes_of(value: &Value) -> Vec<u8> {
    hex::decode(value["hex"].as_str().unwrap())
}

/// Returns the true state of a worked packet, with the position as the dialect puts it on the wire.
fn true_state(case: &Value, home: &[f64], dialect: Dialect) -> State {
    let truth = &case["true"];
    let vector = |name: &str| Vector3::from_column_slice(&numbers(&truth[name]));
    let q = numbers(&truth["q_body_flu_to_enu_wxyz"]);
    let place = |name: &str, centre: f64| {
        let degrees = truth[name].as_f64().unwrap();
        if dialect.mirrors() { fdm::mirrored(centre, degrees) } else { degrees }
    };
    let alt_m = truth["alt_m"].as_f64().unwrap();
    State {
        stamp_s: case["legacy"]["values"][0].as_f64().unwrap(),
        rate_flu: vector("omega_flu"),
        specific_force_flu: vector("specific_force_flu"),
        attitude: UnitQuaternion::new_unchecked(Quaternion::new(q[0], q[1], q[2], q[3])),
        vel_enu: vector("vel_enu"),
        lon_deg: place("lon_deg", home[1]),
        lat_deg: place("lat_deg", home[0]),
        alt_m,
        pressure_pa: fdm::pressure_pa(alt_m),
    }
}

#[test]
fn worked_state_packets_in_three_dialects_both_ways() {
    let wire = wire();
    let home = numbers(&wire["home_lat_lon_alt"]);
    let cases = wire["fdm"].as_array().unwrap();
    assert_eq!(cases.len(), 5);
    let dialects =
        [(Dialect::SitlGz, "sitl_gz"), (Dialect::GzPlugin, "gz_plugin_first18"), (Dialect::Legacy, "legacy")];
    for case in cases {
        for (dialect, key) in dialects {
            let id = format!("{} {key}", case["id"]);
            let expected = &case[key];
            let state = true_state(case, &home, dialect);
            let packet = dialect.encode(&state);
            for (field, (ours, theirs)) in packet.fields.iter().zip(numbers(&expected["values"])).enumerate()
            {
                // The plugin places its world on the exact tangent plane: 0.2 mm and 1.4e-9° away at 50 m.
                let tolerance = match (dialect, field) {
                    (Dialect::GzPlugin, 14 | 15) => 2e-9,
                    (Dialect::GzPlugin, 16) => 3e-4,
                    (_, 14 | 15) => 1e-9,
                    (_, 17) => 1e-6,
                    _ => 1e-12,
                };
                assert!((ours - theirs).abs() <= tolerance, "{id} field {field}: {ours} {theirs}");
            }

            let bytes = bytes_of(expected);
            let parsed = Packet::parse(&bytes).unwrap();
            for (field, value) in parsed.fields.iter().zip(numbers(&expected["values"])) {
                // The reader of the JSON text is exact to the second-last bit.
                assert!((field - value).abs() <= 1e-15 * value.abs(), "{id}");
            }
            assert_eq!(parsed.to_bytes().to_vec(), bytes, "{id}");

            let decoded = dialect.decode(&parsed, dialect.usual_gravity());
            assert!((decoded.rate_flu - state.rate_flu).norm() < 1e-12, "{id}");
            assert!((decoded.specific_force_flu - state.specific_force_flu).norm() < 1e-12, "{id}");
            assert!(decoded.attitude.angle_to(&state.attitude) < 1e-9, "{id}");
            assert!((decoded.vel_enu - state.vel_enu).norm() < 1e-12, "{id}");
            assert!((decoded.pressure_pa - state.pressure_pa).abs() < 3e-3, "{id}");
        }
    }
}

#[test]
fn gravity_is_added_where_the_sender_left_it_out() {
    let wire = wire();
    let bytes = bytes_of(&wire["fdm"][0]["gz_plugin_first18"]);
    let packet = Packet::parse(&bytes).unwrap();
    let felt = |gravity| Dialect::GzPlugin.decode(&packet, gravity).specific_force_flu.norm();
    assert!((felt(Gravity::Missing) - betadeck::geo::GRAVITY).abs() < 1e-12);
    assert!(felt(Gravity::Included) < 1e-12);
}

#[test]
fn the_size_of_a_datagram_tells_the_plugin() {
    assert_eq!(Dialect::from_size(296), Dialect::GzPlugin);
    assert_eq!(Dialect::from_size(144), Dialect::SitlGz);
    assert_eq!(Dialect::from_size(145), Dialect::SitlGz);
}

#[test]
fn worked_motor_packets_both_ways() {
    let wire = wire();
    for case in wire["servo"].as_array().unwrap() {
        let values: Vec<f32> = numbers(&case["values"]).iter().map(|value| *value as f32).collect();
        let motors: [f32; 4] = values.clone().try_into().unwrap();
        let bytes = bytes_of(case);
        let pulses = motors.map(|motor| (1000.0 + 1000.0 * f64::from(motor)).round() as f32);
        assert_eq!(servo::encode(pulses).to_vec(), bytes, "{}", case["id"]);
        assert_eq!(servo::decode(&bytes), Some(motors), "{}", case["id"]);
    }
    for case in wire["servo_raw"].as_array().unwrap() {
        let values: Vec<f32> = numbers(&case["values"]).iter().map(|value| *value as f32).collect();
        let count = case["motor_count"].as_u64().unwrap() as u16;
        let bytes = bytes_of(case);
        assert_eq!(servo::encode_raw(count, &values).to_vec(), bytes, "{}", case["id"]);
    }
}

#[test]
fn motor_commands_become_whole_thousandths_rounded_down() {
    use betadeck::signals::MotorCommand;
    for thousandths in 0..=1000 {
        let command = MotorCommand([f64::from(thousandths) / 1000.0; 4]);
        let sent = servo::decode(&servo::encode(servo::pulses_us(&command))).unwrap();
        assert!((sent[0] - thousandths as f32 / 1000.0).abs() < 1e-6, "{thousandths}");
    }
    let odd = MotorCommand([0.502_578_125, f64::NAN, -1.0, 7.0]);
    assert_eq!(servo::decode(&servo::encode(servo::pulses_us(&odd))), Some([0.502, 0.0, 0.0, 1.0]));
}

#[test]
fn worked_rc_packets_both_ways() {
    for case in wire()["rc"].as_array().unwrap() {
        let stamp = case["timestamp"].as_f64().unwrap();
        let pulses: Vec<u16> = numbers(&case["channels"]).iter().map(|pulse| *pulse as u16).collect();
        let frame = RcFrame { channels: pulses.try_into().unwrap() };
        let bytes = bytes_of(case);
        assert_eq!(rc::encode(stamp, &frame).to_vec(), bytes, "{}", case["id"]);
        assert_eq!(rc::decode(&bytes), Some((stamp, frame)), "{}", case["id"]);
    }
}

#[test]
fn datagrams_of_every_size_in_the_table() {
    let wire = wire();
    let good = bytes_of(&wire["fdm"][0]["sitl_gz"]);
    for rule in wire["size_rules"].as_array().unwrap() {
        let size = rule["bytes"].as_u64().unwrap() as usize;
        let mut datagram = good.clone();
        datagram.resize(size, 0);
        let accepted = match rule["port"].as_u64().unwrap() {
            9002 => servo::decode(&datagram).is_some(),
            9003 => Packet::parse(&datagram).is_ok(),
            9004 => rc::decode(&datagram).is_some(),
            port => panic!("a rule for port {port}"),
        };
        assert_eq!(accepted, rule["accepted"].as_bool().unwrap(), "{rule}");
    }
}
