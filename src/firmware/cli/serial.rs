//! `serial`: functions and speeds of the ports. The settings `msp_uart_*` control the MSP function.

use super::super::config::{BAUD_RATES, Configuration, SerialRow};
use super::foreign::keep_command;
use super::session::{Session, integer};

/// Returns `true` if one of the `msp_uart_*` settings assigns MSP to this port.
fn speaks_msp(configuration: &Configuration, port: i64) -> bool {
    (1..=3).any(|slot| configuration.settings.number(&format!("msp_uart_{slot}")) == port)
}

/// Formats the row of one port.
pub(super) fn serial_row(configuration: &Configuration, at: usize, row: &SerialRow) -> String {
    let port = at + 1;
    let functions = row.functions | u32::from(speaks_msp(configuration, port as i64));
    format!(
        "serial UART{port} {functions} {} {} {} {}",
        row.msp_baud, row.gps_baud, row.telemetry_baud, row.blackbox_baud
    )
}

/// `serial [<port> <functions> <msp> <gps> <telemetry> <blackbox>]`.
pub(super) fn serial(session: &mut Session<'_>, rest: &str) {
    let words: Vec<&str> = rest.split_ascii_whitespace().collect();
    if words.is_empty() {
        let rows = session.configuration.serial.0;
        for (at, row) in rows.iter().enumerate() {
            let line = serial_row(session.configuration, at, row);
            session.line(line);
        }
        return;
    }
    if session.refused_while_armed() {
        return;
    }
    let &[port, functions, msp, gps, telemetry, blackbox] = words.as_slice() else {
        session.wrong_count();
        return;
    };
    let numbers: Option<Vec<u32>> = [functions, msp, gps, telemetry, blackbox]
        .into_iter()
        .map(|word| integer(word).and_then(|number| u32::try_from(number).ok()))
        .collect();
    let Some(&[functions, msp_baud, gps_baud, telemetry_baud, blackbox_baud]) = numbers.as_deref() else {
        session.not_understood();
        return;
    };
    let number = port.to_ascii_uppercase().strip_prefix("UART").and_then(integer).unwrap_or(0);
    let Some(at) = usize::try_from(number - 1).ok().filter(|at| *at < session.configuration.serial.0.len())
    else {
        keep_command(session, &format!("serial {port}"), &format!("serial {rest}"));
        return;
    };
    let bauds = [msp_baud, gps_baud, telemetry_baud, blackbox_baud];
    if !bauds.iter().all(|baud| BAUD_RATES.contains(baud)) {
        session.not_understood();
        return;
    }
    let row = SerialRow { functions: functions & !1, msp_baud, gps_baud, telemetry_baud, blackbox_baud };
    if let Some(place) = session.configuration.serial.0.get_mut(at) {
        *place = row;
    }
    assign_msp(session.configuration, number, functions & 1 != 0);
    let line = serial_row(session.configuration, at, &row);
    session.line(line);
}

/// Turns MSP on a port on or off through the settings that control it.
fn assign_msp(configuration: &mut Configuration, port: i64, on: bool) {
    let already = speaks_msp(configuration, port);
    if on && already {
        return;
    }
    let wanted = if on { 0 } else { port };
    for slot in 1..=3 {
        let name = format!("msp_uart_{slot}");
        if configuration.settings.number(&name) == wanted {
            // Port numbers of this vehicle are always valid values.
            let _valid = configuration.settings.set_number(&name, if on { port } else { 0 });
            if on {
                return;
            }
        }
    }
}
