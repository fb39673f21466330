//! The flight recorder: notes what belongs in a log of each flight, and writes it as bytes.
//!
//! ```text
//!                        in the step                                  after it, on any thread
//!  Firmware ─► Recorder ─► Log: header, frames, events ─► LogStep ─► LogStream ─► bytes
//!                           │ when they are due: `schedule`             │ values of the fields, predictions, encodings
//! ```
//!
//! The step only copies the state of the craft: to turn it into bytes takes longer than a step may be delayed. The owner
//! of the firmware reads [`LogStep`] after each step. It is gone with the next one. A clone of the firmware logs on by
//! itself; nobody reads its steps. Nothing here allocates.
//!
//! `main_frame` has the fields of `I` and `P` frames, `side_frames` those of `S`, `H` and `G`, `header` the lines before
//! the frames, `debug` the values of `debug_mode`.

mod config;
mod debug;
mod flash;
mod header;
mod log;
mod main_frame;
mod recorder;
mod schedule;
mod side_frames;
mod stream;

pub use config::{DISABLED_FIELDS, LogConfig, LogDevice, disabled_mask};
pub use flash::{FLASH_BYTES, FLASH_SECTORS, Flash, FlashFacts};
pub use header::WRITER_LINE;
pub use log::{LogDefinition, LogPart};
pub use main_frame::MainState;
pub use recorder::LogStep;
pub(super) use recorder::Recorder;
pub use schedule::{I_INTERVAL_US, Schedule};
pub use side_frames::{GpsValues, HomeValues, SlowValues};
pub use stream::LogStream;
