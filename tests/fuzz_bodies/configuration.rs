//! The configuration file: options and keys.

use std::collections::BTreeMap;
use std::ffi::OsString;

use betadeck::app::configuration_file::ConfigurationFile;
use betadeck::args::{self, Layers};
use betadeck::ui::keymap::Keymap;

/// The command lines for which the file is read.
const COMMANDS: [&[&str]; 4] = [&[], &["fly", "square"], &["serve"], &["check"]];

/// Reads the text, its keys, and its options for every kind of command.
pub fn run(data: &[u8]) {
    let text = String::from_utf8_lossy(data);
    let file = match ConfigurationFile::read("config.toml", &text) {
        Ok(file) => file,
        Err(error) => {
            assert!(error.code == 2 && error.message.starts_with("config.toml:"), "{error}");
            return;
        }
    };
    assert!(!file.options.contains_key("keys"));
    assert_keys(&file, text.lines().count());
    assert_options(file);
}

fn assert_keys(file: &ConfigurationFile, lines: usize) {
    assert!(file.keys.iter().all(|key| (1..=lines).contains(&key.line)), "{:?}", file.keys);
    if let Err(problems) = Keymap::remapped(&file.keys) {
        assert!(!problems.is_empty());
        for (line, problem) in problems {
            assert!((1..=lines).contains(&line) && !problem.is_empty(), "{line}: {problem}");
        }
    }
}

fn assert_options(file: ConfigurationFile) {
    let keys = file.options.len();
    let layers =
        Layers { environment: BTreeMap::new(), file_name: "config.toml".to_owned(), file: file.options };
    match args::origins(&layers) {
        Ok(origins) => {
            let of_file = origins.iter().filter(|origin| origin.source.starts_with("config.toml: "));
            assert!(of_file.count() <= keys);
        }
        Err(problem) => assert!(problem.starts_with("config.toml: "), "{problem}"),
    }
    for command in COMMANDS {
        let line = std::iter::once("betadeck").chain(command.iter().copied()).map(OsString::from);
        let parsed = args::parse(line, &layers);
        // Without a file every command is understood.
        assert!(keys > 0 || parsed.is_ok(), "{command:?}");
        if let Err(error) = parsed {
            assert!(!error.to_string().is_empty());
        }
    }
    for problem in args::layer_problems(&layers) {
        assert!(!problem.is_empty());
    }
}
