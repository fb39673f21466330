//! The flash memory for logs, as its owner keeps it and MSP reports it.

/// The size of the memory, bytes.
pub const FLASH_BYTES: usize = 16 << 20;
/// The size of a sector, bytes.
const SECTOR_BYTES: usize = 4096;
/// The number of sectors.
pub const FLASH_SECTORS: usize = FLASH_BYTES / SECTOR_BYTES;

/// The facts about the memory that messages report.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FlashFacts {
    /// `true` if the owner of the firmware keeps such a memory.
    pub is_present: bool,
    /// The bytes that are used.
    pub used: usize,
}

/// The memory: the logs one after the other, in as much space as they need.
#[derive(Debug, Clone, Default)]
pub struct Flash {
    bytes: Vec<u8>,
    /// `true` while the log under way fits.
    takes: bool,
}

impl Flash {
    /// Begins a log. Returns `false` if the memory is full.
    pub fn begin(&mut self) -> bool {
        self.takes = self.bytes.len() < FLASH_BYTES;
        self.takes
    }

    /// Adds to the log under way. What does not fit ends the log. Returns `false` if this call ended it.
    pub fn write(&mut self, bytes: &[u8]) -> bool {
        if !self.takes {
            return true;
        }
        self.takes = self.bytes.len() + bytes.len() <= FLASH_BYTES;
        if self.takes {
            self.bytes.extend_from_slice(bytes);
        }
        self.takes
    }

    /// Erases everything. The rest of a log under way is not kept.
    pub fn erase(&mut self) {
        *self = Self::default();
    }

    pub fn facts(&self) -> FlashFacts {
        FlashFacts { is_present: true, used: self.bytes.len() }
    }

    /// Returns at most `length` bytes at an address; fewer, or none, beyond the end.
    pub fn read(&self, address: usize, length: usize) -> &[u8] {
        let rest = self.bytes.get(address..).unwrap_or_default();
        rest.get(..length).unwrap_or(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_follow_each_other_and_reads_end_with_them() {
        let mut flash = Flash::default();
        assert!(flash.begin() && flash.write(b"one") && flash.begin() && flash.write(b"two"));
        assert_eq!(flash.facts(), FlashFacts { is_present: true, used: 6 });
        assert_eq!(flash.read(2, 3), b"etw");
        assert_eq!(flash.read(4, 4096), b"wo");
        assert_eq!(flash.read(6, 1), b"");
        assert_eq!(flash.read(usize::MAX, usize::MAX), b"");
    }

    #[test]
    fn a_full_memory_ends_the_log_and_stays_as_it_is() {
        let mut flash = Flash::default();
        assert!(flash.begin() && flash.write(&vec![1; FLASH_BYTES - 1]));
        assert!(!flash.write(b"two"), "it ends here");
        assert!(flash.write(b"1"), "it had ended before");
        assert_eq!(flash.facts().used, FLASH_BYTES - 1);
        assert!(flash.begin() && flash.write(b"1"));
        assert!(!flash.begin());
    }

    #[test]
    fn a_log_that_was_erased_does_not_go_on() {
        let mut flash = Flash::default();
        assert!(flash.begin() && flash.write(b"one"));
        flash.erase();
        assert!(flash.write(b"rest"));
        assert_eq!(flash.facts().used, 0);
    }
}
