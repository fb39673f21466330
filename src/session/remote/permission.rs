//! What may be done with a craft outside: reading is free, changes are permitted once a connection, nothing moves it.

mod impact;

use std::fmt;

use crate::link::proto::fc_client::{Answer, CliAccess, Unanswered};
pub use impact::Impact;

/// Why an order that would move a craft outside is not carried out.
pub const NOTHING_MOVES: &str =
    "This craft is real: it is armed, flown and its motors are turned by its own transmitter, not from here.";

/// Why the world of a craft outside cannot be changed.
pub const NOTHING_SIMULATED: &str =
    "Nothing is simulated here: this craft is real, and so are its place and its air.";

/// Why a change is not made that the user has not permitted.
pub const NOT_PERMITTED: &str =
    "Changes are not permitted over this connection: the command allow-changes permits them.";

/// What may be done with a flight controller outside.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// Everything: its craft is simulated here.
    Everything,
    /// Reading, until the user permits changes.
    Reading,
    /// Reading and changing, until the connection ends.
    Changing,
}

/// Why something is not done now. `Display` gives a sentence.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Denial {
    /// The user has not permitted changes over this connection.
    NotPermitted,
    /// It is never done: why, as a sentence.
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
    /// Whether something with this impact may be done.
    ///
    /// # Errors
    /// Why not.
    pub fn check(self, impact: Impact) -> Result<(), Denial> {
        match (self, impact) {
            (Self::Everything, _) | (_, Impact::Reads) | (Self::Changing, Impact::Changes) => Ok(()),
            (_, Impact::Forbidden(why)) => Err(Denial::Never(why)),
            (Self::Reading, Impact::Changes) => Err(Denial::NotPermitted),
        }
    }

    /// Whether the craft is real.
    pub fn is_limited(self) -> bool {
        self != Self::Everything
    }
}

/// What the user has permitted over the present connection.
#[derive(Debug, Default)]
pub(super) struct Permission {
    /// The number of the connection.
    connection: u32,
    may_change: bool,
    /// What became of lines so far.
    lines: Lines,
}

/// What became of the lines of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Lines {
    #[default]
    NoneYet,
    /// None was answered: the craft is armed, or its command line has no framing.
    Closed,
    Work,
}

impl Permission {
    /// There is a new connection, over which nothing is permitted yet.
    pub(super) fn connected(&mut self) {
        *self = Self { connection: self.connection + 1, ..Self::default() };
    }

    /// The connection is gone.
    pub(super) fn lost(&mut self) {
        self.may_change = false;
    }

    /// The user permits changes over a connection; one that is gone does not matter any more.
    pub(super) fn permit(&mut self, connection: u32) {
        self.may_change |= connection == self.connection;
    }

    /// Takes in what became of a line.
    pub(super) fn line_answered(&mut self, answer: &Answer) {
        self.lines = match answer {
            Answer::Line { .. } => Lines::Work,
            Answer::NotAnswered(Unanswered::CliClosed) if self.lines == Lines::NoneYet => Lines::Closed,
            Answer::NotAnswered(_) | Answer::Msp(_) => self.lines,
        };
    }

    /// The craft has disarmed: lines that were not answered in flight may be answered now.
    pub(super) fn try_lines_again(&mut self) {
        self.lines = Lines::NoneYet;
    }

    /// The number of the connection.
    pub(super) fn connection(&self) -> u32 {
        self.connection
    }

    /// Whether a line would have to open the command line of a disarmed craft, which is a change itself.
    pub(super) fn opens_cli(&self) -> bool {
        self.lines == Lines::Closed
    }

    /// How lines reach the command line.
    pub(super) fn cli(&self) -> CliAccess {
        if self.opens_cli() && self.may_change { CliAccess::Interactive } else { CliAccess::Framed }
    }

    /// What may be done with a real craft.
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
        assert_eq!(Impact::of_line("get").or_changes(permission.opens_cli()), Impact::Changes);
        assert_eq!(Impact::of_line("motor 1 1500").or_changes(true), MOVES);
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
