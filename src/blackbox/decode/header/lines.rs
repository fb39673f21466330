//! The lines of a header, and the fields that they define.

use super::super::super::field::{Encoding, Field, Predictor};
use super::super::layout::Layout;
use super::finding::HeaderFinding;
use super::{HeaderError, MAX_HEADER, MAX_LINES};

/// The most bytes of a line. Firmwares write less than 1024.
const MAX_LINE: usize = 8192;
/// The most fields of a frame.
const MAX_FIELDS: usize = 256;
/// The most damaged lines that are named.
const MAX_DAMAGED: usize = 20;
/// The lines with free text, which may have a colon.
const FREE_TEXT: [&str; 8] = [
    "Product",
    "Firmware date",
    "Board information",
    "Log start datetime",
    "Craft name",
    "Pilot name",
    "Log writer",
    "DeviceUID",
];

/// The lines of a header, each as name and value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Lines {
    all: Vec<(String, String)>,
    /// The lines that are not of the known form.
    damaged: Vec<HeaderFinding>,
}

impl Lines {
    /// Reads the lines at the start of `bytes`. Returns them with their length.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, usize), HeaderError> {
        let (mut all, mut damaged) = (Vec::new(), Vec::new());
        let mut at = 0;
        // The line before the first one of these names the format.
        let mut number = 2;
        loop {
            let rest = &bytes[at..];
            at += if let Some((name, value, length)) = line(rest) {
                let (name, value) = (text(name), text(value));
                if !is_known_form(&name, &value) {
                    damaged.push(HeaderFinding::joined(number, &name, &value));
                }
                all.push((name, value));
                number += 1;
                length
            } else if let Some(length) = damaged_length(rest) {
                damaged.push(HeaderFinding::damaged(number, &rest[..length]));
                number += rest[..length].iter().filter(|byte| **byte == b'\n').count();
                length
            } else {
                break;
            };
            if at > MAX_HEADER || all.len() > MAX_LINES {
                return Err(HeaderError::TooLong { bytes: MAX_HEADER, lines: MAX_LINES });
            }
        }
        damaged.truncate(MAX_DAMAGED);
        Ok((Self { all, damaged }, at))
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.all.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }

    pub(super) fn damaged(&self) -> &[HeaderFinding] {
        &self.damaged
    }

    pub(super) fn value(&self, name: &str) -> Option<&str> {
        self.iter().find(|(known, _)| *known == name).map(|(_, value)| value)
    }

    pub(super) fn number(&self, name: &str) -> Option<i32> {
        let first = self.value(name)?.split(',').next()?.trim();
        match first.strip_prefix("0x") {
            Some(digits) => u32::from_str_radix(digits, 16).ok().map(|bits| bits as i32),
            None => first.parse().ok(),
        }
    }

    fn list(&self, frame: char, what: &str) -> Result<Vec<&str>, HeaderError> {
        let name = format!("Field {frame} {what}");
        let list: Vec<&str> = match self.value(&name) {
            Some(value) if !value.trim().is_empty() => {
                value.split(',').map(str::trim).take(MAX_FIELDS + 1).collect()
            }
            _ => return Err(HeaderError::NoLine(name)),
        };
        if list.len() > MAX_FIELDS { Err(HeaderError::TooManyFields(MAX_FIELDS)) } else { Ok(list) }
    }

    /// Returns the layout of a frame other than a main frame, and adds what is assumed of it. If one of its four lines cannot be
    /// used, it is assumed from the others, as firmwares write them.
    pub(super) fn side_layout(&self, frame: char, findings: &mut Vec<HeaderFinding>) -> Option<Layout> {
        let prefix = format!("Field {frame} ");
        let given = || self.iter().filter(|(name, _)| name.starts_with(&prefix));
        given().next()?;
        if let Ok(layout) = self.layout(frame, frame) {
            return Some(layout);
        }
        for what in ["name", "signed", "predictor", "encoding"] {
            let line = format!("{prefix}{what}");
            let mut mended = Self {
                all: given().map(|(name, value)| (name.to_owned(), value.to_owned())).collect(),
                damaged: Vec::new(),
            };
            mended.all.retain(|(name, _)| *name != line);
            let Some(value) = mended.assumed(frame, what) else { continue };
            mended.all.push((line.clone(), value));
            if let Ok(layout) = mended.layout(frame, frame) {
                let assumed =
                    format!("the one that firmwares write for such fields is assumed for {frame} frames");
                findings.push(HeaderFinding::of(self, &line, &assumed));
                return Some(layout);
            }
        }
        None
    }

    /// Returns the values that firmwares write in one of the lines that define a frame, from the other lines.
    fn assumed(&self, frame: char, what: &str) -> Option<String> {
        let list = |what: &str| self.list(frame, what).ok();
        let value = |at: usize| -> Option<String> {
            let name = || list("name")?.get(at).copied();
            Some(match what {
                "name" => format!("{frame}[{at}]"),
                "signed" => u8::from(*list("encoding")?.get(at)? == "0").to_string(),
                "predictor" => match (frame, name()?) {
                    ('G', "time") => Predictor::LastMainFrameTime as u8,
                    (_, "GPS_coord[0]" | "GPS_coord[1]") => Predictor::HomeCoordinate as u8,
                    _ => Predictor::Zero as u8,
                }
                .to_string(),
                _ => match name()? {
                    "failsafePhase" | "rxSignalReceived" | "rxFlightChannelsValid" => {
                        Encoding::Tag2_3S32 as u8
                    }
                    _ if *list("signed")?.get(at)? == "0" => Encoding::UnsignedVb as u8,
                    _ => Encoding::SignedVb as u8,
                }
                .to_string(),
            })
        };
        let count = if what == "name" { list("encoding") } else { list("name") }?.len();
        Some((0..count).map(value).collect::<Option<Vec<_>>>()?.join(","))
    }

    /// Returns the layout of a frame: names and signs from the lines of one letter, predictors and encodings from those of
    /// another.
    pub(super) fn layout(&self, names_of: char, rest_of: char) -> Result<Layout, HeaderError> {
        let names = self.list(names_of, "name")?;
        let as_many = |frame: char, what: &str| {
            let list = self.list(frame, what)?;
            if list.len() == names.len() {
                return Ok(list);
            }
            let line = format!("Field {frame} {what}");
            Err(HeaderError::Counts { line, names: names.len(), other: list.len() })
        };
        let signs = as_many(names_of, "signed")?;
        let predictors = as_many(rest_of, "predictor")?;
        let encodings = as_many(rest_of, "encoding")?;
        let field = |at: usize| {
            let name = field_name(names[at]);
            let number = |text: &str| text.parse::<u8>().ok();
            let predictor = number(predictors[at]).and_then(Predictor::from_repr).ok_or_else(|| {
                HeaderError::Predictor { field: name.clone(), number: predictors[at].to_owned() }
            })?;
            let encoding = number(encodings[at]).and_then(Encoding::from_repr).ok_or_else(|| {
                HeaderError::Encoding { field: name.clone(), number: encodings[at].to_owned() }
            })?;
            Ok(Field { signed: signs[at] != "0", name, predictor, encoding })
        };
        Ok(Layout::new((0..names.len()).map(field).collect::<Result<_, _>>()?))
    }
}

/// Returns the present name of a field. Cleanflight before 1.11 called the gyro `gyroData`.
fn field_name(name: &str) -> String {
    match name.strip_prefix("gyroData") {
        Some(rest) => format!("gyroADC{rest}"),
        None => name.to_owned(),
    }
}

/// Returns name, value and length of the line at the start, if there is one.
fn line(bytes: &[u8]) -> Option<(&[u8], &[u8], usize)> {
    let bytes = bytes.strip_prefix(b"H ")?;
    let end = bytes.iter().take(MAX_LINE).position(|byte| *byte == b'\n')?;
    let colon = bytes[..end].iter().position(|byte| *byte == b':')?;
    Some((&bytes[..colon], &bytes[colon + 1..end], end + 3))
}

/// Returns `false` if a line has parts of two lines, or characters that no firmware writes.
fn is_known_form(name: &str, value: &str) -> bool {
    let is_setting = !name.starts_with(|first: char| first.is_ascii_uppercase())
        || name.starts_with("Field ")
        || ["Data version", "Firmware type", "Firmware revision", "I interval", "P interval", "P ratio"]
            .contains(&name);
    let has_room = |text: &str| !text.contains(|letter: char| letter.is_control() || letter == '\u{fffd}');
    let is_name = name.bytes().all(|byte| (b' '..=b'~').contains(&byte));
    let is_free = FREE_TEXT.contains(&name);
    is_name && (is_free || has_room(value)) && !(is_setting && value.contains(':'))
}

/// Returns the length of the bytes before the next line of a header, if they are the rest of damaged lines and no frames: a gap
/// leaves text, or the bytes of a card that was never written.
fn damaged_length(bytes: &[u8]) -> Option<usize> {
    let is_left = |byte: u8| matches!(byte, b' '..=b'~' | b'\t' | b'\r' | b'\n' | 0 | 0xff);
    let within = bytes.iter().take(MAX_LINE).take_while(|byte| is_left(**byte)).count();
    let ends = bytes[..within].iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(at, _)| at + 1);
    let is_line = |at: &usize| {
        let next = line(&bytes[*at..]).map(|(name, value, _)| (text(name), text(value)));
        next.is_some_and(|(name, value)| !name.is_empty() && is_known_form(&name, &value))
    };
    ends.into_iter().find(is_line)
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes.trim_ascii()).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Lines {
        Lines::read(text.as_bytes()).unwrap().0
    }

    #[test]
    fn lines_end_where_a_frame_begins() {
        let bytes = b"H a:1\r\nH b: x:y \nH \x10\x11\x12";
        let (lines, length) = Lines::read(bytes).unwrap();
        assert_eq!(lines.iter().collect::<Vec<_>>(), [("a", "1"), ("b", "x:y")]);
        assert_eq!(&bytes[length..], b"H \x10\x11\x12");
    }

    #[test]
    fn damaged_lines_are_counted_each() {
        let (lines, _) = Lines::read(b"H a:1\nx\ny\nz\nH b:2\nx\nH c:3\n").unwrap();
        let starts: Vec<_> = lines.damaged().iter().map(|line| line.to_string()[..7].to_owned()).collect();
        assert_eq!(starts, ["Line 3 ", "Line 7 "]);
    }

    #[test]
    fn numbers_are_decimal_or_bits() {
        let lines = lines("H gyro_scale:0x3f800000\nH motorOutput:1070,2000\nH low:-5\nH odd:x\n");
        assert_eq!(lines.number("gyro_scale"), Some(0x3f80_0000));
        assert_eq!(lines.number("motorOutput"), Some(1070));
        assert_eq!(lines.number("low"), Some(-5));
        assert_eq!(lines.number("odd"), None);
    }

    #[test]
    fn incomplete_definitions_are_named() {
        let of = |text: &str| lines(text).layout('I', 'I').unwrap_err().to_string();
        assert_eq!(of(""), "its header has no line `Field I name`");
        let names = "H Field I name:gyroData[0],b\nH Field I signed:1,0\nH Field I predictor:0,0\n";
        assert_eq!(of(names), "its header has no line `Field I encoding`");
        assert_eq!(
            of(&format!("{names}H Field I encoding:0\n")),
            "its header has 2 names but 1 entries in the line `Field I encoding`"
        );
        assert_eq!(
            of(&format!("{names}H Field I encoding:0,2\n")),
            "its field `b` has the encoding `2`, which is unknown"
        );
        let whole = lines(&format!("{names}H Field I encoding:0,1\n")).layout('I', 'I').unwrap();
        assert_eq!(whole.fields()[0].name, "gyroADC[0]");
        assert!(whole.fields()[0].signed && !whole.fields()[1].signed);
    }

    #[test]
    fn fields_and_headers_without_end_are_refused() {
        let list = "a,".repeat(300);
        let text = format!("H Field I name:{list}\n");
        assert_eq!(lines(&text).layout('I', 'I'), Err(HeaderError::TooManyFields(MAX_FIELDS)));
        let too_long = HeaderError::TooLong { bytes: MAX_HEADER, lines: MAX_LINES };
        for line in ["H a:b\n".to_owned(), format!("H a:{}\n", "b".repeat(MAX_LINE - 5))] {
            assert!(Lines::read(line.repeat(3).as_bytes()).is_ok());
            assert_eq!(Lines::read(line.repeat(1001).as_bytes()), Err(too_long.clone()));
        }
    }
}
