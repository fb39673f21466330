//! Uploads a plan as a ground station does: through the command line.

use crate::firmware::Firmware;
use crate::firmware::cli::Interpreter;
use crate::plan::{FlightPlan, upload_lines};

/// Stores `settings` and `plan` in the craft.
///
/// # Errors
/// The sentence of the first refusal; what came before it stays.
pub fn upload(firmware: &mut Firmware, plan: &FlightPlan, settings: &[String]) -> Result<(), String> {
    let mut interpreter = Interpreter::default();
    for line in upload_lines(plan, settings) {
        let reply = firmware.run_cli(&mut interpreter, &line);
        if reply.failed {
            return Err(format!("the craft refused `{line}`: {}", reply.text.trim()));
        }
    }
    Ok(())
}
