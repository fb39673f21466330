//! The colours of the pictures, by their roles.

macro_rules! colours {
    ($($(#[$doc:meta])* $variant:ident $light:literal $dark:literal;)*) => {
        /// The role of a colour. Each has a value on white and one on a dark page.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub(in crate::report) enum Colour {
            $($(#[$doc])* $variant,)*
        }

        impl Colour {
            /// All colours. Their values on white differ from each other.
            pub(in crate::report) const ALL: &[Self] = &[$(Self::$variant,)*];

            /// Returns the values on white and on a dark page, red, green and blue in 24 bits.
            const fn values(self) -> (u32, u32) {
                match self {
                    $(Self::$variant => ($light, $dark),)*
                }
            }
        }
    };
}

colours! {
    /// The page.
    Paper 0xffffff 0x161b22;
    /// Texts and marks.
    Ink 0x1f2328 0xe6edf3;
    /// Numbers at the axes.
    Label 0x59636e 0x9da7b3;
    /// The lines of the axes.
    Axis 0xafb8c1 0x4b535d;
    /// The lines of the grid.
    Grid 0xe4e8ec 0x2b323b;
    /// The plan.
    Plan 0x6e7781 0x8b949e;
    /// The first of two firmwares, and true values.
    First 0x0072b2 0x58a6ff;
    /// The second of two firmwares.
    Second 0xd55e00 0xff9e4a;
    /// Values that the flight controller estimates or reports.
    Estimate 0xc2418b 0xf48fc4;
    /// The ground.
    Ground 0x8a6d3b 0xc9a86a;
    /// Areas and lines of the map.
    Backdrop 0xa3adb8 0x5c6672;
    /// Zones in which nobody may fly.
    Exclusion 0xcf222e 0xff7b72;
    /// Zones that the craft must not leave.
    Inclusion 0x1a7f37 0x56d364;
    /// No state is known, or the autopilot is off.
    Idle 0x8c959f 0x76818d;
    Approaching 0x0969da 0x54aeff;
    Arrived 0x007a7a 0x39c5cf;
    Holding 0x9a6700 0xd29922;
    Orbiting 0xbc4c00 0xf0883e;
    Figure8 0x8250df 0xbc8cff;
    Landing 0xa40e26 0xffa198;
    Complete 0x116329 0x3fb950;
}

impl Colour {
    /// Returns the value on white as the drawings write it: `#0072B2`.
    pub(in crate::report) fn light(self) -> String {
        format!("#{:06X}", self.values().0)
    }

    /// Returns the value on a dark page.
    pub(in crate::report) fn dark(self) -> String {
        format!("#{:06X}", self.values().1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the contrast ratio of two colours, 1 to 21, as WCAG 2 defines it.
    fn contrast(one: u32, other: u32) -> f64 {
        let luminance = |colour: u32| {
            let channel = |shift: u32| {
                let value = f64::from(colour >> shift & 0xff) / 255.0;
                if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * channel(16) + 0.7152 * channel(8) + 0.0722 * channel(0)
        };
        let (one, other) = (luminance(one) + 0.05, luminance(other) + 0.05);
        one.max(other) / one.min(other)
    }

    #[test]
    fn lines_and_texts_stand_out_from_the_page() {
        let (paper, dark_paper) = Colour::Paper.values();
        let quiet = [Colour::Paper, Colour::Axis, Colour::Grid, Colour::Backdrop];
        for colour in Colour::ALL.iter().filter(|colour| !quiet.contains(colour)) {
            let (light, dark) = colour.values();
            let least = if matches!(colour, Colour::Ink | Colour::Label) { 4.5 } else { 2.9 };
            assert!(contrast(light, paper) >= least, "{colour:?} on white: {}", contrast(light, paper));
            assert!(contrast(dark, dark_paper) >= least, "{colour:?} dark: {}", contrast(dark, dark_paper));
        }
    }

    #[test]
    fn each_colour_can_be_told_from_the_others_on_white() {
        for (index, colour) in Colour::ALL.iter().enumerate() {
            assert!(!Colour::ALL[..index].iter().any(|other| other.light() == colour.light()), "{colour:?}");
        }
        assert_eq!((Colour::First.light(), Colour::First.dark()), ("#0072B2".into(), "#58A6FF".into()));
    }
}
