//! The flights of a campaign as a table with commas.

use crate::campaign::{Record, Side};

/// The columns of every campaign.
const FIRST: [&str; 7] = ["flight", "side", "seed", "outcome", "result", "margin", "hash"];

/// The columns of a campaign's table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CsvTable {
    inputs: Vec<String>,
    metrics: Vec<String>,
}

impl CsvTable {
    /// Returns a table with these inputs and metrics.
    pub fn new(inputs: Vec<String>, metrics: Vec<String>) -> Self {
        Self { inputs, metrics }
    }

    /// Returns the header row, with the line ending.
    pub fn head(&self) -> Vec<u8> {
        row(FIRST.iter().copied().chain(self.inputs.iter().chain(&self.metrics).map(String::as_str)))
    }

    /// Returns the row of a flight, with the line ending. A missing value gives an empty cell.
    pub fn line(&self, record: &Record) -> Vec<u8> {
        let side = if record.side == Side::B { "b" } else { "a" };
        let mut cells = vec![
            record.number.to_string(),
            side.to_owned(),
            record.seed.to_string(),
            record.standing.to_string(),
            record.result.clone(),
            record.margin.map_or_else(String::new, |margin| margin.to_string()),
            format!("{:016x}", record.hash),
        ];
        let input = |name: &String| record.inputs.iter().find(|(known, _)| known == name);
        cells.extend(
            self.inputs
                .iter()
                .map(|name| input(name).map_or_else(String::new, |(_, value)| value.to_string())),
        );
        cells.extend(
            self.metrics
                .iter()
                .map(|name| record.metric(name).map_or_else(String::new, |value| value.to_string())),
        );
        row(cells.iter().map(String::as_str))
    }
}

fn row<'a>(cells: impl Iterator<Item = &'a str>) -> Vec<u8> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    // A vector takes everything.
    let _written = writer.write_record(cells);
    writer.into_inner().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::{InputValue, Standing};

    #[test]
    fn a_flight_is_a_row_with_gaps_for_what_it_has_not() {
        let table = CsvTable::new(
            vec!["airframe".to_owned(), "wind_mps".to_owned()],
            vec!["touchdown".to_owned(), "time".to_owned()],
        );
        let record = Record {
            number: 3,
            side: Side::A,
            seed: 9,
            inputs: vec![("airframe".to_owned(), InputValue::Word("my, own".to_owned()))],
            standing: Standing::Passed,
            problem: None,
            result: "complete".to_owned(),
            reason: String::new(),
            failures: Vec::new(),
            margin: Some(0.5),
            worst_at: None,
            metrics: vec![("time".to_owned(), 12.5)],
            flown_s: 20.0,
            hash: 255,
        };
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        assert_eq!(
            text(table.head()),
            "flight,side,seed,outcome,result,margin,hash,airframe,wind_mps,touchdown,time\n"
        );
        assert_eq!(
            text(table.line(&record)),
            "3,a,9,passed,complete,0.5,00000000000000ff,\"my, own\",,,12.5\n"
        );
    }
}
