//! Files by name: input files, output files that are replaced as a whole, flights and logs, elevation tiles.

pub(crate) mod directories;
pub(crate) mod file_identity;
pub(crate) mod flight_library;
pub(crate) mod flight_recorder;
pub(crate) mod flown_log;
pub(crate) mod input_file;
pub(crate) mod log_output;
pub(crate) mod log_source;
pub(crate) mod named_file;
pub(crate) mod output_file;
pub(crate) mod recording_file;
pub(crate) mod set_aside;
pub(crate) mod telemetry_log;
pub(crate) mod terrain;
