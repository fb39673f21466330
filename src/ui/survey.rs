//! Many flights of the open plan, flown in the background: a fault at every second of it ("where may this happen?"), and a
//! hundred noisy flights (go or no-go).
//!
//! One survey at a time. It ends by Esc, by an edit of the plan, by other air, or when the program ends. Its result stays
//! on the map until then.

mod requests;
mod strip;

use crate::campaign::Forecast;
use crate::flight::sweep::{Fate, SweepPoint};
use crate::sim::ScheduledFault;

use super::forecast::EstimateBasis;
use super::map_point::MapPoint;
use super::theme::Role;

pub(super) use requests::{ask_go_no_go, ask_sweep, can_ask, dismiss, follow, take_reply, toggle_sweep};
pub(super) use strip::draw;

/// The flights from one line of text about them to the next.
const FLIGHTS_PER_LINE: u64 = 10;

/// The survey of the user interface.
#[derive(Debug, Default)]
pub struct SurveyState {
    /// The revision of the newest request.
    revision: u64,
    /// The fault of the newest sweep.
    fault: Option<ScheduledFault>,
    shown: Option<Shown>,
}

/// A survey that is flown or over.
#[derive(Debug)]
struct Shown {
    /// The plan and the air of the flights.
    basis: EstimateBasis,
    is_over: bool,
    what: Surveyed,
}

/// The results so far.
#[derive(Debug)]
enum Surveyed {
    Sweep(SweepSoFar),
    /// The number of flights so far, and the answer as a sentence.
    GoNoGo(u64, Option<String>),
}

/// The seconds of a sweep so far.
#[derive(Debug)]
pub struct SweepSoFar {
    fault: ScheduledFault,
    points: Vec<SweepPoint>,
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
    pub(super) fn line(&self) -> Option<String> {
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

    /// Returns the line of text that the last reply completed: some seconds of a sweep, or the number of flights.
    pub(super) fn completed_line(&self) -> Option<String> {
        let shown = self.shown.as_ref()?;
        match &shown.what {
            Surveyed::Sweep(sweep) => strip::completed_line(sweep, shown.is_over),
            Surveyed::GoNoGo(flown, None) if *flown == 1 || flown.is_multiple_of(FLIGHTS_PER_LINE) => {
                self.line()
            }
            Surveyed::GoNoGo(..) => None,
        }
    }
}

impl SweepSoFar {
    /// Returns how often each fate comes, with its mark.
    fn counts(&self) -> String {
        let count = |fate| self.points.iter().filter(|point| point.fate == fate).count();
        let [home, off, lost] = [Fate::Home, Fate::Off, Fate::Lost].map(count);
        format!("· {home} home, o {off} landed off, X {lost} lost")
    }

    /// Returns the places at which a craft has this fate, each with the next one, where the fate changes.
    pub(super) fn legs(&self, fate: Fate) -> impl Iterator<Item = (MapPoint, MapPoint)> + '_ {
        let pairs = self.points.windows(2).filter_map(|pair| pair.first().zip(pair.get(1)));
        pairs.filter(move |(from, _)| from.fate == fate).map(|(from, to)| (place(from), place(to)))
    }

    /// Returns the marks of the fates that are not good, the worst last.
    pub(super) fn marks(&self) -> impl Iterator<Item = (MapPoint, &'static str, Role)> + '_ {
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
fn mark(fate: Fate) -> &'static str {
    match fate {
        Fate::Home => "·",
        Fate::Off => "o",
        Fate::Lost => "X",
    }
}

/// Returns the colour of a fate.
pub(super) fn role(fate: Fate) -> Role {
    match fate {
        Fate::Home => Role::Ok,
        Fate::Off => Role::Warn,
        Fate::Lost => Role::Fault,
    }
}
