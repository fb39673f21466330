//! The lines of a header, and the fields that they define.

use super::super::super::field::{Encoding, Field, Predictor};
use super::super::layout::Layout;
use super::{HeaderError, MAX_HEADER, MAX_LINES};

/// The most bytes of a line. Firmwares write less than 1024.
const MAX_LINE: usize = 8192;
/// The most fields of a frame.
const MAX_FIELDS: usize = 256;

/// The lines of a header, each as name and value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Lines(Vec<(String, String)>);

impl Lines {
    /// Reads the lines at the start of `bytes`. Returns them with their length.
    pub(super) fn read(bytes: &[u8]) -> Result<(Self, usize), HeaderError> {
        let mut lines = Vec::new();
        let mut at = 0;
        while let Some((name, value, length)) = line(&bytes[at..]) {
            lines.push((text(name), text(value)));
            at += length;
            if at > MAX_HEADER || lines.len() > MAX_LINES {
                return Err(HeaderError::TooLong { bytes: MAX_HEADER, lines: MAX_LINES });
            }
        }
        Ok((Self(lines), at))
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (&str, &str)> {
        self.0.iter().map(|(name, value)| (name.as_str(), value.as_str()))
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
