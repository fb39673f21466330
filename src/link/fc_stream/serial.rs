//! A serial port, including one over USB.

use std::io::{self, ErrorKind};
use std::path::Path;

use rustix::io::Errno;
use serial2_tokio::SerialPort;

use super::reason;

/// Opens the port in raw mode with eight data bits, no parity and one stop bit.
///
/// # Errors
/// Returns the reason as part of a sentence.
pub(super) fn open(device: &Path, baud: u32) -> Result<SerialPort, String> {
    let port = SerialPort::open(device, baud).map_err(|error| refusal(device, baud, &error))?;
    // Without DTR the firmware's USB port is silent. A pseudo-terminal has no such line.
    let _only_on_real_ports = port.set_dtr(true);
    Ok(port)
}

/// Returns the reason why the port cannot be opened, and the remedy.
fn refusal(device: &Path, baud: u32, error: &io::Error) -> String {
    let name = device.display();
    let is = |errno: Errno| error.raw_os_error() == Some(errno.raw_os_error());
    match error.kind() {
        ErrorKind::NotFound => {
            let other = ports_here().map_or_else(String::new, |ports| format!(" (there is {ports})"));
            format!("there is no {name}: plug the cable in, or name another port{other}")
        }
        ErrorKind::PermissionDenied => format!(
            "{name} may not be opened by this user: join its group (`sudo usermod -aG dialout $USER`) and log in again"
        ),
        ErrorKind::ResourceBusy => format!("{name} is open in another program: close it there"),
        ErrorKind::InvalidInput => format!("{name} does not support {baud} bit/s: try 115200"),
        ErrorKind::IsADirectory => format!("{name} is a directory, not a serial port"),
        _ if is(Errno::NOTTY) => format!("{name} is not a serial port"),
        _ if is(Errno::NXIO) || is(Errno::NODEV) || is(Errno::IO) => {
            format!("nothing is connected to {name}: plug the cable in")
        }
        _ => format!("{name} cannot be opened: {}", reason(error)),
    }
}

/// Returns the names of the serial ports of this machine.
fn ports_here() -> Option<String> {
    let mut ports = SerialPort::available_ports().ok()?;
    ports.sort();
    let names: Vec<String> = ports.iter().map(|port| port.display().to_string()).collect();
    (!names.is_empty()).then(|| names.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_port_is_reported_in_a_sentence() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let directory = tempfile::tempdir().unwrap();
        for (path, part) in [
            (Path::new("/dev/no-such-port"), "there is no /dev/no-such-port: plug the cable in"),
            (file.path(), "is not a serial port"),
            (directory.path(), "is a directory"),
        ] {
            let reported = open(path, 115_200).expect_err("no port");
            assert!(reported.contains(part), "{reported}");
        }
        let denied = refusal(Path::new("/dev/ttyACM0"), 9600, &ErrorKind::PermissionDenied.into());
        assert!(denied.contains("usermod -aG dialout"), "{denied}");
    }
}
