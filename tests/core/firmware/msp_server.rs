//! The MSP server against exchanges captured from the real executable, and the effects of its messages.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod captured;
mod commands;
mod reading;
mod table;
mod writing;

use betadeck_core::firmware::cli::BuildInfo;
use betadeck_core::firmware::config::{Configuration, ModeCondition};
use betadeck_core::firmware::msp::{MspFacts, handle};
use betadeck_core::geo::LatLon;
use betadeck_core::msp::RawGps;

/// Returns the configuration of the craft in the captured exchanges.
fn craft() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.settings.set_text("craft_name", "SITLQUAD").unwrap();
    configuration.settings.set_number("small_angle", 180).unwrap();
    for (slot, box_id) in [0, 56, 1, 46].into_iter().enumerate() {
        configuration.modes[slot] = ModeCondition {
            box_id,
            aux_channel: slot as u8,
            start_us: 1700,
            end_us: 2100,
            ..ModeCondition::default()
        };
    }
    configuration
}

/// Returns the state of the craft in the captured exchanges.
fn facts() -> MspFacts {
    let mut channels = [1500; 16];
    channels[3..10].fill(1000);
    MspFacts {
        build: BuildInfo {
            version: "2026.12.0-alpha".to_owned(),
            api: "1.49".to_owned(),
            date: "Nov 21 2026".to_owned(),
            time: "02:51:34".to_owned(),
            revision: "301d01a".to_owned(),
        },
        cycle_time_us: 939,
        heading_deg: 358.0,
        gps: RawGps {
            fix: true,
            sats: 12,
            position: LatLon::new(-275_000_000, 1_530_000_000),
            alt_amsl_m: 30.0,
            ..RawGps::default()
        },
        channels,
        ..MspFacts::default()
    }
}

fn ask(configuration: &mut Configuration, code: u16, request: &[u8]) -> Option<Vec<u8>> {
    handle(code, request, configuration, &facts()).reply
}
