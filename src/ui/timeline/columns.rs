//! Converts between columns of the timeline and instants.
//!
//! Time is spread evenly over the columns, except for long idle parts, each of which is folded into one column.

use ratatui::layout::Rect;
use unicode_width::UnicodeWidthStr as _;

use crate::signals::SimTime;
use crate::timeline::{IdleSpan, TimelineView};
use crate::ui::formatting::clock;

/// The least number of columns for each fold. If there are too many folds, the shortest are drawn unfolded.
const COLUMNS_A_FOLD: usize = 6;

/// A folded part of the time.
#[derive(Debug, Clone, Copy)]
struct Fold {
    span: IdleSpan,
    /// The column of the fold, counted from the first.
    column: u64,
}

/// The columns of the line between its labels.
#[derive(Debug)]
pub(super) struct Columns {
    /// The screen column at which they begin; `width` is their number.
    pub(super) x: u16,
    pub(super) width: u16,
    first: SimTime,
    head: SimTime,
    folds: Vec<Fold>,
    /// The unfolded time, µs, at least 1.
    unfolded_us: u64,
}

impl Columns {
    /// Returns the columns of a timeline drawn into `area`.
    pub(super) fn new(timeline: &TimelineView, area: Rect) -> Self {
        let label = |time| clock(time).width() as u16 + 2;
        let (left, right) = (label(timeline.first), label(timeline.head));
        let width = area.width.saturating_sub(left + right);
        let (first, head) = (timeline.first, timeline.head);
        let spans = chosen(timeline, usize::from(width) / COLUMNS_A_FOLD);
        let folded_us: u64 = spans.iter().map(IdleSpan::length_us).sum();
        let mut columns = Self {
            x: area.x + left,
            width,
            first,
            head,
            folds: Vec::with_capacity(spans.len()),
            unfolded_us: head.0.saturating_sub(first.0).saturating_sub(folded_us).max(1),
        };
        let last = columns.last_unfolded(spans.len());
        let mut before_us = 0;
        for (number, span) in spans.into_iter().enumerate() {
            let since_us = span.from.0.saturating_sub(first.0).saturating_sub(before_us);
            // After the columns that show the time before it.
            let column = since_us.checked_sub(1).map_or(0, |us| columns.share(us, last) + 1);
            columns.folds.push(Fold { span, column: column + number as u64 });
            before_us += span.length_us();
        }
        columns
    }

    /// Returns the number of the last column of unfolded time, without counting folds.
    fn last_unfolded(&self, folds: usize) -> u64 {
        u64::from(self.width).saturating_sub(1 + folds as u64)
    }

    /// Returns the column at this time since the first instant, without counting folds.
    fn share(&self, since_us: u64, last: u64) -> u64 {
        let share = u128::from(since_us.min(self.unfolded_us)) * u128::from(last);
        (share / u128::from(self.unfolded_us)) as u64
    }

    /// Returns the column of an instant.
    pub(super) fn column_of(&self, time: SimTime) -> u16 {
        if time >= self.head {
            return self.width.saturating_sub(1);
        }
        let ended = self.folds.partition_point(|fold| fold.span.to <= time);
        if let Some(fold) = self.folds.get(ended).filter(|fold| fold.span.from <= time) {
            return fold.column as u16;
        }
        let folded_us: u64 = self.folds.iter().take(ended).map(|fold| fold.span.length_us()).sum();
        let since_us = time.0.saturating_sub(self.first.0).saturating_sub(folded_us);
        (self.share(since_us, self.last_unfolded(self.folds.len())) + ended as u64) as u16
    }

    /// Returns the instant at which a column begins; for the last column the newest instant.
    pub(super) fn start_of(&self, column: u16) -> SimTime {
        if column + 1 >= self.width {
            return self.head;
        }
        let column = u64::from(column);
        let before = self.folds.partition_point(|fold| fold.column < column);
        if let Some(fold) = self.folds.get(before).filter(|fold| fold.column == column) {
            return fold.span.from;
        }
        let folded_us: u64 = self.folds.iter().take(before).map(|fold| fold.span.length_us()).sum();
        let last = u128::from(self.last_unfolded(self.folds.len()).max(1));
        let unfolded = u128::from(column - before as u64) * u128::from(self.unfolded_us);
        SimTime(self.first.0 + unfolded.div_ceil(last) as u64 + folded_us)
    }

    /// Returns the instant at a column of the screen; `None` beside the line.
    pub(super) fn time_at(&self, screen_column: u16) -> Option<SimTime> {
        let column = screen_column.checked_sub(self.x).filter(|at| *at < self.width)?;
        Some(self.start_of(column))
    }

    /// Returns `true` if a column is a fold.
    pub(super) fn is_fold(&self, column: u16) -> bool {
        self.folds.iter().any(|fold| fold.column == u64::from(column))
    }
}

/// Returns the longest folds, at most `most`, the oldest first.
fn chosen(timeline: &TimelineView, most: usize) -> Vec<IdleSpan> {
    let inside = |span: &&IdleSpan| span.from >= timeline.first && span.to <= timeline.head;
    let mut spans: Vec<IdleSpan> = timeline.folds.iter().filter(inside).copied().collect();
    spans.sort_by_key(|span| std::cmp::Reverse(span.length_us()));
    spans.truncate(most);
    spans.sort_by_key(|span| span.from);
    spans
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: u64) -> SimTime {
        SimTime(seconds * 1_000_000)
    }

    fn columns(width: u16, head_s: u64, folds: &[(u64, u64)]) -> Columns {
        let folds = folds.iter().map(|&(from, to)| IdleSpan { from: at(from), to: at(to) }).collect();
        let timeline = TimelineView { first: at(7), head: at(head_s), folds, ..TimelineView::default() };
        let columns = Columns::new(&timeline, Rect::new(3, 5, width, 1));
        assert!(columns.width > 20, "{columns:?}");
        columns
    }

    /// Folds at the beginning, at the end, next to each other, at the border of columns, and more folds than fit.
    const CASES: [&[(u64, u64)]; 7] = [
        &[],
        &[(7, 100)],
        &[(100, 4000)],
        &[(100, 200), (200, 3999)],
        &[(57, 107), (157, 207), (1000, 3000), (3001, 3950)],
        &[(50, 80), (110, 140), (170, 200), (230, 260), (290, 320), (350, 380), (410, 440), (470, 3990)],
        &[(7, 4000)],
    ];

    #[test]
    fn a_column_and_its_instant_belong_together_whatever_is_folded() {
        for folds in CASES {
            for width in [40, 41, 80, 120, 200] {
                let columns = columns(width, 4000, folds);
                for column in 0..columns.width {
                    let time = columns.time_at(columns.x + column).unwrap();
                    // Without any time, some columns show nothing.
                    if columns.unfolded_us > 1 {
                        assert_eq!(columns.column_of(time), column, "{time:?} of {columns:?}");
                    }
                }
                assert_eq!(columns.time_at(columns.x + columns.width - 1), Some(at(4000)));
                assert_eq!(columns.time_at(columns.x + columns.width), None);
                assert_eq!(columns.time_at(columns.x - 1), None);
            }
        }
    }

    #[test]
    fn later_instants_are_never_further_left() {
        for folds in CASES {
            let columns = columns(100, 4000, folds);
            let shown: Vec<u16> = (7..=4000).map(|second| columns.column_of(at(second))).collect();
            assert!(shown.is_sorted(), "{columns:?}");
            assert_eq!(columns.column_of(SimTime::ZERO), columns.column_of(at(7)));
            assert!(shown.iter().all(|column| *column < columns.width));
        }
    }

    #[test]
    fn a_fold_is_one_column_however_long_it_is() {
        let columns = columns(100, 100_000, &[(100, 100_000)]);
        let fold = columns.column_of(at(5000));
        assert!(columns.is_fold(fold) && !columns.is_fold(fold - 1));
        assert_eq!(columns.start_of(fold), at(100));
        assert_eq!(fold, columns.width - 2, "the newest instant follows");
        assert_eq!(columns.column_of(at(99)), fold - 1);
        assert_eq!(columns.column_of(at(7)), 0);
    }
}
