//! A file of blackbox logs as a source of bytes.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt as _;
use std::sync::Arc;

use crate::blackbox::FIRST_LINE;
use crate::blackbox::decode::LogSource;

/// Returns `true` if a blackbox log begins in these first bytes of a file.
pub(crate) fn has_log(head: &[u8]) -> bool {
    memchr::memmem::find(head, FIRST_LINE.as_bytes()).is_some()
}

/// An open file. Copies share it.
#[derive(Debug, Clone)]
pub(crate) struct FileSource {
    file: Arc<File>,
    size: u64,
}

impl FileSource {
    pub(crate) fn new(file: File, size: u64) -> Self {
        Self { file: Arc::new(file), size }
    }
}

impl LogSource for FileSource {
    fn size(&self) -> u64 {
        self.size
    }

    fn read_at(&mut self, offset: u64, buffer: &mut [u8]) -> io::Result<usize> {
        // A file that grows is shown as it was when it was opened.
        let most = usize::try_from(self.size.saturating_sub(offset)).unwrap_or(usize::MAX);
        let length = buffer.len().min(most);
        loop {
            match self.file.read_at(&mut buffer[..length], offset) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                read => return read,
            }
        }
    }
}
