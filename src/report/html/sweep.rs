//! The page of a sweep: the flight coloured by the fate of a craft that gets the fault there.

use askama::Template;

use super::page::Page;
use super::{bounded, text};
use crate::flight::sweep::{Fate, SweepPoint};
use crate::report::flight::{Detail, Figure, Verdict};
use crate::report::plot::{Chart, Colour, Line, Map, MapTrack, Picture, Point, StateBar, Stay};
use crate::report::route::Route;
use crate::report::sweep::{SpanRow, SweptFlight, span_rows, summary, without};

/// Height of the chart of the distances, px.
const HEIGHT: f64 = 130.0;

/// A page about a sweep.
#[derive(Debug, Clone, Copy)]
pub struct SweepPage<'a> {
    pub swept: &'a SweptFlight<'a>,
    /// The plan in metres, if its place is known.
    pub route: Option<&'a Route>,
    /// Radius of the fence around home, m.
    pub fence_m: Option<f64>,
    /// The command that flies the sweep again.
    pub command: Option<&'a str>,
    /// The command that flies the worst second.
    pub worst: Option<&'a str>,
}

#[derive(Debug, Template)]
#[template(path = "report/sweep.html")]
struct Body {
    sentences: Vec<String>,
    figures: Vec<Figure>,
    rows: Vec<SpanRow>,
    worst: Option<String>,
}

/// Returns the page. `program` is the name of this program with its version.
pub fn sweep_page(sweep: &SweepPage<'_>, program: &str) -> String {
    let swept = sweep.swept;
    let title = text::line(&format!("{}: {} at every second", swept.name, swept.fault_name()));
    let lost = swept.count(Fate::Lost);
    let verdict = Verdict {
        passed: (!swept.points.is_empty()).then_some(lost == 0),
        word: match (swept.points.is_empty(), lost) {
            (true, _) => "nothing was flown",
            (false, 0) => "never lost",
            (false, _) => "may be lost",
        }
        .to_owned(),
        reason: text::line(&summary(swept)),
    };
    bounded(Detail::WHOLE, |detail| {
        let body = Body {
            sentences: vec![text::line(&without(swept))],
            figures: figures(sweep, detail),
            rows: span_rows(swept).into_iter().take(detail.rows).map(printable).collect(),
            worst: sweep.worst.and_then(text::command).map(str::to_owned),
        };
        // Writing to a string does not fail.
        let body = body.render().unwrap_or_default();
        let mut page = Page::new("A fault at every second by betadeck", &title, &verdict, &body, program);
        page.command = sweep.command.and_then(text::command);
        page.note = "Times are simulated seconds after the autopilot engaged. Places are true. A craft comes home if it \
                     flies its plan to the end, or lands at home or at its LAND.";
        page.html()
    })
}

fn printable(row: SpanRow) -> SpanRow {
    SpanRow { reason: text::line(&row.reason), ..row }
}

/// Returns the colour of a fate, its width on the map, px, and its name. Thicker is worse, for those who see no colours.
fn look(fate: Fate) -> (Colour, f64, &'static str) {
    match fate {
        Fate::Home => (Colour::Complete, 2.0, "comes home"),
        Fate::Off => (Colour::Orbiting, 4.0, "ends elsewhere, under control"),
        Fate::Lost => (Colour::Exclusion, 6.0, "lost"),
    }
}

fn figures(sweep: &SweepPage<'_>, detail: Detail) -> Vec<Figure> {
    let points = sweep.swept.points;
    let Some(last) = points.last() else { return Vec::new() };
    let end = f64::from(last.second + 1);
    let name = text::line(&sweep.swept.fault_name());
    vec![map(sweep, &name, detail), timeline(points, end, &name), distances(points, end, &name, detail)]
}

fn place(point: &SweepPoint) -> Point {
    (point.place_enu[0], point.place_enu[1])
}

fn map(sweep: &SweepPage<'_>, name: &str, detail: Detail) -> Figure {
    let points = sweep.swept.points;
    let mut map = Map { most_points: detail.points, ..Map::default() };
    if let Some(route) = sweep.route {
        map.legs = points.first().map(place).into_iter().chain(route.legs()).collect();
        map.marks = route.marks();
        map.rings = route.rings();
        map.legend.push((Colour::Plan, 1.0, "plan".to_owned()));
    }
    map.rings.extend(sweep.fence_m.map(|fence_m| ((0.0, 0.0), fence_m)));
    let mut start = 0;
    for span in points.chunk_by(|a, b| a.fate == b.fate) {
        let fate = span.first().map_or(Fate::Home, |first| first.fate);
        let end = start + span.len();
        // Each part ends where the next one begins, so that the line has no gap.
        let part = points.get(start..points.len().min(end + 1)).unwrap_or(span);
        let (colour, width, _) = look(fate);
        map.tracks.push(MapTrack { points: part.iter().map(place).collect(), colour, width });
        start = end;
    }
    for fate in [Fate::Home, Fate::Off, Fate::Lost] {
        let (colour, width, name) = look(fate);
        let count = sweep.swept.count(fate);
        if count > 0 {
            map.legend.push((colour, width, format!("{name} ({count})")));
        }
    }
    let picture = Picture::new(
        "sweep-map",
        "Map of the sweep",
        &format!(
            "The track of the flight, north up, coloured by the fate of a craft that gets {name} there."
        ),
    );
    Figure {
        svg: map.svg(&picture),
        title: "Where.".to_owned(),
        caption: "The true track without the fault. Thicker is worse.".to_owned(),
        is_wide: false,
    }
}

fn timeline(points: &[SweepPoint], end: f64, name: &str) -> Figure {
    let mut stays: Vec<Stay> = Vec::new();
    for span in points.chunk_by(|a, b| a.fate == b.fate) {
        let (Some(first), Some(last)) = (span.first(), span.last()) else { continue };
        let (colour, _, name) = look(first.fate);
        let (from, to) = (f64::from(first.second), f64::from(last.second + 1));
        stays.push(Stay { from, to, name, colour, label: first.fate.to_string() });
    }
    let picture = Picture::new(
        "sweep-timeline",
        "Timeline of the sweep",
        &format!("The fate of a craft that gets {name} at each second, from 0 s to {end:.0} s."),
    );
    Figure {
        svg: StateBar { time: (0.0, end), stays }.svg(&picture),
        title: "When.".to_owned(),
        caption: "Seconds after the engagement at which the fault begins.".to_owned(),
        is_wide: true,
    }
}

fn distances(points: &[SweepPoint], end: f64, name: &str, detail: Detail) -> Figure {
    let off = points.iter().map(|point| (f64::from(point.second), point.off_m)).collect();
    let line = Line {
        name: "distance".to_owned(),
        colour: Colour::First,
        width: 1.75,
        is_filled: true,
        points: off,
    };
    let chart = Chart {
        time: (0.0, end),
        lines: vec![line],
        least_span: 5.0,
        height: HEIGHT,
        most_points: detail.points,
    };
    let picture = Picture::new(
        "sweep-distance",
        "Distance at the end",
        &format!("The distance of the craft from home or from its LAND at its end, by the second of {name}."),
    );
    Figure {
        svg: chart.svg(&picture),
        title: "How far off, m.".to_owned(),
        caption: "The distance at the end from home or from its LAND, whichever is closer.".to_owned(),
        is_wide: true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::FlightResult;
    use crate::report::html::tests::elements;

    fn page(points: &[SweepPoint], name: &str) -> String {
        let swept = SweptFlight {
            name,
            fault: "gps-loss@0,6".parse().unwrap(),
            without: Some(("complete", name)),
            points,
        };
        let page = SweepPage {
            swept: &swept,
            route: None,
            fence_m: Some(80.0),
            command: Some("betadeck campaign land --sweep gps-loss,6"),
            worst: Some("betadeck fly land --fault gps-loss@12,6"),
        };
        sweep_page(&page, "betadeck 0.1.0")
    }

    fn points(reason: &str) -> Vec<SweepPoint> {
        (0..60)
            .map(|second| {
                let (fate, result) = match second {
                    12 => (Fate::Lost, FlightResult::Crashed),
                    20..=25 => (Fate::Off, FlightResult::Landed),
                    _ => (Fate::Home, FlightResult::Complete),
                };
                SweepPoint {
                    second,
                    place_enu: [f64::from(second), 5.0, 10.0],
                    fate,
                    result,
                    reason: reason.to_owned(),
                    off_m: f64::from(second) / 3.0,
                    after_s: 10.0,
                }
            })
            .collect()
    }

    #[test]
    fn the_page_of_a_sweep_shows_where_and_when_the_craft_is_lost() {
        let page = page(&points("the craft crashed"), "land");
        elements(&page);
        for part in [
            "✗ may be lost",
            "53 home, 6 off, 1 lost",
            "comes home (53)",
            "lost (1)",
            "<th scope=\"row\" class=\"nowrap\">0:12</th><td class=\"failed\">lost</td>",
            "0:20 to 0:25",
            "up to 8.33 m",
            "<code>betadeck fly land --fault gps-loss@12,6</code>",
        ] {
            assert!(page.contains(part), "{part} is not in the page");
        }
        // The crossing from one fate to the next is drawn.
        assert!(page.matches("<polyline").count() >= 5, "{}", page.matches("<polyline").count());
    }

    #[test]
    fn a_sweep_of_nothing_or_with_markup_in_a_name_has_a_page() {
        assert!(page(&[], "land").contains("– nothing was flown"));
        let hostile = "</title><script>a('\"');</script><img src=x onerror=a()>&amp;";
        assert_eq!(
            elements(&page(&points(hostile), hostile)),
            elements(&page(&points("harmless"), &"x".repeat(60)))
        );
    }
}
