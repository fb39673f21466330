//! A campaign with everything that is needed to fly it.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::version;
use crate::args::TerrainArgs;
use crate::campaign::{Campaign, CampaignFlight, Record, Side};
use crate::design::Stream;
use crate::files::terrain::with_terrain;
use crate::headless::campaign::consent::Consent;
use crate::headless::campaign::definition::{check_other_side, firmware_of};
use crate::headless::campaign::run_file::RunReader;
use crate::headless::campaign::sources::Sources;
use crate::headless::check::{RemoteFlown, fly_case};
use crate::launch::RemoteFirmware;
use crate::launch::run::Stopped;
use crate::plan::format;
use crate::process::error;
use crate::process::error::AppError;
use crate::report::campaign::{Definition, RunHeader};
use crate::runner::Runner;
use crate::scenario::{self, CaseFlight, Change, Flights, Request, read_request};

/// The most flights of a file of `check`.
const MAX_LISTED: usize = 1_000_000;
/// The most flights that are looked at before the start.
const LOOKED_AT: u64 = 2000;

/// A campaign that can be flown.
pub(super) struct Loaded {
    pub(super) header: RunHeader,
    pub(super) campaign: Campaign,
    firmware: [Option<RemoteFirmware>; 2],
}

/// A flight of a campaign for the screen.
pub(crate) struct OneFlight {
    pub(crate) flight: CampaignFlight,
    /// The name of the campaign.
    pub(crate) name: String,
    pub(crate) firmware: Option<RemoteFirmware>,
    /// The flight as it was flown in the campaign.
    pub(crate) record: Record,
}

impl Loaded {
    /// Reads the scenario of a definition, whose files come from `sources`.
    pub(super) fn new(mut definition: Definition, mut sources: Sources) -> Result<Self, AppError> {
        let campaign = campaign(&definition, &mut sources)?;
        definition.files = sources.contents;
        let name = campaign.scenario().name.clone();
        let header = RunHeader::new(definition, &version(), &name, campaign.count());
        Self::with_header(header, campaign)
    }

    /// Reads the campaign of a run's file.
    pub(super) fn from_run(header: RunHeader) -> Result<Self, AppError> {
        let definition = &header.definition;
        let mut sources = Sources { place: None, contents: definition.files.clone() };
        let campaign = campaign(definition, &mut sources)?;
        if campaign.count() != header.flights {
            return Err(AppError::input(format!(
                "the first line of the run is damaged: it says {} flights, and its campaign has {}",
                header.flights,
                campaign.count()
            )));
        }
        Self::with_header(header, campaign)
    }

    fn with_header(header: RunHeader, campaign: Campaign) -> Result<Self, AppError> {
        let definition = &header.definition;
        let own = firmware_of(&definition.firmware, definition.firmware_print.as_deref())?;
        let other = match &definition.versus {
            None => None,
            Some(side) => {
                let firmware = if side.has_firmware {
                    firmware_of(&side.firmware, side.firmware_print.as_deref())?
                } else {
                    own.clone()
                };
                check_other_side(side, firmware.is_none())?;
                firmware
            }
        };
        Ok(Self { header, campaign, firmware: [own, other] })
    }

    /// Checks, before the start, that the flights can be flown: all of a small campaign, some of a large one.
    ///
    /// # Errors
    /// Returns a sentence with the first flight that cannot be flown, and the number of them.
    pub(super) fn refuse_impossible_flights(&self) -> Result<(), AppError> {
        let flights = self.header.flights;
        let (mut looked_at, mut impossible, mut first) = (0_u64, 0_u64, None);
        for number in looks(flights) {
            looked_at += 1;
            let sides = [Side::A, Side::B].into_iter().take(self.header.sides() as usize);
            let problem = sides.filter_map(|side| self.of_side(number, side)?.impossible()).next();
            impossible += u64::from(problem.is_some());
            first = first.or(problem.map(|problem| (number, problem)));
        }
        let Some((number, problem)) = first else { return Ok(()) };
        let inputs = self.campaign.flight(number).map(|flight| flight.inputs).unwrap_or_default();
        let inputs: Vec<String> = inputs.iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let with = if inputs.is_empty() { String::new() } else { format!(" ({})", inputs.join(", ")) };
        Err(AppError::input(format!(
            "{impossible} of {looked_at} flights cannot be flown; flight {number}{with}: {problem}; let the inputs vary less"
        )))
    }

    /// Returns the flight of a line, from 0, and its side.
    pub(super) fn flight(&self, line: u64) -> Option<(CampaignFlight, Side)> {
        let sides = self.header.sides();
        let side = if line.is_multiple_of(sides) { Side::A } else { Side::B };
        self.of_side(line / sides + 1, side).map(|flight| (flight, side))
    }

    fn of_side(&self, number: u64, side: Side) -> Option<CampaignFlight> {
        let mut flight = self.campaign.flight(number)?;
        if let Some(other) = self.header.definition.versus.as_ref().filter(|_| side == Side::B) {
            for setting in &other.settings {
                let applied = Change::Setting(setting.clone()).apply(&mut flight.case, &mut flight.air);
                if let Err(problem) = applied {
                    flight.problem.get_or_insert(problem);
                }
            }
        }
        Some(flight)
    }

    /// Flies and judges the flight of a line; `None` if it was interrupted. Adds messages about a remote firmware to
    /// `reported`.
    pub(super) fn fly(
        &self,
        line: u64,
        thread: usize,
        interrupted: &Arc<AtomicBool>,
        is_stopped: &impl Fn() -> bool,
        reported: &mut Vec<String>,
    ) -> Option<Result<Record, AppError>> {
        let (flight, side) = self.flight(line)?;
        if let Some(problem) = flight.problem.clone() {
            return Some(Ok(Record::not_flown(&flight, side, problem)));
        }
        match &self.firmware[side as usize] {
            None => embedded(&flight, side, is_stopped).map(Ok),
            Some(firmware) => remote(&flight, side, firmware, thread, interrupted, reported),
        }
    }
}

/// Returns the numbers of the flights that are looked at: one, by chance, of each of at most [`LOOKED_AT`] equal parts.
/// Evenly spaced numbers would miss levels of a grid, whose inputs have periods.
fn looks(flights: u64) -> impl Iterator<Item = u64> {
    let stride = flights.div_ceil(LOOKED_AT).max(1);
    let chance = Stream::new(0, "looks");
    (0..flights.div_ceil(stride)).map(move |part| {
        let first = part * stride;
        first + chance.bits(part) % stride.min(flights - first) + 1
    })
}

fn embedded(flight: &CampaignFlight, side: Side, is_stopped: &impl Fn() -> bool) -> Option<Record> {
    let mut flown = match CaseFlight::new(&flight.case, &flight.air) {
        Ok(flown) => flown,
        Err(problem) => return Some(Record::not_flown(flight, side, problem)),
    };
    let mut runner = Runner::new(flown.vehicle().step_us(), f64::INFINITY, None);
    runner.fly(&mut flown, &mut (), is_stopped).ok()?;
    Some(Record::of(flight, side, &flown.finish(), None))
}

fn remote(
    flight: &CampaignFlight,
    side: Side,
    firmware: &RemoteFirmware,
    thread: usize,
    interrupted: &Arc<AtomicBool>,
    reported: &mut Vec<String>,
) -> Option<Result<Record, AppError>> {
    if scenario::skip(&flight.case).is_some() {
        let problem = "only the embedded firmware can fly this case: its inputs or its end need knowledge that no other gives";
        return Some(Ok(Record::not_flown(flight, side, problem.to_owned())));
    }
    match fly_case(firmware, &flight.case, &flight.air, interrupted, thread, false, reported) {
        Ok(Ok(RemoteFlown { flown, problem, hash, .. })) => {
            let record = Record::of(flight, side, &flown, hash);
            Some(Ok(record.with_problem(problem)))
        }
        Ok(Err(problem)) => Some(Ok(Record::not_flown(flight, side, problem))),
        Err(Stopped::Interrupted | Stopped::BySubscriber) => None,
        Err(Stopped::Failed(problem)) if problem.code >= error::ENVIRONMENT => Some(Err(problem)),
        Err(Stopped::Failed(problem)) => Some(Ok(Record::not_flown(flight, side, problem.message))),
    }
}

/// Reads the scenario of a definition as a campaign.
fn campaign(definition: &Definition, sources: &mut Sources) -> Result<Campaign, AppError> {
    let seeds: Option<Vec<u64>> = definition.seeds.map(|(first, last)| (first..=last).collect());
    let is_drawn = definition.flights.is_some() || definition.design.is_some();
    let request = Request {
        file: &definition.file,
        text: &definition.text,
        seeds: seeds.as_deref(),
        max_flights: MAX_LISTED,
        flights: Flights::OfCampaign { is_drawn },
    };
    let mut scenario = read_request(&request, sources)
        .map_err(|errors| AppError::input(format::report(&errors).trim_end().to_owned()))?;
    if let Some(directory) = &definition.terrain {
        let directory = Some(PathBuf::from(directory)).filter(|directory| !directory.as_os_str().is_empty());
        let mut notices = Vec::new();
        for case in &mut scenario.cases {
            let setup = std::mem::take(&mut case.setup);
            case.setup = with_terrain(setup, &TerrainArgs { directory: directory.clone() }, &mut notices)?;
        }
        notices.dedup();
        notices.iter().for_each(|notice| error::tell(notice));
    }
    let design = definition.design.as_deref().and_then(|design| design.parse().ok());
    Campaign::new(scenario, definition.flights, design).map_err(AppError::input)
}

/// Returns the flight that `RUN.jsonl:1234` names, or `None` if the text names no file of a run. `1234b` is the flight of
/// the other side of a comparison.
pub(crate) fn open_flight(text: &str, consent: Consent<'_>) -> Result<Option<OneFlight>, AppError> {
    let Some((file, number)) = text.rsplit_once(':') else { return Ok(None) };
    let path = Path::new(file);
    if !path.is_file() {
        return Ok(None);
    }
    let (number, side) = match number.strip_suffix('b') {
        Some(number) => (number, Side::B),
        None => (number.strip_suffix('a').unwrap_or(number), Side::A),
    };
    let number: u64 = number.parse().map_err(|_| {
        AppError::input(format!("{text}: {number} is not the number of a flight; write {file}:17"))
    })?;
    let reader = RunReader::open(path)?;
    let header = reader.header().clone();
    if side == Side::B && header.sides() < 2 {
        return Err(AppError::input(format!("{file} has no second side: write {file}:{number}")));
    }
    let record = reader.find(number, side)?.ok_or_else(|| {
        AppError::input(format!("{file} has no flight {number}: the campaign has {} flights", header.flights))
    })?;
    let definition = &header.definition;
    let (options, print) = match (side, &definition.versus) {
        (Side::B, Some(other)) if other.has_firmware => (&other.firmware, &other.firmware_print),
        _ => (&definition.firmware, &definition.firmware_print),
    };
    consent.check(path, options, print.as_deref())?;
    let loaded = Loaded::from_run(header)?;
    let flight = loaded.of_side(number, side).ok_or_else(|| AppError::internal("a flight without a case"))?;
    let [own, other] = loaded.firmware;
    let firmware = if side == Side::A { own } else { other };
    Ok(Some(OneFlight { flight, name: loaded.header.name, firmware, record }))
}

/// Returns how another campaign differs from this one, for messages.
pub(super) fn differs(mine: &RunHeader, theirs: &RunHeader) -> String {
    if mine.version != theirs.version {
        return format!("it was flown by betadeck {}, and this is {}", theirs.version, mine.version);
    }
    let (mine, theirs) = (&mine.definition, &theirs.definition);
    if mine.text != theirs.text {
        return "its scenario, plan or options were others".to_owned();
    }
    if mine.files != theirs.files {
        return "a file that it names has changed".to_owned();
    }
    if mine.firmware_print != theirs.firmware_print || mine.firmware != theirs.firmware {
        return "its firmware was another".to_owned();
    }
    "its options were others".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_look_at_some_flights_of_a_grid_sees_each_level_of_each_input() {
        assert!(looks(0).next().is_none());
        assert!(looks(2000).eq(1..=2000), "all of a small campaign");
        for (flights, levels) in [(2002, 2), (4000, 2), (30_000, 15), (1_000_000, 10)] {
            let numbers: Vec<u64> = looks(flights).collect();
            assert!(numbers.len() as u64 <= LOOKED_AT && numbers.is_sorted_by(|a, b| a < b));
            assert!(numbers.iter().all(|number| (1..=flights).contains(number)));
            for level in 0..levels {
                assert!(
                    numbers.iter().any(|number| (number - 1) % levels == level),
                    "level {level} of {levels} in {flights} flights"
                );
            }
        }
    }
}
