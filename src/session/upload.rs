//! Uploads a plan as a ground station does: through the command line.

use crate::firmware::cli::Interpreter;
use crate::plan::{FlightPlan, upload_lines};
use crate::vehicle::{Answer, FlightController};

/// Stores `settings` and `plan` in the craft.
///
/// # Errors
/// The sentence of the first refusal; what came before it stays. A remote flight controller takes no plan this way.
pub fn upload(
    controller: &mut FlightController,
    plan: &FlightPlan,
    settings: &[String],
) -> Result<(), String> {
    let mut interpreter = Interpreter::default();
    for line in upload_lines(plan, settings) {
        let Answer::Now(reply) = controller.run_cli(&mut interpreter, &line) else {
            return Err("a remote flight controller takes no plan from here".to_owned());
        };
        if reply.failed {
            return Err(format!("the craft refused `{line}`: {}", reply.text.trim()));
        }
    }
    Ok(())
}
