//! The permitted actions on a remote craft: reading is always allowed, changes need permission once per
//! connection, and nothing may move it.

mod impact;

use std::fmt;

use crate::fc::client::{Answer, CliAccess, Unanswered};
pub use impact::Impact;

/// Refusal of an order that would move a remote craft.
pub const NOTHING_MOVES: &str =
    "This craft is real: its own transmitter arms it, flies it and runs its motors, not this program.";

/// Refusal to change the world of a remote craft.
pub const NOTHING_SIMULATED: &str =
    "Nothing is simulated here: this craft is real, and so are its position and the air.";

/// Refusal of a change that the user has not permitted.
pub const NOT_PERMITTED: &str =
    "Changes are not permitted over this connection: the command allow-changes permits them.";

/// The access to a remote flight controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Everything is allowed: its craft is simulated here.
    Everything,
    /// Only reading, until the user permits changes.
    Reading,
    /// Reading and changing, until the connection ends.
    Changing,
}

/// The reason for a refusal. `Display` gives a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Denial {
    /// The user has not permitted changes over this connection.
    NotPermitted,
    /// It is never allowed, with the reason as a sentence.
    Never(&'static str),
}

impl fmt::Display for Denial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotPermitted => NOT_PERMITTED,
            Self::Never(why) => why,
        })
    }
}

impl Access {
    /// Checks that an action with this impact is allowed.
    ///
    /// # Errors
    /// Returns the reason for the refusal.
    pub fn check(self, impact: Impact) -> Result<(), Denial> {
        match (self, impact) {
            (Self::Everything, _) | (_, Impact::Reads) | (Self::Changing, Impact::Changes) => Ok(()),
            (_, Impact::Forbidden(why)) => Err(Denial::Never(why)),
            (Self::Reading, Impact::Changes) => Err(Denial::NotPermitted),
        }
    }

    /// Returns `true` if the craft is real.
    pub fn is_limited(self) -> bool {
        self != Self::Everything
    }
}

/// The permission for the current connection.
#[derive(Debug, Clone, Default)]
pub(super) struct Permission {
    /// The number of the connection.
    connection: u32,
    may_change: bool,
    /// The results of lines so far.
    lines: Lines,
}

/// The results of the lines of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Lines {
    #[default]
    NoneYet,
    /// No line was answered: the craft is armed, or its command line has no framing.
    Closed,
    Work,
}

impl Permission {
    /// Begins a new connection, over which nothing is permitted yet.
    pub(super) fn connected(&mut self) {
        *self = Self { connection: self.connection + 1, ..Self::default() };
    }

    /// Ends the permission after the connection was lost.
    pub(super) fn lost(&mut self) {
        self.may_change = false;
    }

    /// Permits changes over a connection, if it is the current one.
    pub(super) fn permit(&mut self, connection: u32) {
        self.may_change |= connection == self.connection;
    }

    /// Records the result of a line.
    pub(super) fn line_answered(&mut self, answer: &Answer) {
        self.lines = match answer {
            Answer::Line { .. } => Lines::Work,
            Answer::NotAnswered(Unanswered::CliClosed) if self.lines == Lines::NoneYet => Lines::Closed,
            Answer::NotAnswered(_) | Answer::Msp(_) => self.lines,
        };
    }

    /// Tries lines again after the craft has disarmed: lines that failed in flight may work now.
    pub(super) fn try_lines_again(&mut self) {
        self.lines = Lines::NoneYet;
    }

    /// Returns the number of the connection.
    pub(super) fn connection(&self) -> u32 {
        self.connection
    }

    /// Returns `true` if a line would have to open the command line of a disarmed craft, which is itself a
    /// change.
    pub(super) fn opens_cli(&self) -> bool {
        self.lines == Lines::Closed
    }

    /// Returns the way in which lines reach the command line.
    pub(super) fn cli(&self) -> CliAccess {
        if self.opens_cli() && self.may_change { CliAccess::Interactive } else { CliAccess::Framed }
    }

    /// Returns the access to a real craft.
    pub(super) fn access(&self) -> Access {
        if self.may_change { Access::Changing } else { Access::Reading }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOVES: Impact = Impact::Forbidden(NOTHING_MOVES);

    #[test]
    fn a_permission_is_for_one_connection() {
        let mut permission = Permission::default();
        permission.connected();
        assert_eq!((permission.access(), permission.connection()), (Access::Reading, 1));
        permission.permit(1);
        assert_eq!(permission.access(), Access::Changing);
        permission.lost();
        assert_eq!(permission.access(), Access::Reading);
        permission.connected();
        permission.permit(1);
        assert_eq!(permission.access(), Access::Reading, "that was for the connection before");
        permission.permit(2);
        assert_eq!(permission.access(), Access::Changing);
    }

    #[test]
    fn the_prompt_is_opened_with_permission_only() {
        let mut permission = Permission::default();
        permission.connected();
        permission.line_answered(&Answer::NotAnswered(Unanswered::Silent));
        assert!(!permission.opens_cli(), "silence is no refusal");
        permission.line_answered(&Answer::NotAnswered(Unanswered::CliClosed));
        assert_eq!((permission.opens_cli(), permission.cli()), (true, CliAccess::Framed));
        permission.permit(1);
        assert_eq!(permission.cli(), CliAccess::Interactive);
        assert_eq!(Impact::from_line("get").or_changes(permission.opens_cli()), Impact::Changes);
        assert_eq!(Impact::from_line("motor 1 1500").or_changes(true), MOVES);
    }

    #[test]
    fn where_a_line_was_answered_the_prompt_stays_closed() {
        let mut permission = Permission::default();
        permission.connected();
        permission.permit(1);
        permission.line_answered(&Answer::Line { text: String::new(), failed: true, restarted: false });
        permission.line_answered(&Answer::NotAnswered(Unanswered::CliClosed));
        assert_eq!((permission.opens_cli(), permission.cli()), (false, CliAccess::Framed));
    }

    #[test]
    fn changes_wait_for_the_permission() {
        assert_eq!(Access::Reading.check(Impact::Reads), Ok(()));
        assert_eq!(Access::Reading.check(Impact::Changes), Err(Denial::NotPermitted));
        assert_eq!(Access::Changing.check(Impact::Changes), Ok(()));
    }
}
