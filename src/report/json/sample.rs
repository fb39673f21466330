//! The fields of a sample: truth and estimate side by side.
//!
//! All `n`, `e` and `alt` count from the place of the craft at boot, as in the snapshot.

use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::super::number::{Centi, Decimals, Milli, Place, compass};
use crate::telemetry::Snapshot;
use crate::telemetry::signal::{Observed, Signal};

/// The form of a value.
#[derive(Debug, Clone, Copy)]
enum Form {
    /// A signal, to the thousandth.
    Milli(Signal),
    /// A signal, to the hundredth.
    Centi(Signal),
    /// A direction, to the thousandth of a degree, below 360 after rounding.
    Compass(Signal),
    /// A direction, to the hundredth of a degree.
    Bearing(Signal),
    Latitude,
    Longitude,
    BatteryMah,
    Motors,
    State,
    Wp,
    WpType,
    L1Mode,
    HoldRemaining,
}

/// The fields after `t` and `event`, in the order of the output; a value that does not exist is `null`.
const FIELDS: [(&str, Form); 32] = [
    ("lat", Form::Latitude),
    ("lon", Form::Longitude),
    ("alt", Form::Milli(Signal::Altitude)),
    ("n", Form::Milli(Signal::North)),
    ("e", Form::Milli(Signal::East)),
    ("vn", Form::Milli(Signal::SpeedNorth)),
    ("ve", Form::Milli(Signal::SpeedEast)),
    ("vu", Form::Milli(Signal::Climb)),
    ("roll", Form::Milli(Signal::Roll)),
    ("pitch", Form::Milli(Signal::Pitch)),
    ("heading", Form::Compass(Signal::Heading)),
    ("est_n", Form::Milli(Signal::EstNorth)),
    ("est_e", Form::Milli(Signal::EstEast)),
    ("est_alt", Form::Milli(Signal::EstAltitude)),
    ("throttle_us", Form::Centi(Signal::Throttle)),
    ("motors", Form::Motors),
    ("battery_v", Form::Milli(Signal::ReportedBattery)),
    ("battery_a", Form::Milli(Signal::ReportedCurrent)),
    ("battery_mah", Form::BatteryMah),
    ("state", Form::State),
    ("wp", Form::Wp),
    ("wp_type", Form::WpType),
    ("dist_m", Form::Milli(Signal::WpDistance)),
    ("bearing", Form::Bearing(Signal::Bearing)),
    ("xte_m", Form::Milli(Signal::CrossTrack)),
    ("l1_mode", Form::L1Mode),
    ("target_n", Form::Milli(Signal::TargetNorth)),
    ("target_e", Form::Milli(Signal::TargetEast)),
    ("target_alt", Form::Milli(Signal::TargetAltitude)),
    ("hold_remaining_ds", Form::HoldRemaining),
    ("wind_n", Form::Milli(Signal::WindNorth)),
    ("wind_e", Form::Milli(Signal::WindEast)),
];

/// The fields of a sample of this snapshot.
#[derive(Debug)]
pub(super) struct Fields<'a>(pub(super) &'a Snapshot);

impl Serialize for Fields<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (truth, nav) = (&self.0.truth, self.0.nav.as_ref());
        let observed = Observed::of(self.0);
        let place = |value: Option<f64>| value.map(Place::from);
        let kind = nav.and_then(|nav| nav.kind);
        let mut map = serializer.serialize_map(Some(FIELDS.len()))?;
        for (key, form) in FIELDS {
            match form {
                Form::Milli(signal) => map.serialize_entry(key, &signal.read(&observed).map(Milli::from)),
                Form::Centi(signal) => map.serialize_entry(key, &signal.read(&observed).map(Centi::from)),
                Form::Compass(signal) => map.serialize_entry(key, &signal.read(&observed).map(compass::<3>)),
                Form::Bearing(signal) => map.serialize_entry(key, &signal.read(&observed).map(compass::<2>)),
                Form::BatteryMah => map.serialize_entry(key, &self.0.craft.battery_mah.map(Milli::from)),
                Form::Latitude => map.serialize_entry(key, &place(truth.map(|truth| truth.lat_deg))),
                Form::Longitude => map.serialize_entry(key, &place(truth.map(|truth| truth.lon_deg))),
                Form::Motors => {
                    let motors = self.0.craft.motors;
                    map.serialize_entry(key, &motors.map(|motors| motors.map(Decimals::<4>)))
                }
                Form::State => map.serialize_entry(key, &nav.map(|nav| nav.state.to_string())),
                Form::Wp => map.serialize_entry(key, &nav.filter(|_| kind.is_some()).map(|nav| nav.wp)),
                Form::WpType => map.serialize_entry(key, &kind.map(|kind| kind.to_string())),
                Form::L1Mode => {
                    let mode = nav.and_then(|nav| nav.l1_mode);
                    map.serialize_entry(key, &mode.map(|mode| mode.to_string()))
                }
                Form::HoldRemaining => {
                    let left_s = nav.and_then(|nav| nav.hold_remaining_s);
                    map.serialize_entry(key, &left_s.map(|left_s| (left_s * 10.0).round() as u16))
                }
            }?;
        }
        map.end()
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
