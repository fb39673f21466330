//! `NAME@T[,FOR][,VALUE]` and the table of faults.

use std::str::FromStr;

use strum::VariantNames;

use crate::sim::value_text::{ParseError, number, number_in};
use crate::sim::wind::Wind;
use crate::telemetry::FaultKind;
use crate::text::did_you_mean;

use super::{
    BatteryFault, Direction, Fault, FaultKey, FaultStart, MAX_GPS_DELAY_S, MotorNumber, ScheduledFault,
};

/// One kind of fault: name, form of its value, meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FaultInfo {
    /// The kind; its name comes before the first `@`.
    pub kind: FaultKind,
    /// Form of VALUE; empty if there is none.
    pub value: &'static str,
    /// Default of VALUE; empty if there is none or VALUE is required.
    pub default: &'static str,
    /// The effect of the fault.
    pub help: &'static str,
}

impl FaultInfo {
    /// Returns the name before the first `@`.
    pub fn name(&self) -> &'static str {
        self.kind.into()
    }

    /// Returns `true` if the fault acts on the link to an external simulator.
    pub fn needs_link(&self) -> bool {
        self.help.starts_with("external link")
    }
}

const fn info(kind: FaultKind, value: &'static str, default: &'static str, help: &'static str) -> FaultInfo {
    FaultInfo { kind, value, default, help }
}

/// All faults, for parsing, help and completion.
pub const FAULTS: [FaultInfo; 30] = [
    info(FaultKind::RxLoss, "", "", "RC frames stop"),
    info(FaultKind::RxJitter, "fraction 0 to 1", "0.5", "RC frames are dropped at random"),
    info(FaultKind::GpsLoss, "", "", "no GPS solution, no satellites"),
    info(FaultKind::GpsGlitch, "METRES@BEARING", "30@90", "GPS position shifted, velocity honest"),
    info(FaultKind::GpsFreeze, "", "", "the same GPS solution repeated"),
    info(FaultKind::GpsDelay, "s, 0 to 2", "0.5", "GPS solutions later than they say"),
    info(FaultKind::GpsNoise, "factor 0 to 1000", "5", "all GPS errors times a factor"),
    info(FaultKind::BaroDrift, "Pa/s, -1000 to 1000", "1", "pressure ramps"),
    info(FaultKind::BaroSpike, "Pa, -100000 to 100000", "100", "one-sample pressure spikes, one a second"),
    info(FaultKind::BaroFreeze, "", "", "the same pressure repeated"),
    info(FaultKind::MagOff, "", "", "no magnetometer samples"),
    info(FaultKind::MagBias, "degrees, -180 to 180", "20", "magnetic heading off, clockwise positive"),
    info(FaultKind::GyroBias, "°/s, -2000 to 2000", "2", "step on the gyro's x axis"),
    info(FaultKind::AccBias, "m/s², -150 to 150", "0.3", "step on the accelerometer's x axis"),
    info(FaultKind::ImuFreeze, "", "", "the last inertial sample repeated"),
    info(FaultKind::Motor, "MOTOR:EFFICIENCY, 1 to 4 : 0 to 1", "2:0.8", "a weak or dead motor"),
    info(FaultKind::MotorStuck, "MOTOR:COMMAND, 1 to 4 : 0 to 1", "", "a motor's command frozen"),
    info(
        FaultKind::PropImbalance,
        "MOTOR:M/S², 1 to 4 : 0 to 100",
        "2:2",
        "an unbalanced propeller shakes the IMU",
    ),
    info(FaultKind::Vibration, "m/s² rms at hover, 0 to 50", "0.3", "accelerometer vibration"),
    info(FaultKind::Battery, "volts, -100 to 100, or cell-out", "-1", "voltage offset, or one cell short"),
    info(FaultKind::Gust, "M/S@FROM, 0 to 60", "8@0", "one gust, rising and falling as 1 − cos"),
    info(FaultKind::Wind, "M/S@FROM, 0 to 60", "", "another mean wind, over 2 s"),
    info(
        FaultKind::Push,
        "N·s,DIRECTION (north, east, south, west, up, down), 0 to 1000",
        "0.5,up",
        "one impulse",
    ),
    info(
        FaultKind::Teleport,
        "NORTH,EAST,UP in metres, -10000 to 10000",
        "",
        "moves the craft, velocity kept",
    ),
    info(FaultKind::Payload, "kg, 0 to 100", "", "a weight below the craft"),
    info(FaultKind::Stall, "", "", "external link: the simulator stops sending"),
    info(FaultKind::FdmLoss, "fraction 0 to 1", "0.2", "external link: packets lost"),
    info(FaultKind::FdmLate, "ms, 0 to 10000", "50", "external link: packets late"),
    info(FaultKind::FdmDup, "fraction 0 to 1", "0.2", "external link: packets doubled"),
    info(FaultKind::FdmJitter, "ms, 0 to 10000", "5", "external link: packets late at random"),
];

/// The longest permitted time, s: a century, so that microseconds never overflow.
pub(in crate::sim) const MAX_TIME_S: f64 = 3.2e9;

impl ScheduledFault {
    /// Reads a fault without its time, `NAME[,FOR][,VALUE]`. It begins at the engagement.
    ///
    /// # Errors
    /// Fails with a sentence.
    pub fn without_time(text: &str) -> Result<Self, String> {
        let (name, rest) = text.split_once(',').map_or((text, None), |(name, rest)| (name, Some(rest)));
        if name.contains('@') {
            return Err(
                "leave the time out: the fault begins at every second; write NAME[,FOR][,VALUE]".to_owned()
            );
        }
        let timed = rest.map_or_else(|| format!("{name}@0"), |rest| format!("{name}@0,{rest}"));
        timed.parse().map_err(|error: ParseError| error.problem().to_owned())
    }

    /// Returns the fault without its time.
    pub fn timeless(&self) -> String {
        let at_engagement = Self { start: FaultStart::Engagement(0.0), ..*self };
        at_engagement.to_string().replacen("@0", "", 1)
    }
}

impl FromStr for ScheduledFault {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        let error = |problem: String| ParseError::new("fault", text, problem);
        let Some((name, rest)) = text.split_once('@') else {
            let problem = match find(text) {
                Ok(_) => "the time is missing".to_owned(),
                Err(problem) => problem,
            };
            return Err(error(format!(
                "{problem}; write NAME@T[,FOR][,VALUE], for example gps-loss@20,6 or motor@10,,2:0.8"
            )));
        };
        let info = find(name).map_err(error)?;
        let mut parts = rest.splitn(3, ',');
        let start = parts.next().unwrap_or_default();
        let duration = parts.next().unwrap_or_default();
        let value = parts.next();
        let start =
            match start.strip_prefix("boot+") {
                Some(after) => FaultStart::Boot(seconds("time T", after).map_err(error)?),
                None => FaultStart::Engagement(number_in("time T", start, 0.0, MAX_TIME_S).map_err(
                    |problem| error(format!("{problem} (seconds from engagement, or boot+SECONDS)")),
                )?),
            };
        let for_s =
            if duration.is_empty() { None } else { Some(seconds("duration FOR", duration).map_err(error)?) };
        let fault = parse_value(info, value).map_err(error)?;
        if for_s.is_some() && fault.is_instant() {
            return Err(error(format!(
                "{name} acts at once and has no duration; leave FOR empty: {name}@T,,VALUE"
            )));
        }
        Ok(Self { fault, start, for_s })
    }
}

impl Fault {
    /// Reads a fault from its name and the text of its value, as a command line or a form gives them.
    ///
    /// # Errors
    /// Fails if the name is unknown or the value is not allowed.
    pub fn parse(name: &str, value: Option<&str>) -> Result<Self, ParseError> {
        find(name)
            .and_then(|info| parse_value(info, value))
            .map_err(|problem| ParseError::new("fault", name, problem))
    }
}

impl Fault {
    /// Checks that the value is allowed: its printed form must parse as an allowed value.
    pub(in crate::sim) fn check(&self) -> Result<(), ParseError> {
        Self::parse(self.name(), Some(&self.to_string())).map(|_| ())
    }
}

impl ScheduledFault {
    /// Checks that value and times are allowed.
    pub(in crate::sim) fn check(&self) -> Result<(), ParseError> {
        self.to_string().parse::<Self>().map(|_| ())
    }
}

impl FromStr for FaultKey {
    type Err = ParseError;

    /// Reads `NAME` or, for motor faults, `NAME:MOTOR`.
    fn from_str(text: &str) -> Result<Self, ParseError> {
        let error = |problem: String| ParseError::new("fault", text, problem);
        let (name, motor) = text.split_once(':').map_or((text, None), |(name, motor)| (name, Some(motor)));
        let info = find(name).map_err(error)?;
        let motor = motor.map(motor_number).transpose().map_err(error)?;
        if motor.is_some() && !info.value.starts_with("MOTOR") {
            return Err(error(format!("{name} is not a fault of one motor; write {name} alone")));
        }
        Ok(Self { kind: info.kind, motor })
    }
}

/// Reads a time in seconds. The error names the unit and what is allowed.
fn seconds(name: &str, text: &str) -> Result<f64, String> {
    match number(name, text)? {
        value if (0.0..=MAX_TIME_S).contains(&value) => Ok(value),
        value => Err(format!("{name} {value} s is out of range; allowed are 0 to {MAX_TIME_S} s")),
    }
}

fn find(name: &str) -> Result<&'static FaultInfo, String> {
    FAULTS.iter().find(|info| info.name() == name).ok_or_else(|| {
        let hint = did_you_mean::suffix(name, FAULTS.map(|info| info.name()));
        // The faults of the external link are of no use to most flights.
        let names = FAULTS.iter().filter(|info| !info.needs_link()).map(FaultInfo::name);
        format!("there is no fault {name:?}{hint}; there are {}", names.collect::<Vec<_>>().join(", "))
    })
}

fn parse_value(info: &FaultInfo, value: Option<&str>) -> Result<Fault, String> {
    let given = value.map(str::trim).filter(|value| !value.is_empty());
    if info.value.is_empty() && given.is_some() {
        return Err(format!("{} has no value", info.name()));
    }
    let text = given.unwrap_or(info.default);
    if !info.value.is_empty() && text.is_empty() {
        return Err(format!("the value of {} is missing: {}", info.name(), info.value));
    }
    build(info.kind, text)
        .map_err(|problem| format!("{problem}; the value of {} is {}", info.name(), info.value))
}

fn build(kind: FaultKind, text: &str) -> Result<Fault, String> {
    let range = |min, max| number_in("value", text, min, max);
    Ok(match kind {
        FaultKind::RxLoss => Fault::RxLoss,
        FaultKind::RxJitter => Fault::RxJitter(range(0.0, 1.0)?),
        FaultKind::GpsLoss => Fault::GpsLoss,
        FaultKind::GpsGlitch => {
            let (metres, bearing) = text.split_once('@').ok_or("the bearing is missing")?;
            let metres = number_in("distance", metres, -100_000.0, 100_000.0)?;
            Fault::GpsGlitch(metres, number("bearing", bearing)?.rem_euclid(360.0))
        }
        FaultKind::GpsFreeze => Fault::GpsFreeze,
        FaultKind::GpsDelay => Fault::GpsDelay(range(0.0, MAX_GPS_DELAY_S)?),
        FaultKind::GpsNoise => Fault::GpsNoise(range(0.0, 1000.0)?),
        FaultKind::BaroDrift => Fault::BaroDrift(range(-1000.0, 1000.0)?),
        FaultKind::BaroSpike => Fault::BaroSpike(range(-100_000.0, 100_000.0)?),
        FaultKind::BaroFreeze => Fault::BaroFreeze,
        FaultKind::MagOff => Fault::MagOff,
        FaultKind::MagBias => Fault::MagBias(range(-180.0, 180.0)?),
        FaultKind::GyroBias => Fault::GyroBias(range(-2000.0, 2000.0)?),
        FaultKind::AccBias => Fault::AccBias(range(-150.0, 150.0)?),
        FaultKind::ImuFreeze => Fault::ImuFreeze,
        FaultKind::Motor => {
            let (motor, efficiency) = motor_and(text, "efficiency", 1.0)?;
            Fault::Motor(motor, efficiency)
        }
        FaultKind::MotorStuck => {
            let (motor, command) = motor_and(text, "command", 1.0)?;
            Fault::MotorStuck(motor, command)
        }
        FaultKind::PropImbalance => {
            let (motor, shake) = motor_and(text, "acceleration", 100.0)?;
            Fault::PropImbalance(motor, shake)
        }
        FaultKind::Vibration => Fault::Vibration(range(0.0, 50.0)?),
        FaultKind::Battery if text == "cell-out" => Fault::Battery(BatteryFault::CellOut),
        FaultKind::Battery => Fault::Battery(BatteryFault::Offset(range(-100.0, 100.0)?)),
        FaultKind::Gust => Fault::Gust(text.parse::<Wind>().map_err(|error| error.to_string())?),
        FaultKind::Wind => Fault::Wind(text.parse::<Wind>().map_err(|error| error.to_string())?),
        FaultKind::Push => {
            let (impulse, direction) = text.split_once([',', ' ', '@']).ok_or("the direction is missing")?;
            let direction: Direction = direction.trim().parse().map_err(|_| {
                let hint = did_you_mean::suffix(direction, Direction::VARIANTS.iter().copied());
                format!("{direction} is not a direction{hint}")
            })?;
            Fault::Push(number_in("impulse", impulse, 0.0, 1000.0)?, direction)
        }
        FaultKind::Teleport => {
            let parts: Vec<&str> = text.split(',').collect();
            let [north, east, up] = parts[..] else {
                return Err(
                    "three numbers are needed; a teleport has no duration, so its place stays empty: \
                            teleport,,NORTH,EAST,UP"
                        .to_owned(),
                );
            };
            let metres = |name, text| number_in(name, text, -10_000.0, 10_000.0);
            Fault::Teleport([metres("north", north)?, metres("east", east)?, metres("up", up)?])
        }
        FaultKind::Payload => Fault::Payload(range(0.0, 100.0)?),
        FaultKind::Stall => Fault::Stall,
        FaultKind::FdmLoss => Fault::FdmLoss(range(0.0, 1.0)?),
        FaultKind::FdmLate => Fault::FdmLate(range(0.0, 10_000.0)?),
        FaultKind::FdmDup => Fault::FdmDup(range(0.0, 1.0)?),
        FaultKind::FdmJitter => Fault::FdmJitter(range(0.0, 10_000.0)?),
    })
}

fn motor_and(text: &str, name: &str, max: f64) -> Result<(MotorNumber, f64), String> {
    let (motor, value) = text.split_once(':').ok_or_else(|| format!("the {name} is missing"))?;
    Ok((motor_number(motor)?, number_in(name, value, 0.0, max)?))
}

fn motor_number(text: &str) -> Result<MotorNumber, String> {
    let number = text.trim().parse().ok().and_then(MotorNumber::new);
    number.ok_or_else(|| format!("{text} is not a motor; allowed are 1 to 4"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> ScheduledFault {
        text.parse().unwrap_or_else(|error| panic!("{error}"))
    }

    #[test]
    fn the_documented_forms_parse() {
        let motor = MotorNumber::new(2).unwrap();
        for (text, fault, start, for_s) in [
            ("gps-loss@20,6", Fault::GpsLoss, FaultStart::Engagement(20.0), Some(6.0)),
            ("gps-glitch@10,2,30@90", Fault::GpsGlitch(30.0, 90.0), FaultStart::Engagement(10.0), Some(2.0)),
            ("motor@10,,2:0.8", Fault::Motor(motor, 0.8), FaultStart::Engagement(10.0), None),
            ("motor@10", Fault::Motor(motor, 0.8), FaultStart::Engagement(10.0), None),
            ("wind@boot+3,5,8@270", Fault::Wind("8@270".parse().unwrap()), FaultStart::Boot(3.0), Some(5.0)),
            ("push@1", Fault::Push(0.5, Direction::Up), FaultStart::Engagement(1.0), None),
            ("push@1,,2,north", Fault::Push(2.0, Direction::North), FaultStart::Engagement(1.0), None),
            ("teleport@0,,0,20,0", Fault::Teleport([0.0, 20.0, 0.0]), FaultStart::Engagement(0.0), None),
            ("battery@5,,cell-out", Fault::Battery(BatteryFault::CellOut), FaultStart::Engagement(5.0), None),
            ("stall@5,1", Fault::Stall, FaultStart::Engagement(5.0), Some(1.0)),
        ] {
            assert_eq!(parse(text), ScheduledFault { fault, start, for_s }, "{text}");
        }
    }

    #[test]
    fn every_fault_of_the_table_parses_and_prints_back() {
        for info in FAULTS {
            let value = match info.name() {
                "motor-stuck" => "3:0.5",
                "wind" => "8@270",
                "teleport" => "1,-2,3",
                "payload" => "0.1",
                _ => info.default,
            };
            let fault = Fault::parse(info.name(), Some(value)).unwrap();
            assert_eq!(fault.name(), info.name());
            assert_eq!(fault.to_string(), value);
            for for_s in [None, Some(2.5)] {
                if for_s.is_some() && fault.is_instant() {
                    continue;
                }
                let scheduled = ScheduledFault { fault, start: FaultStart::Boot(1.25), for_s };
                assert_eq!(parse(&scheduled.to_string()), scheduled);
            }
        }
    }

    #[test]
    fn errors_name_the_field_and_what_is_allowed() {
        for (text, part) in [
            ("gps-los@3", "did you mean gps-loss?"),
            ("gps-loss", "the time is missing"),
            ("gps-loss@", "the time T is missing"),
            ("gps-loss@x", "time T x is not a number (seconds from engagement, or boot+SECONDS)"),
            ("gps-loss@-1", "time T -1 is out of range"),
            ("gps-loss@1,y", "duration FOR y is not a number"),
            ("gps-loss@1,-5", "duration FOR -5 s is out of range; allowed are 0 to 3200000000 s"),
            ("gps-loss@boot+-5", "time T -5 s is out of range; allowed are 0 to 3200000000 s"),
            ("gps-loss@1,,7", "gps-loss has no value"),
            ("motor@1,,5:0.5", "5 is not a motor; allowed are 1 to 4"),
            ("motor@1,,2:1.5", "efficiency 1.5 is out of range; allowed are 0 to 1"),
            ("push@1,,1,upp", "did you mean up?"),
            ("push@1,2,1,up", "acts at once and has no duration"),
            ("teleport@20,0,20,0", "stays empty: teleport,,NORTH,EAST,UP"),
            ("payload@1", "the value of payload is missing: kg"),
            ("rx-jitter@1,,2", "out of range; allowed are 0 to 1"),
        ] {
            let error = text.parse::<ScheduledFault>().unwrap_err().to_string();
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn link_faults_are_known_and_not_offered() {
        for info in &FAULTS {
            let fault = build(info.kind, if info.default.is_empty() { "1" } else { info.default });
            if let Ok(fault) = fault {
                assert_eq!(fault.needs_link(), info.needs_link(), "{}", info.name());
            }
        }
        let offered = "banana@1".parse::<ScheduledFault>().unwrap_err().to_string();
        assert!(
            offered.contains("payload") && !offered.contains("fdm-") && !offered.contains("stall"),
            "{offered}"
        );
    }

    proptest::proptest! {
        #[test]
        fn any_text_is_read_or_refused_without_panic(text in ".{0,40}", name in 0usize..FAULTS.len()) {
            let _ = text.parse::<ScheduledFault>();
            let _ = format!("{}@{text}", FAULTS[name].name()).parse::<ScheduledFault>();
        }
    }
}
