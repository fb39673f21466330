//! Turns what the recorder noted into bytes.

use super::log::{LogDefinition, LogPart};
use super::main_frame::{FieldPlaces, MainState};
use super::recorder::LogStep;
use crate::blackbox::encode::{FrameValues, LogBuffer, LogEncoder, MAX_FIELDS};

/// The writer of the logs of one firmware, one after the other.
#[derive(Debug, Clone, Default)]
pub struct LogStream {
    log: Option<Open>,
}

/// A log under way.
#[derive(Debug, Clone)]
struct Open {
    encoder: LogEncoder,
    places: FieldPlaces,
    scale: f64,
}

impl LogStream {
    /// Begins a log.
    pub fn begin(&mut self, definition: &LogDefinition) {
        self.log = Some(Open {
            encoder: LogEncoder::new(&definition.layout, definition.constants),
            places: FieldPlaces::new(&definition.fields),
            scale: definition.scale,
        });
    }

    /// Writes a part of the log that was begun last. `main` is the state for main frames.
    pub fn part(&mut self, part: &LogPart, main: &MainState, buffer: &mut LogBuffer) {
        let Some(Open { encoder, places, scale }) = &mut self.log else { return };
        match part {
            LogPart::Intra => encoder.intra(&places.values(main, *scale), buffer),
            LogPart::Inter => encoder.inter(&places.values(main, *scale), buffer),
            LogPart::Slow(values) => encoder.slow(&frame(values), buffer),
            LogPart::Home(values) => encoder.home(&frame(values), buffer),
            LogPart::Gps(values) => encoder.gps(&frame(values), buffer),
            LogPart::Event(event) => buffer.write(|log| log.event(event)),
        }
    }

    /// Writes all that a step noted. A buffer has room for it.
    pub fn step(&mut self, step: &LogStep<'_>, buffer: &mut LogBuffer) {
        if let Some(definition) = step.begins {
            self.begin(definition);
        }
        buffer.write(|log| log.all(step.text));
        for part in step.parts {
            self.part(part, step.main, buffer);
        }
    }
}

fn frame(values: &[i32]) -> FrameValues {
    let mut frame = [0; MAX_FIELDS];
    for (place, value) in frame.iter_mut().zip(values) {
        *place = *value;
    }
    frame
}
