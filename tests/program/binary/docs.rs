//! Every command that a page shows is run: in a shell, on the screen, or in the command line of the firmware.

mod extract;
mod firmware_lines;
mod order;
mod screen_lines;
mod shell;

use self::extract::Shown;

/// Words of the pages that represent something else, and an example for each.
const PLACEHOLDERS: [(&str, &str); 12] = [
    ("FAULT", "gps-loss,6"),
    ("COMMAND", "fly"),
    ("FILE", "my-test.toml"),
    ("N", "0"),
    ("NAME", "ap_max_angle"),
    ("NEW", "new.elf"),
    ("OLD", "old.elf"),
    ("PATH", "remote.elf"),
    ("PLACE", "tcp:127.0.0.1:5761"),
    ("PLAN", "square"),
    ("VALUE", "25"),
    ("…", "tcp:127.0.0.1:5761"),
];

/// Values of settings that look like placeholders.
const VALUES: [&str; 4] = ["OFF", "ON", "SPIFLASH", "VIRTUAL"];

/// Returns a command without its comment, with examples in place of the placeholders.
fn filled_in(shown: &Shown) -> Result<String, String> {
    let text = shown.text.split(" #").next().unwrap_or_default().trim();
    let filled: Vec<String> = text
        .split(' ')
        .map(|word| {
            let is_placeholder =
                word == "…" || (!word.is_empty() && word.chars().all(|c| c.is_ascii_uppercase() || c == '_'));
            match PLACEHOLDERS.iter().find(|(name, _)| *name == word) {
                Some((_, example)) => Ok((*example).to_owned()),
                None if is_placeholder && !VALUES.contains(&word) => Err(format!(
                    "{}: {word} is a placeholder; add an example of it to PLACEHOLDERS",
                    shown.place
                )),
                None => Ok(word.to_owned()),
            }
        })
        .collect::<Result<_, _>>()?;
    Ok(filled.join(" "))
}
