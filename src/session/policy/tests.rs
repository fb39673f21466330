use super::*;
use crate::fc::NOT_PERMITTED;
use crate::plan::FlightPlan;
use crate::session::ReplyTo;
use crate::signals::RcFrame;
use crate::sim::WorldCommand;
use crate::telemetry::InFlightCommand;

const ALL: [Intent; 17] = [
    Intent::Read,
    Intent::Time,
    Intent::Recording,
    Intent::FlyOn,
    Intent::Fly,
    Intent::Move,
    Intent::Order,
    Intent::Reset,
    Intent::World,
    Intent::Upload,
    Intent::Download,
    Intent::Save,
    Intent::Line(Impact::Reads),
    Intent::Line(Impact::Changes),
    Intent::Line(Impact::Forbidden(NOTHING_MOVES)),
    Intent::Forecast,
    Intent::FlyAhead,
];

const EMBEDDED: Facts = Facts {
    access: Access::Everything,
    remote: None,
    simulator: None,
    upload: None,
    is_piloted: false,
    is_recorded: true,
    cannot_continue: false,
    has_ended: false,
    is_rewound: false,
    is_replay: false,
};
const REMOTE: Facts = Facts {
    remote: Some(RemoteFacts {
        is_ready: true,
        has_plans: true,
        knows_settings: false,
        opens_cli: false,
        is_in_steps: false,
    }),
    is_recorded: false,
    ..EMBEDDED
};

/// Returns the refused intents with the sentences.
fn refused(facts: &Facts) -> Vec<(Intent, String)> {
    let refusal = |intent| check(facts, intent).err().map(|refusal| (intent, refusal.to_string()));
    ALL.into_iter().filter_map(refusal).collect()
}

fn table(rows: &[(Intent, &str)]) -> Vec<(Intent, String)> {
    rows.iter().map(|(intent, sentence)| (*intent, (*sentence).to_owned())).collect()
}

#[test]
fn an_embedded_craft_is_free() {
    assert_eq!(refused(&EMBEDDED), []);
}

#[test]
fn an_earlier_instant_is_only_read() {
    let rewound = Facts { is_rewound: true, ..EMBEDDED };
    let refused: Vec<Intent> = refused(&rewound)
        .into_iter()
        .map(|(intent, sentence)| {
            assert_eq!(sentence, REWOUND);
            intent
        })
        .collect();
    assert_eq!(refused, [&ALL[4..12], &ALL[13..15]].concat());
}

#[test]
fn of_a_flight_whose_firmware_has_ended_only_the_recording_is_left() {
    let ended = Facts { cannot_continue: true, has_ended: true, ..EMBEDDED };
    for (is_rewound, time) in [(false, Err(Refusal::Now(FIRMWARE_ENDED))), (true, Ok(()))] {
        let ended = Facts { is_rewound, ..ended };
        assert_eq!(check(&ended, Intent::Time), time);
        assert_eq!(check(&ended, Intent::Recording), Ok(()));
        assert_eq!(check(&ended, Intent::Fly), Err(Refusal::Now(FIRMWARE_ENDED)));
    }
}

#[test]
fn a_recorded_flight_is_only_looked_at() {
    for is_rewound in [false, true] {
        let recorded = Facts { is_replay: true, is_rewound, ..EMBEDDED };
        let looks = [Intent::Read, Intent::Time, Intent::Recording];
        for intent in ALL {
            let expected = if looks.contains(&intent) { Ok(()) } else { Err(Refusal::Now(RECORDED)) };
            assert_eq!(check(&recorded, intent), expected, "{intent:?}");
        }
        assert_eq!(check(&recorded, Intent::OtherFlight), Ok(()));
    }
    assert_eq!(check(&EMBEDDED, Intent::OtherFlight), Err(Refusal::Now(NO_FILE)));
}

#[test]
fn an_external_simulator_keeps_time_and_place_to_itself() {
    let silent = Facts { simulator: Some(LinkState::Silent), is_recorded: false, ..EMBEDDED };
    let time = [
        (Intent::Time, TIME_IS_EXTERNAL),
        (Intent::Recording, TIME_IS_EXTERNAL),
        (Intent::FlyOn, TIME_IS_EXTERNAL),
        (Intent::Forecast, PHYSICS_IS_EXTERNAL),
        (Intent::FlyAhead, PHYSICS_IS_EXTERNAL),
    ];
    assert_eq!(refused(&silent), table(&time));
    let flowing = Facts { simulator: Some(LinkState::Flowing), ..silent };
    assert_eq!(check(&flowing, Intent::Reset), Err(Refusal::Now(PLACE_IS_EXTERNAL)));
}

#[test]
fn a_remote_flight_controller_of_a_simulated_craft_keeps_its_time() {
    let always = [
        (Intent::Time, TIME_IS_THE_FIRMWARES),
        (Intent::Recording, NOT_RECORDED),
        (Intent::FlyOn, NOT_RECORDED),
        (Intent::Order, NO_ORDERS),
        (Intent::Forecast, SETTINGS_UNKNOWN),
        (Intent::FlyAhead, CONTROLLER_IS_REMOTE),
    ];
    assert_eq!(refused(&REMOTE), table(&always));
    let in_steps = REMOTE.remote.map(|remote| RemoteFacts { is_in_steps: true, ..remote });
    // In simulated time the session sets its time.
    assert_eq!(refused(&Facts { remote: in_steps, ..REMOTE }), table(&always[1..]));
    // Its flight is recorded as pictures.
    let pictures = Facts { remote: in_steps, is_recorded: true, cannot_continue: true, ..REMOTE };
    assert_eq!(check(&pictures, Intent::Recording), Ok(()));
    for intent in [Intent::FlyOn, Intent::FlyAhead] {
        assert_eq!(check(&pictures, intent), Err(Refusal::Now(NOT_FLOWN_AGAIN)));
        assert_eq!(check(&Facts { cannot_continue: false, ..pictures }, intent), Ok(()));
    }
    let known = REMOTE.remote.map(|remote| RemoteFacts { knows_settings: true, ..remote });
    assert_eq!(
        check(&Facts { remote: known, ..REMOTE }, Intent::Forecast),
        Ok(()),
        "flown by the embedded one"
    );
    let remote = |is_ready, has_plans| Facts {
        remote: REMOTE.remote.map(|remote| RemoteFacts { is_ready, has_plans, ..remote }),
        ..REMOTE
    };
    assert_eq!(check(&remote(false, false), Intent::Fly), Err(Refusal::Now(NOT_KNOWN_YET)));
    assert_eq!(check(&remote(false, false), Intent::Upload), Ok(()));
    for intent in [Intent::Fly, Intent::Upload, Intent::Download] {
        assert_eq!(check(&remote(true, false), intent), Err(Refusal::Now(NO_PLANS)));
    }
}

#[test]
fn a_real_craft_is_read_and_changed_with_permission() {
    let reading = Facts { access: Access::Reading, ..REMOTE };
    let never = [
        (Intent::Time, TIME_IS_THE_FIRMWARES),
        (Intent::Recording, NOT_RECORDED),
        (Intent::FlyOn, NOT_RECORDED),
        (Intent::Fly, NOTHING_MOVES),
        (Intent::Move, NOTHING_MOVES),
        (Intent::Order, NOTHING_MOVES),
        (Intent::Reset, NOTHING_SIMULATED),
        (Intent::World, NOTHING_SIMULATED),
        (Intent::Line(Impact::Forbidden(NOTHING_MOVES)), NOTHING_MOVES),
        (Intent::Forecast, SETTINGS_UNKNOWN),
        (Intent::FlyAhead, CONTROLLER_IS_REMOTE),
    ];
    assert_eq!(refused(&Facts { access: Access::Changing, ..REMOTE }), table(&never));
    let unpermitted = [Intent::Upload, Intent::Save, Intent::Line(Impact::Changes)];
    for intent in unpermitted {
        assert_eq!(check(&reading, intent).unwrap_err().to_string(), NOT_PERMITTED);
    }
    assert_eq!(refused(&reading).len(), never.len() + unpermitted.len());
    let opens = REMOTE.remote.map(|remote| RemoteFacts { opens_cli: true, ..remote });
    let opening = Facts { remote: opens, ..reading };
    for intent in [Intent::Download, Intent::Line(Impact::Reads)] {
        assert_eq!(check(&opening, intent), Err(Refusal::Access(Denial::NotPermitted)));
    }
}

#[test]
fn one_upload_ends_before_the_next_and_before_a_flight() {
    let upload = Some(UploadView { sent: 3, total: 12 });
    let uploading = Facts { upload, ..EMBEDDED };
    let sentence = "An upload is under way, line 3 of 12: wait for its end.";
    assert_eq!(refused(&uploading), table(&[(Intent::Fly, sentence), (Intent::Upload, sentence)]));
    let piloted = Facts { is_piloted: true, ..uploading };
    assert_eq!(refused(&piloted), table(&[(Intent::Upload, sentence)]));
}

#[test]
fn the_intents_of_commands() {
    fn reply<T: Send + 'static>() -> ReplyTo<T> {
        ReplyTo::channel().0
    }
    let line = |line: &str| Command::Cli { line: line.to_owned(), reply: reply() };
    let (plan, settings) = (Box::<FlightPlan>::default(), Vec::new());
    for (command, intent) in [
        (line("get"), Intent::Line(Impact::Reads)),
        (line("save"), Intent::Line(Impact::Changes)),
        (line("motor 1 1500"), Intent::Line(Impact::Forbidden(NOTHING_MOVES))),
        (Command::Upload { name: String::new(), plan, settings, reply: reply() }, Intent::Upload),
        (Command::Save { reply: reply() }, Intent::Save),
        (Command::Download { reply: reply() }, Intent::Download),
        (Command::Vehicle(VehicleCommand::Sticks(RcFrame::SAFE)), Intent::Move),
        (Command::Vehicle(VehicleCommand::CutRc(true)), Intent::Move),
        (Command::StartPilot, Intent::Fly),
        (Command::Vehicle(VehicleCommand::ReturnHome), Intent::Move),
        (Command::Vehicle(VehicleCommand::CancelReturn), Intent::Move),
        (Command::Vehicle(VehicleCommand::InFlight(InFlightCommand::HoldHere)), Intent::Order),
        (Command::Vehicle(VehicleCommand::ResetCraft), Intent::Reset),
        (Command::World { change: Box::new(WorldCommand::ClearFaults), reply: reply() }, Intent::World),
        (Command::PermitChanges(1), Intent::Read),
        (Command::Quit, Intent::Read),
    ] {
        assert_eq!(Intent::of(&command), intent, "{command:?}");
    }
}
