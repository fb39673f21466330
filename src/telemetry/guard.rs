//! A condition of the state machine with its value, limit and unit.

/// Comparison a guard makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::Display)]
pub enum GuardOp {
    /// value ≤ limit
    #[strum(to_string = "≤")]
    AtMost,
    /// value ≥ limit
    #[strum(to_string = "≥")]
    AtLeast,
    /// value < limit
    #[strum(to_string = "<")]
    Below,
    /// value > limit
    #[strum(to_string = ">")]
    Above,
}

/// A named condition of the state machine with everything needed to say why it does or does not hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Guard {
    /// What is compared: `arrival`, `turn radius`, `plane`, `hold time`, `touchdown altitude`…
    pub name: &'static str,
    /// The measured value.
    pub value: f64,
    /// The limit it is compared with.
    pub limit: f64,
    /// How.
    pub op: GuardOp,
    /// Unit of both, `m`, `s`, `m/s`, `µs`, `deg`.
    pub unit: &'static str,
}

impl Guard {
    /// Whether the condition holds; never for NaN.
    #[must_use]
    pub fn holds(&self) -> bool {
        match self.op {
            GuardOp::AtMost => self.value <= self.limit,
            GuardOp::AtLeast => self.value >= self.limit,
            GuardOp::Below => self.value < self.limit,
            GuardOp::Above => self.value > self.limit,
        }
    }

    /// How far the value is on the fulfilled side: ≥ 0 when the condition holds.
    #[must_use]
    pub fn margin(&self) -> f64 {
        match self.op {
            GuardOp::AtMost | GuardOp::Below => self.limit - self.value,
            GuardOp::AtLeast | GuardOp::Above => self.value - self.limit,
        }
    }
}
