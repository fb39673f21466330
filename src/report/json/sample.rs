//! The fields of a sample: truth and estimate side by side.
//!
//! All `n`, `e` and `alt` count from the place of the craft at boot, as in the snapshot.

use serde::Serialize;

use super::super::number::{Centi, Decimals, Milli, Place, compass};
use crate::signals::PerMotor;
use crate::telemetry::Snapshot;
use crate::telemetry::snapshot::TruthView;

/// The fields after `t` and `event`, in the order of the output; a value that does not exist is `null`.
#[derive(Debug, Serialize)]
pub(super) struct Fields {
    lat: Option<Place>,
    lon: Option<Place>,
    alt: Option<Milli>,
    n: Option<Milli>,
    e: Option<Milli>,
    vn: Option<Milli>,
    ve: Option<Milli>,
    vu: Option<Milli>,
    roll: Option<Milli>,
    pitch: Option<Milli>,
    heading: Option<Milli>,
    est_n: Option<Milli>,
    est_e: Option<Milli>,
    est_alt: Option<Milli>,
    throttle_us: Option<Centi>,
    motors: Option<PerMotor<Decimals<4>>>,
    battery_v: Option<Milli>,
    battery_a: Option<Milli>,
    battery_mah: Option<Milli>,
    state: Option<String>,
    wp: Option<u8>,
    wp_type: Option<String>,
    dist_m: Option<Milli>,
    bearing: Option<Centi>,
    xte_m: Option<Milli>,
    l1_mode: Option<String>,
    target_n: Option<Milli>,
    target_e: Option<Milli>,
    target_alt: Option<Milli>,
    hold_remaining_ds: Option<u16>,
    wind_n: Option<Milli>,
    wind_e: Option<Milli>,
}

impl Fields {
    pub(super) fn of(snapshot: &Snapshot) -> Self {
        let truth =
            |value: fn(&TruthView) -> f64| snapshot.truth.as_ref().map(|truth| Decimals(value(truth)));
        let place =
            |value: fn(&TruthView) -> f64| snapshot.truth.as_ref().map(|truth| Decimals(value(truth)));
        let (craft, nav, estimate) = (&snapshot.craft, snapshot.nav.as_ref(), &snapshot.estimate);
        let kind = nav.and_then(|nav| nav.kind);
        let target = nav.and_then(|nav| nav.target_ne);
        let wind = snapshot.truth.and_then(|truth| truth.wind_ne);
        Self {
            lat: place(|truth| truth.lat_deg),
            lon: place(|truth| truth.lon_deg),
            alt: truth(|truth| truth.alt),
            n: truth(|truth| truth.n),
            e: truth(|truth| truth.e),
            vn: truth(|truth| truth.vn),
            ve: truth(|truth| truth.ve),
            vu: truth(|truth| truth.vu),
            roll: truth(|truth| truth.roll_deg),
            pitch: truth(|truth| truth.pitch_deg),
            heading: snapshot.truth.as_ref().map(|truth| compass(truth.heading_deg)),
            est_n: estimate.n.map(Decimals),
            est_e: estimate.e.map(Decimals),
            est_alt: estimate.alt.map(Decimals),
            throttle_us: craft.throttle_us.map(Decimals),
            motors: craft.motors.map(|motors| motors.map(Decimals)),
            battery_v: craft.battery_v.map(Decimals),
            battery_a: craft.battery_a.map(Decimals),
            battery_mah: craft.battery_mah.map(Decimals),
            state: nav.map(|nav| nav.state.to_string()),
            wp: nav.filter(|_| kind.is_some()).map(|nav| nav.wp),
            wp_type: kind.map(|kind| kind.to_string()),
            dist_m: nav.and_then(|nav| nav.distance_m).map(Decimals),
            bearing: nav.and_then(|nav| nav.bearing_rad).map(|bearing| compass(bearing.to_degrees())),
            xte_m: nav.and_then(|nav| nav.xte_m).map(Decimals),
            l1_mode: nav.and_then(|nav| nav.l1_mode).map(|mode| mode.to_string()),
            target_n: target.map(|target| Decimals(target.x)),
            target_e: target.map(|target| Decimals(target.y)),
            target_alt: nav.and_then(|nav| nav.target_alt_m).map(Decimals),
            hold_remaining_ds: nav
                .and_then(|nav| nav.hold_remaining_s)
                .map(|left_s| (left_s * 10.0).round() as u16),
            wind_n: wind.map(|ne| Decimals(ne.x)),
            wind_e: wind.map(|ne| Decimals(ne.y)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample_line;
    use crate::signals::SimTime;
    use crate::telemetry::snapshot::TruthView;
    use crate::telemetry::{L1Mode, NavTelemetry, Snapshot};

    /// The keys of a sample, in their order.
    const KEYS: [&str; 34] = [
        "t",
        "event",
        "lat",
        "lon",
        "alt",
        "n",
        "e",
        "vn",
        "ve",
        "vu",
        "roll",
        "pitch",
        "heading",
        "est_n",
        "est_e",
        "est_alt",
        "throttle_us",
        "motors",
        "battery_v",
        "battery_a",
        "battery_mah",
        "state",
        "wp",
        "wp_type",
        "dist_m",
        "bearing",
        "xte_m",
        "l1_mode",
        "target_n",
        "target_e",
        "target_alt",
        "hold_remaining_ds",
        "wind_n",
        "wind_e",
    ];

    #[test]
    fn an_empty_snapshot_has_all_keys_in_order() {
        let nav = Some(NavTelemetry::default());
        let line = sample_line(&Snapshot { time: SimTime(1_500), nav, ..Snapshot::default() });
        let mut rest = line.as_str();
        for key in KEYS {
            let (_, after) =
                rest.split_once(&format!("\"{key}\":")).unwrap_or_else(|| panic!("{key} in {line}"));
            rest = after;
        }
        assert!(line.starts_with(r#"{"t":0.0015,"event":"sample","lat":null,"lon":null"#), "{line}");
        assert!(line.contains(r#""state":"IDLE","wp":null,"wp_type":null"#), "{line}");
    }

    #[test]
    fn what_a_navigator_does_not_tell_is_null() {
        let nav = Some(NavTelemetry::default());
        let line = sample_line(&Snapshot { nav: nav.clone(), ..Snapshot::default() });
        for unknown in ["l1_mode", "hold_remaining_ds", "motors", "xte_m"] {
            assert!(line.contains(&format!("\"{unknown}\":null")), "{unknown} in {line}");
        }
        let nav =
            nav.map(|nav| NavTelemetry { l1_mode: Some(L1Mode::Off), hold_remaining_s: Some(0.0), ..nav });
        let line = sample_line(&Snapshot { nav, ..Snapshot::default() });
        assert!(line.contains(r#""l1_mode":"OFF""#) && line.contains(r#""hold_remaining_ds":0"#), "{line}");
    }

    #[test]
    fn values_are_rounded() {
        let mut snapshot = Snapshot {
            truth: Some(TruthView {
                lat_deg: 40.123_456_789_12,
                n: 1.0 / 3.0,
                pitch_deg: -7.9,
                heading_deg: 359.999_9,
                ..TruthView::default()
            }),
            ..Snapshot::default()
        };
        assert!(sample_line(&snapshot).contains(r#""heading":0.0"#));
        let bearing_rad = Some(std::f64::consts::FRAC_PI_2);
        snapshot.nav = Some(NavTelemetry { bearing_rad, ..NavTelemetry::default() });
        snapshot.craft.motors = Some([0.502_565_52, 0.0, 1.0, 0.25]);
        let line = sample_line(&snapshot);
        for part in [
            r#""lat":40.12345679"#,
            r#""n":0.333"#,
            r#""pitch":-7.9"#,
            r#""bearing":90.0"#,
            r#""motors":[0.5026,0.0,1.0,0.25]"#,
        ] {
            assert!(line.contains(part), "{part} in {line}");
        }
    }
}
