//! MSP, the serial protocol of Betaflight's configurators: frames, the table of messages, and the messages
//! that both sides use, each with its encoding and decoding.
//!
//! Messages grew over the releases: a field that an older message lacks is `None` or 0, and fields appended by
//! newer releases are skipped. Each type has `decode(payload)`, which returns `None` when the payload is no such
//! message, and `encode(&mut Writer)`. Quantities are in SI units.

pub mod code;
mod frame;
mod identity;
mod modes;
mod motion;
mod power;
mod receiver;
mod status;
#[cfg(test)]
mod tests;
mod wire;

pub use code::{Access, MessageKind};
pub use frame::{Decoder, Dropped, Form, Frame, Kind, MAX_REPLY, MAX_REQUEST};
pub use identity::{
    ApiVersion, BETAFLIGHT, BoardInfo, BuildInfo, FLIGHT_PLAN_OPTION, FcVersion, PROCESSOR_NAMED,
};
pub use modes::{ModeLink, ModeSlot, range_step, range_us};
pub use motion::{Altitude, Attitude, HomeVector, RawGps};
pub use power::{BatteryReading, BatteryState};
pub use receiver::{Channels, Motors};
pub use status::Status;
pub use wire::{PaddedReader, Reader, Writer, steps};
