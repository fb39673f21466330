//! A wind rose: how often the wind blows from each direction with each speed.

use super::cells::{Row, number};
use super::{DrawnWind, MAX_MPS, choose};

/// A wind rose. The directions are in the middle of their sectors.
#[derive(Debug, Clone, PartialEq)]
pub struct Rose {
    /// The bounds of each class of speed, m/s.
    classes: Vec<(f64, f64)>,
    /// The middle and the width of each sector, degrees.
    sectors: Vec<(f64, f64)>,
    /// How often each class blows from each sector: the classes of the first sector, then those of the next.
    weights: Vec<f64>,
}

impl Rose {
    pub(super) fn read(head: &Row, body: &[Row]) -> Result<Self, String> {
        let classes =
            head.cells.iter().skip(1).map(|cell| class(cell, head.line)).collect::<Result<Vec<_>, _>>()?;
        if classes.is_empty() {
            return Err(format!(
                "line {}: write from_deg, 0..2, 2..4 and so on, the classes of speed",
                head.line
            ));
        }
        let (mut directions, mut weights) = (Vec::new(), Vec::new());
        for row in body {
            let [direction, cells @ ..] = row.cells.as_slice() else { continue };
            let direction = number(direction, row.line, -360.0, 720.0)?.rem_euclid(360.0);
            if directions.last().is_some_and(|&before| direction <= before) {
                return Err(format!("line {}: the directions do not grow from row to row", row.line));
            }
            directions.push(direction);
            for cell in cells {
                weights.push(number(cell, row.line, 0.0, 1e12)?);
            }
        }
        if weights.iter().sum::<f64>() <= 0.0 {
            return Err("no wind blows in it: every cell is 0".to_owned());
        }
        let count = directions.len();
        let sectors = (0..count).map(|index| sector(&directions, index)).collect();
        Ok(Self { classes, sectors, weights })
    }

    pub(super) fn draw(&self, [cell, across, _]: [f64; 3]) -> DrawnWind {
        let (index, along) = choose(&self.weights, cell);
        let classes = self.classes.len().max(1);
        let (low, high) = self.classes.get(index % classes).copied().unwrap_or_default();
        let (middle, width) = self.sectors.get(index / classes).copied().unwrap_or_default();
        DrawnWind {
            speed_mps: low + along * (high - low),
            from_deg: middle + width * (across - 0.5),
            gust_mps: None,
        }
    }
}

/// Returns the middle and the width of a sector, which ends halfway to its neighbours.
fn sector(directions: &[f64], index: usize) -> (f64, f64) {
    let count = directions.len();
    if count == 1 {
        return (directions[0], 360.0);
    }
    let here = directions[index];
    let before = (here - directions[(index + count - 1) % count]).rem_euclid(360.0);
    let behind = (directions[(index + 1) % count] - here).rem_euclid(360.0);
    (here + (behind - before) / 4.0, (before + behind) / 2.0)
}

fn class(text: &str, line: usize) -> Result<(f64, f64), String> {
    let (low, high) =
        text.split_once("..").ok_or_else(|| format!("line {line}: {text} is not a range of speeds"))?;
    let number = |text: &str| number(text.trim(), line, 0.0, MAX_MPS);
    match (number(low)?, number(high)?) {
        (low, high) if low < high => Ok((low, high)),
        _ => Err(format!("line {line}: {text} has no speed in it; write the smaller one first")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::WindTable;

    const ROSE: &str = "# station 42, 2015 to 2024
from_deg, 0..2, 2..6
0, 1, 0
90, 0, 2
180, 0, 0
270, 1, 4
";

    #[test]
    fn winds_blow_as_often_as_the_rose_says() {
        let rose = WindTable::parse(ROSE).unwrap();
        let count = 8000;
        let winds: Vec<_> = (0..count)
            .map(|index| {
                let (a, b) = (index % 100, index / 100);
                rose.draw([(f64::from(a) + 0.5) / 100.0, (f64::from(b) + 0.5) / 80.0, 0.5])
            })
            .collect();
        let share = |wanted: &dyn Fn(f64, f64) -> bool| {
            winds.iter().filter(|wind| wanted(wind.from_deg, wind.speed_mps)).count() as f64
                / f64::from(count)
        };
        let from_west = share(&|from, _| (225.0..315.0).contains(&from));
        assert!((from_west - 5.0 / 8.0).abs() < 0.02, "{from_west}");
        let from_south = share(&|from, _| (135.0..225.0).contains(&from));
        assert!(from_south < 1e-9, "{from_south}");
        let slow_from_north = share(&|from, speed| !(45.0..315.0).contains(&from) && speed <= 2.0);
        assert!((slow_from_north - 1.0 / 8.0).abs() < 0.02, "{slow_from_north}");
        assert!(winds.iter().all(|wind| (0.0..=6.0).contains(&wind.speed_mps)));
    }

    #[test]
    fn sectors_of_different_width_meet() {
        let rose = WindTable::parse("from_deg,4..6\n0,1\n30,1\n180,1\n").unwrap();
        let from = |cell, across| rose.draw([cell, across, 0.5]).from_deg;
        assert!((from(0.1, 0.999_99) - 15.0).abs() < 0.01, "the first ends where the second begins");
        assert!((from(0.5, 0.0) - 15.0).abs() < 0.01);
        assert!((from(0.5, 0.999_99) - 105.0).abs() < 0.01);
        assert!((from(0.1, 0.0) - 270.0).abs() < 0.01, "the first begins halfway back to the last");
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, problem) in [
            ("", "it is empty"),
            ("from_deg,0..2\n0,0\n", "no wind blows in it: every cell is 0"),
            ("from_deg,0..2\n0,1,2\n", "line 2 has 3 cells and the first row 2"),
            ("from_deg,0..2\n90,1\n0,1\n", "line 3: the directions do not grow from row to row"),
            ("from_deg,0..2\nN,1\n", "line 2: \"N\" is not a number"),
            ("from_deg,2..2\n0,1\n", "line 1: 2..2 has no speed in it; write the smaller one first"),
            ("from_deg,0..90\n0,1\n", "line 1: 90 is out of range; allowed: 0 to 60"),
            ("from_deg,0..2\n0,-1\n", "line 2: -1 is out of range; allowed: 0 to 1000000000000"),
        ] {
            assert_eq!(WindTable::parse(text).unwrap_err(), problem);
        }
    }
}
