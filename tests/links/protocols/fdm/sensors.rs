//! The sensor values that the firmware gets from the simulator's packets: position, acceleration, sample
//! rates, dialect.

use betadeck::firmware::config::Configuration;
use betadeck::firmware::{AttitudeSource, Firmware, FirmwareOptions};
use betadeck::link::conventions::{Dialect, Mirror};
use betadeck::link::proto::fdm::GZ_PLUGIN_SIZE;
use betadeck::link::proto::fdm_link::{FdmLink, FdmLinkConfig, FdmNotice};
use betadeck::signals::SimTime;
use betadeck::telemetry::FirmwareEvent;
use nalgebra::Vector3;

use super::{MS, at_rest, bytes, default_flow, flowing, packet};

#[test]
fn a_position_off_the_globe_is_no_fix_and_harms_nothing_else() {
    let (mut link, start) = default_flow(500);
    let mut last_fix = 0;
    for ms in 0..3500 {
        let now = start + ms * MS;
        let mut state = at_rest(now as f64 * 1e-6);
        if ms < 3000 {
            state.lat_deg = 999.0;
        }
        let received = link.receive(&bytes(Dialect::SitlGz, &state), now);
        let sensors = received.sensors.unwrap();
        assert!(sensors.specific_force_flu.z > 9.0);
        if let Some(gps) = sensors.gps {
            assert!(ms >= 3000 && gps.fix);
            last_fix = ms;
            if ms < 3200 {
                assert!(ms <= 3200, "back within 0.2 s");
            }
        }
    }
    assert!(last_fix >= 3400);
}

#[test]
fn a_firmware_loses_the_fix_2500_ms_after_the_last_position_and_nothing_else() {
    let options =
        FirmwareOptions { attitude: AttitudeSource::Truth, gps_timeout_s: 2.5, ..FirmwareOptions::default() };
    let mut firmware = Firmware::new(Configuration::default(), options);
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut time_ms = 0;
    let (mut lost_ms, mut back_ms) = (None, None);
    const GONE_MS: u64 = 4000;
    const HERE_MS: u64 = 7000;
    for ms in 0..8000 {
        let mut state = at_rest(ms as f64 * 1e-3);
        if (GONE_MS..HERE_MS).contains(&ms) {
            state.lat_deg = 999.0;
        }
        let received = link.receive(&bytes(Dialect::SitlGz, &state), ms * MS);
        let Some(mut sensors) = received.sensors else { continue };
        for _ in 0..received.ticks {
            time_ms += 1;
            sensors.time = SimTime(time_ms * MS);
            firmware.step(&sensors);
            (sensors.pressure_pa, sensors.mag_flu, sensors.gps) = (None, None, None);
        }
        while let Some(event) = firmware.take_event() {
            match event {
                FirmwareEvent::GpsLost { .. } => lost_ms = Some(ms),
                FirmwareEvent::GpsFix { .. } if ms > GONE_MS => back_ms = Some(ms),
                _ => {}
            }
        }
        if ms > 1000 {
            let facts = firmware.msp_facts(None);
            assert!(facts.roll_deg.abs() < 0.1 && facts.pitch_deg.abs() < 0.1, "level at {ms} ms");
        }
    }
    // A position comes every 100 ms, so the last good one may be that much older than the first bad one.
    let (lost_ms, back_ms) = (lost_ms.unwrap(), back_ms.unwrap());
    assert!((GONE_MS + 2400..=GONE_MS + 2700).contains(&lost_ms), "{lost_ms}");
    assert!((HERE_MS..=HERE_MS + 200).contains(&back_ms), "{back_ms}");
}

#[test]
fn sensors_sample_at_their_own_rates() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let (mut gps, mut baro, mut mag) = (0, 0, 0);
    for step in 0..1990_u64 {
        let received = link.receive(&packet(step as f64 * 0.5e-3), step * MS);
        let sensors = received.sensors.unwrap();
        gps += u32::from(sensors.gps.is_some());
        baro += u32::from(sensors.pressure_pa.is_some());
        mag += u32::from(sensors.mag_flu.is_some());
        assert!(sensors.truth_attitude.is_some());
    }
    assert_eq!((gps, baro, mag), (10, 50, 100));
}

/// Flies north at 5 m/s for three seconds. Positions are mirrored on the wire if `mirrored`.
fn fly_north(config: FdmLinkConfig, dialect: Dialect, mirrored: bool) -> (Vec<FdmNotice>, f64) {
    let (mut link, start) = flowing(config, dialect, 300);
    let mut notices = Vec::new();
    let mut lat = 0.0;
    for ms in 0..3000 {
        let now = start + ms * MS;
        let mut state = at_rest(now as f64 * 1e-6);
        state.vel_enu = Vector3::new(0.0, 5.0, 0.0);
        let north_deg = ms as f64 * 5e-3 / 111_043.55;
        state.lat_deg += if mirrored { -north_deg } else { north_deg };
        let received = link.receive(&bytes(dialect, &state), now);
        notices.extend(received.notices);
        if let Some(gps) = received.sensors.unwrap().gps {
            lat = gps.position.lat_deg();
        }
    }
    (notices, lat)
}

#[test]
fn mirrored_positions_are_turned_back() {
    let (notices, lat) = fly_north(FdmLinkConfig::default(), Dialect::GzPlugin, true);
    assert!(notices.is_empty());
    assert!(lat > 40.4635 + 0.0001);
}

#[test]
fn positions_that_are_not_mirrored_are_noticed() {
    let (notices, lat) = fly_north(FdmLinkConfig::default(), Dialect::GzPlugin, false);
    assert_eq!(notices, [FdmNotice::NotMirrored]);
    assert!(lat > 40.4635 + 0.0001);
    let forced = FdmLinkConfig { mirror: Mirror::On, ..FdmLinkConfig::default() };
    let (notices, lat) = fly_north(forced, Dialect::GzPlugin, false);
    assert!(notices.is_empty() && lat < 40.4635);
    let off = FdmLinkConfig { mirror: Mirror::Off, ..FdmLinkConfig::default() };
    assert!(fly_north(off, Dialect::SitlGz, false).1 > 40.4635);
}

#[test]
fn gravity_is_found_in_the_acceleration_at_rest() {
    // A newer plugin sends the specific force in the plugin's layout.
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut notices = Vec::new();
    let mut force = 0.0;
    for ms in 0..400_u64 {
        let mut packet = Dialect::GzPlugin.encode(&at_rest(ms as f64 * 1e-3));
        packet.fields[6] = -betadeck::geo::GRAVITY;
        let mut bytes = packet.to_bytes().to_vec();
        bytes.resize(GZ_PLUGIN_SIZE, 0);
        let received = link.receive(&bytes, ms * MS);
        notices.extend(received.notices);
        force = received.sensors.unwrap().specific_force_flu.z;
    }
    assert_eq!(notices, [FdmNotice::GravityIncluded]);
    assert!((force - betadeck::geo::GRAVITY).abs() < 1e-9);
}

#[test]
fn an_acceleration_that_makes_no_sense_is_reported_once() {
    let mut link = FdmLink::new(FdmLinkConfig::default(), 0);
    let mut notices = Vec::new();
    for ms in 0..1000_u64 {
        let mut packet = Dialect::SitlGz.encode(&at_rest(ms as f64 * 1e-3));
        packet.fields[6] = -5.0;
        notices.extend(link.receive(&packet.to_bytes(), ms * MS).notices);
    }
    assert_eq!(notices, [FdmNotice::GravityUnclear]);
}

#[test]
fn the_dialect_follows_the_size_and_can_be_reported() {
    let (link, _) = flowing(FdmLinkConfig::default(), Dialect::GzPlugin, 10);
    assert_eq!(link.dialect(), Some(Dialect::GzPlugin));
    let legacy = FdmLinkConfig { dialect: Some(Dialect::Legacy), ..FdmLinkConfig::default() };
    let (mut link, now) = flowing(legacy, Dialect::Legacy, 10);
    let received = link.receive(&bytes(Dialect::Legacy, &at_rest(0.010)), now);
    assert!(received.sensors.unwrap().truth_attitude.unwrap().angle_to(&at_rest(0.0).attitude) < 1e-9);
}
