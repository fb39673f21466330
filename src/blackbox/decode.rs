//! The reader of logs.
//!
//! [`LogReader`] takes bytes from a [`LogSource`] and gives the logs of a file with their frames and events, one at a time, in
//! bounded memory whatever the bytes are. `header` reads the lines of a header, `layout` turns the fields of a frame into
//! steps, `bytes` and `group` decode numbers, `decoder` is the state machine of one log, `window` the part of the source that
//! is in memory.
//!
//! A log has no checksums. A frame is taken if another frame, or the end, follows it. Bytes that are no frame are skipped and
//! counted; differences are useless until the next whole main frame, and are counted, too. A whole main frame is taken if its
//! time and iteration follow those before it, or if the next one confirms a jump.

mod bytes;
mod clock;
mod constants;
mod decoder;
mod event;
mod group;
mod header;
mod layout;
mod predict;
mod reader;
mod source;
#[cfg(test)]
mod tests;
mod window;

pub use decoder::DecoderState;
pub use header::{FirmwareName, Header, HeaderError, HeaderFinding, Version};
pub use reader::{Frame, Item, LogReader, ResumePoint};
pub use source::LogSource;
