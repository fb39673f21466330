//! The tuning sliders: a few multipliers that set gains and filters.
//!
//! Each gain is its default times the master multiplier times the sliders of its term. The pitch sliders apply to pitch
//! only. Each low-pass frequency is its default times the filter's multiplier. 100 means 1.0.

use super::Call;
use super::layout::{self, Field, u8};
use crate::firmware::settings::{Kind, Settings, find};
use crate::msp::{PaddedReader, Writer};

/// The sliders of the gains in wire order.
const SLIDERS: [&str; 9] = [
    "simplified_pids_mode",
    "simplified_master_multiplier",
    "simplified_pitch_d_gain",
    "simplified_i_gain",
    "simplified_d_gain",
    "simplified_pi_gain",
    "simplified_d_max_gain",
    "simplified_feedforward_gain",
    "simplified_pitch_pi_gain",
];

/// The number of unused bytes at the end of each block.
const SPARE: usize = 8;

const AXES: [&str; 3] = ["roll", "pitch", "yaw"];
const PITCH: usize = 1;
const YAW: usize = 2;

/// The low-pass filters of one slider: its switch, its multiplier, and the cutoffs (first, second, dynamic minimum,
/// dynamic maximum).
struct Filter {
    switch: &'static str,
    multiplier: &'static str,
    cutoffs: [&'static str; 4],
}

const DTERM: Filter = Filter {
    switch: "simplified_dterm_filter",
    multiplier: "simplified_dterm_filter_multiplier",
    cutoffs: [
        "dterm_lpf1_static_hz",
        "dterm_lpf2_static_hz",
        "dterm_lpf1_dyn_min_hz",
        "dterm_lpf1_dyn_max_hz",
    ],
};

const GYRO: Filter = Filter {
    switch: "simplified_gyro_filter",
    multiplier: "simplified_gyro_filter_multiplier",
    cutoffs: ["gyro_lpf1_static_hz", "gyro_lpf2_static_hz", "gyro_lpf1_dyn_min_hz", "gyro_lpf1_dyn_max_hz"],
};

/// The gains of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Gains {
    p: i64,
    i: i64,
    d: i64,
    d_max: i64,
    f: i64,
}

/// The positions of the gain sliders.
#[derive(Debug, Clone, Copy)]
struct Sliders {
    mode: i64,
    master: f64,
    pitch_d: f64,
    i: f64,
    d: f64,
    pi: f64,
    d_max: f64,
    feedforward: f64,
    pitch_pi: f64,
}

impl Sliders {
    fn new(values: [i64; 9]) -> Self {
        let [mode, rest @ ..] = values;
        let [master, pitch_d, i, d, pi, d_max, feedforward, pitch_pi] =
            rest.map(|value| value as f64 / 100.0);
        Self { mode, master, pitch_d, i, d, pi, d_max, feedforward, pitch_pi }
    }

    fn stored(settings: &Settings) -> Self {
        Self::new(SLIDERS.map(|name| settings.number(name)))
    }

    /// Returns `true` if the sliders set the gains of this axis. Mode 1 leaves yaw unchanged; mode 2 sets all axes.
    fn governs(&self, axis: usize) -> bool {
        self.mode >= 2 || (self.mode == 1 && axis != YAW)
    }

    fn gains(&self, axis: usize) -> Gains {
        let name = AXES[axis];
        let (pitch_d, pitch_pi) = if axis == PITCH { (self.pitch_d, self.pitch_pi) } else { (1.0, 1.0) };
        let pi = self.master * self.pi * pitch_pi;
        let d = self.master * self.d * pitch_d;
        let (d_default, d_max_default) = (default(&format!("d_{name}")), default(&format!("d_max_{name}")));
        let headroom =
            if d_default > 0.0 { 1.0 + (d_max_default / d_default - 1.0) * self.d_max } else { 1.0 };
        let scaled = |term: &str, factor: f64| fit(&format!("{term}_{name}"), factor);
        Gains {
            p: scaled("p", pi),
            i: scaled("i", pi * self.i),
            d: scaled("d", d),
            d_max: limit(&format!("d_max_{name}"), d_default * d * headroom),
            f: scaled("f", self.master * self.feedforward * pitch_pi),
        }
    }
}

/// Returns the default of a numeric setting.
fn default(name: &str) -> f64 {
    match find(name).map(|setting| setting.kind) {
        Some(Kind::Number { default, .. }) => default as f64,
        _ => 0.0,
    }
}

/// Returns a setting's default times a factor, within its range.
fn fit(name: &str, factor: f64) -> i64 {
    limit(name, default(name) * factor)
}

fn limit(name: &str, value: f64) -> i64 {
    let value = value.round() as i64;
    match find(name).map(|setting| setting.kind) {
        Some(Kind::Number { min, max, .. }) => value.clamp(min, max),
        _ => value,
    }
}

fn stored_gains(settings: &Settings, axis: usize) -> Gains {
    let name = AXES[axis];
    let number = |term: &str| settings.number(&format!("{term}_{name}"));
    Gains { p: number("p"), i: number("i"), d: number("d"), d_max: number("d_max"), f: number("f") }
}

impl Filter {
    /// Returns the cutoffs for a multiplier. A low-pass that is off stays off.
    fn computed(&self, multiplier: i64, present: [i64; 4]) -> [i64; 4] {
        let mut cutoffs = present;
        for (cutoff, name) in cutoffs.iter_mut().zip(self.cutoffs) {
            if *cutoff != 0 {
                *cutoff = fit(name, multiplier as f64 / 100.0);
            }
        }
        cutoffs
    }

    fn stored(&self, settings: &Settings) -> [i64; 4] {
        self.cutoffs.map(|name| settings.number(name))
    }

    fn read(&self, settings: &Settings, reply: &mut Writer) {
        self.write_block(
            settings.number(self.switch),
            settings.number(self.multiplier),
            self.stored(settings),
            reply,
        );
    }

    fn write_block(&self, switch: i64, multiplier: i64, cutoffs: [i64; 4], reply: &mut Writer) {
        reply.u8(switch);
        reply.u8(multiplier);
        for cutoff in cutoffs {
            reply.u16(cutoff);
        }
        reply.zeros(SPARE);
    }

    fn take_block(request: &mut PaddedReader<'_>) -> (i64, i64, [i64; 4]) {
        let (switch, multiplier) = (i64::from(request.u8()), i64::from(request.u8()));
        let cutoffs = [(); 4].map(|()| i64::from(request.u16()));
        request.u32();
        request.u32();
        (switch, multiplier, cutoffs)
    }

    fn write(&self, settings: &mut Settings, request: &mut PaddedReader<'_>) {
        if request.remaining() == 0 {
            return;
        }
        let (switch, multiplier, cutoffs) = Self::take_block(request);
        layout::put(settings, self.switch, switch);
        layout::put(settings, self.multiplier, multiplier);
        let cutoffs =
            if switch == 0 { cutoffs } else { self.computed(settings.number(self.multiplier), cutoffs) };
        for (name, cutoff) in self.cutoffs.into_iter().zip(cutoffs) {
            layout::put(settings, name, cutoff);
        }
    }

    /// Returns `true` if the slider is off or the stored cutoffs match it.
    fn is_explained(&self, settings: &Settings) -> bool {
        let stored = self.stored(settings);
        settings.number(self.switch) == 0 || self.computed(settings.number(self.multiplier), stored) == stored
    }

    fn calculate(&self, call: &mut Call<'_>) {
        let (switch, multiplier, cutoffs) = Self::take_block(&mut call.request);
        let cutoffs = if switch == 0 { cutoffs } else { self.computed(multiplier, cutoffs) };
        self.write_block(switch, multiplier, cutoffs, &mut call.reply);
    }
}

pub(super) fn tuning(call: &mut Call<'_>) {
    let settings = &call.configuration.settings;
    layout::read(&SLIDERS.map(u8), settings, &mut call.reply);
    call.reply.zeros(SPARE);
    DTERM.read(settings, &mut call.reply);
    GYRO.read(settings, &mut call.reply);
}

pub(super) fn set_tuning(call: &mut Call<'_>) {
    let settings = &mut call.configuration.settings;
    let fields: [Field; 9] = SLIDERS.map(u8);
    layout::write(&fields, settings, &mut call.request);
    call.request.u32();
    call.request.u32();
    let sliders = Sliders::stored(settings);
    for axis in (0..AXES.len()).filter(|&axis| sliders.governs(axis)) {
        let (name, gains) = (AXES[axis], sliders.gains(axis));
        let terms = [("p", gains.p), ("i", gains.i), ("d", gains.d), ("d_max", gains.d_max), ("f", gains.f)];
        for (term, gain) in terms {
            layout::put(settings, &format!("{term}_{name}"), gain);
        }
    }
    DTERM.write(settings, &mut call.request);
    GYRO.write(settings, &mut call.request);
}

pub(super) fn calculate_pid(call: &mut Call<'_>) {
    let sliders = Sliders::new([(); 9].map(|()| i64::from(call.request.u8())));
    for axis in 0..AXES.len() {
        let gains = if sliders.governs(axis) {
            sliders.gains(axis)
        } else {
            stored_gains(&call.configuration.settings, axis)
        };
        for gain in [gains.p, gains.i, gains.d, gains.d_max] {
            call.reply.u8(gain);
        }
        call.reply.u16(gains.f);
    }
}

pub(super) fn calculate_gyro(call: &mut Call<'_>) {
    GYRO.calculate(call);
}

pub(super) fn calculate_dterm(call: &mut Call<'_>) {
    DTERM.calculate(call);
}

pub(super) fn validate(call: &mut Call<'_>) {
    let settings = &call.configuration.settings;
    let sliders = Sliders::stored(settings);
    let gains = (0..AXES.len())
        .filter(|&axis| sliders.governs(axis))
        .all(|axis| sliders.gains(axis) == stored_gains(settings, axis));
    let explained = [gains, GYRO.is_explained(settings), DTERM.is_explained(settings)];
    for part in explained {
        call.reply.u8(u8::from(part));
    }
}
