//! Reports as HTML pages: one file each, without scripts and without anything from elsewhere.
//!
//! The templates in `templates/report/` escape every text. `page` is the frame of all pages, `flight` the part about one
//! flight, and `check`, `compare`, `lab`, `campaign` and `sweep` the pages of those commands. A page is at most [`MAX_BYTES`] long: lines get fewer
//! points and tables fewer rows until it is.

mod campaign;
mod check;
mod compare;
mod flight;
mod lab;
mod page;
mod sweep;
mod text;

pub use campaign::{CampaignPage, campaign_page};
pub use check::CheckPage;
pub use compare::compare_page;
pub use flight::flight_page;
pub use lab::lab_page;
pub use sweep::{SweepPage, sweep_page};

use super::flight::Detail;

/// The greatest size of a page, bytes.
pub const MAX_BYTES: usize = 1_000_000;

/// Returns the page with the greatest detail that fits.
fn bounded(mut detail: Detail, render: impl Fn(Detail) -> String) -> String {
    loop {
        let page = render(detail);
        match detail.halved() {
            Some(less) if page.len() > MAX_BYTES => detail = less,
            _ => return page,
        }
    }
}

#[cfg(test)]
mod tests;
