//! The bytes of a file of logs.

use std::io;

/// A log file whose bytes can be read at any offset.
pub trait LogSource {
    /// Returns the number of bytes.
    fn size(&self) -> u64;

    /// Reads bytes at `offset` into `buffer` and returns their number: 0 only at the end of the file or for an empty buffer.
    ///
    /// # Errors
    ///
    /// Returns the error of the source.
    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize>;
}

impl LogSource for &[u8] {
    fn size(&self) -> u64 {
        self.len() as u64
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        let from = usize::try_from(offset).unwrap_or(usize::MAX).min(self.len());
        let count = buffer.len().min(self.len() - from);
        buffer[..count].copy_from_slice(&self[from..from + count]);
        Ok(count)
    }
}

impl<S: LogSource + ?Sized> LogSource for &mut S {
    fn size(&self) -> u64 {
        (**self).size()
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        (**self).read_at(offset, buffer)
    }
}
