//! The first line of a run's file: the campaign, with everything that its flights need.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::campaign::Shard;
use crate::design::fingerprint;
use crate::scenario::{MAX_CAMPAIGN, MAX_SEEDS};

/// The version of the file format.
const FORMAT: u32 = 1;
/// The name of the line.
const EVENT: &str = "campaign";

/// The first line of a run's file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunHeader {
    event: String,
    format: u32,
    /// The version of the program that flies.
    pub version: String,
    /// Tells campaigns apart: equal only if all flights are.
    pub id: String,
    /// The name of the scenario or plan.
    pub name: String,
    /// The number of flights of the whole campaign.
    pub flights: u64,
    /// The shard, as `K/N`; `None` = the whole campaign.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shard: Option<String>,
    pub definition: Definition,
}

/// Everything from which the flights of a campaign follow.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Definition {
    /// The name of the scenario's file, or of the plan.
    pub file: String,
    /// The text of the scenario.
    pub text: String,
    /// The files that the scenario names.
    #[serde(default)]
    pub files: BTreeMap<String, Contents>,
    /// The number of flights that takes the place of the one in the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flights: Option<u64>,
    /// The design that takes the place of the one in the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<String>,
    /// The first and the last seed, which take the place of those in the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seeds: Option<(u64, u64)>,
    /// The directory of elevation tiles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub terrain: Option<String>,
    /// The options of a remote firmware; none for the embedded one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub firmware: Vec<String>,
    /// The fingerprint of its executable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub firmware_print: Option<String>,
    /// The other side of a comparison.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub versus: Option<OtherSide>,
}

/// The differences of the other side of a comparison.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct OtherSide {
    /// Settings, `name = value`, after all others.
    pub settings: Vec<String>,
    /// `true` if it is flown by another firmware, whose options are `firmware`.
    #[serde(default)]
    pub has_firmware: bool,
    #[serde(default)]
    pub firmware: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub firmware_print: Option<String>,
}

/// The contents of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Contents {
    Text(String),
    /// Bytes that are no text.
    Bytes {
        hex: String,
    },
}

impl Contents {
    pub fn new(bytes: &[u8]) -> Self {
        match std::str::from_utf8(bytes) {
            Ok(text) => Self::Text(text.to_owned()),
            Err(_) => Self::Bytes { hex: data_encoding::HEXLOWER.encode(bytes) },
        }
    }

    /// Returns the bytes.
    ///
    /// # Errors
    /// Fails if they are damaged.
    pub fn bytes(&self) -> Result<Vec<u8>, String> {
        match self {
            Self::Text(text) => Ok(text.clone().into_bytes()),
            Self::Bytes { hex } => data_encoding::HEXLOWER
                .decode(hex.as_bytes())
                .map_err(|error| format!("it is damaged: {error}")),
        }
    }
}

impl RunHeader {
    /// Returns the header of a campaign.
    pub fn new(definition: Definition, version: &str, name: &str, flights: u64) -> Self {
        let definition_json = serde_json::to_string(&definition).unwrap_or_default();
        let id = fingerprint(format!("{version}\n{flights}\n{definition_json}").as_bytes());
        Self {
            event: EVENT.to_owned(),
            format: FORMAT,
            version: version.to_owned(),
            id: format!("{id:016x}"),
            name: name.to_owned(),
            flights,
            shard: None,
            definition,
        }
    }

    /// Returns the header of a part of the campaign.
    pub fn of_shard(&self, shard: Shard) -> Self {
        let shard = (shard != Shard::WHOLE).then(|| shard.to_string());
        Self { shard, ..self.clone() }
    }

    /// Returns the shard.
    ///
    /// # Errors
    /// Fails if it is damaged.
    pub fn part(&self) -> Result<Shard, String> {
        self.shard.as_deref().map_or(Ok(Shard::WHOLE), |shard| {
            shard.parse().map_err(|error: crate::campaign::ShardError| error.to_string())
        })
    }

    /// Returns the number of lines of a flight.
    pub fn sides(&self) -> u64 {
        if self.definition.versus.is_some() { 2 } else { 1 }
    }

    /// Returns the line.
    pub fn line(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }

    /// Returns `true` if a line begins as that of a campaign.
    pub fn begins(line: &str) -> bool {
        line.starts_with(&format!("{{\"event\":\"{EVENT}\""))
    }

    /// Reads the first line of a file.
    ///
    /// # Errors
    /// Returns half a sentence if the file is not that of a campaign.
    pub fn read(line: &str) -> Result<Self, String> {
        let header: Self =
            serde_json::from_str(line).map_err(|_| "is not the file of a campaign".to_owned())?;
        if header.event != EVENT {
            return Err("is not the file of a campaign".to_owned());
        }
        if header.format != FORMAT {
            return Err(format!(
                "has the format {} of a later betadeck ({}); this one reads format {FORMAT}",
                header.format, header.version
            ));
        }
        header.part()?;
        let flights = [Some(header.flights), header.definition.flights];
        if let Some(flights) =
            flights.into_iter().flatten().find(|flights| !(1..=MAX_CAMPAIGN).contains(flights))
        {
            return Err(format!("has {flights} flights (allowed: 1 to {MAX_CAMPAIGN})"));
        }
        if let Some((first, last)) = header.definition.seeds
            && !(first..first.saturating_add(MAX_SEEDS)).contains(&last)
        {
            return Err(format!("has the seeds {first}..{last} (allowed: 1 to {MAX_SEEDS} seeds)"));
        }
        Ok(header)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_header_reads_back_and_tells_campaigns_apart() {
        let files = BTreeMap::from([
            ("plan.toml".to_owned(), Contents::new(b"name = 'x'")),
            ("plan.kmz".to_owned(), Contents::new(&[0x50, 0xff, 0])),
        ]);
        let definition = Definition { file: "a.toml".to_owned(), files, ..Definition::default() };
        let header = RunHeader::new(definition.clone(), "0.1.0 abc", "a", 1000);
        assert_eq!(RunHeader::read(&header.line()), Ok(header.clone()));
        assert_eq!(header.definition.files["plan.kmz"].bytes(), Ok(vec![0x50, 0xff, 0]));
        let other = RunHeader::new(definition.clone(), "0.1.1 abc", "a", 1000);
        assert_ne!(header.id, other.id, "another version flies otherwise");
        let more = RunHeader::new(Definition { flights: Some(5), ..definition }, "0.1.0 abc", "a", 1000);
        assert_ne!(header.id, more.id);
        let part = header.of_shard(Shard::new(3, 7).unwrap());
        assert_eq!((part.id.as_str(), part.part()), (header.id.as_str(), Ok(Shard::new(3, 7).unwrap())));
        assert_eq!(part.of_shard(Shard::WHOLE), header);
    }

    #[test]
    fn numbers_of_flights_and_seeds_beyond_those_of_the_options_are_refused() {
        let read = |flights, of_option, seeds| {
            let definition = Definition { flights: of_option, seeds, ..Definition::default() };
            RunHeader::read(&RunHeader::new(definition, "0.1.0", "a", flights).line()).err()
        };
        assert_eq!(read(10_000_000, None, Some((5, 1_000_004))), None);
        assert_eq!(
            read(10, None, Some((u64::MAX, u64::MAX))),
            Some(format!("has the seeds {0}..{0} (allowed: 1 to 1000000 seeds)", u64::MAX))
        );
        for (flights, of_option) in [(0, None), (10_000_001, None), (5, Some(u64::MAX))] {
            let problem = read(flights, of_option, None).expect("refused");
            assert!(problem.ends_with("flights (allowed: 1 to 10000000)"), "{problem}");
        }
        assert!(read(5, None, Some((1, 1_000_001))).is_some() && read(5, None, Some((2, 1))).is_some());
    }

    #[test]
    fn other_files_are_refused() {
        for line in ["", "{}", "{\"event\":\"flight\"}", "[1]", "format = 1"] {
            assert_eq!(RunHeader::read(line), Err("is not the file of a campaign".to_owned()), "{line}");
        }
    }
}
