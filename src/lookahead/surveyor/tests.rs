use super::*;
use crate::campaign::{Campaign, CampaignFlight, Record, Side};
use crate::flight::FlightSetup;
use crate::flight::sweep::Fate;
use crate::plan::builtin::BuiltinPlan;
use crate::scenario::{BuiltinFiles, CaseFlight, Flights, MAX_FLIGHTS, Request, read_request};
use crate::sim::WorldCommand;
use crate::vehicle::VehicleCommand;

fn copy() -> VehicleCopy {
    let (vehicle, _) = FlightSetup::default().build().unwrap();
    VehicleCopy { vehicle: Box::new(vehicle), takeoff_m: 5.0, again: None }
}

/// Starts a thread. Returns its handle and its replies.
fn start() -> (Surveyor, mpsc::Receiver<SurveyReply>) {
    let (answers, answered) = mpsc::channel();
    (Surveyor::start(move |reply| drop(answers.send(reply))).unwrap(), answered)
}

fn order(surveyor: &Surveyor, revision: u64, request: SurveyRequest) {
    let plan = BuiltinPlan::find("land").unwrap().read().unwrap().plan;
    let plan = Box::new(SurveyedPlan { plan, settings: Vec::new() });
    surveyor.want(revision);
    surveyor.order(SurveyJob { revision, plan, request }, copy());
}

#[test]
fn a_sweep_of_the_plan_replies_second_by_second() {
    let (surveyor, answered) = start();
    order(&surveyor, 3, SurveyRequest::Sweep("motor@0,,1:0".parse().unwrap()));
    let mut points = Vec::new();
    loop {
        let SurveyReply { revision, news } = answered.recv().unwrap();
        assert_eq!(revision, 3);
        match news {
            SurveyNews::Point(point) => points.push(*point),
            SurveyNews::SweepEnd => break,
            other => panic!("{other:?}"),
        }
    }
    assert!(points.len() > 10 && points.iter().zip(0..).all(|(point, second)| point.second == second));
    assert!(points.iter().any(|point| point.fate == Fate::Lost));
}

/// Returns the campaign of `land` with these lines about the air, as the command line reads it.
fn campaign(air: &str) -> Campaign {
    let text = format!(
        "format = 1\nseeds = \"1..\"\ntimeout_s = 1800\ntime_limit_s = 1800\n[plan]\nbuiltin = \"land\"\n\
         [craft]\ntakeoff_m = 5\n{air}\n[campaign]\n"
    );
    let request = Request {
        file: "land",
        text: &text,
        seeds: None,
        max_flights: MAX_FLIGHTS,
        flights: Flights::OfCampaign { is_drawn: true },
    };
    let scenario = read_request(&request, &mut BuiltinFiles).unwrap();
    Campaign::new(scenario, Some(100), None).unwrap()
}

/// Returns a copy of a craft that has flown the plan for a while, in a wind that was set meanwhile.
fn copy_in_flight() -> VehicleCopy {
    let plan = BuiltinPlan::find("land").unwrap().read().unwrap();
    let mut setup = FlightSetup { plan: plan.clone(), ..FlightSetup::default() };
    setup.stored.plan = plan.plan;
    setup.world.wind = "3@90".parse().unwrap();
    let (mut vehicle, _) = setup.build().unwrap();
    vehicle.apply(&VehicleCommand::StartPilot(5.0)).accepted().unwrap();
    (0..9000).for_each(|_| vehicle.tick());
    assert!(vehicle.controller().is_armed());
    for command in [
        WorldCommand::SetWind("7@250".parse().unwrap()),
        WorldCommand::SetTurbulence(crate::telemetry::Turbulence::Light),
        WorldCommand::Schedule("motor@0,,3:0.5".parse().unwrap()),
    ] {
        vehicle.apply(&VehicleCommand::from(command)).accepted().unwrap();
    }
    (0..500).for_each(|_| vehicle.tick());
    VehicleCopy { vehicle: Box::new(vehicle), takeoff_m: 5.0, again: None }
}

fn surveyed() -> SurveyedPlan {
    let file = BuiltinPlan::find("land").unwrap().read().unwrap();
    SurveyedPlan { plan: file.plan, settings: file.settings }
}

#[test]
fn a_sweep_of_the_session_is_that_of_a_campaign_with_the_same_plan_and_air() {
    let fault: ScheduledFault = "motor@0,,1:0".parse().unwrap();
    let flight = campaign("[air]\nwind = \"7@250\"\nturbulence = \"light\"").flight(1).unwrap();
    let flight = CaseFlight::new(&flight.case, &flight.air).unwrap().into_flight();
    let mut of_campaign = Sweep::new(flight, fault);
    let mut points = 0;
    let mut compare = |news| {
        let branch = of_campaign.next_branch(&|| false).unwrap();
        let point = branch.and_then(|branch| branch.fly(&|| false));
        assert_eq!(news, point.map_or(SurveyNews::SweepEnd, |point| SurveyNews::Point(Box::new(point))));
        points += 1;
    };
    super::sweep(&surveyed(), &copy_in_flight(), fault, &|| false, &mut compare).unwrap();
    assert!(points > 10, "{points}");
}

#[test]
fn flights_of_the_session_are_those_of_a_forecast_with_the_same_plan_and_air_to_the_last_bit() {
    let (plan, copy) = (surveyed(), copy_in_flight());
    let wanted = campaign("[air]\nturbulence = \"light\"\n[vary]\nwind = \"7+-1.75@250+-20\"");
    let here = go_no_go::campaign(&plan, 5.0, "7@250".parse().unwrap()).unwrap();
    for number in [1, 2, 100] {
        let flight: CampaignFlight = wanted.flight(number).unwrap();
        let flown = CaseFlight::new(&flight.case, &flight.air).unwrap().fly();
        let record = go_no_go::record(&here.flight(number).unwrap(), &plan, &copy, &|| false).unwrap();
        assert_eq!(record, Some(Record::of(&flight, Side::A, &flown, None)));
    }
}

#[test]
fn a_newer_job_or_the_end_of_the_handle_ends_a_survey() {
    let (surveyor, answered) = start();
    order(&surveyor, 1, SurveyRequest::GoNoGo);
    assert_eq!(answered.recv().unwrap(), SurveyReply { revision: 1, news: SurveyNews::Flown(1) });
    order(&surveyor, 2, SurveyRequest::Sweep("stall@0,1".parse().unwrap()));
    let reply = answered.iter().find(|reply| reply.revision == 2).unwrap();
    assert!(matches!(reply.news, SurveyNews::Refused(_)), "a remote firmware's fault: {reply:?}");
    order(&surveyor, 4, SurveyRequest::GoNoGo);
    assert_eq!(answered.recv().unwrap().revision, 4);
    drop(surveyor);
    while answered.recv().is_ok() {}
}

#[test]
fn nothing_is_flown_without_a_plan() {
    let (surveyor, answered) = start();
    let plan = Box::new(SurveyedPlan { plan: FlightPlan::default(), settings: Vec::new() });
    surveyor.want(1);
    surveyor.order(SurveyJob { revision: 1, plan, request: SurveyRequest::GoNoGo }, copy());
    let SurveyNews::Refused(reason) = answered.recv().unwrap().news else { panic!("flown") };
    assert!(reason.contains("nothing to fly"), "{reason}");
}
