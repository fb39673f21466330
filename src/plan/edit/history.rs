//! The history of a document: a tree of revisions, so that nothing that was ever edited is lost.

use super::{Change, PlanDocument};

/// A revision: what changed against its parent.
#[derive(Debug, Clone, PartialEq)]
pub struct Revision {
    parent: usize,
    change: Change,
    label: String,
}

impl Revision {
    /// The revision before it.
    pub(super) fn parent(&self) -> usize {
        self.parent
    }

    /// What was done, a few words.
    pub fn label(&self) -> &str {
        &self.label
    }

    pub fn change(&self) -> &Change {
        &self.change
    }
}

/// A document with its revisions. Revision 0 is the document as it was opened.
#[derive(Debug, Clone, PartialEq)]
pub struct History {
    base: PlanDocument,
    document: PlanDocument,
    /// Revision 1 and up.
    revisions: Vec<Revision>,
    at: usize,
    /// The revision that redo goes to from each revision.
    next: Vec<Option<usize>>,
    /// The revision that the file holds.
    saved: Option<usize>,
}

impl History {
    /// A document without a history; `is_saved` = a file holds it.
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

    /// The document as it is now.
    pub fn document(&self) -> &PlanDocument {
        &self.document
    }

    /// The document as it was opened.
    pub(super) fn base(&self) -> &PlanDocument {
        &self.base
    }

    pub(super) fn revisions(&self) -> &[Revision] {
        &self.revisions
    }

    pub(super) fn saved(&self) -> Option<usize> {
        self.saved
    }

    /// The document that the file holds, as far as the history knows.
    pub fn saved_document(&self) -> Option<PlanDocument> {
        let mut history = self.clone();
        if history.go_to(self.saved?) { Some(history.document) } else { None }
    }

    /// The revision that the document is at.
    pub fn at(&self) -> usize {
        self.at
    }

    /// How many revisions there are.
    pub fn len(&self) -> usize {
        self.revisions.len()
    }

    /// Whether nothing was ever edited.
    pub fn is_empty(&self) -> bool {
        self.revisions.is_empty()
    }

    /// Whether the file holds the document as it is now.
    pub fn is_saved(&self) -> bool {
        self.saved == Some(self.at)
    }

    /// The file holds the document as it is now.
    pub fn mark_saved(&mut self) {
        self.saved = Some(self.at);
    }

    /// The file is gone, or holds something else.
    pub fn mark_unsaved(&mut self) {
        self.saved = None;
    }

    /// Makes the document `after`, as one revision; `None` when that changes nothing.
    pub fn commit(&mut self, label: impl Into<String>, after: PlanDocument) -> Option<&Revision> {
        let change = Change::between(&self.document, &after)?;
        self.document = after;
        self.revisions.push(Revision { parent: self.at, change, label: label.into() });
        self.next[self.at] = Some(self.revisions.len());
        self.next.push(None);
        self.at = self.revisions.len();
        self.revisions.last()
    }

    /// Applies a change that was made before; `None`, and nothing happens, when it does not fit.
    pub(super) fn commit_change(&mut self, label: impl Into<String>, change: &Change) -> Option<&Revision> {
        let after = change.apply(&self.document)?;
        self.commit(label, after)
    }

    /// Takes the last edit back; gives its label.
    pub fn undo(&mut self) -> Option<&str> {
        let revision = self.revisions.get(self.at.checked_sub(1)?)?;
        self.document = revision.change.inverse().apply(&self.document)?;
        self.next[revision.parent] = Some(self.at);
        self.at = revision.parent;
        Some(&revision.label)
    }

    /// Makes the edit again that was taken back last; gives its label.
    pub fn redo(&mut self) -> Option<&str> {
        let index = (*self.next.get(self.at)?)?;
        let revision = self.revisions.get(index - 1)?;
        self.document = revision.change.apply(&self.document)?;
        self.at = index;
        Some(&revision.label)
    }

    /// The revisions from this one back to the document as it was opened.
    fn path(&self, mut at: usize) -> Vec<usize> {
        let mut path = vec![at];
        while let Some(parent) = at.checked_sub(1).map(|index| self.revisions[index].parent) {
            path.push(parent);
            at = parent;
        }
        path
    }

    /// This history with the newest revisions alone, as many as have room, and for every revision its number there.
    /// The edits before them become one, so that the document that the file holds stays known.
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
        // The first revision on the way to the present one behind which all have room.
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

    /// Goes to a revision, wherever in the tree it is; `false` when there is none of that number.
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
                    list.iter().map(|&alt_cm| Waypoint { alt_cm, ..Waypoint::default() }).collect();
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
