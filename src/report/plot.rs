//! Pictures of flights as SVG: a map, charts over time, and the states of a flight.
//!
//! `canvas` turns a drawing into a document with a title and a description, `axes` draws the field of a chart, `colour`
//! names the colours by their roles, and `map`, `chart`, `states`, `bars` and `scatter` are the pictures. `simplify` and
//! `clip` bound the number of points, and `labels` and `legend` place texts. Points are pairs: to the right and up.

mod axes;
mod bars;
mod canvas;
mod chart;
mod clip;
mod colour;
mod labels;
mod legend;
mod map;
mod range;
mod scatter;
mod simplify;
mod states;

pub(super) use bars::{Bar, Bars};
pub(super) use canvas::Picture;
pub(super) use chart::{Chart, Line};
pub(super) use colour::Colour;
pub(super) use map::{Ground, GroundKind, Map, MapTrack, Mark};
pub(super) use scatter::Scatter;
pub(super) use states::{StateBar, Stay};

/// A place on the ground (metres east and north) or on a chart.
pub(super) type Point = (f64, f64);
