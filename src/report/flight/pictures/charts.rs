//! Values of a flight over time.

use super::Figure;
use crate::report::flight::{Detail, FlightReport};
use crate::report::plot::{Chart, Colour, Line, Picture, Point};
use crate::telemetry::signal::Signal;

/// Height of a chart, px.
const HEIGHT: f64 = 130.0;

/// A chart and its signals.
struct Content {
    id: &'static str,
    title: &'static str,
    unit: &'static str,
    signals: &'static [(Signal, &'static str, Colour, f64)],
    /// The smallest range of values.
    least_span: f64,
    /// A chart whose values stay below this is left out.
    least_value: f64,
    /// `true` if also one of many flights has this chart.
    is_short: bool,
}

/// The charts, in the order of the report. Truth is drawn over belief.
const CHARTS: [Content; 6] = [
    Content {
        id: "altitude",
        title: "Altitude",
        unit: "m above home",
        signals: &[
            (Signal::TargetAltitude, "Setpoint", Colour::Plan, 1.0),
            (Signal::EstAltitude, "Estimate", Colour::Estimate, 1.25),
            (Signal::Altitude, "Truth", Colour::First, 1.75),
        ],
        least_span: 5.0,
        least_value: 0.0,
        is_short: true,
    },
    Content {
        id: "speed",
        title: "Ground speed",
        unit: "m/s",
        signals: &[
            (Signal::SpeedSetpoint, "Setpoint", Colour::Plan, 1.0),
            (Signal::EstSpeed, "Estimate", Colour::Estimate, 1.25),
            (Signal::Speed, "Truth", Colour::First, 1.75),
        ],
        least_span: 2.0,
        least_value: 0.0,
        is_short: false,
    },
    Content {
        id: "cross-track",
        title: "Cross-track error",
        unit: "m, right of the leg positive",
        signals: &[(Signal::CrossTrack, "Navigator", Colour::Estimate, 1.5)],
        least_span: 2.0,
        least_value: 0.0,
        is_short: true,
    },
    Content {
        id: "battery",
        title: "Battery",
        unit: "V",
        signals: &[
            (Signal::ReportedBattery, "Reported", Colour::Estimate, 1.25),
            (Signal::Battery, "Truth", Colour::First, 1.75),
        ],
        least_span: 1.0,
        least_value: 0.1,
        is_short: false,
    },
    Content {
        id: "current",
        title: "Current",
        unit: "A",
        signals: &[
            (Signal::ReportedCurrent, "Reported", Colour::Estimate, 1.0),
            (Signal::Current, "Truth", Colour::First, 1.5),
        ],
        least_span: 5.0,
        least_value: 0.1,
        is_short: false,
    },
    Content {
        id: "wind",
        title: "Wind",
        unit: "m/s at the craft",
        signals: &[(Signal::Wind, "Truth", Colour::First, 1.5)],
        least_span: 2.0,
        least_value: 0.05,
        is_short: false,
    },
];

/// Returns the charts of a flight.
pub(super) fn figures(report: &FlightReport, id: &str, time: (f64, f64), detail: Detail) -> Vec<Figure> {
    let wanted = CHARTS.iter().filter(|content| content.is_short || detail.is_whole);
    wanted.filter_map(|content| figure(content, report, id, time, detail)).collect()
}

fn figure(
    content: &Content,
    report: &FlightReport,
    id: &str,
    time: (f64, f64),
    detail: Detail,
) -> Option<Figure> {
    let mut lines: Vec<Line> = Vec::new();
    if content.id == "altitude" && !report.ground.is_empty() {
        let ground = report.ground.iter().map(|(at, height_m)| (report.record.seconds(*at), *height_m));
        lines.push(line("Ground", Colour::Ground, 1.0, ground.collect(), time, true));
    }
    for (signal, name, colour, width) in content.signals {
        let samples = report.record.samples.iter();
        let points = samples.map(|sample| (report.record.seconds(sample.time), sample.values.get(*signal)));
        lines.push(line(name, *colour, *width, points.collect(), time, false));
    }
    lines.retain(|line| line.points.iter().any(|(_, value)| value.is_finite()));
    let last = lines.last()?;
    let known = || last.points.iter().map(|(_, value)| *value).filter(|value| value.is_finite());
    let (least, greatest) =
        (known().fold(f64::INFINITY, f64::min), known().fold(f64::NEG_INFINITY, f64::max));
    if least.abs().max(greatest.abs()) < content.least_value {
        return None;
    }
    let Content { title, unit, .. } = content;
    let measure = unit.split([' ', ',']).next().unwrap_or_default();
    let range = format!("{}: {least:.1} to {greatest:.1} {measure}", last.name);
    let description = format!("{title} from {:.0} s to {:.0} s; {range}.", time.0, time.1);
    let picture = Picture::new(&format!("{id}-{}", content.id), title, &description);
    let (least_span, most_points) = (content.least_span, detail.points);
    let chart = Chart { time, lines, least_span, height: HEIGHT, most_points };
    Some(Figure {
        svg: chart.svg(&picture),
        title: format!("{title}, {unit}."),
        caption: format!("{range}."),
        is_wide: true,
    })
}

fn line(
    name: &str,
    colour: Colour,
    width: f64,
    points: Vec<Point>,
    (from, to): (f64, f64),
    is_filled: bool,
) -> Line {
    let points = points.into_iter().filter(|(at, _)| (from..=to).contains(at)).collect();
    Line { name: name.to_owned(), colour, width, is_filled, points }
}
