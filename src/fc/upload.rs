//! Uploads a plan to a remote flight controller through the command line, as a ground station does, and reads it back.
//! Downloads a plan in the same way.

use crate::firmware::cli::{CliReply, RefusedLine};
use crate::flight::setup::replaced_reported;
use crate::plan::format::{self, Format};
use crate::plan::{AltitudeError, AltitudeReference, CraftPlan, FlightPlan, upload_lines};
use crate::vehicle::{Answer, Ticket, Vehicle, VehicleCommand};

/// The result of an upload.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct UploadReport {
    /// The value added to every altitude, m, because the craft's altitudes are not above home.
    pub added_m: f64,
    /// The settings that replaced the guide's, because the craft falls in LAND with them.
    pub replaced: Vec<String>,
    /// The settings of the plan that a remote firmware does not know or accept, with its answer.
    pub refused: Vec<String>,
}

impl UploadReport {
    /// Returns the conversion of altitudes as a sentence; `None` if there was none.
    pub fn conversion(&self) -> Option<String> {
        let added_m = self.added_m;
        (added_m != 0.0).then(|| {
            format!("Its firmware counts altitudes from sea level: home's {added_m} m were added to each.")
        })
    }

    /// Returns notices for the user, as sentences; `None` if the craft stores exactly the plan as sent.
    pub fn remark(&self) -> Option<String> {
        let refused = (!self.refused.is_empty()).then(|| {
            format!(
                "Its firmware refused {} of the settings: {}.",
                self.refused.len(),
                self.refused.join("; ")
            )
        });
        let sentences: Vec<String> =
            self.conversion().into_iter().chain(replaced_reported(&self.replaced)).chain(refused).collect();
        (!sentences.is_empty()).then(|| sentences.join(" "))
    }
}

/// The line that prints the plan in the craft.
pub const LIST: &str = "waypoint list";

/// Returns the plan in an answer to [`LIST`], with the craft's own altitudes.
///
/// # Errors
/// Returns a sentence if the answer is no plan.
pub fn plan_of_list(reply: &CliReply) -> Result<CraftPlan, String> {
    if reply.failed {
        return Err(format!("the craft refused `{LIST}`: {}", reply.text.trim()));
    }
    // Some releases print nothing if there is no plan.
    if reply.text.trim().is_empty() {
        return Ok(CraftPlan::default());
    }
    let file = format::parse("the craft", &reply.text, Format::CliText).map_err(|errors| {
        errors.first().map_or_else(String::new, |error| format!("the craft's plan cannot be read: {error}"))
    })?;
    Ok(CraftPlan { records: file.plan.records() })
}

/// Returns the plan in an answer to [`LIST`], with altitudes above home.
///
/// # Errors
/// Returns a sentence if the answer is no plan, or if the reference of its altitudes is unknown.
pub fn plan_above_home(reply: &CliReply, reference: AltitudeReference) -> Result<FlightPlan, String> {
    let plan = plan_of_list(reply)?;
    reference.plan_of_craft(&plan).map_err(|unknown| unknown.to_string())
}

/// The refusal of lines to an embedded flight controller.
const NOT_REMOTE: &str = "only a remote flight controller gets a plan as lines";

/// An upload to a remote flight controller in progress.
#[derive(Debug)]
pub struct Upload {
    /// The plan that the craft must store.
    plan: CraftPlan,
    report: UploadReport,
    /// The lines that were not sent yet.
    lines: std::vec::IntoIter<String>,
    total: usize,
    /// The last line sent.
    sent: String,
}

/// The progress of an upload, in lines of the command line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct UploadView {
    /// The number of lines sent.
    pub sent: usize,
    /// The total number of lines, including those that read the plan back.
    pub total: usize,
}

/// The progress of an upload.
#[derive(Debug)]
pub enum UploadProgress {
    /// The upload is finished, or was refused with this sentence. Lines before the refusal keep their effect.
    Done(Result<UploadReport, String>),
    /// The upload continues with the answer to the last line, which comes with this ticket.
    Waiting(Ticket),
}

impl Upload {
    /// Creates an upload to a craft with this altitude reference.
    ///
    /// # Errors
    /// Returns an error if the reference is unknown, or if it is sea level and the altitude of home is unknown.
    pub fn new(
        plan: &FlightPlan,
        settings: &[String],
        reference: AltitudeReference,
    ) -> Result<Self, AltitudeError> {
        let plan = reference.plan_for_craft(plan)?;
        let lines: Vec<String> =
            upload_lines(plan.records.clone(), settings).chain([LIST.to_owned()]).collect();
        Ok(Self {
            plan,
            report: UploadReport { added_m: reference.added_m()?, ..UploadReport::default() },
            total: lines.len(),
            lines: lines.into_iter(),
            sent: String::new(),
        })
    }

    /// Adds these settings, which replace the guide's, to the report.
    pub fn report_replaced(&mut self, settings: Vec<String>) {
        self.report.replaced = settings;
    }

    /// Returns the number of lines sent and the total. Both include the line that reads the plan back.
    pub fn lines_sent(&self) -> UploadView {
        UploadView { sent: self.total - self.lines.len(), total: self.total }
    }

    /// Sends the next line.
    pub fn send_line(&mut self, vehicle: &mut Vehicle) -> UploadProgress {
        let Some(line) = self.lines.next() else { return UploadProgress::Done(Ok(self.report.clone())) };
        self.sent = line;
        match vehicle.apply(&VehicleCommand::single_line(&self.sent)) {
            Answer::Later(ticket) => UploadProgress::Waiting(ticket),
            Answer::Now(_) => UploadProgress::Done(Err(NOT_REMOTE.to_owned())),
        }
    }

    /// Takes the answer to the last line and continues.
    pub fn take_answer(&mut self, reply: &CliReply, vehicle: &mut Vehicle) -> UploadProgress {
        match reply.failed {
            _ if self.is_last() => self.read_back(reply),
            // Another version has other settings. The plan can be flown all the same.
            true if let Some(setting) = self.sent.strip_prefix("set ") => {
                self.report.refused.push(format!("{setting} ({})", complaint(&reply.text)));
                self.send_line(vehicle)
            }
            true => self.refused(reply),
            false => self.send_line(vehicle),
        }
    }

    /// Returns `true` if the last line sent reads the plan back.
    fn is_last(&self) -> bool {
        self.lines.as_slice().is_empty()
    }

    /// Compares the stored plan with the plan sent.
    fn read_back(&self, reply: &CliReply) -> UploadProgress {
        UploadProgress::Done(plan_of_list(reply).and_then(|held| {
            if held == self.plan {
                return Ok(self.report.clone());
            }
            let (sent, held) = (&self.plan.records, &held.records);
            let differs = std::iter::zip(sent, held).position(|(sent, held)| sent != held);
            Err(match differs {
                Some(index) => {
                    format!("waypoint {index} on the craft differs from the one sent: upload again")
                }
                None => format!(
                    "the craft holds {} waypoints, {} were sent: upload again",
                    held.len(),
                    sent.len()
                ),
            })
        }))
    }

    fn refused(&self, reply: &CliReply) -> UploadProgress {
        let refused = RefusedLine { line: self.sent.clone(), reply: reply.text.trim().to_owned() };
        UploadProgress::Done(Err(refused.to_string()))
    }
}

/// Returns the words of a refusal's first line, without the marks around them.
fn complaint(text: &str) -> String {
    let line = text.trim().lines().next().unwrap_or_default();
    let words =
        line.trim().trim_matches('#').trim_start_matches("ERROR IN set: ").trim_start_matches("ERROR: ");
    words.to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Waypoint, plan_lines};
    use crate::vehicle::RemoteRequest;

    /// Returns the new requests to the remote flight controller.
    fn asked(vehicle: &mut Vehicle) -> Vec<String> {
        let mailbox = vehicle.remote_mut().unwrap();
        std::iter::from_fn(|| mailbox.take_request())
            .map(|(_, request)| match request {
                RemoteRequest::Cli(line) => line,
                other => panic!("{other:?}"),
            })
            .collect()
    }

    #[test]
    fn a_setting_that_another_version_does_not_take_is_reported_and_the_plan_uploaded() {
        let plan = FlightPlan { waypoints: std::iter::once(Waypoint::default()).collect() };
        let mut vehicle = Vehicle::elsewhere().unwrap();
        let settings = ["ap_position_cutoff = 5".to_owned()];
        let mut upload = Upload::new(&plan, &settings, AltitudeReference::Home).unwrap();
        let mut progress = upload.send_line(&mut vehicle);
        let text = "###ERROR IN set: INVALID VALUE###\r\nAllowed range: 10 - 50\r\n".to_owned();
        let list: String = plan_lines(&plan).map(|line| line + "\r\n").collect();
        for reply in [
            CliReply { text, failed: true, ..CliReply::default() },
            CliReply::default(),
            CliReply::default(),
            CliReply { text: list, ..CliReply::default() },
        ] {
            assert!(matches!(progress, UploadProgress::Waiting(_)), "{progress:?}");
            progress = upload.take_answer(&reply, &mut vehicle);
        }
        let UploadProgress::Done(Ok(report)) = progress else { panic!("{progress:?}") };
        assert_eq!(
            report.remark().unwrap(),
            "Its firmware refused 1 of the settings: ap_position_cutoff = 5 (invalid value)."
        );
    }

    #[test]
    fn a_craft_that_prints_nothing_has_no_plan() {
        assert_eq!(plan_of_list(&CliReply::default()), Ok(CraftPlan::default()));
        let refused = CliReply { failed: true, ..CliReply::default() };
        assert!(plan_of_list(&refused).is_err());
    }

    #[test]
    fn a_remote_flight_controller_gets_each_line_after_the_answer_to_the_one_before() {
        let plan = FlightPlan { waypoints: std::iter::once(Waypoint::default()).collect() };
        let lines = ["set ap_max_angle = 33", "waypoint clear", "waypoint insert", "waypoint list"];
        let (taken, refused) = (CliReply::default(), CliReply { failed: true, ..CliReply::default() });
        let list: String = plan_lines(&plan).map(|line| line + "\r\n").collect();
        let (held, lost) = (CliReply { text: list, ..CliReply::default() }, CliReply::default());
        for answers in [
            [&taken, &taken, &taken, &held],
            [&taken, &refused, &taken, &held],
            [&taken, &taken, &taken, &lost],
        ] {
            let mut vehicle = Vehicle::elsewhere().unwrap();
            let settings = ["ap_max_angle = 33".to_owned()];
            let mut upload = Upload::new(&plan, &settings, AltitudeReference::Home).unwrap();
            let mut progress = upload.send_line(&mut vehicle);
            for (line, answer) in std::iter::zip(lines, answers) {
                assert!(matches!(progress, UploadProgress::Waiting(_)), "{progress:?}");
                let asked = asked(&mut vehicle);
                assert!(asked.len() == 1 && asked[0].starts_with(line), "{asked:?}");
                progress = upload.take_answer(answer, &mut vehicle);
                if answer.failed {
                    break;
                }
            }
            let UploadProgress::Done(result) = progress else { panic!("{progress:?}") };
            assert_eq!(result.is_ok(), !answers[1].failed && !answers[3].text.is_empty(), "{result:?}");
            assert!(asked(&mut vehicle).is_empty());
        }
    }
}
