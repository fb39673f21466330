//! The change of a document by an edit, in both directions.

use serde::{Deserialize, Serialize};

use super::PlanDocument;
use crate::plan::format::HomePosition;
use crate::plan::{FlightPlan, Waypoint};

/// The difference between a document before and after an edit.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Change {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<Replaced<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<Replaced<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    home: Option<Replaced<Option<HomePosition>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    settings: Option<Splice<String>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    waypoints: Option<Splice<Waypoint>>,
}

/// A value and its replacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Replaced<T> {
    before: T,
    after: T,
}

/// A part of a list and its replacement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Splice<T> {
    at: usize,
    removed: Vec<T>,
    inserted: Vec<T>,
}

impl Change {
    /// Returns the change from `before` to `after`; `None` if they are equal.
    pub fn between(before: &PlanDocument, after: &PlanDocument) -> Option<Self> {
        (before != after).then(|| Self {
            name: Replaced::between(&before.name, &after.name),
            description: Replaced::between(&before.description, &after.description),
            home: Replaced::between(&before.home, &after.home),
            settings: Splice::between(&before.settings, &after.settings),
            waypoints: Splice::between(&before.plan.waypoints, &after.plan.waypoints),
        })
    }

    /// Returns the change that undoes this one.
    pub fn inverse(&self) -> Self {
        Self {
            name: self.name.as_ref().map(Replaced::inverse),
            description: self.description.as_ref().map(Replaced::inverse),
            home: self.home.as_ref().map(Replaced::inverse),
            settings: self.settings.as_ref().map(Splice::inverse),
            waypoints: self.waypoints.as_ref().map(Splice::inverse),
        }
    }

    /// Returns the document after the change; `None` if the change does not fit the document.
    pub fn apply(&self, document: &PlanDocument) -> Option<PlanDocument> {
        let waypoints = apply_splice(self.waypoints.as_ref(), &document.plan.waypoints)?;
        Some(PlanDocument {
            name: apply_replaced(self.name.as_ref(), &document.name)?,
            description: apply_replaced(self.description.as_ref(), &document.description)?,
            home: apply_replaced(self.home.as_ref(), &document.home)?,
            settings: apply_splice(self.settings.as_ref(), &document.settings)?,
            plan: FlightPlan { waypoints: waypoints.as_slice().try_into().ok()? },
        })
    }
}

impl<T: Clone + PartialEq> Replaced<T> {
    fn between(before: &T, after: &T) -> Option<Self> {
        (before != after).then(|| Self { before: before.clone(), after: after.clone() })
    }

    fn inverse(&self) -> Self {
        Self { before: self.after.clone(), after: self.before.clone() }
    }
}

impl<T: Clone + PartialEq> Splice<T> {
    fn between(before: &[T], after: &[T]) -> Option<Self> {
        if before == after {
            return None;
        }
        let at = std::iter::zip(before, after).take_while(|(a, b)| a == b).count();
        let (before, after) = (&before[at..], &after[at..]);
        let same_end =
            std::iter::zip(before.iter().rev(), after.iter().rev()).take_while(|(a, b)| a == b).count();
        Some(Self {
            at,
            removed: before[..before.len() - same_end].to_vec(),
            inserted: after[..after.len() - same_end].to_vec(),
        })
    }

    fn inverse(&self) -> Self {
        Self { at: self.at, removed: self.inserted.clone(), inserted: self.removed.clone() }
    }
}

fn apply_replaced<T: Clone + PartialEq>(change: Option<&Replaced<T>>, value: &T) -> Option<T> {
    match change {
        None => Some(value.clone()),
        Some(change) => (change.before == *value).then(|| change.after.clone()),
    }
}

fn apply_splice<T: Clone + PartialEq>(change: Option<&Splice<T>>, list: &[T]) -> Option<Vec<T>> {
    let Some(Splice { at, removed, inserted }) = change else { return Some(list.to_vec()) };
    let rest = list.get(*at..)?.strip_prefix(removed.as_slice())?;
    Some(list[..*at].iter().chain(inserted).chain(rest).cloned().collect())
}
