//! RC datagrams of scripts, one after the other.

use betadeck::firmware::config::Configuration;
use betadeck::firmware::{Firmware, FirmwareOptions};
use betadeck::link::proto::rc;
use betadeck::signals::{RcSource, SensorFrame};

use super::craft;

/// Reads each datagram and steps a craft on it.
pub fn run(data: &[u8]) {
    assert_eq!(rc::decode(data).is_some(), data.len() >= rc::SIZE);
    let mut configuration = Configuration::default();
    configuration.starter_modes();
    let options = FirmwareOptions { arm_assist: true, ..FirmwareOptions::default() };
    let mut firmware = Firmware::new(configuration, options);
    for datagram in data.chunks(rc::SIZE) {
        let Some((stamp_s, frame)) = rc::decode(datagram) else { continue };
        assert_eq!(rc::encode(stamp_s, &frame), *datagram);
        firmware.receive_rc(&frame, RcSource::Udp);
        for _ in 0..4 {
            craft::assert_step(&mut firmware, &SensorFrame::default());
        }
    }
}
