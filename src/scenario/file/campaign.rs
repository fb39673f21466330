//! `[campaign]`: the design, the number of flights and the goals.

use std::collections::BTreeMap;

use strum::{IntoEnumIterator as _, VariantNames as _};

use super::keys::CAMPAIGN_KEYS;
use super::reader::{Layers, Reader};
use super::varied::refuse_both;
use super::{air, varied};
use crate::design::Design;
use crate::plan::format::TomlTable;
use crate::scenario::campaign_spec::{CampaignSpec, MAX_CAMPAIGN, USUAL_LEVELS};
use crate::scenario::case::Case;
use crate::scenario::expression::Cursor;
use crate::scenario::goal::{Goal, read_goal};
use crate::scenario::varied::{Spread, Tolerance};
use crate::telemetry::quantity::Dimension;

/// The most goals.
const MAX_GOALS: usize = 1000;

/// Reads a campaign of these cases. `all` has the layers of each case.
pub(super) fn read(
    top: &TomlTable<'_, '_>,
    all: &[Layers<'_, '_>],
    cases: &[Case],
    reader: &mut Reader<'_, '_>,
) -> CampaignSpec {
    let inputs = varied::read(top, reader);
    let airs = all.iter().map(|layers| air::read_drawn(layers, reader)).collect();
    if let Some(vary) = top.get("vary").and_then(|value| reader.table("vary", value)) {
        for layers in all {
            let craft = layers.tables("craft", reader);
            Tolerance::iter().for_each(|of| refuse_both(&craft, &vary, of.key(), reader));
        }
    }
    let is_listed = inputs.iter().all(|input| matches!(input.spread, Spread::Choice(_)));
    let mut spec = CampaignSpec {
        design: if is_listed && !inputs.is_empty() { Design::Grid } else { Design::MonteCarlo },
        flights: None,
        seed: 1,
        levels: USUAL_LEVELS,
        inputs,
        airs,
        goals: Vec::new(),
    };
    let Some(table) = top.get("campaign").and_then(|value| reader.table("campaign", value)) else {
        return spec;
    };
    reader.refuse_unknown(&table, CAMPAIGN_KEYS);
    if let Some(value) = table.get("design")
        && let Some(word) = reader.text(value)
    {
        match word.parse() {
            Ok(design) => spec.design = design,
            Err(_) => {
                let guess = crate::text::did_you_mean::suffix(&word, Design::VARIANTS.iter().copied());
                let allowed = Design::VARIANTS.join(", ");
                reader.problem(
                    value.span(),
                    format!("{word} is not a design{guess}"),
                    format!("allowed: {allowed}"),
                );
            }
        }
    }
    let whole = |key, most: u64, reader: &mut Reader<'_, '_>| {
        let value = table.get(key)?;
        let number = reader.integer(value)?;
        let allowed = u64::try_from(number).ok().filter(|number| (1..=most).contains(number));
        if allowed.is_none() {
            reader.problem(
                value.span(),
                format!("{number} is out of range"),
                format!("allowed: 1 to {most}"),
            );
        }
        allowed
    };
    spec.flights = whole("flights", MAX_CAMPAIGN, reader);
    spec.levels = whole("levels", 1000, reader).unwrap_or(spec.levels);
    spec.seed = whole("seed", i64::MAX as u64, reader).unwrap_or(spec.seed);
    spec.goals = goals(&table, cases, reader);
    spec
}

fn goals(table: &TomlTable<'_, '_>, cases: &[Case], reader: &mut Reader<'_, '_>) -> Vec<Goal> {
    let measures = measures(cases);
    let texts = reader.texts(table, "expect").unwrap_or_default();
    if texts.len() > MAX_GOALS {
        let message = format!("there are {} expectations", texts.len());
        reader.problem(table.span(), message, format!("allowed: {MAX_GOALS}"));
        return Vec::new();
    }
    texts
        .into_iter()
        .filter_map(|(text, span)| {
            let mut cursor = Cursor::new(&text);
            let read = read_goal(&mut cursor, &measures).and_then(|goal| cursor.finish().map(|()| goal));
            let line = reader.line(span.clone());
            read.map_err(|error| reader.problem(span, error.message, error.hint)).ok().map(|goal| Goal {
                label: text,
                line,
                ..goal
            })
        })
        .collect()
}

/// Returns the measures of all cases with their dimensions.
fn measures(cases: &[Case]) -> BTreeMap<String, Dimension> {
    let all = cases.iter().flat_map(|case| &case.measures);
    all.map(|measure| (measure.name.clone(), measure.dimension)).collect()
}
