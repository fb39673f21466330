//! The strict reader of a scenario file in TOML. It reports all problems with their places.

mod air;
mod bounds;
mod campaign;
mod craft;
mod expect;
mod keys;
mod measure;
mod plan;
mod reader;
mod variant;
mod varied;
mod vary;

use std::collections::BTreeMap;
use std::rc::Rc;

use super::case::{SAMPLE_HZ, WATCH_S};
use super::expression::{Instant, Scope, read_quantity};
use super::input::{TimedInput, read_action, waypoints_after};
use crate::flight::FlightSetup;
use crate::plan::format::{PlanError, PlanFile, Problems, TomlTable, Value};
use crate::scenario::air::Air;
use crate::scenario::case::{Allowance, Case, Compare, Scenario};
use crate::sim::Noise;
use keys::{ALLOW_KEYS, CASE_KEYS, COMPARE_KEYS, FILE_KEYS, INPUT_KEYS};
use reader::{Layers, Reader};
use variant::Variant;

pub use air::{MAX_SEEDS, seed_range};
#[cfg(test)]
pub(super) use bounds::BOUNDS;

/// The version of the file format.
pub const FORMAT: i64 = 1;

/// The largest scenario file, bytes.
const MAX_BYTES: usize = 512 << 10;
/// The most flights of a scenario, cases times seeds, unless the user allows more.
pub const MAX_FLIGHTS: usize = 10_000;
/// The default time limit of a scenario, s after the engagement.
const TIME_LIMIT_S: f64 = 600.0;
/// The most samples of a flight: some 400 MB.
const MAX_SAMPLES: f64 = 2e6;
/// The most names of cases in a message.
const SHOWN_CASES: usize = 20;

/// A reader for the files that a scenario names; names are relative to the place of the scenario.
pub trait Files {
    /// Reads a plan file.
    ///
    /// # Errors
    /// Returns a sentence with the mistake in the file.
    fn plan(&mut self, name: &str) -> Result<PlanFile, String>;

    /// Reads a text file: settings or an airframe.
    ///
    /// # Errors
    /// Returns a sentence with the reason if the file cannot be read.
    fn text(&mut self, name: &str) -> Result<String, String>;
}

/// A request for a scenario.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The name of the file, as the user gave it.
    pub file: &'a str,
    /// The text of the file.
    pub text: &'a str,
    /// The seeds that replace those of the file.
    pub seeds: Option<&'a [u64]>,
    /// The most flights that are listed.
    pub max_flights: usize,
    /// The flights to list.
    pub flights: Flights,
}

/// The flights of a scenario that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flights {
    /// Each case with each of its seeds. A file that draws its flights is refused.
    Listed,
    /// Those of a campaign: drawn if the file or the user says so, else listed.
    OfCampaign {
        /// `true` if they are drawn in any case.
        is_drawn: bool,
    },
}

/// Reads a scenario. `file` is the name given by the user; `seeds` replace the seeds of the file.
///
/// # Errors
/// Returns all problems, in the order of their places.
pub fn read(
    file: &str,
    text: &str,
    seeds: Option<&[u64]>,
    files: &mut dyn Files,
) -> Result<Scenario, Vec<PlanError>> {
    let request = Request { file, text, seeds, max_flights: MAX_FLIGHTS, flights: Flights::Listed };
    read_request(&request, files)
}

/// Reads a scenario as requested.
///
/// # Errors
/// Returns all problems, in the order of their places.
pub fn read_request(request: &Request<'_>, files: &mut dyn Files) -> Result<Scenario, Vec<PlanError>> {
    let text = request.text.strip_prefix('\u{feff}').unwrap_or(request.text);
    let mut problems = Problems::new(request.file, text);
    let scenario = if text.len() > MAX_BYTES {
        let message =
            format!("the file has {} KiB, a scenario at most {} KiB", text.len() >> 10, MAX_BYTES >> 10);
        problems.add(0..0, message, "is this the right file?");
        None
    } else {
        let mut reader = Reader::new(request.max_flights, text, files, &mut problems);
        read_text(&Request { text, ..*request }, &mut reader)
    };
    match scenario {
        Some(scenario) if problems.is_empty() => Ok(scenario),
        _ => Err(problems.into_errors()),
    }
}

fn read_text(request: &Request<'_>, reader: &mut Reader<'_, '_>) -> Option<Scenario> {
    let (document, syntax) = toml::de::DeTable::parse_recoverable(request.text);
    for error in &syntax {
        let message = error.message().replace('\n', ", ");
        reader.problem(error.span().unwrap_or(0..0), message, "this is not valid TOML");
    }
    if !syntax.is_empty() {
        return None;
    }
    let span = document.span();
    let top = TomlTable::from_document("the scenario", document.get_ref(), span);
    reader.refuse_unknown(&top, FILE_KEYS);
    check_format(&top, reader);
    let is_campaign = top.get("campaign").is_some() || varied::is_drawn(&top);
    let is_drawn = match request.flights {
        Flights::Listed if is_campaign => {
            let place = top.get("campaign").or(top.get("vary")).map_or(0..0, toml::Spanned::span);
            let hint = format!("fly it with betadeck campaign {}", request.file);
            reader.problem(place, "this is a campaign", hint);
            return None;
        }
        Flights::Listed => false,
        Flights::OfCampaign { is_drawn } => is_drawn || is_campaign,
    };
    let case_tables = reader.tables(&top, "case", "case");
    let variants = if is_drawn { vec![Variant::default()] } else { vary::read(&top, reader) };
    if !bounds::check(&top, &case_tables, variants.len(), reader) {
        return None;
    }
    let case_names = case_names(&case_tables, reader);
    let mut all_layers = Vec::new();
    let mut cases = Vec::new();
    let undivided = [None];
    let tables: Vec<Option<&TomlTable<'_, '_>>> =
        if case_tables.is_empty() { undivided.to_vec() } else { case_tables.iter().map(Some).collect() };
    for (index, table) in tables.into_iter().enumerate() {
        if let Some(table) = table {
            reader.refuse_unknown(table, CASE_KEYS);
        }
        for variant in &variants {
            let base = case_names.get(index).cloned().unwrap_or_default();
            let layers = Layers { top: &top, case: table, variant, seeds: request.seeds, is_drawn };
            if reader.can_go_on() {
                cases.push(read_case(&base, &case_names, &layers, reader));
            }
            all_layers.push(layers);
        }
    }
    reader.check_flights();
    let campaign = is_drawn.then(|| campaign::read(&top, &all_layers, &cases, reader));
    let compares = read_compares(&top, &cases, reader);
    let name = reader.string(&top, "name").unwrap_or_else(|| stem(request.file).to_owned());
    Some(Scenario {
        file: request.file.to_owned(),
        name,
        description: reader.string(&top, "description").unwrap_or_default(),
        slow: reader.boolean(&top, "slow").unwrap_or(false),
        cases,
        compares,
        campaign,
    })
}

/// Returns the name of a file without its folder and `.toml`: `guide-1` for `plans/scenarios/guide-1.toml`.
fn stem(file: &str) -> &str {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    name.strip_suffix(".toml").unwrap_or(name)
}

fn check_format(top: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) {
    let Some(value) = reader.required(top, "format") else { return };
    match reader.integer(value) {
        Some(FORMAT) | None => {}
        Some(other) => {
            reader.problem(
                value.span(),
                format!("format {other} is not known"),
                format!("write format = {FORMAT}"),
            );
        }
    }
}

fn case_names(tables: &[TomlTable<'_, '_>], reader: &mut Reader<'_, '_>) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for table in tables {
        let name = reader.required(table, "name").and_then(|value| reader.name(value)).unwrap_or_default();
        if names.contains(&name) {
            reader.problem(table.span(), format!("there are two cases {name}"), "each case has its own name");
        }
        names.push(name);
    }
    names
}

fn read_case(base: &str, all: &[String], layers: &Layers<'_, '_>, reader: &mut Reader<'_, '_>) -> Case {
    let plan = plan::read(layers, reader);
    let craft = craft::read(layers, plan, reader);
    let airs = air::read(layers, reader);
    let parameters = read_parameters(layers, reader);
    let real = airs.first().is_some_and(|air| air.noise == Noise::Real);
    let allowance = if real { read_allowance(layers, reader) } else { Allowance::default() };
    let mut scope = Scope {
        names: Rc::new(parameters.iter().map(|(name, _, dimension)| (name.clone(), *dimension)).collect()),
        inputs: Vec::new(),
        waypoints: craft.setup.plan.plan.waypoints.len(),
        fields: &[],
    };
    let belongs = Belongs { base, all };
    scope.inputs = input_names(layers, &belongs, reader);
    scope.waypoints = scope.waypoints.max(uploaded_waypoints(layers, &belongs, reader));
    let inputs = read_inputs(layers, &belongs, &scope, reader);
    let ends = layers.value("ends").and_then(|value| read_awaited(value, &scope, reader));
    let measures = measure::read(layers, &belongs, &mut scope, reader);
    let mut expectations = expect::read(layers, &belongs, &scope, &allowance, reader);
    expect::add_usual_result(&mut expectations, ends.is_some());
    let time_limit_s = reader.number_in(layers.value("time_limit_s"), 1.0, 1e6, "s").unwrap_or(TIME_LIMIT_S);
    let sample_hz = reader.number_in(layers.value("sample_hz"), 0.1, 1000.0, "Hz").unwrap_or(SAMPLE_HZ);
    if time_limit_s * sample_hz > MAX_SAMPLES {
        let place =
            layers.value("time_limit_s").or(layers.value("sample_hz")).map_or(0..0, toml::Spanned::span);
        let message =
            format!("{time_limit_s} s with {sample_hz} samples a second are too many samples to keep");
        reader.problem(place, message, format!("allowed: {MAX_SAMPLES}, lower one of the two"));
    }
    Case {
        name: layers.variant.name_of(base),
        base: base.to_owned(),
        variant: layers.variant.name_of(""),
        varied: layers.variant.shown().map(|(key, shown)| (key.to_owned(), shown)).collect(),
        airs,
        setup: craft.setup,
        options: craft.options,
        pilot: craft.pilot,
        time_limit_s,
        watch_s: reader.number_in(layers.value("watch_s"), 0.0, 1e6, "s").unwrap_or(WATCH_S),
        ends,
        sample_hz,
        parameters: parameters.into_iter().map(|(name, value, _)| (name, value)).collect(),
        inputs,
        measures,
        expectations,
    }
}

/// The case that is being read, to choose the tables that apply to it.
struct Belongs<'a> {
    base: &'a str,
    all: &'a [String],
}

impl Belongs<'_> {
    /// Returns `true` if a table applies to this case: without `cases` it applies to all.
    fn includes(&self, table: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) -> bool {
        // All cases have the same list of names, so only the first case checks it.
        if self.all.first().is_none_or(|first| first == self.base) {
            self.check_names(table, reader);
        }
        reader.is_for(self.base, table)
    }

    fn check_names(&self, table: &TomlTable<'_, '_>, reader: &mut Reader<'_, '_>) {
        let Some(names) = reader.texts(table, "cases") else { return };
        if names.is_empty() {
            reader.problem(table.span(), "this applies to no case", "leave cases out, or name one");
        }
        for (name, span) in &names {
            if !self.all.contains(name) {
                let guess = crate::text::did_you_mean::suffix(name, self.all.iter().map(String::as_str));
                let message = format!("there is no case {name}{guess}");
                let allowed: Vec<&str> = self.all.iter().take(SHOWN_CASES).map(String::as_str).collect();
                let more = if self.all.len() > SHOWN_CASES { " …" } else { "" };
                reader.problem(span.clone(), message, format!("allowed: {}{more}", allowed.join(", ")));
            }
        }
    }
}

fn read_parameters(
    layers: &Layers<'_, '_>,
    reader: &mut Reader<'_, '_>,
) -> Vec<(String, f64, crate::telemetry::quantity::Dimension)> {
    let mut parameters: Vec<(String, f64, crate::telemetry::quantity::Dimension)> = Vec::new();
    let mut known: BTreeMap<String, usize> = BTreeMap::new();
    for table in layers.tables("parameters", reader) {
        for (name, span, value) in table.keys() {
            let Some((number, dimension)) = reader.expression(value, read_quantity) else {
                continue;
            };
            if let Some(problem) = measure::taken(name) {
                reader.problem(span, problem, "choose another name");
                continue;
            }
            if let Some(known) = known.get(name).and_then(|&index| parameters.get_mut(index)) {
                if known.2 != dimension {
                    reader.problem(
                        span,
                        format!("{name} is {} elsewhere", known.2),
                        "all cases need the same unit",
                    );
                }
                *known = (name.to_owned(), number, dimension);
            } else {
                known.insert(name.to_owned(), parameters.len());
                parameters.push((name.to_owned(), number, dimension));
            }
        }
    }
    parameters
}

fn read_allowance(layers: &Layers<'_, '_>, reader: &mut Reader<'_, '_>) -> Allowance {
    let mut allowance = Allowance::default();
    for table in layers.tables("allow", reader) {
        reader.refuse_unknown(&table, ALLOW_KEYS);
        let mut read = |key: &str, into: &mut f64| {
            if let Some(number) = reader.number_in(table.get(key), 0.0, 1e6, "") {
                *into = number;
            }
        };
        read("horizontal_m", &mut allowance.horizontal_m);
        read("vertical_m", &mut allowance.vertical_m);
        read("speed_mps", &mut allowance.speed_mps);
        read("angle_deg", &mut allowance.angle_deg);
    }
    allowance
}

/// Returns the names of the inputs before the inputs are read, because instants may use them.
fn input_names(layers: &Layers<'_, '_>, belongs: &Belongs<'_>, reader: &mut Reader<'_, '_>) -> Vec<String> {
    let mut names = Vec::new();
    for table in layers.lists("input", reader) {
        if belongs.includes(&table, reader) {
            let usual = format!("input{}", names.len() + 1);
            let name = table.get("name").and_then(|value| reader.name(value));
            names.push(name.unwrap_or(usual));
        }
    }
    names
}

/// Returns the number of waypoints of the longest plan that an input uploads, because expressions may use them, too.
fn uploaded_waypoints(layers: &Layers<'_, '_>, belongs: &Belongs<'_>, reader: &mut Reader<'_, '_>) -> usize {
    let mut most = 0;
    for table in layers.lists("input", reader) {
        if belongs.includes(&table, reader)
            && let Some(text) = reader.string(&table, "do")
        {
            // A mistake in it is reported when the inputs are read.
            most = most.max(waypoints_after(&text, &mut |plan| reader.plan(plan)).unwrap_or(0));
        }
    }
    most
}

/// Reads an instant for which the flight waits.
fn read_awaited(value: &Value<'_>, scope: &Scope, reader: &mut Reader<'_, '_>) -> Option<Instant> {
    let instant = reader.expression(value, |cursor| scope.read_instant(cursor))?;
    if let Some(problem) = instant.unseen_in_flight() {
        reader.problem(
            value.span(),
            problem,
            "write 5 s after ARRIVED 1, second ARRIVED 1, or when north > 70 m",
        );
    }
    Some(instant)
}

fn read_inputs(
    layers: &Layers<'_, '_>,
    belongs: &Belongs<'_>,
    scope: &Scope,
    reader: &mut Reader<'_, '_>,
) -> Vec<TimedInput> {
    let mut inputs = Vec::new();
    for table in layers.lists("input", reader) {
        reader.refuse_unknown(&table, INPUT_KEYS);
        if !belongs.includes(&table, reader) {
            continue;
        }
        let name = scope.inputs.get(inputs.len()).cloned().unwrap_or_default();
        if scope.inputs[..inputs.len()].contains(&name) {
            reader.problem(
                table.span(),
                format!("there are two inputs {name}"),
                "each input has its own name",
            );
        }
        let at = reader.required(&table, "at").and_then(|value| read_awaited(value, scope, reader));
        let each = reader.boolean(&table, "each").unwrap_or(false);
        if let Some(span) = at
            .as_ref()
            .filter(|at| each && !at.recurs())
            .and_then(|_| table.get("each"))
            .map(toml::Spanned::span)
        {
            reader.problem(
                span,
                "this instant comes only once",
                "leave each out, or write at = \"COMPLETE\"",
            );
        }
        let reported = reader.required(&table, "do").and_then(|value| Some((value, reader.text(value)?)));
        let Some((value, text)) = reported else { continue };
        let action = read_action(&text, &mut |plan| reader.plan(plan));
        match (action, at) {
            (Ok(action), Some(at)) => {
                let line = reader.line(value.span());
                inputs.push(TimedInput { name, line, at, each, action, text });
            }
            (Err(error), _) => reader.syntax(value, error),
            (Ok(_), None) => {}
        }
    }
    inputs
}

fn read_compares(top: &TomlTable<'_, '_>, cases: &[Case], reader: &mut Reader<'_, '_>) -> Vec<Compare> {
    let mut names = BTreeMap::new();
    for case in cases {
        for measure in &case.measures {
            names.entry(format!("{}.{}", case.base, measure.name)).or_insert(measure.dimension);
        }
    }
    let scope = Scope { names: Rc::new(names), ..Scope::default() };
    let mut compares = Vec::new();
    for table in reader.tables(top, "compare", "compare") {
        reader.refuse_unknown(&table, COMPARE_KEYS);
        let Some(value) = reader.required(&table, "that") else { continue };
        let label = reader.string(&table, "name").or_else(|| reader.text(value)).unwrap_or_default();
        if let Some(that) = reader.expression(value, |cursor| scope.read_condition(cursor)) {
            let firmware = expect::read_firmware(&table, reader);
            compares.push(Compare { label, line: reader.line(value.span()), firmware, that });
        }
    }
    compares
}

/// The craft of a case, without the air.
struct Craft {
    setup: FlightSetup,
    options: crate::flight::FlightOptions,
    pilot: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::expression::{MAX_NAME, MAX_TERMS};

    #[test]
    fn the_reference_names_the_bounds() {
        let reference = include_str!("../../docs/scenarios.md");
        let table =
            reference.split("<!-- BOUNDS -->").nth(1).and_then(|rest| rest.split("<!-- end -->").next());
        let table = table.expect("a table of bounds").replace(' ', "");
        for bound in [MAX_TERMS, MAX_NAME, MAX_FLIGHTS] {
            assert!(table.contains(&bound.to_string()), "{bound}");
        }
        for (of, most) in BOUNDS {
            let row = table.lines().find(|row| row.starts_with(&format!("|{}", of.replace(' ', ""))));
            let row = row.unwrap_or_else(|| panic!("no row for {of}"));
            assert!(row.contains(&most.to_string()), "{row}: {most}");
        }
    }
}
