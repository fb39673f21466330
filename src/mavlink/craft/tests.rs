mod answers;
mod hostile;
mod missions;
mod telemetry;

use std::time::Duration;

use super::super::frame::{Frame, FrameReader, Version};
use super::super::message::*;
use super::super::state::*;
use super::super::value::*;
use super::super::wire::Text;
use super::*;

/// A craft with ground stations, and the time.
struct Rig {
    craft: CraftProtocol,
    state: CraftState,
    now: Duration,
    version: Version,
    sequence: u8,
}

const FIRST: PeerId = PeerId(7);
const SECOND: PeerId = PeerId(8);

impl Rig {
    fn new(options: CraftOptions) -> Self {
        let state = CraftState {
            mode: Some(FlightMode::Angle),
            home: Some(GeoPosition { lat_deg: 40.4635, lon_deg: -79.5182, alt_amsl: 300.0 }),
            ..CraftState::default()
        };
        let craft = CraftProtocol::new(options);
        Self { craft, state, now: Duration::from_secs(100), version: Version::V2, sequence: 0 }
    }

    fn of(identity: Identity) -> Self {
        Self::new(CraftOptions { identity, ..CraftOptions::default() })
    }

    fn bytes(&mut self, message: impl Into<Message>) -> Vec<u8> {
        self.sequence = self.sequence.wrapping_add(1);
        let (version, sequence, message) = (self.version, self.sequence, message.into());
        Frame { version, sequence, system: 255, component: 190, message }.encode().unwrap()
    }

    /// Sends a message and returns the answers to this peer.
    fn tell(&mut self, peer: PeerId, message: impl Into<Message>) -> Vec<Message> {
        let bytes = self.bytes(message);
        self.craft.receive(self.now, peer, &bytes);
        self.answers(peer)
    }

    /// Returns the messages that wait for this peer.
    fn answers(&mut self, peer: PeerId) -> Vec<Message> {
        let mut answers = Vec::new();
        while let Some((to, bytes)) = self.craft.poll_transmit() {
            let mut rest = &bytes[..];
            let frame = FrameReader::default().next_frame(&mut rest).unwrap();
            assert_eq!((frame.system, frame.component, rest), (1, 1, &[][..]));
            answers.extend((to == peer).then_some(frame.message));
        }
        answers
    }

    /// Lets time pass, and returns the messages to this peer.
    fn pass(&mut self, peer: PeerId, time: Duration) -> Vec<Message> {
        let end = self.now + time;
        let mut all = Vec::new();
        while self.now < end {
            self.now += Duration::from_millis(10);
            self.craft.advance(self.now, self.now, &self.state);
            all.extend(self.answers(peer));
        }
        all
    }

    /// Sends a command and returns the answers.
    fn command(&mut self, command: u16, params: [f32; 7]) -> Vec<Message> {
        let [param1, param2, param3, param4, param5, param6, param7] = params;
        let (target_system, target_component, confirmation) = (1, 1, 0);
        self.tell(
            FIRST,
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
                confirmation,
            },
        )
    }

    /// Sends a command that the craft decides at once, and returns the result.
    fn result(&mut self, command: u16, params: [f32; 7]) -> CommandResult {
        let answers = self.command(command, params);
        assert_eq!(self.craft.poll_request(), None);
        acknowledged(&answers, command)
    }

    /// Sends a command, lets the host accept it, and returns the request.
    fn request(&mut self, command: u16, params: [f32; 7]) -> RequestKind {
        assert_eq!(self.command(command, params), []);
        let request = self.craft.poll_request().unwrap();
        self.craft.answer(request.ticket, Answer::Command(CommandResult::Accepted), &[]);
        assert_eq!(acknowledged(&self.answers(FIRST), command), CommandResult::Accepted);
        request.kind
    }
}

/// Returns the result of the only acknowledgement among messages.
fn acknowledged(messages: &[Message], command: u16) -> CommandResult {
    let found: Vec<CommandAck> = messages
        .iter()
        .filter_map(|message| if let Message::CommandAck(ack) = message { Some(*ack) } else { None })
        .collect();
    let [ack] = found[..] else { panic!("{messages:?}") };
    assert_eq!((ack.command, ack.target_system, ack.target_component), (command, 255, 190));
    CommandResult::from_code(ack.result).unwrap()
}

/// Returns the texts among messages.
fn texts(messages: &[Message]) -> Vec<String> {
    let text = |message: &Message| {
        if let Message::Statustext(text) = message { Some(text.text.to_string()) } else { None }
    };
    messages.iter().filter_map(text).collect()
}

/// Seven parameters that begin with these.
fn params<const N: usize>(first: [f32; N]) -> [f32; 7] {
    std::array::from_fn(|at| first.get(at).copied().unwrap_or_default())
}
