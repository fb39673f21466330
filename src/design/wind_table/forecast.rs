//! A forecast as a table: the wind at several times, with its uncertainty.

use super::cells::{Row, number};
use super::{DrawnWind, MAX_MPS, choose};
use crate::design::normal::normal_quantile;
use crate::text::did_you_mean;

/// The columns with numbers: name, least and greatest value. The first two are needed.
const COLUMNS: [(&str, f64, f64); 6] = [
    ("wind_mps", 0.0, MAX_MPS),
    ("from_deg", -360.0, 720.0),
    ("gust_mps", 0.0, MAX_MPS),
    ("wind_sd_mps", 0.0, MAX_MPS),
    ("from_sd_deg", 0.0, 360.0),
    ("weight", 0.0, 1e12),
];
/// The column that is for people.
const TIME: &str = "time";

/// A forecast. Each flight has the wind of one of its rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Forecast {
    rows: Vec<Outlook>,
    weights: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Outlook {
    wind_mps: f64,
    from_deg: f64,
    /// The speed of the air in gusts, m/s.
    gust_mps: Option<f64>,
    wind_sd_mps: f64,
    from_sd_deg: f64,
}

impl Forecast {
    pub(super) fn read(head: &Row, body: &[Row]) -> Result<Self, String> {
        let names = || COLUMNS.iter().map(|(name, ..)| *name).chain([TIME]);
        let mut places = [None; COLUMNS.len()];
        for (place, title) in head.cells.iter().enumerate().filter(|(_, title)| *title != TIME) {
            let Some(column) = COLUMNS.iter().position(|(name, ..)| name == title) else {
                let guess = did_you_mean::suffix(title, names());
                let allowed = names().collect::<Vec<_>>().join(", ");
                return Err(format!(
                    "line {}: {title:?} is not a column{guess}; allowed: {allowed}",
                    head.line
                ));
            };
            if places[column].replace(place).is_some() {
                return Err(format!("line {}: there are two columns {title}", head.line));
            }
        }
        if let Some((name, ..)) = std::iter::zip(COLUMNS, places)
            .take(2)
            .find_map(|(column, place)| place.is_none().then_some(column))
        {
            return Err(format!("line {}: the column {name} is missing", head.line));
        }
        let (mut rows, mut weights) = (Vec::new(), Vec::new());
        for row in body {
            let mut numbers = [None; COLUMNS.len()];
            for ((to, place), (_, low, high)) in numbers.iter_mut().zip(places).zip(COLUMNS) {
                let cell = place.and_then(|place| row.cells.get(place)).filter(|cell| !cell.is_empty());
                *to = cell.map(|cell| number(cell, row.line, low, high)).transpose()?;
            }
            let [Some(wind_mps), Some(from_deg), gust_mps, wind_sd, from_sd, weight] = numbers else {
                return Err(format!("line {}: the wind is missing", row.line));
            };
            let (wind_sd_mps, from_sd_deg) = (wind_sd.unwrap_or(0.0), from_sd.unwrap_or(0.0));
            rows.push(Outlook { wind_mps, from_deg, gust_mps, wind_sd_mps, from_sd_deg });
            weights.push(weight.unwrap_or(1.0));
        }
        if weights.iter().sum::<f64>() <= 0.0 {
            return Err("it has no row with a weight".to_owned());
        }
        Ok(Self { rows, weights })
    }

    pub(super) fn has_gusts(&self) -> bool {
        self.rows.iter().any(|row| row.gust_mps.is_some())
    }

    pub(super) fn draw(&self, [row, direction, speed]: [f64; 3]) -> DrawnWind {
        let (index, _) = choose(&self.weights, row);
        let Some(row) = self.rows.get(index) else {
            return DrawnWind { speed_mps: 0.0, from_deg: 0.0, gust_mps: None };
        };
        let speed_mps = (row.wind_mps + row.wind_sd_mps * normal_quantile(speed)).max(0.0);
        DrawnWind {
            speed_mps,
            from_deg: row.from_deg + row.from_sd_deg * normal_quantile(direction),
            // A forecast names the speed of the air in a gust. It is above that of the row as long as the wind is.
            gust_mps: self
                .has_gusts()
                .then(|| row.gust_mps.map_or(0.0, |gust| (gust - row.wind_mps).max(0.0))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::WindTable;

    const FORECAST: &str = "time,wind_mps,from_deg,gust_mps,wind_sd_mps,from_sd_deg
09:00,4,250,7,1,10
10:00,6,270,10.5,2,20
11:00,8,350,,0,0
";

    #[test]
    fn a_flight_has_the_wind_of_one_of_the_rows() {
        let table = WindTable::parse(FORECAST).unwrap();
        assert!(matches!(&table, WindTable::Forecast(forecast) if forecast.has_gusts()));
        let middle = table.draw([0.5, 0.5, 0.5]);
        assert!((middle.speed_mps - 6.0).abs() < 1e-9 && (middle.from_deg - 270.0).abs() < 1e-9);
        assert_eq!(middle.gust_mps, Some(4.5));
        let strong = table.draw([0.5, 0.158_655_3, 0.841_344_7]);
        assert!((strong.speed_mps - 8.0).abs() < 1e-3 && (strong.from_deg - 250.0).abs() < 1e-3);
        assert_eq!(table.draw([0.9, 0.5, 0.5]).gust_mps, Some(0.0), "a row without gusts");
    }

    #[test]
    fn the_wind_is_never_negative_and_directions_go_round() {
        let table = WindTable::parse("wind_mps,from_deg,wind_sd_mps,from_sd_deg\n1,350,5,40\n").unwrap();
        assert!(table.draw([0.5, 0.5, 0.01]).speed_mps.abs() < 1e-9);
        assert!(table.draw([0.5, 0.9, 0.5]).from_deg < 90.0);
        assert!(matches!(&table, WindTable::Forecast(forecast) if !forecast.has_gusts()));
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, problem) in [
            (
                "time,wind,from_deg\n",
                "line 1: \"wind\" is not a column; allowed: wind_mps, from_deg, gust_mps, wind_sd_mps, from_sd_deg, weight, time",
            ),
            ("time,from_deg\n1,2\n", "line 1: the column wind_mps is missing"),
            ("wind_mps,from_deg,from_deg\n", "line 1: there are two columns from_deg"),
            ("wind_mps,from_deg\n", "it has no row with a weight"),
            ("wind_mps,from_deg\n5,\n", "line 2: the wind is missing"),
            ("wind_mps,from_deg\n5,x\n", "line 2: \"x\" is not a number"),
            ("wind_mps,from_deg\n99,0\n", "line 2: 99 is out of range; allowed: 0 to 60"),
        ] {
            assert_eq!(WindTable::parse(text).unwrap_err(), problem);
        }
    }
}
