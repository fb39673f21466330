//! The cells of a table with commas between them.

use super::{MAX_COLUMNS, MAX_ROWS};

/// A row of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Row {
    /// The line in the file, from 1.
    pub(super) line: usize,
    pub(super) cells: Vec<String>,
}

/// Reads the rows. Lines without text and lines that begin with `#` are left out.
pub(super) fn read(text: &str) -> Result<Vec<Row>, String> {
    let mut rows = Vec::new();
    for (line, text) in text.trim_start_matches('\u{feff}').lines().enumerate() {
        if text.trim().is_empty() || text.trim_start().starts_with('#') {
            continue;
        }
        let line = line + 1;
        if rows.len() > MAX_ROWS {
            return Err(format!("line {line}: it has more than {MAX_ROWS} rows"));
        }
        let cells: Vec<String> = text
            .split(',')
            .take(MAX_COLUMNS + 1)
            .map(|cell| cell.trim().trim_matches('"').trim().to_owned())
            .collect();
        if cells.len() > MAX_COLUMNS {
            return Err(format!("line {line}: it has more than {MAX_COLUMNS} columns"));
        }
        if let Some(Row { cells: head, .. }) = rows.first()
            && head.len() != cells.len()
        {
            return Err(format!("line {line} has {} cells and the first row {}", cells.len(), head.len()));
        }
        rows.push(Row { line, cells });
    }
    Ok(rows)
}

/// Returns the number in a cell.
pub(super) fn number(text: &str, line: usize, low: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if (low..=high).contains(&number) => Ok(number),
        Ok(_) => Err(format!("line {line}: {text} is out of range; allowed: {low} to {high}")),
        Err(_) => Err(format!("line {line}: {text:?} is not a number")),
    }
}
