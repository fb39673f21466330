//! Exchanges captured from a real flight controller, repeated. The client sends the same bytes and reads the
//! captured answer.

use std::time::Duration;
use test_support::{hex, msp_bytes};

use betadeck::fc::client::{Answer, Ask, AskId, FcClient, Unanswered};
use betadeck::msp::{Decoder, Form, Frame, Kind};

const NOW: Duration = Duration::from_secs(5);

fn exchanges() -> Vec<(u32, Vec<u8>, Vec<u8>)> {
    include_str!("../../../vectors/msp.tsv")
        .lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let cells: Vec<&str> = line.split('\t').collect();
            (cells[0].parse().unwrap(), hex::decode(cells[2]), hex::decode(cells[3].trim_start_matches('-')))
        })
        .collect()
}

/// Returns the payload of a captured reply.
pub(crate) fn payload_of(number: u32) -> Vec<u8> {
    let (_, _, reply) = exchanges().into_iter().find(|(of, ..)| *of == number).unwrap();
    frames(Decoder::client(), &reply).remove(0).payload
}

/// Returns a client that has received its first answer.
fn in_step() -> FcClient {
    let mut client = FcClient::default();
    client.connected();
    client.ask(AskId(0), Ask::Msp { code: 2, payload: Vec::new() });
    client.poll(NOW);
    assert_eq!(client.take_output(), hex::decode("244d3c000101"));
    client.push(&hex::decode("244d3e030100013132"), NOW);
    assert_eq!(client.take_output(), hex::decode("244d3c000202"));
    client.push(&hex::decode("244d3e04024254464c1a"), NOW);
    assert_eq!(client.next_answer(), Some((AskId(0), Answer::Msp(Some(b"BTFL".to_vec())))));
    client
}

fn frames(mut decoder: Decoder, bytes: &[u8]) -> Vec<Frame> {
    bytes.iter().filter_map(|byte| decoder.push(*byte)).collect()
}

#[test]
fn messages_go_out_as_captured_and_their_replies_are_the_answers() {
    let mut seen = 0;
    for (number, request, reply) in exchanges() {
        let asked = frames(Decoder::server(), &request);
        let replies = frames(Decoder::client(), &reply);
        let ([asked], [reply_frame]) = (&asked[..], &replies[..]) else { continue };
        // The client sends codes of version 1 in version 1, and the others in version 2 without flags.
        let natural = if asked.code < 255 { Form::V1 } else { Form::V2 };
        if asked.form != natural || number == 41 {
            continue;
        }
        let mut client = in_step();
        let payload = asked.payload.clone();
        client.ask(AskId(1), Ask::Msp { code: asked.code, payload });
        client.poll(NOW);
        assert_eq!(client.take_output(), request, "{number}");
        client.push(&reply, NOW);
        let answer = (reply_frame.kind == Kind::Reply).then(|| reply_frame.payload.clone());
        assert_eq!(client.next_answer(), Some((AskId(1), Answer::Msp(answer))), "{number}");
        assert!(client.is_idle());
        seen += 1;
    }
    assert_eq!(seen, 36);
}

#[test]
fn two_requests_are_asked_one_after_the_other() {
    let (_, requests, replies) = exchanges().into_iter().find(|(number, ..)| *number == 5).unwrap();
    let mut client = in_step();
    for (at, code) in [1, 2].into_iter().enumerate() {
        client.ask(AskId(at as u64), Ask::Msp { code, payload: Vec::new() });
    }
    client.poll(NOW);
    assert_eq!(client.take_output(), requests[..6]);
    client.push(&replies[..9], NOW);
    assert_eq!(client.take_output(), requests[6..]);
    client.push(&replies[9..], NOW);
    let answers: Vec<_> = std::iter::from_fn(|| client.next_answer()).collect();
    let payloads = [&replies[5..8], &replies[14..18]].map(|payload| Answer::Msp(Some(payload.to_vec())));
    assert_eq!(answers, std::iter::zip([AskId(0), AskId(1)], payloads).collect::<Vec<_>>());
}

#[test]
fn framed_lines_go_out_as_captured_once_the_command_line_is_open() {
    for (number, line, failed) in [(38, "waypoint list", false), (39, "foo bar", true)] {
        let (_, request, reply) = exchanges().into_iter().find(|(of, ..)| *of == number).unwrap();
        let mut client = in_step();
        client.ask(AskId(1), Ask::Line(line.to_owned()));
        client.poll(NOW);
        assert_eq!(client.take_output(), request[..1], "{number}");
        client.push(&reply[..1], NOW);
        assert_eq!(client.take_output(), request[1..], "{number}");
        client.push(&reply[1..], NOW);
        let text = String::from_utf8(reply[1..reply.len() - 1].to_vec()).unwrap();
        assert_eq!(client.next_answer(), Some((AskId(1), Answer::Line { text, failed, restarted: false })));
    }
}

#[test]
fn a_save_is_answered_by_the_link_that_closes_or_by_silence_after_its_announcement() {
    let reply = hex::decode("020d0a2320736176696e670d0a0d0a5265626f6f74696e67");
    let text = "\r\n# saving\r\n\r\nRebooting".to_owned();
    let restarted = Answer::Line { text, failed: false, restarted: true };
    for closes in [true, false] {
        let mut client = in_step();
        client.ask(AskId(1), Ask::Line("save".to_owned()));
        client.ask(AskId(2), Ask::Msp { code: 108, payload: Vec::new() });
        client.poll(NOW);
        client.push(&reply, NOW);
        assert_eq!(client.next_answer(), None);
        if closes {
            client.disconnected();
            assert_eq!(client.next_answer(), Some((AskId(1), restarted.clone())));
            let lost = Answer::NotAnswered(Unanswered::LinkLost);
            assert_eq!(client.next_answer(), Some((AskId(2), lost)));
        } else {
            client.poll(NOW + Duration::from_secs(1));
            assert_eq!(client.next_answer(), Some((AskId(1), restarted.clone())));
            assert!(
                client.take_output().ends_with(&hex::decode("244d3c000101")),
                "it asks who is there first"
            );
        }
    }
}

#[test]
fn an_armed_craft_drops_both_ways_into_its_command_line() {
    let mut client = in_step();
    client.ask(AskId(1), Ask::Line("waypoint list".to_owned()));
    client.poll(NOW);
    assert_eq!(client.take_output(), [0x02]);
    client.poll(NOW + Duration::from_millis(800));
    // The client then tries the line by message, which the captured firmware does not support.
    assert_eq!(frames(Decoder::server(), &client.take_output())[0].code, 0x3012);
    client.push(
        &msp_bytes(&Frame { form: Form::V2, kind: Kind::Error, code: 0x3012, payload: Vec::new() }),
        NOW,
    );
    assert_eq!(client.next_answer(), Some((AskId(1), Answer::NotAnswered(Unanswered::CliClosed))));
    client.ask(AskId(2), Ask::MessageLine("waypoint status".to_owned()));
    client.poll(NOW);
    // Gets back in step, as the prompt did not answer.
    assert_eq!(client.take_output(), hex::decode("244d3c000101"));
    client.push(&hex::decode("244d3e030100013132"), NOW);
    assert_eq!(client.take_output(), [0; 0], "not asked a second time");
    assert_eq!(client.next_answer(), Some((AskId(2), Answer::NotAnswered(Unanswered::CliClosed))));
}
