//! The pictures of a campaign: distributions, and the inputs that explain failures.

use crate::campaign::{Answer, Cause, Distribution, Rule, Scatter, Values};
use crate::report::campaign::shown;
use crate::report::flight::{Detail, Figure};
use crate::report::html::text;
use crate::report::plot::{self, Bar, Bars, Picture, Point};
use crate::scenario::Metric;

/// The most distributions that are drawn.
const MAX_DISTRIBUTIONS: usize = 24;
/// The most inputs that are drawn.
const MAX_CAUSES: usize = 3;
/// The least range of a metric that is drawn. A constant has no picture.
const MIN_RANGE: f64 = 1e-9;

/// Returns the distributions of the metrics as histograms with their cumulative curves.
pub(super) fn of_distributions(answer: &Answer, detail: Detail) -> Vec<Figure> {
    let most = MAX_DISTRIBUTIONS.min(detail.rows);
    let drawn = answer.distributions.iter().filter(|one| one.greatest - one.least > MIN_RANGE);
    drawn.take(most).enumerate().map(|(number, one)| distribution(number, one)).collect()
}

fn distribution(number: usize, distribution: &Distribution) -> Figure {
    let of = &distribution.of;
    // Shares are drawn in per cent.
    let is_share = Metric::find(&of.name).is_some_and(Metric::is_share);
    let scale = if is_share { 100.0 } else { 1.0 };
    let unit = if is_share { Some("%") } else { of.dimension.unit().map(|unit| unit.name) };
    let (least, range) = (distribution.least, distribution.greatest - distribution.least);
    let width = range / distribution.classes.len().max(1) as f64;
    let bars = distribution.classes.iter().enumerate().map(|(at, count)| Bar {
        from: scale * (least + at as f64 * width),
        to: scale * (least + (at + 1) as f64 * width),
        share: 100.0 * *count as f64 / distribution.count.max(1) as f64,
        word: String::new(),
    });
    let curve = distribution.curve.iter().enumerate().map(|(at, value)| (scale * value, at as f64));
    let value = |value| shown::value(of, value);
    let name = text::line(&of.name);
    let picture = Picture::new(
        &format!("distribution-{number}"),
        &name,
        &format!(
            "The distribution of {name} over {} flights: between {} and {}, half of them up to {}, 95 % up to {}.",
            distribution.count,
            value(distribution.least),
            value(distribution.greatest),
            value(distribution.median),
            value(distribution.p95)
        ),
    );
    let bars = Bars {
        bars: bars.collect(),
        curve: curve.collect(),
        marks: vec![
            (scale * distribution.median, format!("median {}", value(distribution.median))),
            (scale * distribution.p95, format!("95 % {}", value(distribution.p95))),
        ],
        names: ["flights in a class".to_owned(), "flights up to a value".to_owned()],
    };
    Figure {
        svg: bars.svg(&picture),
        title: unit.map_or_else(|| format!("{name}."), |unit| format!("{name}, {unit}.")),
        caption: format!("{} flights.", distribution.count),
        is_wide: true,
    }
}

/// Returns how often flights failed along the inputs that explain it, and flights by two numbers.
pub(super) fn of_failures(answer: &Answer, detail: Detail) -> Vec<Figure> {
    let causes = &answer.causes;
    let has_both = causes.failures > 0 && causes.failures < causes.flights;
    // Without a cause beyond chance, the closest one is shown.
    let real = causes.of_failures.iter().filter(|cause| cause.is_real).count().clamp(1, MAX_CAUSES);
    let drawn = causes.of_failures.iter().filter(|_| has_both).take(real);
    let bars = drawn.enumerate().map(|(number, cause)| failures(number, cause));
    let first = causes.of_failures.first();
    let scatters = causes.scatters.iter().enumerate();
    bars.chain(scatters.map(|(number, one)| scatter(number, one, first, detail))).collect()
}

fn failures(number: usize, cause: &Cause) -> Figure {
    let share = |failed: u64, flights: u64| 100.0 * failed as f64 / flights.max(1) as f64;
    let bars = cause.classes.iter().enumerate().map(|(at, class)| {
        let share = share(class.failed, class.flights);
        match &class.values {
            Values::Between(from, to) => Bar { from: *from, to: *to, share, word: String::new() },
            Values::Word(word) => {
                Bar { from: at as f64 + 0.1, to: at as f64 + 0.9, share, word: text::line(word) }
            }
        }
    });
    let marks = threshold(cause).into_iter().collect();
    let input = text::line(&cause.input);
    let rule = text::line(&shown::rule(&cause.input, &cause.split.rule));
    let picture = Picture::new(
        &format!("failures-{number}"),
        &format!("Failures by {input}"),
        &format!("The share of failed flights by {input}. {rule}: {}.", shown::split(&cause.split)),
    );
    let bars = Bars {
        bars: bars.collect(),
        curve: Vec::new(),
        marks,
        names: ["failed flights of a class".to_owned(), String::new()],
    };
    Figure {
        svg: bars.svg(&picture),
        title: format!("Failures by {input}."),
        caption: "Each bar is the share of the flights with these values that failed.".to_owned(),
        is_wide: true,
    }
}

/// Returns the value that divides the flights; `None` if a word does.
fn threshold(cause: &Cause) -> Option<(f64, String)> {
    match cause.split.rule {
        Rule::Above(value) | Rule::AtMost(value) => {
            Some((value, format!("divided at {}", shown::number(value))))
        }
        Rule::Is(_) => None,
    }
}

fn scatter(number: usize, scatter: &Scatter, first: Option<&Cause>, detail: Detail) -> Figure {
    let [x, y] = scatter.names.each_ref().map(|name| text::line(name));
    let points = |failed: bool| -> Vec<Point> {
        let of_kind = scatter.points.iter().filter(|point| point.failed == failed);
        of_kind.take(detail.points).map(|point| (point.at[0], point.at[1])).collect()
    };
    let (dots, crosses) = (points(false), points(true));
    let description =
        format!("{} flights that succeeded and {} that failed, by {x} and {y}.", dots.len(), crosses.len());
    let picture = Picture::new(&format!("scatter-{number}"), &format!("{y} over {x}"), &description);
    let marks = first.filter(|cause| cause.is_real && cause.input == scatter.names[0]).and_then(threshold);
    let part = if scatter.is_part { " Of many flights some are left out." } else { "" };
    let plot = plot::Scatter {
        names: ["succeeded (dots)", "failed (crosses)"],
        dots,
        crosses,
        marks: marks.into_iter().collect(),
    };
    Figure {
        svg: plot.svg(&picture),
        title: format!("{y} (up) over {x} (to the right)."),
        caption: format!("Each mark is a flight.{part}"),
        is_wide: true,
    }
}
