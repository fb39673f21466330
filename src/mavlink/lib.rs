//! MAVLink 1 and 2 without I/O: frames, messages, the protocols of a craft and of a ground station, and telemetry logs.
//!
//! | module | has |
//! | --- | --- |
//! | [`frame`] | [`FrameReader`](frame::FrameReader) finds frames in a stream of bytes, [`Frame::encode`](frame::Frame::encode) writes them |
//! | [`message`] | the table of messages, and a type for each |
//! | [`value`] | the numbers of commands, results, flags and states |
//! | [`craft`] | [`CraftProtocol`](craft::CraftProtocol): telemetry, commands, parameters, missions, as a craft sends and answers them |
//! | [`station`] | [`StationProtocol`](station::StationProtocol): follows a craft, gives it orders, moves missions |
//! | [`tlog`] | telemetry logs, `.tlog` |
//!
//! Both protocols are state machines: bytes and times in, bytes and events out. They see no clock, no socket and no thread.
//! No input makes them panic, and the memory that input can take is bounded. A host moves the bytes:
//!
//! ```
//! use std::time::Duration;
//!
//! use betadeck_mavlink::craft::{Answer, CraftOptions, CraftProtocol, CraftState, Lifetime, PeerId, RequestKind};
//! use betadeck_mavlink::station::{Order, StationOptions, StationProtocol};
//! use betadeck_mavlink::value::CommandResult;
//!
//! let mut craft = CraftProtocol::new(CraftOptions::default());
//! let mut station = StationProtocol::new(StationOptions::default());
//! craft.connect(Duration::ZERO, PeerId(0), Lifetime::UntilDisconnected);
//! let mut is_landing = false;
//! for step in 1..300 {
//!     let now = Duration::from_millis(20 * step);
//!     craft.advance(now, now, &CraftState::default());
//!     station.advance(now);
//!     while let Some((_peer, bytes)) = craft.poll_transmit() {
//!         station.receive(now, &bytes);
//!     }
//!     while let Some(bytes) = station.poll_transmit() {
//!         craft.receive(now, PeerId(0), &bytes);
//!     }
//!     while let Some(request) = craft.poll_request() {
//!         is_landing |= request.kind == RequestKind::Land;
//!         craft.answer(request.ticket, Answer::Command(CommandResult::Accepted), &[]);
//!     }
//!     if step == 200 {
//!         assert!(station.is_connected());
//!         station.order(&Order::Land).unwrap();
//!     }
//! }
//! assert!(is_landing);
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod craft;
mod crc;
pub mod frame;
pub mod message;
mod mission;
pub mod state;
pub mod station;
pub mod tlog;
pub mod value;
mod wire;

pub use mission::MissionItem;
pub use wire::{MAX_PAYLOAD, Series, Text};
