//! The settings of the control loops, in the units of the loops.

use super::curve::{RateCurve, RatesType, ThrottleCurve, ThrottleLimit};
use crate::firmware::config::{MixRow, MixerKind};
use crate::firmware::filter::LowPassKind;
use crate::firmware::settings::Settings;
use crate::math;
use crate::signals::PerMotor;
use crate::telemetry::FirmwareProfile;

/// The gains of one axis. The error is in °/s, the sum in thousandths of the mixer's range.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AxisGains {
    /// Per °/s.
    pub p: f64,
    /// Per °.
    pub i: f64,
    /// Per °/s².
    pub d: f64,
    /// Per °/s² of the setpoint.
    pub f: f64,
}

/// A low-pass with a cutoff that moves with the throttle between two bounds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DynamicLowPass {
    pub kind: LowPassKind,
    /// The cutoff at zero throttle, Hz.
    pub min_hz: f64,
    /// The cutoff at full throttle, Hz; equal to `min_hz` for a static filter.
    pub max_hz: f64,
    /// The bend of the curve between them, 0…10.
    pub expo: f64,
}

impl DynamicLowPass {
    /// Returns the cutoff for a throttle 0…1, Hz.
    pub fn cutoff_hz(&self, throttle: f64) -> f64 {
        let bent = throttle + throttle * (1.0 - throttle) * self.expo / 10.0;
        self.min_hz + (self.max_hz - self.min_hz) * bent
    }
}

/// A low-pass with a fixed cutoff.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StaticLowPass {
    pub kind: LowPassKind,
    /// The cutoff, Hz; 0 = off.
    pub hz: f64,
}

/// Settings of i-term relax, which holds back the integral while the setpoint moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ItermRelax {
    /// The axes on which it works: roll, pitch, yaw.
    pub axes: [bool; 3],
    /// Works only while the integral grows.
    pub increments_only: bool,
    /// Uses the gyro instead of the setpoint.
    pub by_gyro: bool,
    /// The cutoff of the slow setpoint, Hz.
    pub cutoff_hz: f64,
}

/// Settings of the reactions to quick throttle changes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BoostTuning {
    /// The rise of I for a change over the whole throttle range, as a factor on top of 1.
    pub anti_gravity_i: f64,
    /// The same for P, before its scale.
    pub anti_gravity_p: f64,
    /// The cutoff below which throttle changes do not raise the gains, Hz.
    pub anti_gravity_cutoff_hz: f64,
    /// The throttle added per quick throttle change.
    pub throttle: f64,
    /// The cutoff below which throttle changes add no throttle, Hz.
    pub throttle_cutoff_hz: f64,
}

/// D-max: a D gain that rises in fast moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DMax {
    /// The D gain in the fastest moves on roll, pitch and yaw, per °/s². It has no effect unless above the base.
    pub most: [f64; 3],
    /// The share of the rise for each °/s² of movement; 0 = D stays at the base.
    pub readiness: f64,
    /// The weight of a moving setpoint relative to a moving craft.
    pub setpoint_share: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateTuning {
    /// The gains of roll, pitch and yaw.
    pub gains: [AxisGains; 3],
    pub sum_limit: [f64; 3],
    pub integral_limit: [f64; 3],
    pub d_max: DMax,
    /// I-term rotation: the integrals turn with the craft, so that they keep their direction in the world.
    pub iterm_rotation: bool,
    /// The first gyro filter.
    pub gyro_lpf1: DynamicLowPass,
    /// The second gyro filter.
    pub gyro_lpf2: StaticLowPass,
    /// The first filter of the derivative.
    pub d_lpf1: DynamicLowPass,
    /// The second filter of the derivative.
    pub d_lpf2: StaticLowPass,
    /// The cutoff of the yaw P term, Hz; 0 = off.
    pub yaw_lowpass_hz: f64,
    pub relax: ItermRelax,
    /// Applies TPA to P, too.
    pub tpa_on_p: bool,
    /// The throttle above which TPA reduces the gains, 0…1.
    pub tpa_breakpoint: f64,
    /// The reduction per unit of throttle above [`RateTuning::tpa_breakpoint`].
    pub tpa_slope: f64,
    /// The throttle below which the gains are reduced, 0…1.
    pub tpa_low_breakpoint: f64,
    /// The reduction at zero throttle; see [`RateTuning::tpa_low_breakpoint`].
    pub tpa_low_share: f64,
    /// Keeps the low-throttle reduction on after the throttle was raised.
    pub tpa_low_always: bool,
    /// The share of the stick within which feed-forward fades in, 0…1; 0 = full everywhere.
    pub feedforward_transition: f64,
    /// Lets P, D and F work at zero throttle without airmode.
    pub at_min_throttle: bool,
    /// The number of gyro samples per run of the loop.
    pub denominator: u8,
}

/// Settings of ANGLE and HORIZON.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelTuning {
    /// `true` for the angle loop of master, which has no leading angle.
    pub is_plain: bool,
    /// The largest angle of the sticks, °.
    pub limit_deg: f64,
    /// The rate per angle error, 1/s.
    pub p: f64,
    /// The share of the angle that is led instead of corrected; 1 = all of it.
    pub feedforward: f64,
    /// The time in which the leading angle follows a stick, s.
    pub smoothing_s: f64,
    /// The share of yaw that turns about the vertical of the earth, 0…1.
    pub earth_reference: f64,
    /// The angles of a level craft, °: roll right and pitch nose down.
    pub trim_deg: [f64; 2],
    /// ANGLE levels roll only; pitch is flown by rate.
    pub race_mode: bool,
    /// HORIZON: the share of levelling at the stick centre, 0…1.
    pub horizon_strength: f64,
    /// HORIZON: the share of the stick at which levelling ends.
    pub horizon_stick_limit: f64,
    /// HORIZON: the tilt at which levelling ends, °.
    pub horizon_tilt_limit_deg: f64,
    /// HORIZON: the sticks do not reduce levelling.
    pub horizon_ignores_sticks: bool,
    /// HORIZON: the time in which levelling returns, s.
    pub horizon_delay_s: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixerTuning {
    /// The shares of the four motors; yaw clockwise positive.
    pub rows: PerMotor<MixRow>,
    /// `true` if the propellers turn the other way round.
    pub yaw_reversed: bool,
    /// The pulse of a stopped motor, µs.
    pub stop_us: f64,
    /// The lowest pulse of a running motor, µs.
    pub idle_us: f64,
    /// The highest pulse, µs.
    pub max_us: f64,
    /// The share of the range that is used, 0…1.
    pub output_limit: f64,
    /// The slope added at zero output to make thrust more linear, 0…1.5.
    pub thrust_linear: f64,
}

/// The throttle added in level modes to make up for the lift that a tilted craft loses.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TiltThrottle {
    /// The share of the throttle range that is added at the tilt below.
    pub share: f64,
    /// The tilt at which the addition is complete, rad.
    pub complete_rad: f64,
}

impl TiltThrottle {
    /// Returns the throttle to add at a tilt.
    pub fn at(&self, cos_tilt: f64) -> f64 {
        if self.share <= 0.0 {
            return 0.0;
        }
        let tilt = math::acos(cos_tilt.clamp(-1.0, 1.0));
        let way = (tilt / self.complete_rad.max(1e-3)).min(1.0);
        self.share * math::sin(way * std::f64::consts::FRAC_PI_2)
    }
}

/// Everything that the controller takes from the settings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tuning {
    /// The rate curves of roll, pitch and yaw.
    pub rates: [RateCurve; 3],
    /// `true` if the yaw stick works the other way round.
    pub yaw_stick_reversed: bool,
    pub throttle: ThrottleCurve,
    pub tilt_throttle: TiltThrottle,
    pub boost: BoostTuning,
    /// The largest change of the stick setpoints of roll, pitch and yaw, °/s²; 0 = no limit.
    pub accel_limit_dps2: [f64; 3],
    pub smoothing: bool,
    /// `rc_smoothing_auto_factor` for sticks and throttle.
    pub smoothing_factor: [f64; 2],
    /// The fixed cutoffs of sticks and throttle, Hz; 0 = by the frame rate.
    pub smoothing_cutoff_hz: [f64; 2],
    pub rate: RateTuning,
    pub level: LevelTuning,
    pub mixer: MixerTuning,
}

impl Default for Tuning {
    fn default() -> Self {
        Self::from_settings(&Settings::default(), MixerKind::QuadX, &[])
    }
}

/// The units of the gain settings.
const P_SCALE: f64 = 0.032_029;
const I_SCALE: f64 = 0.244_381;
const D_SCALE: f64 = 0.000_529;
const F_SCALE: f64 = 0.013_754 / 100.0;
const YAW_I_FACTOR: f64 = 2.5;
/// The unit of `acc_limit`, °/s².
const ACCEL_LIMIT_UNIT_DPS2: f64 = 100.0;
/// The acceleration of the craft or its setpoint (°/s²) at which D is at its maximum with a `d_max_gain` of 1.
const FULL_D_DPS2: f64 = 200_000.0;
/// The value of `angle_feedforward` that leads the whole angle. It is a little above the default, because the rate loop
/// lags and the angle loop adds the rest.
const FULL_ANGLE_FEEDFORWARD: f64 = 67.0;
/// That of master, whose sticks overshoot in ANGLE. Measured, as is the smoothing.
const FULL_PLAIN_FEEDFORWARD: f64 = 62.0;
/// The full stick deflection, RC command units.
const FULL_STICK: f64 = 500.0;

impl Tuning {
    /// Reads the tuning of the active profiles for this airframe type. A type that cannot fly here flies as QUADX.
    pub fn from_settings(settings: &Settings, mixer: MixerKind, custom_mix: &[MixRow]) -> Self {
        let reader = Reader(settings);
        Self {
            rates: [reader.curve("roll"), reader.curve("pitch"), reader.curve("yaw")],
            yaw_stick_reversed: settings.flag("yaw_control_reversed"),
            throttle: reader.throttle(),
            tilt_throttle: TiltThrottle {
                share: reader.number("thr_corr_value") / 1000.0,
                complete_rad: (reader.number("thr_corr_angle") / 10.0).to_radians(),
            },
            boost: reader.boost(),
            accel_limit_dps2: ["acc_limit", "acc_limit", "acc_limit_yaw"]
                .map(|name| ACCEL_LIMIT_UNIT_DPS2 * reader.number(name)),
            smoothing: settings.flag("rc_smoothing"),
            smoothing_factor: [
                reader.number("rc_smoothing_auto_factor"),
                reader.number("rc_smoothing_auto_factor_throttle"),
            ],
            smoothing_cutoff_hz: [
                reader.number("rc_smoothing_setpoint_cutoff"),
                reader.number("rc_smoothing_throttle_cutoff"),
            ],
            rate: reader.rate(),
            level: reader.level(),
            mixer: reader.mixer(mixer, custom_mix),
        }
    }

    /// Returns the angles that the sticks (RC command units, roll right and pitch nose down) ask for in ANGLE mode, °.
    pub fn stick_angles_deg(&self, sticks: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|axis| {
            let rate = self.rates[axis].rate_dps(sticks[axis] / FULL_STICK);
            self.level.limit_deg * (rate / self.rates[axis].rate_dps(1.0).max(1.0)).clamp(-1.0, 1.0)
        })
    }
}

struct Reader<'a>(&'a Settings);

impl Reader<'_> {
    fn number(&self, name: &str) -> f64 {
        self.0.number(name) as f64
    }

    /// Returns the number of a setting whose name contains an axis.
    fn of(&self, prefix: &str, axis: &str, suffix: &str) -> f64 {
        self.number(&format!("{prefix}{axis}{suffix}"))
    }

    fn kind(&self, name: &str) -> LowPassKind {
        u8::try_from(self.0.number(name)).ok().and_then(LowPassKind::from_repr).unwrap_or_default()
    }

    fn curve(&self, axis: &str) -> RateCurve {
        let kind = u8::try_from(self.0.number("rates_type")).ok().and_then(RatesType::from_repr);
        RateCurve {
            kind: kind.unwrap_or_default(),
            rc_rate: self.of("", axis, "_rc_rate"),
            srate: self.of("", axis, "_srate"),
            expo: self.of("", axis, "_expo"),
            limit_dps: self.of("", axis, "_rate_limit"),
            quick_expo_on_stick: self.0.flag("quickrates_rc_expo"),
        }
    }

    fn throttle(&self) -> ThrottleCurve {
        let limit = u8::try_from(self.0.number("throttle_limit_type")).ok();
        ThrottleCurve {
            zero_us: self.number("min_check").clamp(1000.0, 1900.0),
            mid: self.number("thr_mid") / 100.0,
            hover: self.number("thr_hover") / 100.0,
            expo: self.number("thr_expo") / 100.0,
            limit: limit.and_then(ThrottleLimit::from_repr).unwrap_or_default(),
            limit_share: self.number("throttle_limit_percent") / 100.0,
        }
    }

    fn gains(&self, axis: &str, i_factor: f64) -> AxisGains {
        AxisGains {
            p: P_SCALE * self.of("p_", axis, ""),
            i: I_SCALE * i_factor * self.of("i_", axis, ""),
            d: D_SCALE * self.of("d_", axis, ""),
            f: F_SCALE * self.of("f_", axis, ""),
        }
    }

    fn lpf(&self, prefix: &str) -> (DynamicLowPass, StaticLowPass) {
        let number = |suffix: &str| self.number(&format!("{prefix}_{suffix}"));
        let (min, max) = (number("lpf1_dyn_min_hz"), number("lpf1_dyn_max_hz"));
        let fixed = number("lpf1_static_hz");
        let (min_hz, max_hz) = if min > 0.0 { (min, max.max(min)) } else { (fixed, fixed) };
        let first = DynamicLowPass {
            kind: self.kind(&format!("{prefix}_lpf1_type")),
            min_hz,
            max_hz,
            expo: number("lpf1_dyn_expo"),
        };
        let second =
            StaticLowPass { kind: self.kind(&format!("{prefix}_lpf2_type")), hz: number("lpf2_static_hz") };
        (first, second)
    }

    fn boost(&self) -> BoostTuning {
        let gain = self.number("anti_gravity_gain") / 10.0;
        BoostTuning {
            anti_gravity_i: gain,
            anti_gravity_p: gain * self.number("anti_gravity_p_gain") / 100.0,
            anti_gravity_cutoff_hz: self.number("anti_gravity_cutoff_hz"),
            throttle: self.number("throttle_boost") / 10.0,
            throttle_cutoff_hz: self.number("throttle_boost_cutoff"),
        }
    }

    fn d_max(&self) -> DMax {
        DMax {
            most: ["roll", "pitch", "yaw"].map(|axis| D_SCALE * self.of("d_max_", axis, "")),
            readiness: self.number("d_max_gain") / FULL_D_DPS2,
            setpoint_share: self.number("d_max_advance") / 100.0,
        }
    }

    fn rate(&self) -> RateTuning {
        let (gyro_lpf1, gyro_lpf2) = self.lpf("gyro");
        let (d_lpf1, d_lpf2) = self.lpf("dterm");
        let (sum, sum_yaw) = (self.number("pidsum_limit"), self.number("pidsum_limit_yaw"));
        let windup = self.number("iterm_windup") / 100.0;
        let relax = self.0.text("iterm_relax");
        let breakpoint = ((self.number("tpa_breakpoint") - 1000.0) / 1000.0).clamp(0.0, 0.99);
        RateTuning {
            gains: [self.gains("roll", 1.0), self.gains("pitch", 1.0), self.gains("yaw", YAW_I_FACTOR)],
            sum_limit: [sum, sum, sum_yaw],
            integral_limit: [sum * windup, sum * windup, sum_yaw * windup],
            d_max: self.d_max(),
            iterm_rotation: self.0.flag("iterm_rotation"),
            gyro_lpf1,
            gyro_lpf2,
            d_lpf1,
            d_lpf2,
            yaw_lowpass_hz: self.number("yaw_lowpass_hz"),
            relax: ItermRelax {
                axes: [relax != "OFF", relax != "OFF", relax.starts_with("RPY")],
                increments_only: relax.ends_with("INC"),
                by_gyro: self.0.text("iterm_relax_type") == "GYRO",
                cutoff_hz: self.number("iterm_relax_cutoff"),
            },
            tpa_on_p: self.0.text("tpa_mode") == "PD",
            tpa_breakpoint: breakpoint,
            tpa_slope: self.number("tpa_rate") / 100.0 / (1.0 - breakpoint),
            tpa_low_breakpoint: (self.number("tpa_low_breakpoint") - 1000.0) / 1000.0,
            tpa_low_share: self.number("tpa_low_rate") / 100.0,
            tpa_low_always: self.0.flag("tpa_low_always"),
            feedforward_transition: self.number("feedforward_transition") / 100.0,
            at_min_throttle: self.0.flag("pid_at_min_throttle"),
            denominator: u8::try_from(self.0.number("pid_process_denom")).unwrap_or(1).max(1),
        }
    }

    fn level(&self) -> LevelTuning {
        let is_plain = self.0.profile() == FirmwareProfile::Master;
        let full_feedforward = if is_plain { FULL_PLAIN_FEEDFORWARD } else { FULL_ANGLE_FEEDFORWARD };
        LevelTuning {
            is_plain,
            limit_deg: self.number("angle_limit"),
            p: self.number("angle_p_gain") / 10.0,
            feedforward: self.number("angle_feedforward") / full_feedforward,
            smoothing_s: self.number("angle_feedforward_smoothing_ms") / 1000.0,
            earth_reference: self.number("angle_earth_ref") / 100.0,
            trim_deg: [self.number("acc_trim_roll") / 10.0, self.number("acc_trim_pitch") / 10.0],
            race_mode: self.0.flag("level_race_mode"),
            horizon_strength: self.number("horizon_level_strength") / 100.0,
            horizon_stick_limit: self.number("horizon_limit_sticks") / 100.0,
            horizon_tilt_limit_deg: self.number("horizon_limit_degrees"),
            horizon_ignores_sticks: self.0.flag("horizon_ignore_sticks"),
            horizon_delay_s: self.number("horizon_delay_ms") / 1000.0,
        }
    }

    fn mixer(&self, kind: MixerKind, custom: &[MixRow]) -> MixerTuning {
        let quad_x = MixerKind::QuadX.rows().unwrap_or_default();
        let custom_rows = match (kind, custom) {
            (MixerKind::Custom, &[a, b, c, d, ..]) => Some([a, b, c, d]),
            _ => None,
        };
        let stop_us = self.number("min_command");
        MixerTuning {
            rows: custom_rows.or_else(|| kind.rows()).unwrap_or(quad_x),
            yaw_reversed: self.0.flag("yaw_motors_reversed"),
            stop_us,
            idle_us: stop_us + self.number("motor_idle") / 10.0,
            max_us: self.number("max_throttle").max(stop_us + 1.0),
            output_limit: self.number("motor_output_limit") / 100.0,
            thrust_linear: self.number("thrust_linear") / 100.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::Params;

    #[test]
    fn default_gains_and_limits() {
        let rate = Tuning::default().rate;
        assert!((rate.gains[0].p - 45.0 * 0.032029).abs() < 1e-12);
        assert!((rate.gains[2].i - 80.0 * 0.244381 * 2.5).abs() < 1e-12);
        assert_eq!((rate.integral_limit[0], rate.integral_limit[2]), (400.0, 320.0));
        assert!((rate.tpa_slope - 1.0).abs() < 1e-12);
        assert_eq!(rate.relax.axes, [true, true, false]);
    }

    #[test]
    fn mixer_and_navigator_agree_on_zero_throttle() {
        let mut settings = Settings::default();
        for min_check in [750, 1050, 1900, 2000, 2250] {
            settings.set_number("min_check", min_check).unwrap();
            let zero_us = Tuning::from_settings(&settings, MixerKind::QuadX, &[]).throttle.zero_us;
            let params = Params { min_check: min_check as u16, ..Params::default() };
            assert_eq!(zero_us, params.throttle_zero_us(), "{min_check}");
            assert!(zero_us < 2000.0, "{min_check}");
        }
    }

    #[test]
    fn default_motor_range_is_idle_to_full() {
        let mixer = Tuning::default().mixer;
        assert_eq!((mixer.stop_us, mixer.idle_us, mixer.max_us), (1000.0, 1055.0, 2000.0));
        assert_eq!(Some(mixer.rows), MixerKind::QuadX.rows());
    }

    #[test]
    fn a_custom_mix_flies_when_it_has_four_rows() {
        let row = MixRow { throttle: 0.9, roll: 0.5, pitch_down: 0.5, yaw: 0.1 };
        let of = |rows: &[MixRow]| Tuning::from_settings(&Settings::default(), MixerKind::Custom, rows);
        assert_eq!(of(&[row; 4]).mixer.rows, [row; 4]);
        assert_eq!(of(&[row; 2]).mixer.rows, Tuning::default().mixer.rows);
    }

    #[test]
    fn the_dynamic_cutoff_runs_between_its_bounds() {
        let filter = Tuning::default().rate.gyro_lpf1;
        assert_eq!((filter.cutoff_hz(0.0), filter.cutoff_hz(1.0)), (250.0, 500.0));
        assert!((filter.cutoff_hz(0.5) - (250.0 + 250.0 * 0.625)).abs() < 1e-9);
    }
}
