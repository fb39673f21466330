//! Tables of comma or semicolon separated values with a header line.

use std::ops::Range;

use csv::{Reader, ReaderBuilder, StringRecord};

use super::Problems;
use super::bounds::MAX_ITEMS;

/// The most values in a line.
const MAX_VALUES: usize = 256;

/// Returns the names of the columns of a text, in lower case, and the separator.
pub(super) fn header(text: &str) -> (Vec<String>, u8) {
    let line = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    let count = |separator: char| line.matches(separator).count();
    let separator = if count(';') > count(',') { b';' } else { b',' };
    let names = line.split(char::from(separator)).take(MAX_VALUES);
    let clean = |name: &str| name.trim().trim_matches('"').trim().to_ascii_lowercase();
    (names.map(clean).collect(), separator)
}

/// The reader of a table.
pub(super) struct Table<'t> {
    text: &'t str,
    reader: Reader<&'t [u8]>,
    columns: Vec<String>,
    /// The number of rows so far.
    rows: usize,
}

/// A row of a table.
pub(super) struct Row<'t> {
    text: &'t str,
    record: StringRecord,
    /// The place of the row in the text.
    pub(super) span: Range<usize>,
    /// The number of the row, from 1 after the header.
    pub(super) number: usize,
}

impl<'t> Table<'t> {
    /// Begins to read a table. Its columns come in any order. Returns `None` if one of `needed` is missing, or if a
    /// line has too many values.
    pub(super) fn new(text: &'t str, needed: &[&str], problems: &mut Problems<'_>) -> Option<Self> {
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            let separators = line.bytes().filter(|byte| b",;".contains(byte)).count();
            if separators >= MAX_VALUES && !line.contains('"') || separators > 100 * MAX_VALUES {
                let message = format!("a line has {} values, at most {MAX_VALUES} are read", separators + 1);
                problems.add(start..start + line.len(), message, "is this the right file?");
                return None;
            }
            start += line.len();
        }
        let (columns, separator) = header(text);
        let missing: Vec<&str> =
            needed.iter().copied().filter(|&name| columns.iter().all(|column| column != name)).collect();
        if !missing.is_empty() {
            let span = text.len() - text.trim_start().len()..text.len();
            let message = format!("the first line has no column {}", missing.join(", "));
            problems.add(span, message, format!("needed: {}", needed.join(", ")));
            return None;
        }
        let reader = ReaderBuilder::new()
            .delimiter(separator)
            .has_headers(true)
            .flexible(true)
            .from_reader(text.as_bytes());
        Some(Self { text, reader, columns, rows: 0 })
    }

    /// Returns the index of a column.
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column == name)
    }

    pub(super) fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Returns `true` if the table had more rows than are read.
    pub(super) fn is_too_long(&self) -> bool {
        self.rows > MAX_ITEMS
    }

    /// Returns the next row that is not blank. Returns `None` at the end, and after too many rows, which it adds to
    /// `problems`.
    pub(super) fn next_row(&mut self, problems: &mut Problems<'_>) -> Option<Row<'t>> {
        loop {
            let mut record = StringRecord::new();
            if !self.reader.read_record(&mut record).ok()? {
                return None;
            }
            let begin = record.position().map_or(0, |position| position.byte() as usize).min(self.text.len());
            let end = (self.reader.position().byte() as usize).min(self.text.len());
            let row = self.text.get(begin..end).unwrap_or_default();
            if record.iter().all(|value| value.trim().is_empty()) {
                continue;
            }
            let begin = begin + row.len() - row.trim_start().len();
            let span = begin..begin.max(end - (row.len() - row.trim_end().len()));
            self.rows += 1;
            if self.rows > MAX_ITEMS {
                let hint = format!("at most {MAX_ITEMS} are read");
                problems.add(span, format!("the table has more than {MAX_ITEMS} rows"), hint);
                return None;
            }
            if record.len() > self.columns.len() {
                let message = format!(
                    "the line has {} values, the first line {}: a decimal comma is not read",
                    record.len(),
                    self.columns.len()
                );
                problems.add(span, message, "write numbers with a point");
                continue;
            }
            return Some(Row { text: self.text, record, span, number: self.rows });
        }
    }
}

impl Row<'_> {
    /// Returns the value of a column without blanks around it; empty if there is none.
    pub(super) fn value(&self, column: Option<usize>) -> &str {
        column.and_then(|column| self.record.get(column)).unwrap_or_default().trim()
    }

    /// Returns the place of the value of a column; that of the row if quotes hide it.
    pub(super) fn place(&self, column: Option<usize>) -> Range<usize> {
        let Some(column) = column else { return self.span.clone() };
        let mut at = self.span.start;
        let mut found = self.span.clone();
        for value in self.record.iter().take(column + 1) {
            let Some(offset) = self.text.get(at..self.span.end).and_then(|rest| rest.find(value)) else {
                return self.span.clone();
            };
            found = at + offset..at + offset + value.len();
            at = (found.end + 1).min(self.span.end);
        }
        found
    }

    /// Reads the value of a column. Adds a problem if it is wrong.
    pub(super) fn read<T>(
        &self,
        column: Option<usize>,
        problems: &mut Problems<'_>,
        read: impl FnOnce(&str) -> Result<T, String>,
    ) -> Option<T> {
        match read(self.value(column)) {
            Ok(value) => Some(value),
            Err(message) => {
                problems.add(self.place(column), message, "");
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> (Vec<String>, Vec<String>) {
        let mut problems = Problems::new("x", text);
        let mut rows = Vec::new();
        if let Some(mut table) = Table::new(text, &["a", "b"], &mut problems) {
            let (a, b) = (table.column("a"), table.column("b"));
            while let Some(row) = table.next_row(&mut problems) {
                rows.push(format!("{}|{}|{}", row.value(a), row.value(b), &text[row.place(b)]));
            }
        }
        (rows, problems.into_errors().iter().map(super::super::PlanError::headline).collect())
    }

    #[test]
    fn columns_come_in_any_order_and_either_separator() {
        let expected = vec!["1|2|2".to_owned(), "x, \"y\"|2|2".to_owned()];
        assert_eq!(rows("b,a\n2,1\n\n2,\"x, \"\"y\"\"\"\n"), (expected.clone(), vec![]));
        assert_eq!(rows("B;\"a\"\r\n2; 1\r\n;\r\n2;\"x, \"\"y\"\"\""), (expected, vec![]));
        assert_eq!(rows("b,a,c\n1").0, ["|1|1"]);
    }

    #[test]
    fn faults_have_a_place() {
        assert_eq!(
            rows("a,b\n1,2\n1,5,2\n").1,
            ["x:3:1: the line has 3 values, the first line 2: a decimal comma is not read"]
        );
        assert_eq!(rows("a;c\n").1, ["x:1:1: the first line has no column b"]);
        assert!(rows(&format!("a,b\n{}", ",".repeat(300))).1[0].contains("a line has 301 values"));
        let many = format!("a,b\n{}", "1,2\n".repeat(MAX_ITEMS + 1));
        assert_eq!(rows(&many).1, ["x:10002:1: the table has more than 10000 rows"]);
    }
}
