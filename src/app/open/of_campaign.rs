//! A flight of a campaign: `betadeck open RUN.jsonl:1234`.

use super::Opened;
use crate::args::OpenArgs;
use crate::headless::campaign::{Consent, OneFlight, open_flight};
use crate::process::error::AppError;

/// A flight as it was flown in a campaign.
pub(super) struct FlownInCampaign {
    name: String,
    hash: u64,
}

impl FlownInCampaign {
    /// Returns the notice that the flight is the same, or that it is not.
    pub(super) fn compared(&self, hash: u64) -> String {
        let name = &self.name;
        if hash == self.hash {
            return format!("This is {name}, the same to the last bit.");
        }
        format!(
            "This is not quite {name}: its hash is {hash:016x}, and {:016x} was flown. Another version, or other files of the \
             terrain, may be the cause.",
            self.hash
        )
    }
}

/// Reads the flight of a campaign; `None` if the options name a scenario.
pub(super) fn read(args: &OpenArgs) -> Result<Option<Opened>, AppError> {
    let consent = Consent { firmware: args.firmware.firmware.as_ref(), yes: args.firmware.link.yes };
    let Some(OneFlight { flight, name, firmware, record }) = open_flight(&args.scenario, consent)? else {
        return Ok(None);
    };
    let given = [
        ("--case", args.case.is_some()),
        ("--seed", args.seed.is_some()),
        ("--firmware", args.firmware.firmware.is_some() && firmware.is_none()),
    ];
    if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
        return Err(AppError::input(format!(
            "{option} has no meaning here: {} has the case, the seed and the firmware of its flights",
            args.scenario
        )));
    }
    if let Some(problem) = flight.problem {
        return Err(AppError::input(format!("{}: {problem}", args.scenario)));
    }
    let wanted = FlownInCampaign { name: format!("flight {} of {name}", flight.number), hash: record.hash };
    let name = format!("Flight {} of campaign {name}", flight.number);
    Ok(Some(Opened { case: flight.case, air: flight.air, name, firmware, wanted: Some(wanted) }))
}
