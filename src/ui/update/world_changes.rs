//! Notes the changes of the air and the faults.

use crate::signals::SimTime;
use crate::telemetry::snapshot::WorldView;
use crate::ui::knobs::{Knob, knobs_of};
use crate::ui::model::world_history::{WorldChange, WorldHistory};
use crate::ui::shared::Shared;
use crate::ui::units::Units;

/// Notes the differences between the world of the picture before and that of now.
pub(super) fn follow(state: &mut Shared, before: &WorldView) {
    let vehicle = &state.view.vehicle;
    state.world_history.forget_after(vehicle.time);
    note_changes(&mut state.world_history, vehicle.time, [before, &vehicle.world], state.units);
}

fn note_changes(history: &mut WorldHistory, time: SimTime, [before, now]: [&WorldView; 2], units: Units) {
    if before == now || before.airframe != now.airframe {
        return;
    }
    for knob in knobs_of(true) {
        let (was, is) = (knob.value_in(before, units), knob.value_in(now, units));
        // The time that a fault has left is no change.
        let is_change = match knob {
            Knob::Fault(_) => knob.is_default(before) != knob.is_default(now),
            _ => was != is,
        };
        if is_change {
            let is_gradual = matches!(knob, Knob::WindSpeed | Knob::WindFrom | Knob::Gust);
            history.note(WorldChange { time, name: knob.name(), value: is.trim().to_owned(), is_gradual });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::telemetry::snapshot::{FaultView, WindView};
    use crate::telemetry::{FaultKind, FaultValue};

    fn world(speed_mps: f64, left_s: Option<f64>) -> WorldView {
        let fault = left_s.map(|left_s| FaultView {
            kind: FaultKind::GpsLoss,
            value: FaultValue::None,
            left_s: Some(left_s),
        });
        WorldView {
            wind: Some(WindView { speed_mps, from_deg: 270.0 }),
            faults: fault.into_iter().collect(),
            ..WorldView::default()
        }
    }

    fn shown(history: &WorldHistory, time_s: f64) -> Vec<String> {
        let until = history.until(SimTime::from_secs_f64(time_s));
        until.map(|change| format!("{} {}", change.name, change.value)).collect()
    }

    #[test]
    fn a_rising_wind_is_one_change_and_a_fault_has_a_beginning_and_an_end() {
        let worlds = [
            (10.0, world(0.0, None)),
            (11.0, world(2.0, None)),
            (12.0, world(5.0, None)),
            (20.0, world(5.0, Some(6.0))),
            (23.0, world(5.0, Some(3.0))),
            (26.0, world(5.0, None)),
            (40.0, world(7.0, None)),
        ];
        let mut history = WorldHistory::default();
        for pair in worlds.windows(2) {
            let time = SimTime::from_secs_f64(pair[1].0);
            note_changes(&mut history, time, [&pair[0].1, &pair[1].1], Units::Metric);
        }
        assert_eq!(
            shown(&history, 100.0),
            ["wind speed 7.0 m/s", "gps-loss —", "gps-loss on for 6.0 s", "wind speed 5.0 m/s"]
        );
        assert_eq!(shown(&history, 22.0), ["gps-loss on for 6.0 s", "wind speed 5.0 m/s"]);
        history.forget_after(SimTime::from_secs_f64(22.0));
        assert_eq!(shown(&history, 100.0).len(), 2);
    }
}
