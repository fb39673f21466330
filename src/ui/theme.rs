//! The meaning of colours and marks: panels name roles, the theme turns them into styles that the terminal can show.

use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;

use crate::telemetry::GuardOp;

/// The meaning of a piece of text or a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, strum::EnumIter)]
pub enum Role {
    Text,
    /// Less important: frames, units, things that are not active.
    Dim,
    /// Names of panels and columns.
    Title,
    /// The element with the focus.
    Focus,
    /// A good state.
    Ok,
    Warn,
    Fault,
    /// The active element.
    Active,
    /// The current target of the craft.
    Target,
    /// The flown track of the craft.
    Track,
    /// The predicted track of the craft.
    Predicted,
    Craft,
    Fence,
    /// The lines of the backdrop and of the grid.
    Backdrop,
    /// A no-fly zone, or the zone that the flight must not leave.
    Zone,
    /// A key that can be pressed.
    Key,
    Selected,
}

/// The colours that the terminal shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Palette {
    /// 24-bit colours for a dark background, a set that colour-blind people can tell apart.
    #[default]
    Dark,
    /// The same set for a light background.
    Light,
    /// 24-bit colours far from each other and from a dark background.
    HighContrast,
    /// The terminal's own sixteen colours.
    Ansi16,
    /// No colours: only weight and reverse video.
    Mono,
}

impl Palette {
    /// The palettes with their names in theme settings.
    pub const NAMES: [(&'static str, Self); 5] = [
        ("dark", Self::Dark),
        ("light", Self::Light),
        ("high-contrast", Self::HighContrast),
        ("16", Self::Ansi16),
        ("mono", Self::Mono),
    ];
}

/// The characters that the terminal shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Charset {
    /// Box drawing, arrows, Braille.
    #[default]
    Unicode,
    Ascii,
}

/// The palette and character set in use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Theme {
    pub palette: Palette,
    pub charset: Charset,
    /// `true` if the environment requests no colours, which overrides all other settings.
    pub no_colour: bool,
}

impl Theme {
    /// Returns the theme that fits the environment: `NO_COLOR`, `COLORTERM`, `TERM`, and the locale variables. Colours
    /// are decided here because the terminal library on its own would also remove bold and reverse under `NO_COLOR`.
    pub fn from_environment(get: impl Fn(&str) -> Option<String>) -> Self {
        let set = |name: &str| get(name).filter(|value| !value.is_empty());
        let term = set("TERM").unwrap_or_default();
        let truecolour = set("COLORTERM").is_some_and(|value| value == "truecolor" || value == "24bit");
        let no_colour = set("NO_COLOR").is_some();
        let palette = if no_colour || term == "dumb" || term.starts_with("vt") {
            Palette::Mono
        } else if truecolour || term.contains("direct") {
            Palette::Dark
        } else {
            Palette::Ansi16
        };
        let locale = set("LC_ALL").or_else(|| set("LC_CTYPE")).or_else(|| set("LANG"));
        let utf8 = locale.is_none_or(|value| {
            let value = value.to_ascii_lowercase();
            value.contains("utf-8") || value.contains("utf8")
        });
        let charset = if utf8 && term != "linux" { Charset::Unicode } else { Charset::Ascii };
        Self { palette, charset, no_colour }
    }

    /// Returns the marker for lines on the map.
    pub fn marker(&self) -> Marker {
        match self.charset {
            Charset::Unicode => Marker::Braille,
            Charset::Ascii => Marker::Custom('.'),
        }
    }

    /// Returns a comparison operator in the character set.
    pub(super) fn operator(&self, op: GuardOp) -> &'static str {
        match (op, self.charset) {
            (GuardOp::AtMost, Charset::Unicode) => "≤",
            (GuardOp::AtMost, Charset::Ascii) => "<=",
            (GuardOp::AtLeast, Charset::Unicode) => "≥",
            (GuardOp::AtLeast, Charset::Ascii) => ">=",
            (GuardOp::Below, _) => "<",
            (GuardOp::Above, _) => ">",
        }
    }

    /// Returns the background colour to paint if the terminal's own cannot be relied on.
    pub fn background(&self) -> Option<Color> {
        match self.palette {
            Palette::Light => Some(Color::Rgb(250, 250, 247)),
            Palette::HighContrast => Some(Color::Rgb(0, 0, 0)),
            Palette::Dark | Palette::Ansi16 | Palette::Mono => None,
        }
    }

    /// Returns the foreground colour of a role.
    pub fn colour(&self, role: Role) -> Color {
        match self.palette {
            Palette::Mono => Color::Reset,
            Palette::Ansi16 => match role {
                Role::Text | Role::Selected => Color::Reset,
                Role::Dim | Role::Backdrop => Color::DarkGray,
                Role::Title => Color::Gray,
                Role::Focus | Role::Key => Color::LightCyan,
                Role::Ok | Role::Track => Color::LightGreen,
                Role::Warn | Role::Fence => Color::LightYellow,
                Role::Fault => Color::LightRed,
                Role::Zone => Color::Red,
                Role::Active => Color::LightYellow,
                Role::Target => Color::LightMagenta,
                Role::Craft => Color::White,
                Role::Predicted => Color::LightBlue,
            },
            Palette::Light => match role {
                Role::Text | Role::Selected => Color::Rgb(32, 35, 40),
                Role::Dim => Color::Rgb(104, 108, 116),
                Role::Backdrop => Color::Rgb(138, 141, 147),
                Role::Zone => Color::Rgb(170, 84, 58),
                Role::Title => Color::Rgb(62, 68, 78),
                Role::Focus | Role::Key => Color::Rgb(0, 92, 160),
                Role::Ok => Color::Rgb(0, 110, 80),
                Role::Track => Color::Rgb(0, 128, 94),
                Role::Warn => Color::Rgb(150, 90, 0),
                Role::Fence => Color::Rgb(140, 84, 10),
                Role::Fault => Color::Rgb(178, 60, 0),
                Role::Active => Color::Rgb(120, 96, 0),
                Role::Target => Color::Rgb(150, 50, 110),
                Role::Craft => Color::Rgb(0, 0, 0),
                Role::Predicted => Color::Rgb(52, 72, 170),
            },
            Palette::HighContrast => match role {
                Role::Text | Role::Selected | Role::Craft | Role::Title => Color::Rgb(255, 255, 255),
                Role::Dim => Color::Rgb(190, 190, 190),
                Role::Backdrop => Color::Rgb(128, 128, 128),
                Role::Zone => Color::Rgb(255, 110, 90),
                Role::Focus | Role::Key => Color::Rgb(120, 210, 255),
                Role::Ok | Role::Track => Color::Rgb(0, 240, 170),
                Role::Warn | Role::Fence => Color::Rgb(255, 190, 40),
                Role::Fault => Color::Rgb(255, 130, 70),
                Role::Active => Color::Rgb(255, 255, 0),
                Role::Target => Color::Rgb(255, 170, 230),
                Role::Predicted => Color::Rgb(170, 180, 255),
            },
            Palette::Dark => match role {
                Role::Text | Role::Selected => Color::Reset,
                Role::Dim => Color::Rgb(132, 136, 145),
                Role::Backdrop => Color::Rgb(82, 86, 95),
                Role::Zone => Color::Rgb(210, 110, 88),
                Role::Title => Color::Rgb(190, 196, 206),
                Role::Focus | Role::Key => Color::Rgb(86, 180, 233),
                Role::Ok => Color::Rgb(0, 186, 136),
                Role::Track => Color::Rgb(0, 158, 115),
                Role::Warn => Color::Rgb(240, 176, 32),
                Role::Fence => Color::Rgb(182, 122, 38),
                Role::Fault => Color::Rgb(237, 108, 50),
                Role::Active => Color::Rgb(240, 228, 66),
                Role::Target => Color::Rgb(214, 140, 186),
                Role::Craft => Color::Rgb(255, 255, 255),
                Role::Predicted => Color::Rgb(124, 152, 232),
            },
        }
    }

    /// Returns the style of a role.
    pub fn style(&self, role: Role) -> Style {
        let style = Style::new().fg(self.colour(role));
        match role {
            Role::Active | Role::Selected => style.add_modifier(Modifier::REVERSED),
            Role::Fault | Role::Focus | Role::Key | Role::Craft | Role::Target => {
                style.add_modifier(Modifier::BOLD)
            }
            Role::Dim | Role::Backdrop if self.palette == Palette::Mono => style.add_modifier(Modifier::DIM),
            Role::Text
            | Role::Dim
            | Role::Title
            | Role::Ok
            | Role::Warn
            | Role::Track
            | Role::Predicted
            | Role::Backdrop
            | Role::Zone
            | Role::Fence => style,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn theme(vars: &[(&str, &str)]) -> Theme {
        Theme::from_environment(|name| {
            vars.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
        })
    }

    #[test]
    fn the_environment_chooses_colours_and_characters() {
        let rich = [("COLORTERM", "truecolor"), ("TERM", "xterm-256color"), ("LANG", "en_GB.UTF-8")];
        assert_eq!(theme(&rich), Theme { palette: Palette::Dark, ..Theme::default() });
        assert_eq!(theme(&[("TERM", "xterm"), ("LANG", "C")]).charset, Charset::Ascii);
        assert_eq!(theme(&[("TERM", "xterm"), ("NO_COLOR", "1")]).palette, Palette::Mono);
        assert_eq!(theme(&[("TERM", "xterm"), ("NO_COLOR", "")]).palette, Palette::Ansi16);
        assert_eq!(theme(&[("LANG", "C"), ("LC_ALL", "C.utf8")]).charset, Charset::Unicode);
    }

    /// Returns the contrast ratio of two colours by WCAG 2.2, from 1 to 21.
    fn contrast(a: Color, b: Color) -> f64 {
        let luminance = |colour| {
            let Color::Rgb(r, g, b) = colour else { panic!("{colour} depends on the terminal") };
            let linear = |part: u8| match f64::from(part) / 255.0 {
                part if part <= 0.04045 => part / 12.92,
                part => ((part + 0.055) / 1.055).powf(2.4),
            };
            0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
        };
        let (a, b) = (luminance(a), luminance(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn text_and_lines_have_the_contrast_that_wcag_asks_for() {
        use strum::IntoEnumIterator as _;
        assert!((contrast(Color::Rgb(0, 0, 0), Color::Rgb(255, 255, 255)) - 21.0).abs() < 1e-9);
        // The background of the terminal for a palette that paints none; AA asks for 4.5, AAA for 7, lines for 3.
        let dark = Color::Rgb(30, 30, 30);
        let palettes = [(Palette::Dark, 4.5), (Palette::Light, 4.5), (Palette::HighContrast, 7.0)];
        for (palette, least_of_text) in palettes {
            let theme = Theme { palette, ..Theme::default() };
            let background = theme.background().unwrap_or(dark);
            for role in Role::iter() {
                // The dark palette leaves plain text to the terminal; its backdrop is only a hint of the ground.
                let is_left_out =
                    palette == Palette::Dark && matches!(role, Role::Text | Role::Selected | Role::Backdrop);
                if is_left_out {
                    continue;
                }
                let least = if matches!(role, Role::Backdrop | Role::Fence) { 3.0 } else { least_of_text };
                let ratio = contrast(theme.colour(role), background);
                assert!(ratio >= least, "{palette:?} {role:?}: {ratio:.2} of {least}");
            }
        }
    }

    #[test]
    fn without_colours_roles_that_matter_differ_by_weight() {
        let mono = Theme { palette: Palette::Mono, ..Theme::default() };
        let plain = mono.style(Role::Text);
        for role in
            [Role::Active, Role::Selected, Role::Fault, Role::Focus, Role::Key, Role::Craft, Role::Target]
        {
            assert_ne!(mono.style(role), plain, "{role:?}");
        }
    }

    #[test]
    fn without_colours_no_role_names_one() {
        use strum::IntoEnumIterator as _;
        let mono = Theme { palette: Palette::Mono, ..Theme::default() };
        for role in Role::iter() {
            assert_eq!(mono.colour(role), Color::Reset);
        }
    }
}
