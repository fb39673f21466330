//! The changes of settings: the values that wait for the craft, and the steps that can be undone.

use std::collections::VecDeque;

/// A setting with the value that it gets.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    pub name: String,
    pub value: String,
}

impl Assignment {
    /// Returns the line without `set `, as plans and files hold it.
    pub(in crate::ui) fn line(&self) -> String {
        format!("{} = {}", self.name, self.value)
    }
}

/// Values that are set together, and undone together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// A few words for sentences, such as `reset 3 settings`.
    pub label: String,
    pub assignments: Vec<Assignment>,
}

/// A value that was set, with the one before it and the profile to which both belong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) struct Done {
    pub(in crate::ui) name: String,
    pub(in crate::ui) profile: String,
    pub(in crate::ui) before: String,
    pub(in crate::ui) after: String,
}

/// A step that was carried out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::ui) struct DoneStep {
    pub(in crate::ui) label: String,
    pub(in crate::ui) values: Vec<Done>,
}

/// The values on their way to the craft, and the history.
#[derive(Debug, Default)]
pub(in crate::ui) struct Steps {
    /// The value that the craft sets now.
    running: Option<Assignment>,
    waiting: VecDeque<Assignment>,
    undo: Vec<DoneStep>,
    redo: Vec<DoneStep>,
    /// The number of values of the newest request that the craft has set.
    set: usize,
}

/// The most steps that can be undone.
const MAX_STEPS: usize = 1000;

impl Steps {
    pub(in crate::ui) fn pending(&self) -> usize {
        self.waiting.len() + usize::from(self.running.is_some())
    }

    pub(in crate::ui) fn is_pending(&self, name: &str) -> bool {
        self.running.iter().chain(&self.waiting).any(|assignment| assignment.name == name)
    }

    /// Queues the values of a step.
    pub(in crate::ui) fn queue(&mut self, values: impl IntoIterator<Item = Assignment>) {
        if self.pending() == 0 {
            self.set = 0;
        }
        self.waiting.extend(values);
    }

    /// Adds a step to the history. What was undone before cannot be redone any more.
    pub(in crate::ui) fn remember(&mut self, step: DoneStep) {
        self.redo.clear();
        self.push_undo(step);
    }

    fn push_undo(&mut self, step: DoneStep) {
        if self.undo.len() == MAX_STEPS {
            self.undo.remove(0);
        }
        self.undo.push(step);
    }

    /// Returns the newest step and moves it to those that can be redone, or the other way round.
    pub(in crate::ui) fn go_back(&mut self, redo: bool) -> Option<DoneStep> {
        let step = if redo { self.redo.pop() } else { self.undo.pop() }?;
        if redo {
            self.push_undo(step.clone());
        } else {
            self.redo.push(step.clone());
        }
        Some(step)
    }

    /// Puts a step that could not be undone or redone back.
    pub(in crate::ui) fn put_back(&mut self, redo: bool) {
        self.go_back(!redo);
    }

    /// Returns the next value to set, if the craft is free.
    pub(in crate::ui) fn next(&mut self) -> Option<Assignment> {
        if self.running.is_some() {
            return None;
        }
        self.running = self.waiting.pop_front();
        self.running.clone()
    }

    /// Takes the answer for the value that the craft was to set. Returns the value, and the number of values set since
    /// the craft was free.
    pub(in crate::ui) fn answered(&mut self, is_set: bool) -> Option<(Assignment, usize)> {
        let assignment = self.running.take()?;
        if is_set {
            self.set += 1;
        } else {
            self.forget(&assignment.name);
        }
        Some((assignment, self.set))
    }

    /// Gives up the values that the craft has not set. Returns their number.
    pub(in crate::ui) fn give_up(&mut self) -> usize {
        let given_up: Vec<Assignment> =
            self.running.take().into_iter().chain(self.waiting.drain(..)).collect();
        for assignment in &given_up {
            self.forget(&assignment.name);
        }
        given_up.len()
    }

    /// Removes a value that was not changed from the newest steps: there is nothing to undo.
    fn forget(&mut self, name: &str) {
        for step in self.undo.last_mut().into_iter().chain(self.redo.last_mut()) {
            step.values.retain(|done| done.name != name);
        }
        self.undo.retain(|step| !step.values.is_empty());
        self.redo.retain(|step| !step.values.is_empty());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assignment(name: &str) -> Assignment {
        Assignment { name: name.to_owned(), value: "1".to_owned() }
    }

    fn step(name: &str) -> DoneStep {
        let done = Done {
            name: name.to_owned(),
            profile: String::new(),
            before: "0".to_owned(),
            after: "1".to_owned(),
        };
        DoneStep { label: name.to_owned(), values: vec![done] }
    }

    #[test]
    fn values_are_set_one_after_the_other() {
        let mut steps = Steps::default();
        steps.queue([assignment("a"), assignment("b")]);
        assert_eq!(steps.next(), Some(assignment("a")));
        assert_eq!((steps.next(), steps.pending()), (None, 2));
        assert_eq!(steps.answered(true), Some((assignment("a"), 1)));
        assert_eq!(steps.next(), Some(assignment("b")));
        assert_eq!(steps.answered(true), Some((assignment("b"), 2)));
        assert_eq!(steps.pending(), 0);
    }

    #[test]
    fn a_refused_value_leaves_the_history() {
        let mut steps = Steps::default();
        steps.remember(step("a"));
        steps.queue([assignment("a")]);
        steps.next();
        steps.answered(false);
        assert_eq!(steps.go_back(false), None);
    }

    #[test]
    fn undo_and_redo_walk_through_the_same_steps() {
        let mut steps = Steps::default();
        steps.remember(step("a"));
        steps.remember(step("b"));
        assert_eq!(steps.go_back(false), Some(step("b")));
        assert_eq!(steps.go_back(true), Some(step("b")));
        assert_eq!(steps.go_back(true), None);
        steps.go_back(false);
        steps.remember(step("c"));
        assert_eq!(steps.go_back(true), None, "another change came after the undo");
        assert_eq!(steps.go_back(false), Some(step("c")));
        assert_eq!(steps.go_back(false), Some(step("a")));
    }
}
