//! Lines that lose, damage, delay and invent bytes.

use std::time::Duration;

use betadeck::fc::client::{Answer, Ask, AskId, CliAccess, FcClient, Unanswered};
use betadeck::msp::{Form, Frame, Kind};
use proptest::prelude::*;
use test_support::msp_bytes;

use crate::protocols::fc_client::board::{Bench, Manners};

const ATTITUDE: u16 = 108;

fn read(code: u16) -> Ask {
    Ask::Msp { code, payload: Vec::new() }
}

/// Drops complete answers where `lost` is true, and passes the rest.
fn losing(lost: Vec<bool>) -> Box<dyn FnMut(Vec<u8>) -> Vec<u8>> {
    let mut lost = lost.into_iter();
    Box::new(move |bytes| if !bytes.is_empty() && lost.next().unwrap_or(false) { Vec::new() } else { bytes })
}

#[test]
fn a_lost_answer_to_a_message_that_only_asks_is_asked_for_again() {
    let mut bench = Bench::new(Manners::default());
    bench.damage = losing(vec![false, true, false]);
    assert!(bench.msp(ATTITUDE).is_some());
    assert_eq!(bench.board.asked, [1, ATTITUDE, ATTITUDE]);
}

#[test]
fn a_message_that_changes_something_is_sent_once() {
    let mut bench = Bench::new(Manners::default());
    bench.damage = losing(vec![false, true, false]);
    let set = Ask::Msp { code: 11, payload: b"QUAD".to_vec() };
    assert_eq!(bench.ask(set), Answer::NotAnswered(Unanswered::Silent));
    assert_eq!(bench.board.asked, [1, 11]);
    assert_eq!(bench.msp(10).unwrap(), b"QUAD");
    // After the message that was given up, the client makes sure that answers are new.
    assert_eq!(bench.board.asked, [1, 11, 1, 10]);
}

#[test]
fn a_line_by_message_that_was_given_up_does_not_answer_the_next() {
    let mut bench = Bench::new(Manners::default());
    let mut held = None;
    let mut count = 0;
    // The answer to the first line arrives together with the next one.
    bench.damage = Box::new(move |bytes| {
        count += usize::from(!bytes.is_empty());
        if count == 2 && !bytes.is_empty() {
            held = Some(bytes);
            return Vec::new();
        }
        if bytes.is_empty() { bytes } else { [held.take().unwrap_or_default(), bytes].concat() }
    });
    let first = bench.ask(Ask::MessageLine("get ap_max_angle".to_owned()));
    assert_eq!(first, Answer::NotAnswered(Unanswered::Silent));
    let Answer::Line { text, .. } = bench.ask(Ask::MessageLine("get ap_max_velocity".to_owned())) else {
        panic!("no answer")
    };
    assert!(text.starts_with("ap_max_velocity = "), "{text}");
}

/// Returns the time after which the client gives up a line whose output never ends, and its answer. A byte
/// comes after each `pause`.
fn endless(access: CliAccess, pause: Duration) -> (Duration, Answer) {
    let mut client = FcClient::default();
    client.connected();
    client.set_cli(access);
    client.ask(AskId(7), Ask::Line("dump".to_owned()));
    let mut now = Duration::ZERO;
    client.poll(now);
    if access == CliAccess::Framed {
        let api = Frame { form: Form::V1, kind: Kind::Reply, code: 1, payload: vec![0, 1, 49] };
        client.push(&msp_bytes(&api), now);
        client.push(&[0x02], now);
    } else {
        let api = Frame { form: Form::V1, kind: Kind::Reply, code: 1, payload: vec![0, 1, 40] };
        client.push(&msp_bytes(&api), now);
        client.push(b"\r\nEntering CLI Mode, type 'exit' to return, or 'help'\r\n\r\n# ", now);
        now += Duration::from_millis(100);
        client.poll(now);
    }
    assert!(String::from_utf8_lossy(&client.take_output()).contains("dump\n"), "the line was sent");
    let begun = now;
    loop {
        now += pause;
        client.push(b"x", now);
        if let Some((AskId(7), answer)) = client.next_answer() {
            return (now - begun, answer);
        }
    }
}

#[test]
fn an_output_without_end_is_given_up() {
    for access in [CliAccess::Framed, CliAccess::Interactive] {
        let silent = Answer::NotAnswered(Unanswered::Silent);
        let (slow, answer) = endless(access, Duration::from_secs(3));
        assert_eq!(answer, silent);
        assert!(slow <= Duration::from_secs(63), "a byte now and then: {slow:?}");
        // More bytes than are kept arrive within seconds, so the client must give up.
        let (fast, answer) = endless(access, Duration::from_micros(10));
        assert_eq!(answer, silent);
        assert!(fast < Duration::from_secs(10), "without a pause: {fast:?}");
    }
}

#[test]
fn pages_without_end_are_given_up() {
    let mut client = FcClient::default();
    client.connected();
    client.ask(AskId(7), Ask::MessageLine("dump".to_owned()));
    let reply = |code, payload: &[u8]| {
        let form = if code > 254 { Form::V2 } else { Form::V1 };
        msp_bytes(&Frame { form, kind: Kind::Reply, code, payload: payload.to_vec() })
    };
    client.poll(Duration::ZERO);
    client.push(&reply(1, &[0, 1, 49]), Duration::ZERO);
    let mut now = Duration::ZERO;
    let answer = loop {
        now += Duration::from_secs(3);
        // A page of 65535 bytes, one byte at a time.
        client.push(&reply(0x3012, &[0xff, 0xff, 0, b'x']), now);
        if let Some((_, answer)) = client.next_answer() {
            break answer;
        }
    };
    assert_eq!(answer, Answer::NotAnswered(Unanswered::Silent));
    assert!(now <= Duration::from_secs(63), "{now:?}");
}

#[test]
fn a_dead_line_costs_each_request_its_patience_and_no_more() {
    let mut bench = Bench::new(Manners::default());
    bench.damage = Box::new(|_| Vec::new());
    for _ in 0..3 {
        let start = bench.now;
        assert_eq!(bench.ask(read(ATTITUDE)), Answer::NotAnswered(Unanswered::Silent));
        assert!(bench.now - start < Duration::from_millis(2100));
        bench.client.set_armed(true);
        assert_eq!(bench.ask(Ask::Line("version".to_owned())), Answer::NotAnswered(Unanswered::Silent));
    }
    bench.damage = Box::new(|bytes| bytes);
    assert!(bench.msp(ATTITUDE).is_some());
}

#[test]
fn a_prompt_that_an_earlier_client_left_open_is_left() {
    let mut bench = Bench::new(Manners::default());
    // Upstream keeps an open prompt over connections.
    bench.client.set_cli(betadeck::fc::client::CliAccess::Interactive);
    bench.line("version");
    bench.client.connected();
    assert!(bench.msp(ATTITUDE).is_some());
    assert_eq!(bench.board.ran.last().unwrap(), "exit noreboot");
}

#[test]
fn a_prompt_that_an_earlier_client_left_open_is_not_left_unasked() {
    let mut bench = Bench::new(Manners::default());
    bench.client.set_cli(betadeck::fc::client::CliAccess::Interactive);
    bench.line("version");
    bench.client.connected();
    bench.client.set_may_leave_cli(false);
    let ran = bench.board.ran.len();
    assert_eq!(bench.ask(read(ATTITUDE)), Answer::NotAnswered(Unanswered::InCli));
    assert_eq!(bench.board.ran.len(), ran, "nothing was typed: {:?}", bench.board.ran);
    bench.client.set_may_leave_cli(true);
    assert!(bench.msp(ATTITUDE).is_some());
    assert_eq!(bench.board.ran.last().unwrap(), "exit noreboot");
}

#[test]
fn garbage_that_begins_like_a_long_frame_costs_one_repetition() {
    let mut bench = Bench::new(Manners::default());
    let mut first = true;
    bench.damage = Box::new(move |bytes| match std::mem::take(&mut first) {
        true => [&b"$X>\0\x6c\0\0\x10"[..], &bytes].concat(),
        false => bytes,
    });
    assert!(bench.msp(ATTITUDE).is_some());
}

#[test]
fn a_request_without_a_connection_is_answered_at_once() {
    let mut client = FcClient::default();
    client.ask(AskId(7), read(ATTITUDE));
    assert_eq!(client.next_answer(), Some((AskId(7), Answer::NotAnswered(Unanswered::LinkLost))));
    client.connected();
    for id in 0..300 {
        client.ask(AskId(id), read(ATTITUDE));
    }
    assert_eq!(client.next_answer(), Some((AskId(256), Answer::NotAnswered(Unanswered::TooMany))));
}

fn any_ask() -> impl Strategy<Value = Ask> {
    let codes = prop_oneof![Just(ATTITUDE), Just(1), Just(150), Just(4000), Just(250)];
    prop_oneof![
        (codes, prop::collection::vec(any::<u8>(), 0..4))
            .prop_map(|(code, payload)| Ask::Msp { code, payload }),
        prop_oneof![Just("version"), Just("get ap"), Just("waypoint list"), Just("foo"), Just("")]
            .prop_map(|line| Ask::Line(line.to_owned())),
        Just(Ask::MessageLine("waypoint status".to_owned())),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_request_gets_one_answer_of_its_kind_whatever_the_line_does(
        asks in prop::collection::vec(any_ask(), 1..8),
        lost in prop::collection::vec(any::<bool>(), 0..20),
        noise in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..12), 0..10),
    ) {
        let mut bench = Bench::new(Manners::default());
        let (mut lost, mut noise) = (losing(lost), noise.into_iter());
        bench.damage = Box::new(move |bytes| {
            let bytes = lost(bytes);
            if bytes.is_empty() { bytes } else { [noise.next().unwrap_or_default(), bytes].concat() }
        });
        for ask in asks {
            let answer = bench.ask(ask.clone());
            match (&ask, &answer) {
                (_, Answer::NotAnswered(_)) => {}
                (Ask::Msp { .. }, Answer::Msp(_)) => {}
                (Ask::Line(_) | Ask::MessageLine(_), Answer::Line { .. }) => {}
                _ => prop_assert!(false, "{ask:?}: {answer:?}"),
            }
        }
        // On a good line everything works again.
        bench.damage = Box::new(|bytes| bytes);
        bench.ask(read(ATTITUDE));
        let last = bench.ask(read(2));
        prop_assert_eq!(last, Answer::Msp(Some(b"BTFL".to_vec())));
        prop_assert!(bench.line("version").contains("Betaflight"));
    }

    #[test]
    fn pieces_of_any_size_give_the_same_answers(
        cuts in prop::collection::vec(1_usize..40, 1..50),
        lines in prop::collection::vec(prop_oneof![Just("version"), Just("get ap"), Just("foo")], 1..4),
    ) {
        let whole: Vec<_> = {
            let mut bench = Bench::new(Manners::default());
            lines.iter().map(|line| bench.ask(Ask::Line((*line).to_owned()))).collect()
        };
        let mut bench = Bench::new(Manners::default());
        let (mut cuts, mut waiting) = (cuts.into_iter().cycle(), Vec::new());
        bench.damage = Box::new(move |bytes| {
            waiting.extend(bytes);
            let cut = cuts.next().unwrap().min(waiting.len());
            waiting.drain(..cut).collect()
        });
        let pieces: Vec<_> = lines.iter().map(|line| bench.ask(Ask::Line((*line).to_owned()))).collect();
        prop_assert_eq!(pieces, whole);
    }

    #[test]
    fn a_late_reply_of_another_message_is_dropped(codes in prop::collection::vec(0_u16..300, 0..12)) {
        let now = Duration::from_secs(1);
        let mut client = FcClient::default();
        client.connected();
        client.ask(AskId(1), read(ATTITUDE));
        client.poll(now);
        let reply = |code: u16, payload: Vec<u8>| {
            let form = if code > 254 { Form::V2 } else { Form::V1 };
            msp_bytes(&Frame { form, kind: Kind::Reply, code, payload })
        };
        client.push(&reply(1, vec![0, 1, 49]), now);
        for code in codes.into_iter().filter(|code| *code != ATTITUDE) {
            client.push(&reply(code, vec![9; 6]), now);
        }
        prop_assert_eq!(client.next_answer(), None);
        client.push(&reply(ATTITUDE, vec![1; 6]), now);
        prop_assert_eq!(client.next_answer(), Some((AskId(1), Answer::Msp(Some(vec![1; 6])))));
    }

    #[test]
    fn any_bytes_at_any_moment_do_no_harm(
        steps in prop::collection::vec((any_ask(), prop::collection::vec(any::<u8>(), 0..60), 0_u64..1500), 0..30),
        interactive in any::<bool>(),
    ) {
        let mut client = FcClient::default();
        client.connected();
        if interactive {
            client.set_cli(betadeck::fc::client::CliAccess::Interactive);
        }
        let mut now = Duration::ZERO;
        let (mut asked, mut answered) = (0, 0);
        for (ask, bytes, ms) in steps {
            client.ask(AskId(asked), ask);
            asked += 1;
            client.push(&bytes, now);
            now += Duration::from_millis(ms);
            client.poll(now);
            while client.next_answer().is_some() {
                answered += 1;
            }
        }
        while let Some(due) = client.due() {
            now = now.max(due);
            client.poll(now);
            while let Some((id, _)) = client.next_answer() {
                prop_assert!(id.0 < asked);
                answered += 1;
            }
        }
        prop_assert_eq!(answered, asked);
    }
}
