//! The answers of a flight controller, and the client of its serial port. [`PAUSE`] in the bytes marks
//! passing time. The client sends a request before each piece between pauses.

use std::time::Duration;

use betadeck::fc::client::{Answer, Ask, AskId, CliAccess, FcClient};
use betadeck::fc::telemetry::{Mission, Observation, settings};
use betadeck::msp::code;

/// The mark of passing time.
const PAUSE: &[u8] = &[0x1e, 0x1e];
/// The time that passes: longer than a repetition takes, shorter than the patience with a line.
const PASSES: Duration = Duration::from_millis(1100);
/// The greatest length of an answer.
const MAX_ANSWER: usize = 1 << 19;

/// Feeds the bytes in one piece, byte by byte and in pieces. The requests and results are the same, and each
/// request gets one answer.
pub fn run(data: &[u8]) {
    for access in [CliAccess::Framed, CliAccess::Interactive] {
        let whole = talk(data, usize::MAX, access);
        assert_eq!(talk(data, 1, access), whole, "byte by byte");
        let piece = data.first().map_or(7, |byte| usize::from(*byte) % 61 + 2);
        assert_eq!(talk(data, piece, access), whole, "in pieces of {piece}");
    }
}

/// Everything that the client sent, and every answer.
#[derive(Debug, PartialEq, Default)]
struct Talk {
    output: Vec<u8>,
    answers: Vec<(AskId, Answer)>,
    observation: Observation,
}

/// The messages whose payload is understood here.
const MESSAGES: [u16; 10] = [
    code::STATUS_EX,
    code::BOXIDS,
    code::ATTITUDE,
    code::ALTITUDE,
    code::RAW_GPS,
    code::COMP_GPS,
    code::BATTERY_STATE,
    code::RC,
    code::MODE_RANGES,
    code::MODE_RANGES_EXTRA,
];

fn ask(number: usize) -> Ask {
    match number % 4 {
        0 => Ask::Line(["waypoint list", "save", "get ap_", "exit"][number / 4 % 4].to_owned()),
        2 => Ask::MessageLine("waypoint status".to_owned()),
        _ => Ask::Msp { code: MESSAGES[number / 2 % MESSAGES.len()], payload: Vec::new() },
    }
}

fn talk(data: &[u8], piece: usize, access: CliAccess) -> Talk {
    let mut talk = Talk::default();
    let mut client = FcClient::default();
    client.set_cli(access);
    client.connected();
    let mut now = Duration::ZERO;
    let mut asked = 0;
    let mut rest = data;
    loop {
        let end = rest.windows(PAUSE.len()).position(|window| window == PAUSE);
        let burst = &rest[..end.unwrap_or(rest.len())];
        client.ask(AskId(asked), ask(asked as usize));
        asked += 1;
        client.poll(now);
        for bytes in burst.chunks(piece.min(burst.len().max(1))) {
            client.push(bytes, now);
        }
        talk.take_answers(&mut client);
        now += PASSES;
        let Some(end) = end else { break };
        rest = &rest[end + PAUSE.len()..];
    }
    // Silence answers the rest, in bounded time.
    let mut steps = 0;
    while let Some(due) = client.due() {
        now = now.max(due);
        client.poll(now);
        steps += 1;
        assert!(steps < 100 + 20 * asked, "it never ends");
    }
    talk.take_answers(&mut client);
    let ids: Vec<u64> = talk.answers.iter().map(|(id, _)| id.0).collect();
    assert_eq!(ids, (0..asked).collect::<Vec<_>>(), "one answer each, in order");
    talk
}

impl Talk {
    fn take_answers(&mut self, client: &mut FcClient) {
        self.output.extend(client.take_output());
        while let Some((id, answer)) = client.next_answer() {
            match &answer {
                Answer::Msp(payload) => {
                    let Ask::Msp { code, .. } = ask(id.0 as usize) else { panic!("{answer:?}") };
                    self.observation.take(code, payload.as_deref().unwrap_or_default());
                }
                Answer::Line { text, .. } => {
                    assert!(text.len() <= MAX_ANSWER, "{} bytes", text.len());
                    let _ = Mission::parse(text);
                    settings(text).count();
                }
                Answer::NotAnswered(_) => {}
            }
            self.answers.push((id, answer));
        }
        let craft = self.observation.craft_view();
        assert!(craft.mode_ranges().iter().all(|range| range.channel < 16));
        let estimate = self.observation.estimate_view(None);
        assert!(estimate.heading_deg.is_none_or(|heading| (0.0..360.0).contains(&heading)));
    }
}
