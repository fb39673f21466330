//! The choice of one line of a map.

use super::ReadOptions;
use super::loss::{Finding, Severity};
use super::map_data::HOME;
use super::map_file::{Kind, MapFeature, Piece, zone};
use super::map_plan::{Builder, Map};
use crate::plan::feature::{Shape, Vertex};

/// The most lines that a refusal lists.
const MAX_LISTED: usize = 20;

/// A line of a map that can be a plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate<'m> {
    pub(super) feature: &'m MapFeature,
    pub(super) piece: &'m Piece,
    pub(super) number: usize,
}

impl<'m> Candidate<'m> {
    /// Returns the points.
    pub(super) fn vertices(&self) -> &'m [Vertex] {
        match &self.piece.shape {
            Shape::Line(line) => line,
            Shape::Area(rings) => rings.first().map_or(&[], Vec::as_slice),
            Shape::Point(vertex) => std::slice::from_ref(vertex),
        }
    }

    fn label(&self) -> String {
        let what = match self.piece.kind {
            Kind::Track => "track, ",
            Kind::Area => "ring, ",
            Kind::Line | Kind::Point => "",
        };
        let Self { feature, number, .. } = self;
        let name: String = feature.name.chars().take(60).collect();
        format!("{number} \"{name}\" ({what}{} points)", self.vertices().len())
    }
}

/// Returns the lines of a map: routes, tracks, and, if the user asks for them, rings.
fn candidates<'m>(map: &'m Map, options: &ReadOptions) -> Vec<Candidate<'m>> {
    let is_line = |piece: &Piece| match piece.kind {
        Kind::Line | Kind::Track => true,
        Kind::Area => options.ring,
        Kind::Point => false,
    };
    let features = map.features.iter().filter(|feature| zone(&feature.properties).is_none());
    features
        .flat_map(|feature| feature.pieces.iter().map(move |piece| (feature, piece)))
        .filter(|(_, piece)| is_line(piece))
        .enumerate()
        .map(|(index, (feature, piece))| Candidate { feature, piece, number: index + 1 })
        .collect()
}

/// The outcome of a choice.
pub(super) enum Choice<'m> {
    Line(Candidate<'m>),
    /// There is no line that is taken without a word of the user.
    None,
    /// The problem was added.
    Refused,
}

impl<'m> Builder<'m, '_, '_> {
    /// Chooses the line that the user named, or else the only one. A recorded track is taken only if it is named.
    pub(super) fn choose(&mut self) -> Choice<'m> {
        let all = candidates(self.map, self.options);
        let wanted = if self.options.ring { Kind::Area } else { Kind::Line };
        let offered: Vec<Candidate<'m>> = match &self.options.feature {
            Some(word) => {
                let by_name = all.iter().filter(|candidate| candidate.feature.name == *word);
                let found: Vec<Candidate<'m>> = by_name.copied().collect();
                let number = word.parse::<usize>().ok();
                let by_number = || all.iter().filter(|candidate| Some(candidate.number) == number);
                if found.is_empty() { by_number().copied().collect() } else { found }
            }
            None => all.iter().filter(|candidate| candidate.piece.kind == wanted).copied().collect(),
        };
        match (&offered[..], &self.options.feature) {
            ([one], _) => {
                let others = all.len() - 1;
                if others > 0 {
                    let why = "other lines of the file are not part of the plan";
                    let finding = Finding::new(Severity::Info, "lines", why);
                    self.finding(finding.values(others.to_string(), ""));
                }
                let beside = points(self.map).count();
                if beside > 0 {
                    let why = "points beside the line are not part of the plan";
                    let finding = Finding::new(Severity::Info, "points", why);
                    self.finding(finding.values(beside.to_string(), ""));
                }
                Choice::Line(*one)
            }
            ([], None) => Choice::None,
            ([], Some(word)) => self.refuse(format!("there is no line {word}"), &all),
            (several, None) => self.refuse(format!("the file has {} lines", several.len()), &all),
            (several, Some(word)) => {
                self.refuse(format!("{} lines have the name {word}", several.len()), several)
            }
        }
    }

    /// Refuses the file, and lists the lines.
    fn refuse(&mut self, message: String, listed: &[Candidate<'m>]) -> Choice<'m> {
        let shown: Vec<String> = listed.iter().take(MAX_LISTED).map(Candidate::label).collect();
        let rest = match listed.len().saturating_sub(MAX_LISTED) {
            0 => String::new(),
            count => format!(", and {count} more"),
        };
        let hint = if listed.is_empty() {
            "the file has no lines".to_owned()
        } else {
            format!("choose with --feature: {}{rest}", shown.join(", "))
        };
        let at = listed.get(1).or(listed.first()).map_or(0, |candidate| candidate.feature.at);
        self.problem(at, None, message, &hint);
        Choice::Refused
    }

    /// Refuses a file without a line and without points. Names the shapes that can be chosen.
    pub(super) fn refuse_nothing(&mut self) {
        let all = candidates(self.map, self.options);
        if !all.is_empty() {
            self.refuse("the file has recorded tracks only".to_owned(), &all);
            return;
        }
        let mut pieces = self.map.features.iter().flat_map(|feature| &feature.pieces);
        if pieces.any(|piece| piece.kind == Kind::Area) {
            let hint = "take the outer ring of a polygon with --as ring";
            self.problem(0, None, "the file has polygons only".to_owned(), hint);
        } else {
            let hint = "a plan is a line, a route or points";
            self.problem(0, None, "the file has no line and no points".to_owned(), hint);
        }
    }
}

/// Returns the points of a map that may be waypoints.
pub(super) fn points(map: &Map) -> impl Iterator<Item = (usize, &MapFeature, &Piece)> {
    let features = map.features.iter().enumerate().filter(|(_, feature)| {
        zone(&feature.properties).is_none() && feature.properties.get("type") != Some(HOME)
    });
    features.flat_map(|(index, feature)| {
        let points = feature.pieces.iter().filter(|piece| piece.kind == Kind::Point);
        points.map(move |piece| (index + 1, feature, piece))
    })
}
