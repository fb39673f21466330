//! The table of QGroundControl's export, `Index,Name,Latitude,…`. It is only read: QGroundControl does not read it.

use super::bounds::MAX_ITEMS;
use super::loss::{Finding, LossReport, Place, Severity};
use super::mission_item::{self, ABOVE_SEA, Mission, MissionItem, NO_PLACE};
use super::{HomePosition, PlanFile, Problems, ReadOptions, home};
use crate::plan::estimate::Assumptions;

/// The columns.
const COLUMNS: [&str; 12] = [
    "Index",
    "Name",
    "Latitude",
    "Longitude",
    "Altitude",
    "Type",
    "Command",
    "Frame",
    "Param1",
    "Param2",
    "Param3",
    "Param4",
];

/// Returns `true` for the first line of such a table.
pub(super) fn is_header(line: &str) -> bool {
    let separator = if line.contains(';') { ';' } else { ',' };
    let mut fields = line.split(separator).map(|field| field.trim().trim_matches('"'));
    COLUMNS[..5].iter().all(|column| fields.next().is_some_and(|field| field.eq_ignore_ascii_case(column)))
}

/// Reads the text and adds problems to `problems`.
pub(super) fn read(text: &str, options: &ReadOptions, problems: &mut Problems<'_>) -> PlanFile {
    let header = text.lines().next().unwrap_or_default();
    let delimiter = if header.contains(';') { b';' } else { b',' };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    let mut table = Table {
        delimiter,
        columns: [None; COLUMNS.len()],
        home: None,
        items: Vec::new(),
        places: Vec::new(),
    };
    let mut losses = LossReport::default();
    let mut record = csv::StringRecord::new();
    let mut is_first = true;
    while reader.read_record(&mut record).unwrap_or(false) {
        // The position may be that of the line end before.
        let at = record.position().map_or(0, |position| position.byte() as usize);
        let rest = text.get(at..).unwrap_or_default();
        let at = at + (rest.len() - rest.trim_start().len());
        if std::mem::take(&mut is_first) {
            table.header(&record, at, problems);
            continue;
        }
        if table.items.len() > MAX_ITEMS {
            problems.add(at..at + 1, format!("the file has more than {MAX_ITEMS} items"), "");
        }
        if !problems.is_empty() && (problems.is_full() || table.items.len() > MAX_ITEMS) {
            break;
        }
        table.row(&record, at, &mut losses, problems);
    }
    if !problems.is_empty() {
        return PlanFile::default();
    }
    let home = mission_item::home(table.home, options);
    if table.home.is_none() {
        let why = "the table has no row 0 with the home";
        losses.add(Finding::new(Severity::Assumed, "home", why));
    }
    let assumptions = Assumptions::default();
    let mission = Mission {
        items: &table.items,
        home,
        assumptions: &assumptions,
        waypoint_as: options.waypoint_as,
        flat: options.flat,
    };
    let mapping = mission.map();
    for fault in mapping.faults.iter().chain(&mapping.too_many().filter(|_| !options.long)) {
        let at = table.places[fault.item];
        problems.add(at..line_end(text, at), fault.message.clone(), fault.hint.clone());
    }
    losses.items = table.items.len();
    losses.findings.extend(mapping.findings);
    let mut file = PlanFile { home, losses, ..PlanFile::default() };
    file.take(mapping.waypoints.into_iter().map(|(waypoint, _)| waypoint));
    file
}

fn line_end(text: &str, at: usize) -> usize {
    text.get(at..).and_then(|rest| rest.find('\n')).map_or(text.len(), |length| at + length)
}

/// The rows so far.
struct Table {
    delimiter: u8,
    /// The index of each column in the file.
    columns: [Option<usize>; COLUMNS.len()],
    home: Option<HomePosition>,
    items: Vec<MissionItem>,
    /// The first byte of each item.
    places: Vec<usize>,
}

impl Table {
    fn header(&mut self, record: &csv::StringRecord, at: usize, problems: &mut Problems<'_>) {
        for (column, name) in self.columns.iter_mut().zip(COLUMNS) {
            *column = record.iter().position(|field| field.eq_ignore_ascii_case(name));
        }
        for (name, column) in COLUMNS.iter().zip(self.columns) {
            if column.is_none() && !matches!(*name, "Name" | "Type") {
                let hint = COLUMNS.join(",");
                problems.add(
                    at..at + 1,
                    format!("the table has no column {name}"),
                    format!("columns: {hint}"),
                );
            }
        }
    }

    fn row(
        &mut self,
        record: &csv::StringRecord,
        at: usize,
        losses: &mut LossReport,
        problems: &mut Problems<'_>,
    ) {
        let length = record.as_slice().len() + record.len();
        let mut is_right = true;
        if self.delimiter == b',' && record.len() > COLUMNS.len() {
            let message = format!("the row has {} fields", record.len());
            problems.add(at..at + length, message, "write numbers with a decimal point, not a decimal comma");
            return;
        }
        let mut number = |column: usize| -> Option<f64> {
            let field = self.columns[column].and_then(|column| record.get(column)).unwrap_or_default();
            // An empty field and `nan` stand for a value that is not given.
            if field.is_empty() || field.eq_ignore_ascii_case("nan") {
                return None;
            }
            let value = field.parse::<f64>().ok().filter(|value| value.is_finite());
            if value.is_none() {
                let (message, hint) = match field.contains(',') {
                    true => ("has a decimal comma", "write numbers with a decimal point"),
                    false => ("is not a number", ""),
                };
                problems.add(at..at + length, format!("{} {field} {message}", COLUMNS[column]), hint);
                is_right = false;
            }
            value
        };
        let [index, lat_deg, lon_deg, altitude_m, command, frame] = [0, 2, 3, 4, 6, 7].map(&mut number);
        let params = [8, 9, 10, 11].map(&mut number);
        if !is_right {
            return;
        }
        let whole = |value: Option<f64>| {
            value
                .filter(|value| value.fract() == 0.0 && (0.0..=65535.0).contains(value))
                .map(|value| value as u16)
        };
        let Some(index) = whole(index) else {
            problems.add(at..at + length, "the row has no index", "the index is a number from 0");
            return;
        };
        if index == 0 {
            if let (Some(lat_deg), Some(lon_deg)) = (lat_deg, lon_deg) {
                let place = Place::Line { line: problems.line_at(at) };
                self.home = home::of_file(lat_deg, lon_deg, altitude_m, Some(&place), losses);
            }
            return;
        }
        let Some(command) = whole(command) else {
            problems.add(
                at..at + length,
                "the row has no command number",
                "the command is a number of MAVLink",
            );
            return;
        };
        // The altitude is above sea level in any frame.
        let has_place = frame != Some(f64::from(NO_PLACE));
        self.places.push(at);
        self.items.push(MissionItem {
            number: usize::from(index),
            command,
            frame: if has_place { ABOVE_SEA } else { NO_PLACE },
            params,
            lat_deg,
            lon_deg,
            altitude_m,
            autocontinue: true,
            place: Some(Place::Line { line: problems.line_at(at) }),
        });
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Format, PlanFile, parse, report};
    use crate::plan::WaypointType;

    const TABLE: &str = "Index,Name,Latitude,Longitude,Altitude,Type,Command,Frame,Param1,Param2,Param3,Param4\r\n\
        0,Home,40.4635000,-79.5182000,300,Home,16,0,0,0,0,0\r\n\
        1,\"Takeoff, \"\"high\"\"\",40.4635000,-79.5182000,310,Takeoff,22,3,0,0,0,\r\n\
        2,,,,,Speed,178,2,1,4,-1,0\r\n\
        3,Waypoint,40.4640000,-79.5175000,350,Waypoint,16,3,0,5,0,nan\r\n\
        4,Land,40.4640000,-79.5190000,300,Land,21,3,0,0,0,\r\n";

    fn read(text: &str) -> PlanFile {
        assert_eq!(Format::from_contents(text.as_bytes()), Format::QgcCsv);
        parse("x.csv", text, Format::QgcCsv).unwrap_or_else(|errors| panic!("{}", report(&errors)))
    }

    fn fault(text: &str) -> String {
        parse("x.csv", text, Format::QgcCsv).unwrap_err()[0].headline()
    }

    #[test]
    fn a_table_is_read() {
        for text in [TABLE.to_owned(), TABLE.replace("Takeoff, ", "Takeoff").replace(',', ";")] {
            let file = read(&text);
            assert_eq!(file.home.unwrap().to_string(), "40.4635000,-79.5182000,300");
            let found: Vec<_> = file
                .plan
                .waypoints
                .iter()
                .map(|waypoint| (waypoint.kind, waypoint.altitude.above_home_m(), waypoint.speed.mps()))
                .collect();
            let (takeoff, flyover, land) = (WaypointType::Takeoff, WaypointType::Flyover, WaypointType::Land);
            assert_eq!(found, [(takeoff, 10.0, 0.0), (flyover, 50.0, 4.0), (land, 50.0, 4.0)]);
            assert_eq!(file.losses.items, 4);
        }
    }

    #[test]
    fn wrong_tables_give_sentences() {
        assert!(fault(&TABLE.replace("Param4", "P4")).contains("no column Param4"));
        assert_eq!(fault(&TABLE.replace(",178,", ",176,")), "x.csv:4:1: item 2: command 176 is unknown");
        assert!(
            fault(&TABLE.replace("40.4640000", "94.4640000")).contains("latitude 94.464 is out of range")
        );
        assert!(fault(&TABLE.replace("40.4640000", "40,4640000")).contains("has 13 fields"));
        assert!(fault(&TABLE.replace(',', ";").replace("40.4640000", "\"40,46\"")).contains("decimal comma"));
        assert!(fault(&TABLE.replace("310", "inf")).contains("Altitude inf is not a number"));
        let no_home = TABLE.replace("0,Home,40.4635000,-79.5182000,300", "0,Home,,,");
        assert!(fault(&no_home).contains("add --home"));
    }
}
