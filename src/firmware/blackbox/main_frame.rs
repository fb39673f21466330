//! The main frames: the state of the craft in a loop, the fields that a log has of it, and their values.

use arrayvec::ArrayVec;
use nalgebra::{UnitQuaternion, Vector3};
use strum::{EnumCount, IntoEnumIterator as _};

use super::debug::{DEBUG_VALUES, debug_values};
use crate::blackbox::Predictor::{
    Average2, Increment, MinMotor, Motor0, Previous, StraightLine, VbatReference, Zero,
};
use crate::blackbox::encode::Coding::{
    Neg14Bit, Null, SignedVb, Tag2_3S32, Tag8_4S16, Tag8_8Svb, UnsignedVb,
};
use crate::blackbox::encode::{FieldGroup, FrameValues, MAX_FIELDS, Rule};
use crate::firmware::Firmware;
use crate::firmware::control::PidTerms;
use crate::firmware::estimate::{ACC_COUNTS_PER_G, Rates};
use crate::firmware::rx::Sticks;
use crate::geo::GRAVITY;
use crate::signals::{PerMotor, SimTime};

/// The counts of a quaternion component of 1.
const QUATERNION_COUNTS: f64 = 32_767.0;

/// Fields that exist together, in the order of the frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumCount, strum::EnumIter)]
pub(super) enum MainFields {
    LoopIteration,
    Time,
    P,
    I,
    DRoll,
    DPitch,
    DYaw,
    F,
    RcCommand,
    RcThrottle,
    Setpoint,
    Voltage,
    Current,
    Mag,
    Baro,
    Rssi,
    Gyro,
    GyroUnfiltered,
    Acc,
    Attitude,
    Debug,
    Motor0,
    OtherMotors,
}

/// The groups of fields of a log.
pub(super) type LoggedFields = ArrayVec<MainFields, { MainFields::COUNT }>;

/// Returns the fields that a log has which begins now. Sensors that come later are not in it.
pub(super) fn logged(firmware: &Firmware) -> LoggedFields {
    MainFields::iter().filter(|fields| fields.are_logged(firmware)).collect()
}

/// The state of the craft in one loop, as it is. Conversion and encoding come later.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MainState {
    pub(super) iteration: u32,
    pub(super) time: SimTime,
    terms: PidTerms,
    sticks: Sticks,
    setpoint_dps: [f64; 3],
    throttle: f64,
    voltage_v: f64,
    current_a: f64,
    mag_flu: Vector3<f64>,
    baro_alt_m: f64,
    rssi: u16,
    gyro_dps: [f64; 3],
    rates: Rates,
    force_flu: Vector3<f64>,
    attitude: UnitQuaternion<f64>,
    debug: [i32; DEBUG_VALUES],
    motors_us: PerMotor,
}

impl MainState {
    /// Returns the present state, in the loop with this number.
    // Inlined, because the result would otherwise be copied through memory in every step.
    #[inline(always)]
    pub(super) fn of(firmware: &Firmware, iteration: u32) -> Self {
        let (control, estimate) = (firmware.control(), firmware.estimate());
        let (parameters, receiver) = (firmware.parameters(), firmware.receiver());
        let battery = firmware.battery().sample().copied().unwrap_or_default();
        Self {
            iteration,
            time: firmware.now,
            terms: control.terms,
            sticks: *receiver.sticks(),
            setpoint_dps: control.setpoint_dps,
            throttle: control.throttle,
            voltage_v: battery.voltage_v,
            current_a: battery.current_a,
            mag_flu: parameters.estimator.field_flu(&firmware.sensing.mag_flu),
            baro_alt_m: estimate.baro_alt_m,
            rssi: receiver.rssi(&parameters.rx),
            gyro_dps: control.gyro_dps,
            rates: estimate.rates,
            force_flu: estimate.force_flu,
            attitude: estimate.attitude,
            debug: parameters
                .blackbox
                .debug
                .map_or([0; DEBUG_VALUES], |source| debug_values(source, firmware)),
            motors_us: control.motors_us,
        }
    }

    /// Returns the voltage of the battery, 0.01 V.
    pub(super) fn volts(&self) -> i32 {
        whole(100.0 * self.voltage_v)
    }

    /// Returns the values of all fields, in the order of [`MainFields`], also of those that a log does not have. `scale` is
    /// the units of a degree per second and of a stick unit.
    fn values(&self, scale: f64) -> FrameValues {
        let (terms, sticks, rates) = (&self.terms, &self.sticks, &self.rates);
        let mut values = Values { values: [0; MAX_FIELDS], len: 0 };
        // The counter of microseconds starts again after 71 minutes.
        values.all([self.iteration.cast_signed(), self.time.0 as i32].map(f64::from));
        values.all(signed(terms.p));
        values.all(signed(terms.i));
        values.all(signed(terms.d));
        values.all(signed(terms.f));
        values.all(signed([sticks.roll, sticks.pitch, sticks.yaw]).map(|stick| scale * stick));
        values.all([scale * sticks.throttle_us]);
        values.all(signed(self.setpoint_dps).map(|rate| scale * rate));
        values.all([1000.0 * self.throttle, 100.0 * self.voltage_v, 100.0 * self.current_a]);
        values.all(self.mag_flu.into());
        values.all([100.0 * self.baro_alt_m, self.rssi.into()]);
        values.all(signed(self.gyro_dps).map(|rate| scale * rate));
        let raw = [rates.roll, rates.pitch_down, rates.yaw];
        values.all(signed(raw).map(|rate| scale * rate.to_degrees()));
        values.all((self.force_flu * (ACC_COUNTS_PER_G / GRAVITY)).into());
        values.all(attitude(&self.attitude).map(|part| QUATERNION_COUNTS * part));
        values.all(self.debug.map(f64::from));
        values.all(self.motors_us);
        values.values
    }
}

/// The places of the fields of a log among [`MainState::values`].
#[derive(Debug, Clone)]
pub(super) struct FieldPlaces(ArrayVec<u8, MAX_FIELDS>);

impl FieldPlaces {
    pub(super) fn new(logged: &LoggedFields) -> Self {
        let mut places = ArrayVec::new();
        let mut next = 0;
        for fields in MainFields::iter() {
            let count = fields.group().names.len() as u8;
            if logged.contains(&fields) {
                for place in next..next + count {
                    // A frame has room for all fields.
                    let _full = places.try_push(place);
                }
            }
            next += count;
        }
        Self(places)
    }

    /// Returns the values of the fields of a log, in the order of its frames. `scale` is the units of a degree per second
    /// and of a stick unit.
    pub(super) fn values(&self, state: &MainState, scale: f64) -> FrameValues {
        let all = state.values(scale);
        let mut values = [0; MAX_FIELDS];
        for (value, place) in values.iter_mut().zip(&self.0) {
            *value = all[usize::from(*place) % MAX_FIELDS];
        }
        values
    }
}

/// A sum with this number has the nearest whole number in its lower half.
const TO_WHOLE: f64 = (3_u64 << 51) as f64;

/// Rounds to a unit of a log, halves to the even one.
#[inline]
fn whole(value: f64) -> i32 {
    // `f64::round` calls a library function on processors without an instruction for it.
    (value.clamp(i32::MIN.into(), i32::MAX.into()) + TO_WHOLE).to_bits() as i32
}

/// The values of a frame in their order.
struct Values {
    values: FrameValues,
    len: usize,
}

impl Values {
    /// Adds numbers, rounded. All of them at once, because the processor rounds several in one instruction.
    #[inline(always)]
    fn all<const N: usize>(&mut self, numbers: [f64; N]) {
        if let Some(places) = self.values.get_mut(self.len..).and_then(|free| free.first_chunk_mut()) {
            *places = numbers.map(whole);
            self.len += N;
        }
    }
}

/// Converts values of roll right, pitch nose down and yaw clockwise to those of a log, where yaw is anticlockwise.
fn signed([roll, pitch, yaw]: [f64; 3]) -> [f64; 3] {
    [roll, pitch, -yaw]
}

/// Converts an attitude from body → east-north-up to the vector part of body → north-west-up, with a positive scalar.
fn attitude(to_enu: &UnitQuaternion<f64>) -> [f64; 3] {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    // A quarter turn clockwise about the vertical.
    let (w, i, j, k) = (to_enu.w, to_enu.i, to_enu.j, to_enu.k);
    let sign = half.copysign(w + k);
    [i + j, j - i, k - w].map(|part| sign * part)
}

impl MainFields {
    #[rustfmt::skip]
    pub(super) fn group(self) -> FieldGroup {
        const fn fields(names: &'static [&'static str], signed: bool, intra: Rule, inter: Rule) -> FieldGroup {
            FieldGroup::main(names, signed, intra, inter)
        }
        let (whole, positive) = (Rule(Zero, SignedVb), Rule(Zero, UnsignedVb));
        match self {
            Self::LoopIteration => fields(&["loopIteration"], false, positive, Rule(Increment, Null)),
            Self::Time => fields(&["time"], false, positive, Rule(StraightLine, SignedVb)),
            Self::P => fields(&["axisP[0]", "axisP[1]", "axisP[2]"], true, whole, Rule(Previous, SignedVb)),
            Self::I => fields(&["axisI[0]", "axisI[1]", "axisI[2]"], true, whole, Rule(Previous, Tag2_3S32)),
            Self::DRoll => fields(&["axisD[0]"], true, whole, Rule(Previous, SignedVb)),
            Self::DPitch => fields(&["axisD[1]"], true, whole, Rule(Previous, SignedVb)),
            Self::DYaw => fields(&["axisD[2]"], true, whole, Rule(Previous, SignedVb)),
            Self::F => fields(&["axisF[0]", "axisF[1]", "axisF[2]"], true, whole, Rule(Previous, SignedVb)),
            Self::RcCommand => fields(&["rcCommand[0]", "rcCommand[1]", "rcCommand[2]"], true, whole, Rule(Previous, Tag8_4S16)),
            Self::RcThrottle => fields(&["rcCommand[3]"], false, positive, Rule(Previous, Tag8_4S16)),
            Self::Setpoint => fields(&["setpoint[0]", "setpoint[1]", "setpoint[2]", "setpoint[3]"], true, whole, Rule(Previous, Tag8_4S16)),
            Self::Voltage => fields(&["vbatLatest"], false, Rule(VbatReference, Neg14Bit), Rule(Previous, Tag8_8Svb)),
            Self::Current => fields(&["amperageLatest"], true, whole, Rule(Previous, Tag8_8Svb)),
            Self::Mag => fields(&["magADC[0]", "magADC[1]", "magADC[2]"], true, whole, Rule(Previous, Tag8_8Svb)),
            Self::Baro => fields(&["baroAlt"], true, whole, Rule(Previous, Tag8_8Svb)),
            Self::Rssi => fields(&["rssi"], false, positive, Rule(Previous, Tag8_8Svb)),
            Self::Gyro => fields(&["gyroADC[0]", "gyroADC[1]", "gyroADC[2]"], true, whole, Rule(Average2, SignedVb)),
            Self::GyroUnfiltered => fields(&["gyroUnfilt[0]", "gyroUnfilt[1]", "gyroUnfilt[2]"], true, whole, Rule(Average2, SignedVb)),
            Self::Acc => fields(&["accSmooth[0]", "accSmooth[1]", "accSmooth[2]"], true, whole, Rule(Average2, SignedVb)),
            Self::Attitude => fields(&["imuQuaternion[0]", "imuQuaternion[1]", "imuQuaternion[2]"], true, whole, Rule(Average2, SignedVb)),
            Self::Debug => fields(
                &["debug[0]", "debug[1]", "debug[2]", "debug[3]", "debug[4]", "debug[5]", "debug[6]", "debug[7]"],
                true, whole, Rule(Average2, SignedVb),
            ),
            Self::Motor0 => fields(&["motor[0]"], false, Rule(MinMotor, UnsignedVb), Rule(Average2, SignedVb)),
            Self::OtherMotors => fields(&["motor[1]", "motor[2]", "motor[3]"], false, Rule(Motor0, SignedVb), Rule(Average2, SignedVb)),
        }
    }

    fn are_logged(self, firmware: &Firmware) -> bool {
        let parameters = firmware.parameters();
        let config = &parameters.blackbox;
        let rate = &parameters.control.rate;
        let has_d =
            |axis: usize| config.has(0) && (rate.gains[axis].d != 0.0 || rate.d_max.most[axis] != 0.0);
        match self {
            Self::LoopIteration | Self::Time => true,
            Self::P | Self::I | Self::F => config.has(0),
            Self::DRoll => has_d(0),
            Self::DPitch => has_d(1),
            Self::DYaw => has_d(2),
            Self::RcCommand | Self::RcThrottle => config.has(1),
            Self::Setpoint => config.has(2),
            Self::Voltage | Self::Current => config.has(3) && firmware.battery().sample().is_some(),
            Self::Mag => config.has(4) && firmware.setup.boot.mag,
            Self::Baro => config.has(5),
            Self::Rssi => config.has(6) && parameters.rx.rssi_channel.is_some(),
            Self::Gyro => config.has(7),
            Self::GyroUnfiltered => config.has(14),
            Self::Acc => config.has(9),
            Self::Attitude => config.has(8),
            Self::Debug => config.has(10) && config.debug.is_some(),
            Self::Motor0 | Self::OtherMotors => config.has(11),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attitudes_have_the_quaternion_of_the_msp_message() {
        let to_nwu = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -std::f64::consts::FRAC_PI_2);
        for (roll, pitch, yaw) in [(0.0, 0.0, 0.0), (0.3, -0.2, 1.0), (-1.0, 0.5, 3.0), (0.1, 0.0, -2.0)] {
            let enu = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
            let q = to_nwu * enu;
            let sign = 1.0_f64.copysign(q.w);
            for (part, expected) in attitude(&enu).into_iter().zip([q.i, q.j, q.k]) {
                assert!((part - sign * expected).abs() < 1e-12, "{part} {expected}");
            }
        }
    }

    #[test]
    fn values_are_rounded_to_the_nearest_unit() {
        assert_eq!([-1.5, -0.6, -0.4, 0.0, 0.4, 0.5, 1.6].map(whole), [-2, -1, 0, 0, 0, 0, 2]);
        assert_eq!(whole(f64::NAN), 0);
        assert_eq!(whole(1e12), i32::MAX);
    }
}
