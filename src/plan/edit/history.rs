//! The history of a document: a tree of revisions, so that no edit is ever lost.

use super::{Change, PlanDocument};

/// A revision: the change from its parent.
#[derive(Debug, Clone, PartialEq)]
pub struct Revision {
    parent: usize,
    change: Change,
    label: String,
}

impl Revision {
    /// Returns the previous revision.
    pub(super) fn parent(&self) -> usize {
        self.parent
    }

    /// Returns the description of the edit, a few words.
    pub fn label(&self) -> &str {
        &self.label
    }

    /// Returns the change.
    pub fn change(&self) -> &Change {
        &self.change
    }
}

/// A document with its revisions. Revision 0 is the document when it was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    base: PlanDocument,
    document: PlanDocument,
    /// Revisions 1 and up.
    revisions: Vec<Revision>,
    at: usize,
    /// For each revision, the target of a redo.
    next: Vec<Option<usize>>,
    /// The revision in the file.
    saved: Option<usize>,
}

impl History {
    /// Creates a history without edits; `is_saved` = the document is in a file.
    pub fn new(document: PlanDocument, is_saved: bool) -> Self {
        Self {
            base: document.clone(),
            document,
            revisions: Vec::new(),
            at: 0,
            next: vec![None],
            saved: is_saved.then_some(0),
        }
    }

    /// Returns the current document.
    pub fn document(&self) -> &PlanDocument {
        &self.document
    }

    /// Returns the document when it was opened.
    pub(super) fn base(&self) -> &PlanDocument {
        &self.base
    }

    pub(super) fn revisions(&self) -> &[Revision] {
        &self.revisions
    }

    pub(super) fn saved(&self) -> Option<usize> {
        self.saved
    }

    /// Returns the document in the file, as far as the history can tell.
    pub fn saved_document(&self) -> Option<PlanDocument> {
        let mut history = self.clone();
        if history.go_to(self.saved?) { Some(history.document) } else { None }
    }

    /// Returns the document of a revision.
    pub fn document_at(&self, revision: usize) -> Option<PlanDocument> {
        if revision > self.len() {
            return None;
        }
        let (here, there) = (self.path(self.at), self.path(revision));
        // Both descend to the opened document.
        let is_on = |path: &[usize], at: &usize| path.binary_search_by(|on| at.cmp(on)).is_ok();
        let mut document = self.document.clone();
        for at in here.iter().take_while(|at| !is_on(&there, at)) {
            document = self.revisions.get(at.checked_sub(1)?)?.change.inverse().apply(&document)?;
        }
        let behind = there.iter().take_while(|at| !is_on(&here, at)).collect::<Vec<_>>();
        for at in behind.into_iter().rev() {
            document = self.revisions.get(at.checked_sub(1)?)?.change.apply(&document)?;
        }
        Some(document)
    }

    /// Returns the current revision.
    pub fn at(&self) -> usize {
        self.at
    }

    /// Returns the description of the edit that made a revision; `None` for the opened document.
    pub fn label(&self, revision: usize) -> Option<&str> {
        self.revisions.get(revision.checked_sub(1)?).map(Revision::label)
    }

    /// Returns the newest revision that is not on the way from the opened document to this one.
    pub fn newest_beside(&self) -> Option<usize> {
        let path = self.path(self.at);
        // A parent is older than its child, so the path descends.
        (1..=self.len()).rev().find(|revision| path.binary_search_by(|on| revision.cmp(on)).is_err())
    }

    /// Returns the number of revisions.
    pub fn len(&self) -> usize {
        self.revisions.len()
    }

    /// Returns `true` if there was never an edit.
    pub fn is_empty(&self) -> bool {
        self.revisions.is_empty()
    }

    /// Returns `true` if the file has the current document.
    pub fn is_saved(&self) -> bool {
        self.saved == Some(self.at)
    }

    /// Notes that the file has the current document.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.at);
    }

    /// Notes that the file is gone or has other contents.
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Makes `after` the document, as one revision; `None` if that changes nothing.
    pub fn commit(&mut self, label: impl Into<String>, after: PlanDocument) -> Option<&Revision> {
        let change = Change::between(&self.document, &after)?;
        self.document = after;
        self.revisions.push(Revision { parent: self.at, change, label: label.into() });
        self.next[self.at] = Some(self.revisions.len());
        self.next.push(None);
        self.at = self.revisions.len();
        self.revisions.last()
    }

    /// Applies an earlier change. If it does not fit, nothing happens and the result is `None`.
    pub(super) fn commit_change(&mut self, label: impl Into<String>, change: &Change) -> Option<&Revision> {
        let after = change.apply(&self.document)?;
        self.commit(label, after)
    }

    /// Undoes the last edit and returns its label.
    pub fn undo(&mut self) -> Option<&str> {
        let revision = self.revisions.get(self.at.checked_sub(1)?)?;
        self.document = revision.change.inverse().apply(&self.document)?;
        self.next[revision.parent] = Some(self.at);
        self.at = revision.parent;
        Some(&revision.label)
    }

    /// Repeats the edit that was undone last and returns its label.
    pub fn redo(&mut self) -> Option<&str> {
        let index = (*self.next.get(self.at)?)?;
        let revision = self.revisions.get(index - 1)?;
        self.document = revision.change.apply(&self.document)?;
        self.at = index;
        Some(&revision.label)
    }

    /// Returns the revisions from this one back to the opened document.
    fn path(&self, mut at: usize) -> Vec<usize> {
        let mut path = vec![at];
        while let Some(parent) = at.checked_sub(1).map(|index| self.revisions[index].parent) {
            path.push(parent);
            at = parent;
        }
        path
    }

    /// Returns a history with only the newest revisions for which there is room, and the new number of every
    /// revision. The edits before them become one, so that the document in the file stays known.
    pub(super) fn newest(
        &self,
        room: usize,
        size: impl Fn(&Revision) -> usize,
    ) -> (Self, Vec<Option<usize>>) {
        let sizes: Vec<usize> = self.revisions.iter().map(size).collect();
        let mut behind: usize = sizes.iter().sum();
        if behind <= room {
            return (self.clone(), (0..=self.len()).map(Some).collect());
        }
        // The first revision on the path to the current one after which all revisions have room.
        let way = self.path(self.at);
        let mut counted = 0;
        let first = way.iter().rev().copied().find(|&revision| {
            behind -= sizes[counted..revision].iter().sum::<usize>();
            counted = revision;
            behind <= room
        });
        let first = first.unwrap_or(self.at);
        let mut at_first = self.clone();
        at_first.go_to(first);
        let is_saved_behind =
            first < self.at && self.saved.is_some_and(|saved| self.path(saved).contains(&first));
        let base = if is_saved_behind { Some(at_first.document.clone()) } else { self.saved_document() };
        let base = base.unwrap_or_else(|| self.base.clone());
        let mut newest = Self::new(base, self.saved.is_some() && !is_saved_behind);
        let mut numbers = vec![None; self.len() + 1];
        if let Some(saved) = self.saved {
            numbers[saved] = Some(0);
        }
        newest.commit("earlier edits", at_first.document);
        numbers[first] = Some(newest.at);
        let mut left = room;
        for (number, revision) in (1..).zip(&self.revisions).skip(first) {
            let Some(parent) = numbers[revision.parent] else { continue };
            let Some(rest) = left.checked_sub(sizes[number - 1]) else { continue };
            if newest.at != parent {
                newest.go_to(parent);
            }
            if newest.commit_change(revision.label.clone(), &revision.change).is_some() {
                left = rest;
                numbers[number] = Some(newest.at);
            }
        }
        if is_saved_behind {
            newest.saved = self.saved.and_then(|saved| numbers[saved]);
        }
        newest.go_to(numbers[self.at].unwrap_or_default());
        (newest, numbers)
    }

    /// Goes to a revision anywhere in the tree. Returns `false` if there is no such revision.
    pub fn go_to(&mut self, revision: usize) -> bool {
        if revision > self.revisions.len() {
            return false;
        }
        let (here, there) = (self.path(self.at), self.path(revision));
        let common = here.iter().rev().zip(there.iter().rev()).take_while(|(a, b)| a == b).count();
        for _ in 0..here.len() - common {
            self.undo();
        }
        for &step in there[..there.len() - common].iter().rev() {
            self.next[self.at] = Some(step);
            self.redo();
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Waypoint;
    use crate::plan::record::WaypointRecord;
    use proptest::prelude::*;

    fn named(name: &str) -> PlanDocument {
        PlanDocument { name: name.to_owned(), ..PlanDocument::default() }
    }

    #[test]
    fn an_edit_after_undo_keeps_the_other_branch() {
        let mut history = History::new(named("0"), true);
        history.commit("a", named("a"));
        history.undo();
        history.commit("b", named("b"));
        assert_eq!(history.undo(), Some("b"));
        assert_eq!(history.redo(), Some("b"), "redo follows the newest");
        assert_eq!(history.newest_beside(), Some(1));
        let names = (0..4).map(|revision| history.document_at(revision).map(|document| document.name));
        assert_eq!(
            names.collect::<Vec<_>>(),
            [Some("0"), Some("a"), Some("b"), None].map(|name| name.map(str::to_owned))
        );
        assert_eq!((history.label(0), history.label(1), history.label(2)), (None, Some("a"), Some("b")));
        assert!(history.go_to(1));
        assert_eq!(history.document().name, "a");
        assert!(!history.go_to(3));
    }

    #[test]
    fn an_edit_that_changes_nothing_is_none() {
        let mut history = History::new(named("0"), true);
        assert!(history.commit("same", named("0")).is_none() && history.is_empty() && history.is_saved());
        history.commit("a", named("a"));
        assert!(!history.is_saved());
        history.undo();
        assert!(history.is_saved(), "back at what the file holds");
    }

    proptest! {
        #[test]
        fn the_newest_edits_alone_lead_to_the_same_documents(
            steps in prop::collection::vec((0_u8..5, 0_i32..50), 1..40),
            room in 0_usize..40,
        ) {
            let mut history = History::new(named("base"), true);
            for (kind, number) in steps {
                match kind {
                    0 => history.mark_saved(),
                    1 => {
                        history.go_to(number as usize % (history.len() + 1));
                    }
                    _ => {
                        history.commit("edit", named(&number.to_string()));
                    }
                }
            }
            let document_at = |history: &History, revision| {
                let mut history = history.clone();
                history.go_to(revision).then_some(history.document)
            };
            let (newest, numbers) = history.newest(room, |_| 1);
            prop_assert_eq!(newest.document(), history.document());
            prop_assert_eq!(newest.saved_document(), history.saved_document());
            prop_assert!(newest.len() <= room + 1);
            prop_assert_eq!(numbers.len(), history.len() + 1);
            prop_assert_eq!(numbers[history.at()].map(|at| document_at(&newest, at)), Some(Some(history.document.clone())));
            for (revision, number) in numbers.iter().enumerate() {
                if let Some(number) = *number {
                    prop_assert_eq!(document_at(&newest, number), document_at(&history, revision));
                }
            }
            if history.len() <= room {
                prop_assert_eq!(newest, history);
            }
        }

        #[test]
        fn undo_and_redo_walk_through_the_same_documents(
            lists in prop::collection::vec(prop::collection::vec(0_i32..4, 0..8), 1..12),
        ) {
            let mut history = History::new(PlanDocument::default(), true);
            let mut seen = vec![history.document().clone()];
            for list in lists {
                let mut document = history.document().clone();
                document.plan.waypoints =
                    list.iter().map(|&alt_cm| Waypoint::from(WaypointRecord { alt_cm, ..Default::default() })).collect();
                if history.commit("edit", document.clone()).is_some() {
                    seen.push(document);
                }
            }
            for document in seen.iter().rev() {
                prop_assert_eq!(history.document(), document);
                history.undo();
            }
            for document in &seen {
                prop_assert_eq!(history.document(), document);
                history.redo();
            }
            for (revision, document) in seen.iter().enumerate() {
                prop_assert!(history.go_to(revision));
                prop_assert_eq!(history.document(), document);
            }
        }
    }
}
