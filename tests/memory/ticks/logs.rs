//! A step that notes a log allocates nothing, from the header to the end, and neither does the encoding.

use betadeck::blackbox::encode::LogBuffer;
use betadeck::firmware::blackbox::LogStream;
use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::signals::{RcFrame, RcSource};
use betadeck::sim::{World, WorldConfig};

use crate::meter::allocations;

#[test]
fn a_log_allocates_nothing() {
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    for (name, number) in [("blackbox_device", 4), ("blackbox_sample_rate", 0), ("rssi_channel", 9)] {
        configuration.settings.set_number(name, number).unwrap();
    }
    let mut firmware = Firmware::new(configuration, FirmwareOptions::default());
    let mut world = World::new(WorldConfig::default()).unwrap();
    let (mut stream, mut buffer) = (LogStream::default(), LogBuffer::default());
    let (mut stepped, mut encoded, mut bytes, mut logs) = (0, 0, 0, 0);
    let mut sticks = RcFrame::SAFE;
    while world.time().as_secs_f64() < 14.0 {
        let seconds = world.time().as_secs_f64();
        sticks.channels[4] = if (6.0..9.0).contains(&seconds) || seconds > 10.0 { 2000 } else { 1000 };
        if world.time().0.is_multiple_of(20_000) {
            firmware.receive_rc(&sticks, RcSource::Sticks);
        }
        let before = allocations();
        let command = firmware.step(world.sensors());
        stepped += allocations() - before;
        let before = allocations();
        buffer.clear();
        let step = firmware.log_step().unwrap();
        stream.step(&step, &mut buffer);
        encoded += allocations() - before;
        bytes += buffer.bytes().len();
        logs += usize::from(step.begins.is_some());
        while firmware.take_event().is_some() {}
        world.step(&command);
    }
    assert_eq!(logs, 2);
    assert!(bytes > 200_000, "{bytes}");
    assert_eq!((stepped, encoded), (0, 0));
}
