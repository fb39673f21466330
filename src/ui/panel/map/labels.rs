//! Text on the map that does not overlap.

use ratatui::buffer::Buffer;
use unicode_width::UnicodeWidthStr as _;

use crate::ui::acts::viewport::Viewport;
use crate::ui::drawing;
use crate::ui::model::map_point::MapPoint;
use crate::ui::text_wrap::wrapped;
use crate::ui::theme::{Palette, Role, Theme};

/// The greatest number of lines at the top.
const TOP_LINES: usize = 3;

/// Writes marks and labels, and keeps track of the occupied cells.
pub(super) struct Labels<'a> {
    theme: &'a Theme,
    view: Viewport,
    buffer: &'a mut Buffer,
    taken: Vec<bool>,
}

impl<'a> Labels<'a> {
    pub(super) fn new(theme: &'a Theme, view: Viewport, buffer: &'a mut Buffer) -> Self {
        let taken = vec![false; usize::from(view.area.width) * usize::from(view.area.height)];
        Self { theme, view, buffer, taken }
    }

    /// Returns the window of the map.
    pub(super) fn view(&self) -> &Viewport {
        &self.view
    }

    fn index(&self, column: u16, row: u16) -> usize {
        usize::from(row - self.view.area.y) * usize::from(self.view.area.width)
            + usize::from(column - self.view.area.x)
    }

    /// Writes a mark of one column at a place, over everything.
    pub(super) fn mark(&mut self, place: MapPoint, symbol: &str, role: Role) {
        if let Some((column, row)) = self.view.screen_cell(place) {
            self.put(column, row, symbol, role);
        }
    }

    fn put(&mut self, column: u16, row: u16, text: &str, role: Role) {
        drawing::text(self.buffer, column, row, text, self.theme.style(role));
        for column in column..column.saturating_add(text.width() as u16).min(self.view.area.right()) {
            let index = self.index(column, row);
            if let Some(taken) = self.taken.get_mut(index) {
                *taken = true;
            }
        }
    }

    fn is_free(&self, column: i32, row: i32, width: usize) -> bool {
        let area = self.view.area;
        let inside = column >= i32::from(area.left())
            && row >= i32::from(area.top())
            && row < i32::from(area.bottom())
            && column + width as i32 <= i32::from(area.right());
        inside
            && (column..column + width as i32)
                .all(|column| self.taken.get(self.index(column as u16, row as u16)) == Some(&false))
    }

    /// Writes a label right, left, below or above a place: the short form if the long one does not fit, else nothing.
    pub(super) fn beside(&mut self, place: MapPoint, long: &str, short: &str, role: Role) {
        let Some((column, row)) = self.view.screen_cell(place) else { return };
        let (column, row) = (i32::from(column), i32::from(row));
        for text in [long, short] {
            let width = text.width();
            let places = [
                (column + 1, row),
                (column - width as i32, row),
                (column, row + 1),
                (column, row - 1),
                (column - width as i32, row + 1),
                (column + 1, row - 1),
            ];
            if let Some(&(column, row)) =
                places.iter().find(|(column, row)| self.is_free(*column, *row, width))
            {
                self.put(column as u16, row as u16, text, role);
                return;
            }
        }
    }

    /// Writes a text where its cells hold nothing but the backdrop: at the first offset, in columns and rows from a
    /// place, that has room.
    pub(super) fn on_free_ground(&mut self, place: MapPoint, text: &str, offsets: &[(i32, i32)], role: Role) {
        let Some((column, row)) = self.view.screen_cell(place) else { return };
        let width = text.width();
        let at = offsets.iter().map(|(right, down)| (i32::from(column) + right, i32::from(row) + down));
        let free = at.into_iter().find(|&(column, row)| {
            let cells = column..column + width as i32;
            self.is_free(column, row, width) && cells.into_iter().all(|column| self.is_ground(column, row))
        });
        if let Some((column, row)) = free {
            self.put(column as u16, row as u16, text, role);
        }
    }

    fn is_ground(&self, column: i32, row: i32) -> bool {
        let Some(cell) = self.buffer.cell((column as u16, row as u16)) else { return false };
        // Without colours the lines of plan and track look the same.
        let faint = [Role::Backdrop, Role::Zone].map(|role| self.theme.colour(role));
        cell.symbol() == " " || self.theme.palette != Palette::Mono && faint.contains(&cell.fg)
    }

    /// Writes a line in the middle.
    pub(super) fn middle(&mut self, text: &str, role: Role) {
        let area = self.view.area;
        let width = text.width() as u16;
        if width <= area.width {
            self.put(area.x + (area.width - width) / 2, area.y + area.height / 2, text, role);
        }
    }

    /// Writes lines at the top, as many as the text takes, at most three.
    pub(super) fn top(&mut self, text: &str, role: Role) {
        let area = self.view.area;
        for (row, line) in (area.y..area.bottom()).zip(wrapped(text, usize::from(area.width))).take(TOP_LINES)
        {
            self.put(area.x, row, &line, role);
        }
    }

    /// Writes the bottom line: text on the left, and on the right if there is room for both.
    pub(super) fn bottom(&mut self, left: &str, right: &str) {
        let area = self.view.area;
        let row = area.bottom() - 1;
        let (left_width, right_width) = (left.width() as u16, right.width() as u16);
        if left_width <= area.width {
            self.put(area.x, row, left, Role::Dim);
        }
        if left_width + right_width < area.width {
            self.put(area.right() - right_width, row, right, Role::Dim);
        }
    }
}
