//! Logs of the product's own writer.

use proptest::prelude::*;

use super::{Read, all};
use crate::blackbox::encode::{
    Coding, FieldGroup, FrameValues, LogBuffer, LogConstants, LogEncoder, LogLayout, MAX_FIELDS, Rule,
};
use crate::blackbox::{AdjustedValue, FIRST_LINE, FrameKind, LogEvent, Predictor};

/// The loops from one whole frame to the next.
const INTRA: u32 = 32;
const CONSTANTS: LogConstants =
    LogConstants { p_interval: 1, min_throttle: 1070, min_motor: 1000, vbat_reference: 1620 };

/// The groups of main frames with the range of their values.
fn main_groups() -> Vec<(FieldGroup, std::ops::RangeInclusive<i32>)> {
    use Coding::*;
    use Predictor::*;
    // The average of two greater numbers does not fit 32 bits.
    let half = i32::MIN / 2..=i32::MAX / 2;
    let svb = Rule(Zero, SignedVb);
    vec![
        (FieldGroup::main(&["p[0]", "p[1]"], true, svb, Rule(Previous, SignedVb)), i32::MIN..=i32::MAX),
        (
            FieldGroup::main(&["i[0]", "i[1]", "i[2]"], true, svb, Rule(Previous, Tag2_3S32)),
            i32::MIN..=i32::MAX,
        ),
        (
            FieldGroup::main(&["rc[0]", "rc[1]", "rc[2]", "rc[3]"], true, svb, Rule(Previous, Tag8_4S16)),
            -9000..=9000,
        ),
        (
            FieldGroup::main(&["vbat"], false, Rule(VbatReference, Neg14Bit), Rule(Previous, Tag8_8Svb)),
            0..=8000,
        ),
        (
            FieldGroup::main(&["a", "b", "c", "d", "e", "f"], true, svb, Rule(Previous, Tag8_8Svb)),
            i32::MIN..=i32::MAX,
        ),
        (FieldGroup::main(&["gyro[0]", "gyro[1]"], true, svb, Rule(Average2, SignedVb)), half.clone()),
        (FieldGroup::main(&["line"], true, Rule(MinThrottle, SignedVb), Rule(StraightLine, SignedVb)), half),
        (FieldGroup::main(&["centre"], true, Rule(Centre1500, SignedVb), Rule(Previous, SignedVb)), 0..=3000),
        (
            FieldGroup::main(&["motor[0]"], false, Rule(MinMotor, UnsignedVb), Rule(Average2, SignedVb)),
            900..=2100,
        ),
        (
            FieldGroup::main(
                &["motor[1]", "motor[2]"],
                false,
                Rule(Motor0, SignedVb),
                Rule(Average2, SignedVb),
            ),
            900..=2100,
        ),
        (FieldGroup::main(&["alone"], true, svb, Rule(Previous, Tag8_8Svb)), i32::MIN..=i32::MAX),
    ]
}

fn layout() -> LogLayout {
    let mut layout = LogLayout::default();
    let mut add = |kind, group| assert!(layout.add(kind, group));
    let counter = Rule(Predictor::Increment, Coding::Null);
    let unsigned = Rule(Predictor::Zero, Coding::UnsignedVb);
    let signed = Rule(Predictor::Zero, Coding::SignedVb);
    add(FrameKind::Intra, FieldGroup::main(&["loopIteration"], false, unsigned, counter));
    let time = Rule(Predictor::StraightLine, Coding::SignedVb);
    add(FrameKind::Intra, FieldGroup::main(&["time"], false, unsigned, time));
    main_groups().into_iter().for_each(|(group, _)| add(FrameKind::Intra, group));
    add(FrameKind::Slow, FieldGroup::side(&["flags", "state"], false, unsigned));
    let slow = Rule(Predictor::Zero, Coding::Tag2_3S32);
    add(FrameKind::Slow, FieldGroup::side(&["phase", "signal", "valid"], false, slow));
    add(FrameKind::GpsHome, FieldGroup::side(&["GPS_home[0]", "GPS_home[1]"], true, signed));
    add(
        FrameKind::Gps,
        FieldGroup::side(&["time"], false, Rule(Predictor::LastMainFrameTime, Coding::UnsignedVb)),
    );
    add(
        FrameKind::Gps,
        FieldGroup::side(
            &["GPS_coord[0]", "GPS_coord[1]"],
            true,
            Rule(Predictor::HomeCoordinate, Coding::SignedVb),
        ),
    );
    layout
}

/// Something to write between two loops.
#[derive(Debug, Clone)]
enum Extra {
    Slow([i32; 5]),
    Home([i32; 2]),
    Gps([i32; 2]),
    Event(LogEvent),
}

fn extra() -> impl Strategy<Value = Extra> {
    let event = prop_oneof![
        any::<u32>().prop_map(|time| LogEvent::SyncBeep { time_us: time.into() }),
        any::<u32>().prop_map(|reason| LogEvent::Disarm { reason }),
        any::<[u32; 2]>().prop_map(|[new, old]| LogEvent::FlightMode { new, old }),
        (0..128_u8, any::<i32>()).prop_map(|(function, value)| LogEvent::Adjustment {
            function,
            value: AdjustedValue::Whole(value)
        }),
        (0..128_u8, -1e9..1e9_f32).prop_map(|(function, value)| LogEvent::Adjustment {
            function,
            value: AdjustedValue::Float(value)
        }),
    ];
    prop_oneof![
        any::<[i32; 5]>().prop_map(Extra::Slow),
        (-900_000_000..=900_000_000, -1_800_000_000..=1_800_000_000)
            .prop_map(|(lat, lon)| Extra::Home([lat, lon])),
        (-900_000_000..=900_000_000, -1_800_000_000..=1_800_000_000)
            .prop_map(|(lat, lon)| Extra::Gps([lat, lon])),
        event.prop_map(Extra::Event),
    ]
}

/// A loop: the step of time, the values of the main frame, and what follows it.
type Loop = (u32, Vec<i32>, Option<Extra>);

fn loops() -> impl Strategy<Value = Vec<Loop>> {
    let values: Vec<_> = main_groups()
        .into_iter()
        .flat_map(|(group, range)| std::iter::repeat_n(range, group.names.len()))
        // Most values are small in real logs, and so are their differences.
        .map(|range| {
            let small = (*range.start()).max(-40)..=(*range.end()).min((*range.start()).max(0) + 40);
            prop_oneof![3 => small, 1 => range]
        })
        .collect();
    prop::collection::vec((1..5000_u32, values, prop::option::weighted(0.1, extra())), 1..120)
}

fn frame(values: impl IntoIterator<Item = i32>) -> FrameValues {
    let mut frame = [0; MAX_FIELDS];
    frame.iter_mut().zip(values).for_each(|(place, value)| *place = value);
    frame
}

/// Writes the loops and returns the log with what is to be read from it.
fn written(loops: &[Loop], p_interval: u32, begin: u32) -> (Vec<u8>, Vec<Read>) {
    let (layout, constants) = (layout(), LogConstants { p_interval, ..CONSTANTS });
    let mut bytes = format!("{FIRST_LINE}\nH Data version:2\n").into_bytes();
    bytes
        .extend((0..).map_while(|number| layout.line(number)).flat_map(|line| line.to_string().into_bytes()));
    let settings = format!(
        "H I interval:{INTRA}\nH P interval:{p_interval}\nH minthrottle:1070\nH motorOutput:1000,2000\nH vbatref:1620\n"
    );
    bytes.extend(settings.into_bytes());
    let mut encoder = LogEncoder::new(&layout, constants);
    let mut buffer = LogBuffer::default();
    let mut expected = vec![Read::Log];
    let (mut time, mut time_us) = (begin, u64::from(begin));
    for (iteration, (step, values, extra)) in (0..).zip(loops) {
        if iteration > 0 {
            time = time.wrapping_add(*step);
            time_us += u64::from(*step);
        }
        let place = iteration % INTRA;
        if !place.is_multiple_of(p_interval) {
            // What is between two frames belongs to the next one.
            continue;
        }
        let values: Vec<i32> =
            [iteration as i32, time as i32].into_iter().chain(values.iter().copied()).collect();
        let kind = if place == 0 { FrameKind::Intra } else { FrameKind::Inter };
        match kind {
            FrameKind::Intra => encoder.intra(&frame(values.clone()), &mut buffer),
            _ => encoder.inter(&frame(values.clone()), &mut buffer),
        }
        expected.push(Read::Frame(kind, values, time_us));
        match extra {
            None => {}
            Some(Extra::Slow(values)) => {
                encoder.slow(&frame(*values), &mut buffer);
                expected.push(Read::Frame(FrameKind::Slow, values.to_vec(), time_us));
            }
            Some(Extra::Home(values)) => {
                encoder.home(&frame(*values), &mut buffer);
                expected.push(Read::Frame(FrameKind::GpsHome, values.to_vec(), time_us));
            }
            Some(Extra::Gps([lat, lon])) => {
                let values = [time as i32, *lat, *lon];
                encoder.gps(&frame(values), &mut buffer);
                expected.push(Read::Frame(FrameKind::Gps, values.to_vec(), time_us));
            }
            Some(Extra::Event(event)) => {
                buffer.write(|log| log.event(event));
                expected.push(Read::Event(Some(*event)));
            }
        }
        bytes.extend_from_slice(buffer.bytes());
        buffer.clear();
    }
    buffer.write(|log| log.event(&LogEvent::End));
    bytes.extend_from_slice(buffer.bytes());
    expected.extend([Read::Event(Some(LogEvent::End)), Read::LogEnd]);
    (bytes, expected)
}

proptest! {
    #[test]
    fn what_was_written_is_read(loops in loops(), p_interval in prop::sample::select(vec![1, 2, 4, 8, 16]), begin in any::<u32>()) {
        let (bytes, expected) = written(&loops, p_interval, begin);
        let read = all(&bytes);
        for (at, (read, expected)) in read.iter().zip(&expected).enumerate() {
            prop_assert_eq!(read, expected, "item {}", at);
        }
        prop_assert_eq!(read.len(), expected.len());
    }
}
