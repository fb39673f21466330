//! The child with the processes that it started. A script in place of the executable may have started it as a
//! separate process.

use std::io;
use std::process::{Child, ExitStatus};

#[cfg(unix)]
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions};

/// Returns `true` if the child has ended. Its process id stays reserved until [`reap`].
pub(super) fn has_ended(child: &mut Child) -> io::Result<bool> {
    #[cfg(unix)]
    {
        let Some(pid) = pid(child) else { return Ok(true) };
        let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
        let ended = rustix::io::retry_on_intr(|| rustix::process::waitid(WaitId::Pid(pid), options))?;
        Ok(ended.is_some())
    }
    #[cfg(not(unix))]
    Ok(child.try_wait()?.is_some())
}

/// Asks all processes of the group to end.
pub(super) fn ask_to_end(child: &Child) {
    #[cfg(unix)]
    signal(child, Signal::TERM);
    let _ = child;
}

/// Ends all remaining processes and returns the exit status of the child.
pub(super) fn reap(child: &mut Child) -> io::Result<ExitStatus> {
    #[cfg(unix)]
    signal(child, Signal::KILL);
    #[cfg(not(unix))]
    child.kill()?;
    child.wait()
}

#[cfg(unix)]
fn signal(child: &Child, signal: Signal) {
    if let Some(pid) = pid(child) {
        // They may have ended by themselves in the meantime.
        let _gone = rustix::process::kill_process_group(pid, signal);
    }
}

#[cfg(unix)]
fn pid(child: &Child) -> Option<Pid> {
    Pid::from_raw(child.id() as i32)
}
