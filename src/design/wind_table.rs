//! Winds from a table: a wind rose, or a forecast.

mod cells;
mod forecast;
mod rose;

pub use forecast::Forecast;
pub use rose::Rose;

/// The most rows of a table.
const MAX_ROWS: usize = 1000;
/// The most columns of a table.
const MAX_COLUMNS: usize = 100;
/// The greatest wind, m/s.
const MAX_MPS: f64 = 60.0;

/// A wind that was drawn from a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrawnWind {
    /// m/s.
    pub speed_mps: f64,
    /// The direction that it blows from, degrees clockwise from north, at least 0 and less than 360.
    pub from_deg: f64,
    /// The speed of gusts above the mean wind, m/s, if the table has gusts.
    pub gust_mps: Option<f64>,
}

/// A table of winds.
#[derive(Debug, Clone, PartialEq)]
pub enum WindTable {
    /// How often each wind blows, by its direction and its speed.
    Rose(Rose),
    /// The winds of a forecast, one row for each time.
    Forecast(Forecast),
}

impl WindTable {
    /// Reads a table: its first column is `from_deg` in a rose, anything else in a forecast.
    ///
    /// # Errors
    /// Returns a sentence with the line and the way out.
    pub fn parse(text: &str) -> Result<Self, String> {
        let rows = cells::read(text)?;
        let [head, body @ ..] = rows.as_slice() else { return Err("it is empty".to_owned()) };
        let is_rose = head.cells.iter().skip(1).all(|cell| cell.contains(".."));
        if is_rose {
            Rose::read(head, body).map(Self::Rose)
        } else {
            Forecast::read(head, body).map(Self::Forecast)
        }
    }

    /// Returns the wind for three independent numbers between 0 and 1: of the row or cell, of the direction, of the speed.
    pub fn draw(&self, units: [f64; 3]) -> DrawnWind {
        let drawn = match self {
            Self::Rose(rose) => rose.draw(units),
            Self::Forecast(forecast) => forecast.draw(units),
        };
        DrawnWind {
            speed_mps: rounded(drawn.speed_mps.clamp(0.0, MAX_MPS)),
            from_deg: rounded(drawn.from_deg).rem_euclid(360.0),
            gust_mps: drawn.gust_mps.map(rounded),
        }
    }
}

/// Returns a value with four decimals, as distributions give it.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// Returns the index of the part that contains `unit`, and the share of this part below it. The weights are not all 0.
fn choose(weights: &[f64], unit: f64) -> (usize, f64) {
    let all: f64 = weights.iter().sum();
    let mut rest = unit * all;
    let mut last = (0, 0.5);
    for (index, &weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
        if rest < weight {
            return (index, rest / weight);
        }
        rest -= weight;
        last = (index, 0.999_999);
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_chosen_by_their_weight() {
        let weights = [1.0, 0.0, 3.0];
        assert_eq!(choose(&weights, 0.125), (0, 0.5));
        assert_eq!(choose(&weights, 0.625), (2, 0.5));
        assert_eq!(choose(&weights, 1.0 - 1e-17).0, 2);
    }
}
