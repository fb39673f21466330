//! The reasons for which a log cannot be read.

/// The reason for which a log cannot be read. `Display` gives a sentence without its full stop.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum HeaderError {
    /// The data version is not 2.
    #[error(
        "it has data version {0}; only version 2, which all firmwares have written since 2015, can be read"
    )]
    DataVersion(String),
    /// A line that defines a frame is missing.
    #[error("its header has no line `{0}`")]
    NoLine(String),
    /// The lines that define a frame have different numbers of entries.
    #[error("its header has {names} names but {other} entries in the line `{line}`")]
    Counts { line: String, names: usize, other: usize },
    /// A frame has more fields than any firmware writes.
    #[error("its header defines more than {0} fields of a frame")]
    TooManyFields(usize),
    #[error("its field `{field}` has the encoding `{number}`, which is unknown")]
    Encoding { field: String, number: String },
    #[error("its field `{field}` has the predictor `{number}`, which is unknown")]
    Predictor { field: String, number: String },
    /// Main frames have no loop iteration or no time.
    #[error("its main frames have no field `{0}`")]
    NoField(&'static str),
    #[error("its header is longer than {bytes} bytes or {lines} lines")]
    TooLong { bytes: usize, lines: usize },
    #[error("the file ends inside its header")]
    Cut,
}
