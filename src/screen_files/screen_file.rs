//! The files of the state directory with the screen of the run before.
//!
//! Each kind of session has a file for its panels. The plans, the place and the speed of one craft or one recorded flight
//! are in a second file, so that programs that show different flights at the same time replace no file of each other.

use std::path::{Path, PathBuf};

use crate::files::set_aside;
use crate::link::FcPlace;
use crate::storage::state_file;
use crate::ui::{KeptOf, KeptScreen, KeptScreens, KeptTexts, Unread};

/// The name of the file of flights, and of the folder of all other files.
const NAME: &str = "screen.json";
const FOLDER: &str = "screens";
/// The extension of the files in the folder.
const EXTENSION: &str = "json";
/// The most bytes of a file that are read.
const MAX_BYTES: u64 = 1 << 20;
/// The most crafts and recorded flights whose files are kept.
const MAX_SUBJECTS: usize = 200;
/// The checksum that names a file after its subject.
const CHECKSUM: crc::Crc<u64> = crc::Crc::<u64>::new(&crc::CRC_64_XZ);

/// The session whose screen is kept.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Subject<'a> {
    Flight,
    Craft(&'a FcPlace),
    /// A flight that was flown to its end, with a number that other flights do not have.
    Flown(u64),
    /// A file of recorded flights, with a number that other files do not have.
    Record(u64),
}

/// The start of a screen.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ScreenStart {
    /// `true` without a screen: nothing is kept.
    pub(crate) plain: bool,
    /// `true` for a clean screen, which is kept.
    pub(crate) fresh: bool,
}

/// The files, if there is a state directory.
#[derive(Debug, Clone, Default)]
pub(crate) struct ScreenFile {
    screen: Option<PathBuf>,
    /// The file with the part that belongs to the craft or the flight.
    subject: Option<PathBuf>,
}

impl Subject<'_> {
    fn kept_of(self) -> KeptOf {
        match self {
            Self::Flight => KeptOf::Flight,
            Self::Craft(_) => KeptOf::Craft,
            Self::Flown(_) => KeptOf::Flown,
            Self::Record(_) => KeptOf::Record,
        }
    }

    /// Returns the name of its kind and its number; `None` if all is in one file.
    fn file_name(self) -> Option<(&'static str, u64)> {
        match self {
            Self::Flight => None,
            Self::Craft(place) => Some(("connect", CHECKSUM.checksum(place.to_string().as_bytes()))),
            Self::Flown(number) => Some(("open", number)),
            Self::Record(number) => Some(("replay", number)),
        }
    }
}

impl ScreenFile {
    /// Reads the screen of the run before. A file that cannot be used is a sentence for `notices`, and its part of the screen
    /// starts clean. A damaged file is set aside; otherwise the file stays, and this run keeps no screen.
    pub(crate) fn open(
        state: Option<&Path>,
        of: Subject<'_>,
        start: ScreenStart,
        notices: &mut Vec<String>,
    ) -> (Self, KeptScreens) {
        let Some(state) = state.filter(|_| !start.plain) else {
            return (Self::default(), KeptScreens::none());
        };
        let file = Self::new(state, of);
        let kept = file.read(of.kept_of(), notices);
        (file, if start.fresh { kept.fresh() } else { kept })
    }

    fn new(state: &Path, of: Subject<'_>) -> Self {
        let Some((kind, number)) = of.file_name() else {
            return Self { screen: Some(state.join(NAME)), subject: None };
        };
        let folder = state.join(FOLDER);
        Self {
            screen: Some(folder.join(format!("{kind}.{EXTENSION}"))),
            subject: Some(folder.join(format!("{kind}-{number:016x}.{EXTENSION}"))),
        }
    }

    fn read(&self, of: KeptOf, notices: &mut Vec<String>) -> KeptScreens {
        if let Some(folder) = self.subject.as_deref().and_then(Path::parent) {
            make_room(folder);
        }
        let clean = "The screen starts clean";
        let without = "The screen starts without the plans and the place of the last run";
        let screen = self.screen.as_deref().map_or(Ok(None), |path| read_part(path, clean, notices));
        let subject = self.subject.as_deref().map_or(Ok(None), |path| read_part(path, without, notices));
        let (Ok(screen), Ok(subject)) = (screen, subject) else { return KeptScreens::none() };
        let before = if self.subject.is_some() { KeptScreen::joined(screen, subject) } else { screen };
        KeptScreens::after(of, before)
    }

    /// Replaces the files of a kept screen. A screen that cannot be kept is no loss, so a failure is not reported.
    pub(crate) fn write(&self, texts: &KeptTexts) {
        for (path, text) in [(&self.screen, &texts.screen), (&self.subject, &texts.subject)] {
            if let (Some(path), Some(text)) = (path, text) {
                if let Some(folder) = path.parent() {
                    std::fs::create_dir_all(folder).ok();
                }
                state_file::replace(path, text.as_bytes()).ok();
            }
        }
    }
}

/// A file that cannot be used and stays as it is.
struct Stays;

/// Reads the part of the screen in a file. `effect` is the beginning of the sentence about a file that cannot be used.
fn read_part(path: &Path, effect: &str, notices: &mut Vec<String>) -> Result<Option<KeptScreen>, Stays> {
    let mut stays = |why: &str| {
        notices.push(format!("{effect}, and is not kept after this run: {} {why}.", path.display()));
        Err(Stays)
    };
    let contents = match state_file::read(path, MAX_BYTES) {
        Ok(None) => return Ok(None),
        Ok(Some(contents)) => contents,
        Err(error) => return stays(&format!("cannot be read: {error}")),
    };
    let text = String::from_utf8(contents).map_err(|_| Unread::Damaged);
    match text.and_then(|text| KeptScreen::parse(&text)) {
        Ok(before) => Ok(Some(before)),
        Err(Unread::Later) => stays("was written by a later version of betadeck"),
        Err(Unread::Damaged) => {
            let kept = set_aside::copy(path);
            let now = set_aside::place(&kept, path);
            notices.push(format!("{effect}: {} is damaged. {now}.", path.display()));
            kept.map(|_| None).map_err(|_| Stays)
        }
    }
}

/// Deletes the files of the crafts and recorded flights that were shown the longest time ago, and what a killed program
/// left.
fn make_room(folder: &Path) {
    state_file::sweep(folder);
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_of_subject = |path: &PathBuf| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        path.extension().is_some_and(|extension| extension == EXTENSION) && name.contains('-')
    };
    let paths = entries.map(|entry| entry.path()).filter(is_of_subject);
    let mut dated: Vec<_> =
        paths.filter_map(|path| Some((path.symlink_metadata().ok()?.modified().ok()?, path))).collect();
    dated.sort_unstable();
    // One file may be added.
    let oldest = (dated.len() + 1).saturating_sub(MAX_SUBJECTS);
    for (_, path) in dated.drain(..oldest) {
        std::fs::remove_file(path).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const START: ScreenStart = ScreenStart { plain: false, fresh: false };

    fn texts(screen: &str, subject: &str) -> KeptTexts {
        KeptTexts { screen: Some(screen.to_owned()), subject: Some(subject.to_owned()) }
    }

    fn opened(state: &Path, of: Subject<'_>) -> (ScreenFile, KeptScreens, Vec<String>) {
        let mut notices = Vec::new();
        let (file, kept) = ScreenFile::open(Some(state), of, START, &mut notices);
        (file, kept, notices)
    }

    #[test]
    fn a_screen_is_kept_until_the_next_run() {
        let directory = tempfile::tempdir().unwrap();
        let (file, kept, _) = opened(directory.path(), Subject::Flight);
        assert!(kept.before().is_none());
        file.write(&texts(r#"{"version": 1, "focus": "Graphs", "plans": ["a.txt"]}"#, ""));
        let (_, kept, notices) = opened(directory.path(), Subject::Flight);
        assert_eq!(kept.before().map(|before| before.plans().count()), Some(1));
        assert_eq!(notices, [""; 0]);
        let (_, kept) = ScreenFile::open(None, Subject::Flight, START, &mut Vec::new());
        assert!(!kept.is_kept);
        let plain = ScreenStart { plain: true, ..START };
        let (_, kept) = ScreenFile::open(Some(directory.path()), Subject::Flight, plain, &mut Vec::new());
        assert!(!kept.is_kept);
    }

    #[test]
    fn recorded_files_share_their_panels_and_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let (first, ..) = opened(directory.path(), Subject::Record(1));
        let (second, ..) = opened(directory.path(), Subject::Record(2));
        first.write(&texts(r#"{"version": 1, "focus": "Graphs"}"#, r#"{"place": {"flight": 1}}"#));
        second.write(&texts(r#"{"version": 1, "focus": "Map"}"#, r#"{"place": {"flight": 2}}"#));
        for (number, flight) in [(1, Some(1)), (2, Some(2)), (3, None)] {
            let (_, kept, _) = opened(directory.path(), Subject::Record(number));
            let place = kept.before().expect("the panels").place();
            assert_eq!(place.map(|place| place.flight), flight);
        }
        assert!(opened(directory.path(), Subject::Flown(1)).1.before().is_none());
        assert!(!directory.path().join(NAME).exists(), "the screen of flights is another");
    }

    #[test]
    fn a_damaged_screen_is_set_aside_and_one_of_a_later_version_stays() {
        let directory = tempfile::tempdir().unwrap();
        let (file, ..) = opened(directory.path(), Subject::Flight);
        file.write(&texts("{ damaged", ""));
        let (_, kept, notices) = opened(directory.path(), Subject::Flight);
        assert!(kept.is_kept);
        let bad = directory.path().join("screen.bad");
        assert_eq!(std::fs::read_to_string(&bad).unwrap(), "{ damaged");
        assert!(notices[0].contains("screen.json is damaged. It is kept as"), "{notices:?}");
        file.write(&texts("{}", ""));
        assert_eq!(
            std::fs::read_to_string(&bad).unwrap(),
            "{ damaged",
            "a new screen replaces the damaged one only"
        );
        file.write(&texts(r#"{"version": 99}"#, ""));
        let (_, kept, notices) = opened(directory.path(), Subject::Flight);
        assert!(!kept.is_kept);
        assert!(notices[0].contains("later version"), "{notices:?}");
    }

    #[test]
    fn the_panels_come_back_beside_a_damaged_place_and_the_place_beside_damaged_panels() {
        let directory = tempfile::tempdir().unwrap();
        for (screen, subject, sentence, is_place) in [
            (r#"{"focus": "Graphs"}"#, "{", "without the plans and the place of the last run: ", false),
            ("{", r#"{"place": {"flight": 1}}"#, "The screen starts clean: ", true),
        ] {
            opened(directory.path(), Subject::Record(1)).0.write(&texts(screen, subject));
            let (_, kept, notices) = opened(directory.path(), Subject::Record(1));
            let before = kept.before().expect("a part");
            assert_eq!(before.place().is_some(), is_place);
            assert!(notices.len() == 1 && notices[0].contains(sentence), "{notices:?}");
        }
    }

    #[test]
    fn the_places_of_the_longest_unseen_files_make_room() {
        let directory = tempfile::tempdir().unwrap();
        for number in 0..MAX_SUBJECTS as u64 + 5 {
            opened(directory.path(), Subject::Record(number)).0.write(&texts("{}", "{}"));
        }
        let files = std::fs::read_dir(directory.path().join(FOLDER)).unwrap().count();
        assert_eq!(files, MAX_SUBJECTS + 1, "and the panels");
        assert!(opened(directory.path(), Subject::Record(1)).0.subject.is_some_and(|path| !path.exists()));
    }
}
