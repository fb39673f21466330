//! Many flights of the open plan, flown in the background: a fault at every second of it ("where may this happen?"), and a
//! hundred noisy flights (go or no-go).
//!
//! One survey at a time. It ends by Esc, by an edit of the plan, by other air, or when the program ends. Its result stays
//! on the map until then.

use crate::campaign::Forecast;
use crate::flight::sweep::{Fate, SweepPoint};
use crate::sim::ScheduledFault;

use crate::ui::model::forecast::EstimateBasis;
use crate::ui::model::map_point::MapPoint;
use crate::ui::theme::Role;

/// The survey of the user interface.
#[derive(Debug, Default)]
pub struct SurveyState {
    /// The revision of the newest request.
    pub(in crate::ui) revision: u64,
    /// The fault of the newest sweep.
    pub(in crate::ui) fault: Option<ScheduledFault>,
    pub(in crate::ui) shown: Option<Shown>,
}

/// A survey that is flown or over.
#[derive(Debug)]
pub(in crate::ui) struct Shown {
    /// The plan and the air of the flights.
    pub(in crate::ui) basis: EstimateBasis,
    pub(in crate::ui) is_over: bool,
    pub(in crate::ui) what: Surveyed,
}

/// The results so far.
#[derive(Debug)]
pub(in crate::ui) enum Surveyed {
    Sweep(SweepSoFar),
    /// The number of flights so far, and the answer as a sentence.
    GoNoGo(u64, Option<String>),
}

/// The seconds of a sweep so far.
#[derive(Debug)]
pub struct SweepSoFar {
    pub(in crate::ui) fault: ScheduledFault,
    pub(in crate::ui) points: Vec<SweepPoint>,
}

impl SurveyState {
    /// Returns the sweep that is shown.
    pub fn sweep(&self) -> Option<&SweepSoFar> {
        match &self.shown.as_ref()?.what {
            Surveyed::Sweep(sweep) => Some(sweep),
            Surveyed::GoNoGo(..) => None,
        }
    }

    /// Returns `true` while a survey is flown.
    pub fn is_flying(&self) -> bool {
        self.shown.as_ref().is_some_and(|shown| !shown.is_over)
    }

    /// Returns the line about the survey for the top of the map.
    pub(in crate::ui) fn line(&self) -> Option<String> {
        let shown = self.shown.as_ref()?;
        Some(match &shown.what {
            Surveyed::Sweep(sweep) => {
                let so_far = if shown.is_over { "" } else { " so far…" };
                format!("{} at every second: {}{so_far}", sweep.fault.timeless(), sweep.counts())
            }
            Surveyed::GoNoGo(_, Some(sentence)) => sentence.clone(),
            Surveyed::GoNoGo(flown, None) => {
                format!("go or no-go: {flown} of {} flights …", Forecast::FLIGHTS)
            }
        })
    }
}

impl SweepSoFar {
    /// Returns how often each fate comes, with its mark.
    pub(in crate::ui) fn counts(&self) -> String {
        let count = |fate| self.points.iter().filter(|point| point.fate == fate).count();
        let [home, off, lost] = [Fate::Home, Fate::Off, Fate::Lost].map(count);
        format!("· {home} home, o {off} landed off, X {lost} lost")
    }

    /// Returns the places at which a craft has this fate, each with the next one, where the fate changes.
    pub(in crate::ui) fn legs(&self, fate: Fate) -> impl Iterator<Item = (MapPoint, MapPoint)> + '_ {
        let pairs = self.points.windows(2).filter_map(|pair| pair.first().zip(pair.get(1)));
        pairs.filter(move |(from, _)| from.fate == fate).map(|(from, to)| (place(from), place(to)))
    }

    /// Returns the marks of the fates that are not good, the worst last.
    pub(in crate::ui) fn marks(&self) -> impl Iterator<Item = (MapPoint, &'static str, Role)> + '_ {
        [Fate::Off, Fate::Lost].into_iter().flat_map(|fate| {
            let of_fate = self.points.iter().filter(move |point| point.fate == fate);
            of_fate.map(move |point| (place(point), mark(fate), role(fate)))
        })
    }
}

fn place(point: &SweepPoint) -> MapPoint {
    let [east, north, _] = point.place_enu;
    MapPoint::new(north, east)
}

/// Returns the character of a fate.
pub(in crate::ui) fn mark(fate: Fate) -> &'static str {
    match fate {
        Fate::Home => "·",
        Fate::Off => "o",
        Fate::Lost => "X",
    }
}

/// Returns the colour of a fate.
pub(in crate::ui) fn role(fate: Fate) -> Role {
    match fate {
        Fate::Home => Role::Ok,
        Fate::Off => Role::Warn,
        Fate::Lost => Role::Fault,
    }
}
