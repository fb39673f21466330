//! Rules that must hold for a craft, whatever was typed, sent or stored.

use betadeck::firmware::cli::{CliContext, CliFacts, CliMode, Interpreter, apply_lines};
use betadeck::firmware::config::{Configuration, correct};
use betadeck::firmware::msp::MESSAGES;
use betadeck::firmware::storage::{MAX_IMAGE, decode, encode};
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::signals::{RcFrame, RcSource, SensorFrame};

/// The greatest length of a command line reply.
pub const MAX_TEXT: usize = 1 << 20;
/// The greatest length of a reply to a message, which is the next buffer size of a configurator.
const MAX_MESSAGE: usize = 4096;

/// Runs one line on a configuration, at rest on the ground.
pub fn run_line(configuration: &mut Configuration, interpreter: &mut Interpreter, line: &str) -> String {
    let facts = CliFacts::default();
    let reply = interpreter.run(line, &mut CliContext { configuration, facts: &facts });
    assert!(reply.text.len() <= MAX_TEXT, "{line}: {} bytes", reply.text.len());
    reply.text
}

/// The configurations that were checked, so that each is checked once. A fresh craft's counts as checked.
pub struct Checked(Vec<Configuration>);

impl Default for Checked {
    fn default() -> Self {
        let mut corrected = Configuration::default();
        correct(&mut corrected);
        Self(vec![Configuration::default(), corrected])
    }
}

impl Checked {
    /// Asserts that a configuration can be corrected, stored, typed again and flown.
    pub fn assert_sound(&mut self, configuration: Configuration) {
        if !self.0.contains(&configuration) {
            assert_retyped(&assert_flyable(&configuration));
            self.0.push(configuration);
        }
    }
}

/// Asserts that a configuration can be corrected, stored and flown. Returns the corrected one.
pub fn assert_flyable(configuration: &Configuration) -> Configuration {
    let mut corrected = configuration.clone();
    correct(&mut corrected);
    let mut again = corrected.clone();
    correct(&mut again);
    assert_eq!(again, corrected, "a correction is final");
    assert_stored(&corrected);
    let mut firmware = Firmware::new(corrected.clone(), FirmwareOptions::default());
    assert_answers(&mut firmware);
    assert_flies(&mut firmware);
    corrected
}

fn assert_stored(configuration: &Configuration) {
    let image = encode(configuration);
    assert!(image.len() <= MAX_IMAGE, "{} bytes", image.len());
    let (stored, findings) = decode(&image).expect("a good image");
    assert_eq!((&stored, findings), (configuration, Vec::new()));
    assert_eq!(encode(&stored), image);
}

/// Asserts that `diff all` typed into a fresh craft gives the same craft.
fn assert_retyped(configuration: &Configuration) {
    let diff = run_line(&mut configuration.clone(), &mut Interpreter::default(), "diff all");
    let mut copy = Configuration::default();
    let mut context = CliContext { configuration: &mut copy, facts: &CliFacts::default() };
    let report = apply_lines(diff.lines(), &mut Interpreter::new(CliMode::File), &mut context, |_, _| ());
    assert_eq!(report.failed, [], "{diff}");
    let copied = run_line(&mut copy, &mut Interpreter::default(), "diff all");
    assert_eq!(copied, diff);
}

/// Asserts that the command line and every message that only reads are answered.
pub fn assert_answers(firmware: &mut Firmware) {
    let reply = firmware.run_cli(&mut Interpreter::default(), "version");
    assert!(!reply.failed && reply.text.contains("Betaflight"), "{}", reply.text);
    for message in MESSAGES.iter().filter(|message| message.kind.access.to_string() == "read") {
        let reply = firmware.run_msp(message.kind.code, &[], None).reply;
        let length = reply.unwrap_or_else(|| panic!("{} is refused", message.kind.name)).len();
        assert!(length <= MAX_MESSAGE, "{}: {length} bytes", message.kind.name);
    }
}

/// Asserts that the motors get valid numbers.
pub fn assert_flies(firmware: &mut Firmware) {
    for _ in 0..4 {
        firmware.receive_rc(&RcFrame::SAFE, RcSource::Sticks);
        assert_step(firmware, &SensorFrame { pressure_pa: Some(101_325.0), ..SensorFrame::default() });
    }
}

/// Runs one step of the firmware on these sensors and checks the motors.
pub fn assert_step(firmware: &mut Firmware, sensors: &SensorFrame) {
    let motors = firmware.step(sensors).0;
    assert!(motors.iter().all(|motor| (0.0..=1.0).contains(motor)), "{motors:?}");
    while firmware.take_event().is_some() {}
}
