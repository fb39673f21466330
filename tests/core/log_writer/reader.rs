//! A decoder that shares no code with the program. It stops at the first byte that it does not understand.

use std::collections::BTreeMap;

/// The values of a frame by the names of their fields.
pub(crate) type Values = BTreeMap<String, i64>;

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Event {
    SyncBeep { time_us: i64 },
    Resume { iteration: i64, time_us: i64 },
    Disarm { reason: i64 },
    FlightMode { new: i64, old: i64 },
    End,
}

/// A frame or an event.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Part {
    /// A frame with its letter, and the place behind it.
    Frame {
        letter: char,
        values: Values,
        end: usize,
    },
    Event(Event),
}

/// A log, in its order.
#[derive(Debug)]
pub(crate) struct Log {
    pub(crate) headers: BTreeMap<String, String>,
    pub(crate) parts: Vec<Part>,
    /// The length of the header.
    pub(crate) header: usize,
}

struct Fields {
    names: Vec<String>,
    predictors: Vec<i64>,
    encodings: Vec<i64>,
}

struct Bytes<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Bytes<'_> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn unsigned(&mut self) -> Option<i64> {
        let mut value = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            value |= i64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(value);
            }
        }
        None
    }

    fn signed(&mut self) -> Option<i64> {
        let value = self.unsigned()?;
        Some(if value % 2 == 0 { value / 2 } else { -(value + 1) / 2 })
    }

    /// Reads values of consecutive fields.
    fn group(&mut self, encoding: i64, count: usize) -> Option<Vec<i64>> {
        let extend =
            |value: i64, bits: u32| if value >> (bits - 1) & 1 == 1 { value - (1 << bits) } else { value };
        Some(match encoding {
            0 => vec![self.signed()?],
            1 => vec![self.unsigned()?],
            3 => vec![-extend(self.unsigned()?, 14)],
            6 if count == 1 => vec![self.signed()?],
            6 => {
                let flags = self.byte()?;
                let mut value = |bit: usize| if flags >> bit & 1 == 1 { self.signed() } else { Some(0) };
                (0..count).map(&mut value).collect::<Option<_>>()?
            }
            7 => {
                let first = i64::from(self.byte()?);
                match first >> 6 {
                    0 => [4, 2, 0].map(|shift| extend(first >> shift & 3, 2)).to_vec(),
                    1 => {
                        let second = i64::from(self.byte()?);
                        vec![extend(first & 15, 4), extend(second >> 4, 4), extend(second & 15, 4)]
                    }
                    2 => {
                        let (second, third) = (i64::from(self.byte()?), i64::from(self.byte()?));
                        [first, second, third].map(|byte| extend(byte & 63, 6)).to_vec()
                    }
                    _ => {
                        let mut long = |shift: i64| {
                            let bytes = (first >> shift & 3) as u32 + 1;
                            let mut value = 0;
                            for place in 0..bytes {
                                value |= i64::from(self.byte()?) << (8 * place);
                            }
                            Some(extend(value, 8 * bytes))
                        };
                        vec![long(0)?, long(2)?, long(4)?]
                    }
                }
            }
            8 => {
                let selector = self.byte()?;
                let mut waiting: Option<u8> = None;
                let mut nibble = || match waiting.take() {
                    Some(low) => Some(i64::from(low)),
                    None => {
                        let byte = self.byte()?;
                        waiting = Some(byte & 15);
                        Some(i64::from(byte >> 4))
                    }
                };
                let mut values = Vec::new();
                for field in 0..4 {
                    let nibbles = [0, 1, 2, 4][usize::from(selector >> (2 * field) & 3)];
                    let mut value = 0;
                    for _ in 0..nibbles {
                        value = value << 4 | nibble()?;
                    }
                    values.push(if nibbles == 0 { 0 } else { extend(value, 4 * nibbles) });
                }
                values
            }
            9 => vec![0],
            _ => panic!("encoding {encoding} is not written"),
        })
    }

    /// Reads the differences of a frame.
    fn differences(&mut self, encodings: &[i64]) -> Option<Vec<i64>> {
        let mut differences = Vec::new();
        while let Some(encoding) = encodings.get(differences.len()) {
            let same = encodings[differences.len()..].iter().take_while(|other| *other == encoding).count();
            differences.extend(self.group(*encoding, same.min(8))?);
        }
        Some(differences)
    }

    fn event(&mut self) -> Option<Event> {
        Some(match self.byte()? {
            0 => Event::SyncBeep { time_us: self.unsigned()? },
            14 => Event::Resume { iteration: self.unsigned()?, time_us: self.unsigned()? },
            15 => Event::Disarm { reason: self.unsigned()? },
            30 => Event::FlightMode { new: self.unsigned()?, old: self.unsigned()? },
            255 => {
                let text = self.bytes.get(self.at..self.at + 11)?;
                assert_eq!(text, b"End of log\0");
                self.at += 11;
                Event::End
            }
            other => panic!("event {other} is not written"),
        })
    }
}

/// The frames on which predictions are based.
#[derive(Default)]
struct Past {
    main: [Vec<i64>; 2],
    home: Vec<i64>,
}

/// Reads one log. A log that is cut is read to its last whole part.
pub(crate) fn read(log: &[u8]) -> Log {
    assert!(log.starts_with(b"H Product:Blackbox flight data recorder by Nicholas Sherlock\n"));
    let (mut headers, mut at) = (BTreeMap::new(), 0);
    while log[at..].starts_with(b"H ") {
        let end = at + log[at..].iter().position(|byte| *byte == b'\n').unwrap();
        let line = std::str::from_utf8(&log[at + 2..end]).unwrap();
        let (name, value) = line.split_once(':').unwrap();
        headers.insert(name.to_owned(), value.to_owned());
        at = end + 1;
    }
    let header = at;
    let list = |letter: char, what: &str| headers.get(&format!("Field {letter} {what}"));
    let numbers = |letter, what| -> Vec<i64> {
        list(letter, what)
            .map_or_else(Vec::new, |line| line.split(',').map(|one| one.parse().unwrap()).collect())
    };
    let fields = |letter: char| {
        let names = list(if letter == 'P' { 'I' } else { letter }, "name").map_or("", String::as_str);
        let names = names.split(',').map(str::to_owned).collect();
        Fields { names, predictors: numbers(letter, "predictor"), encodings: numbers(letter, "encoding") }
    };
    let definitions: BTreeMap<u8, Fields> =
        "IPSHG".chars().map(|letter| (letter as u8, fields(letter))).collect();
    let mut bytes = Bytes { bytes: log, at };
    let mut past = Past::default();
    let mut parts = Vec::new();
    while let Some(letter) = bytes.byte() {
        let part = if letter == b'E' {
            bytes.event().map(Part::Event)
        } else {
            let fields = &definitions[&letter];
            bytes.differences(&fields.encodings).map(|differences| {
                let values = predict(letter, fields, differences, &mut past, &headers);
                let values = fields.names.iter().cloned().zip(values).collect();
                Part::Frame { letter: letter.into(), values, end: bytes.at }
            })
        };
        match part {
            Some(part) => parts.push(part),
            None => break,
        }
    }
    Log { headers, parts, header }
}

/// Adds the predictions, and remembers the frame.
fn predict(
    letter: u8,
    fields: &Fields,
    mut values: Vec<i64>,
    past: &mut Past,
    headers: &BTreeMap<String, String>,
) -> Vec<i64> {
    let header = |name: &str| -> i64 { headers[name].split(',').next().unwrap().parse().unwrap() };
    let motor = fields.names.iter().position(|name| name == "motor[0]");
    let mut homes = 0;
    for (at, predictor) in fields.predictors.iter().enumerate() {
        let last = || past.main[0][at];
        let prediction = match predictor {
            0 => 0,
            1 => last(),
            2 => 2 * last() - past.main[1][at],
            3 => (last() + past.main[1][at]) / 2,
            5 => values[motor.unwrap()],
            6 => last() + header("P interval"),
            7 => {
                homes += 1;
                past.home[homes - 1]
            }
            9 => header("vbatref"),
            10 => past.main[0][1],
            11 => header("motorOutput"),
            other => panic!("predictor {other} is not used"),
        };
        values[at] += prediction;
    }
    match letter {
        b'I' => past.main = [values.clone(), values.clone()],
        b'P' => {
            past.main.swap(0, 1);
            past.main[0].clone_from(&values);
        }
        b'H' => past.home.clone_from(&values),
        _ => {}
    }
    values
}

impl Log {
    /// Returns the frames with these letters.
    pub(crate) fn frames(&self, letters: &str) -> Vec<&Values> {
        let wanted = |part| match part {
            &Part::Frame { letter, ref values, .. } if letters.contains(letter) => Some(values),
            _ => None,
        };
        self.parts.iter().filter_map(wanted).collect()
    }

    pub(crate) fn mains(&self) -> Vec<&Values> {
        self.frames("IP")
    }

    pub(crate) fn events(&self) -> Vec<&Event> {
        fn event(part: &Part) -> Option<&Event> {
            match part {
                Part::Event(event) => Some(event),
                Part::Frame { .. } => None,
            }
        }
        self.parts.iter().filter_map(event).collect()
    }

    /// Returns the letters of all parts.
    pub(crate) fn letters(&self) -> String {
        let letter = |part: &Part| match part {
            Part::Frame { letter, .. } => *letter,
            Part::Event(_) => 'E',
        };
        self.parts.iter().map(letter).collect()
    }
}
