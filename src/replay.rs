//! Finished flights, as a display shows them.
//!
//! `past_flight` is the interface to such a flight, which gives the picture of any instant. `overview` is what a display needs of
//! the whole flight at once: its events, a bounded number of pictures, and the names of the series that were recorded.
//! `curve` is a part of such a series in the detail that a display can show. `log` shows blackbox logs,
//! `recorded` recordings of this program.
//!
//! Nothing here does I/O, except for what an implementation of the interface does.

mod curve;
mod log;
mod overview;
mod past_flight;
mod picture;
mod recorded;

pub use curve::Curve;
pub use log::{LogFlights, log_assumptions, log_end_notices};
pub use overview::{Overview, PastEvent, PastEventKind, Series};
pub use past_flight::{CurvesRequest, Moment, PastFlight, PastFlights, Progress};
pub use picture::Picture;
pub use recorded::RecordedFlights;
