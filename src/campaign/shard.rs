//! Shards: the parts of a campaign that several machines fly.

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// The most shards of a campaign.
const MAX_SHARDS: u64 = 1_000_000;

/// One of several parts of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Shard {
    /// The number, from 1.
    pub number: u64,
    /// The number of shards.
    pub of: u64,
}

/// Text that is not a valid shard.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}; write K/N, such as 3/7 for the third of seven")]
pub struct ShardError(String);

impl Shard {
    /// The whole campaign.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Returns a shard.
    ///
    /// # Errors
    /// Fails unless `number` lies between 1 and `of`.
    pub fn new(number: u64, of: u64) -> Result<Self, ShardError> {
        if of == 0 || of > MAX_SHARDS {
            return Err(ShardError(format!("{of} shards are not possible (1 to {MAX_SHARDS})")));
        }
        if !(1..=of).contains(&number) {
            return Err(ShardError(format!("there is no shard {number} of {of}: they count from 1 to {of}")));
        }
        Ok(Self { number, of })
    }

    /// Returns the numbers of its flights, of so many in all. It is empty if there are more shards than flights.
    pub fn flights(self, count: u64) -> RangeInclusive<u64> {
        let end = |shards: u64| (u128::from(shards) * u128::from(count) / u128::from(self.of)) as u64;
        end(self.number - 1) + 1..=end(self.number)
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let numbers = text
            .split_once('/')
            .and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
        match numbers {
            Some((number, of)) => Self::new(number, of),
            None => Err(ShardError(format!("{text:?} is not a shard"))),
        }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_cover_every_flight_once() {
        for (count, of) in [(0, 3), (1, 7), (7, 7), (1000, 7), (10_000_000, 999_983), (5, 1)] {
            let mut next = 1;
            for number in 1..=of {
                let flights = Shard::new(number, of).unwrap().flights(count);
                assert_eq!(*flights.start(), next, "{number}/{of} of {count}");
                next = flights.end() + 1;
            }
            assert_eq!(next, count + 1, "{of} of {count}");
        }
    }

    #[test]
    fn shards_are_read_from_their_text() {
        assert_eq!("3/7".parse(), Ok(Shard { number: 3, of: 7 }));
        for (text, problem) in [
            (
                "0/7",
                "there is no shard 0 of 7: they count from 1 to 7; write K/N, such as 3/7 for the third of seven",
            ),
            (
                "8/7",
                "there is no shard 8 of 7: they count from 1 to 7; write K/N, such as 3/7 for the third of seven",
            ),
            (
                "1/0",
                "0 shards are not possible (1 to 1000000); write K/N, such as 3/7 for the third of seven",
            ),
            ("7", "\"7\" is not a shard; write K/N, such as 3/7 for the third of seven"),
        ] {
            assert_eq!(text.parse::<Shard>().unwrap_err().to_string(), problem);
        }
    }
}
