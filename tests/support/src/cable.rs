//! A pseudo-terminal pair as a USB cable. The program opens a device file, which keeps its name while the cable is
//! pulled out and plugged in again.

use std::fs::File;
use std::io::{ErrorKind, Read as _, Write as _};
use std::path::PathBuf;

use rustix::fs::{OFlags, fcntl_setfl};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

/// A cable whose far end is held by the test.
#[derive(Debug)]
pub struct Cable {
    directory: tempfile::TempDir,
    far_end: Option<File>,
}

impl Cable {
    /// Returns a cable that is not plugged in.
    pub fn unplugged() -> Self {
        Self { directory: tempfile::tempdir().expect("a directory"), far_end: None }
    }

    /// Returns the path of the device file.
    pub fn device(&self) -> PathBuf {
        self.directory.path().join("ttyACM0")
    }

    /// Plugs the cable in, which creates the device file.
    pub fn plug_in(&mut self) {
        let far_end = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)
            .expect("a pseudo-terminal");
        grantpt(&far_end).expect("a pseudo-terminal");
        unlockpt(&far_end).expect("a pseudo-terminal");
        let name = ptsname(&far_end, Vec::new())
            .expect("a pseudo-terminal")
            .into_string()
            .expect("a pseudo-terminal");
        fcntl_setfl(&far_end, OFlags::NONBLOCK).expect("a pseudo-terminal");
        std::os::unix::fs::symlink(name, self.device()).expect("a pseudo-terminal");
        self.far_end = Some(far_end.into());
    }

    /// Pulls the cable out: the device file is gone, and a program that has it open notices.
    pub fn pull(&mut self) {
        std::fs::remove_file(self.device()).expect("a pseudo-terminal");
        self.far_end = None;
    }

    /// Returns the bytes that have arrived since the last call. There are none while no program has the device open.
    pub fn received(&mut self) -> Vec<u8> {
        let Some(far_end) = &mut self.far_end else { return Vec::new() };
        let mut bytes = [0; 4096];
        match far_end.read(&mut bytes) {
            Ok(count) => bytes[..count].to_vec(),
            // The system reports "input/output error" while the device is closed.
            Err(_) => Vec::new(),
        }
    }

    /// Sends bytes and returns those that the line does not take now.
    pub fn send<'a>(&mut self, bytes: &'a [u8]) -> &'a [u8] {
        let Some(far_end) = &mut self.far_end else { return &[] };
        match far_end.write(bytes) {
            Ok(count) => &bytes[count..],
            Err(error) if error.kind() == ErrorKind::WouldBlock => bytes,
            Err(error) => panic!("{error}"),
        }
    }
}
