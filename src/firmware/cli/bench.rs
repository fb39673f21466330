//! Commands of the workbench: motors, sounds, pass-through.

use super::CliAction;
use super::session::{Session, integer};

/// The number of motors.
const MOTORS: i64 = 4;
/// The index that means all motors.
const ALL: i64 = 255;
/// The range of a motor output, µs.
const OUTPUT_US: (i64, i64) = (1000, 2000);

/// `motor <index> [<value>]`.
pub(super) fn motor(session: &mut Session<'_>, rest: &str) {
    if session.refused_while_armed() {
        return;
    }
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    let Some((index, values)) = words.split_first() else {
        session.wrong_count();
        return;
    };
    let motor = match integer(index) {
        Some(ALL) => None,
        Some(index) if (0..MOTORS).contains(&index) => Some(index as u8),
        Some(_) => {
            session.error(format_args!("INVALID OUTPUT NUMBER. RANGE: 0 - {}.", MOTORS - 1));
            return;
        }
        None => {
            session.not_understood();
            return;
        }
    };
    match motor {
        Some(index) => session.line(format_args!("Using output {index}.")),
        None => session.line("Using all outputs."),
    }
    let &[value] = values else {
        session.wrong_count();
        return;
    };
    let Some(value) = session.bounded(value, "VALUE", OUTPUT_US.0, OUTPUT_US.1) else { return };
    match motor {
        Some(index) => session.line(format_args!("motor {index}: {value}")),
        None => session.line(format_args!("all motors: {value}")),
    }
    session.act(CliAction::MotorTest { motor, output_us: value as u16 });
}

/// The names of the sounds that a real craft makes, in the order of their numbers.
const SOUNDS: [&str; 10] = [
    "GYRO_CALIBRATED",
    "RX_LOST",
    "RX_LOST_LANDING",
    "DISARMING",
    "ARMING",
    "ARMING_GPS_FIX",
    "BAT_CRIT_LOW",
    "BAT_LOW",
    "GPS_STATUS",
    "RX_SET",
];

/// `play_sound [<index>]`. A simulator has no beeper, so this only prints the name.
pub(super) fn play_sound(session: &mut Session<'_>, rest: &str) {
    let index = if rest.is_empty() { Some(0) } else { integer(rest) };
    let Some(index) = session.understood(index) else { return };
    match usize::try_from(index).ok().and_then(|at| SOUNDS.get(at)) {
        Some(name) => session.line(format_args!("Playing sound {index}: {name}")),
        None => session.error("ARGUMENT OUT OF RANGE"),
    }
}

pub(super) fn gpspassthrough(session: &mut Session<'_>, _rest: &str) {
    session.error("GPS forwarding failed");
}

pub(super) fn serialpassthrough(session: &mut Session<'_>, _rest: &str) {
    session.error("NO SERIAL HARDWARE TO PASS THROUGH TO");
}
