//! The child with the processes that it started: a script in place of the executable may have started that without becoming
//! it.

use std::io;
use std::process::{Child, ExitStatus};

#[cfg(unix)]
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions};

/// Whether the child has ended. Its number stays its own until [`reap`].
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

/// Asks all of them to end.
pub(super) fn ask_to_end(child: &Child) {
    #[cfg(unix)]
    signal(child, Signal::TERM);
    let _ = child;
}

/// Ends all that are left, and tells how the child ended.
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
        // They may have ended by themselves meanwhile.
        let _gone = rustix::process::kill_process_group(pid, signal);
    }
}

#[cfg(unix)]
fn pid(child: &Child) -> Option<Pid> {
    Pid::from_raw(child.id() as i32)
}
