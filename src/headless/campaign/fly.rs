//! Flies the flights of a campaign that are not flown yet, and answers.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::{definition, outputs, shard, version};
use crate::args::CampaignArgs;
use crate::campaign::{Record, Shard};
use crate::headless::campaign::consent::Consent;
use crate::headless::campaign::definition::Wanted;
use crate::headless::campaign::loaded::Loaded;
use crate::headless::campaign::outputs::{Outputs, Titles};
use crate::headless::campaign::progress::Progress;
use crate::headless::campaign::run_file::RunFile;
use crate::headless::report;
use crate::process::error::AppError;
use crate::process::interrupt::interrupt_flag;
use crate::process::{error, parallel};
use crate::report::campaign::record_line;

/// How often a flight is prepared whose firmware cannot be started.
const ATTEMPTS: u32 = 3;

/// Flies and answers. The exit code is 0 if every goal was met.
pub(super) fn run(args: &CampaignArgs, repeat: &[String]) -> Result<u8, AppError> {
    let shard = shard::of(args.shard)?;
    let mut of_file = None;
    let (loaded, out, shard) = match definition::read(args)? {
        Wanted::Scenario(definition, sources) | Wanted::Plan(definition, sources) => {
            let inputs = inputs(&definition.file, &sources);
            outputs::claim(&args.output, args.out.as_deref(), &inputs)?;
            let loaded = Loaded::new(*definition, sources)?;
            loaded.campaign.refuse_equal_flights().map_err(AppError::input)?;
            loaded.refuse_impossible_flights()?;
            (loaded, args.out.clone(), shard)
        }
        Wanted::Run(path, header) => {
            outputs::claim(&args.output, Some(&path), &[])?;
            let shard = header.part().map_err(AppError::input)?;
            of_file = Some(path.clone());
            (Loaded::from_run(*header)?, Some(path), shard)
        }
    };
    let header = loaded.header.of_shard(shard);
    let interrupted = interrupt_flag()?;
    let mut outputs = Outputs::begin(&args.output, &loaded, shard)?;
    let mut trouble = Ok(());
    let file = out.as_deref().map(|path| {
        RunFile::open(path, &header, |record| {
            if trouble.is_ok() {
                trouble = outputs.add(record);
            }
        })
    });
    let file = file.transpose()?;
    trouble?;
    let before = file.as_ref().map_or(0, RunFile::lines);
    let flights = shard.flights(header.flights);
    let lines = (flights.start() - 1) * header.sides()..flights.end() * header.sides();
    let is_unfinished = lines.start + before < lines.end;
    refuse_two_versions(&loaded, out.as_deref(), is_unfinished)?;
    if let Some(file) = of_file.filter(|_| is_unfinished) {
        let consent = Consent { firmware: args.firmware.firmware.as_ref(), yes: args.firmware.link.yes };
        let definition = &loaded.header.definition;
        consent.check(&file, &definition.firmware, definition.firmware_print.as_deref())?;
        if let Some(side) = &definition.versus {
            consent.check(&file, &side.firmware, side.firmware_print.as_deref())?;
        }
    }
    let mut run = Run {
        progress: Progress::new(Some(lines.end - lines.start), before),
        next: lines.start + before,
        flown_s: 0.0,
        reported: BTreeSet::new(),
        loaded: &loaded,
        outputs,
        file,
        trouble: None,
        command: report::command(repeat),
    };
    run.fly(lines.start + before..lines.end, parallel::threads(args.jobs), &interrupted)?;
    let is_whole = run.next == lines.end;
    run.finish(out.as_deref(), shard, before, is_whole, &interrupted)
}

/// Returns the files that are read for a campaign.
pub(super) fn inputs(file: &str, sources: &crate::headless::campaign::sources::Sources) -> Vec<PathBuf> {
    let place = sources.place.clone().unwrap_or_default();
    let named = sources.contents.keys().map(|name| place.folder.join(name));
    std::iter::once(PathBuf::from(file)).chain(named).collect()
}

/// Refuses to go on with a run that another version began.
fn refuse_two_versions(loaded: &Loaded, out: Option<&Path>, is_unfinished: bool) -> Result<(), AppError> {
    let theirs = &loaded.header.version;
    if !is_unfinished || *theirs == version() {
        return Ok(());
    }
    let name = out.map(|path| path.display().to_string()).unwrap_or_default();
    Err(AppError::input(format!(
        "{name} was begun by betadeck {theirs}, and this is {}: finish it with that one, or fly all of it again with another --out",
        version()
    )))
}

/// A campaign in progress.
struct Run<'a> {
    loaded: &'a Loaded,
    outputs: Outputs,
    file: Option<RunFile>,
    progress: Progress,
    /// The next line.
    next: u64,
    /// Simulated seconds of the new flights.
    flown_s: f64,
    /// The messages about a firmware that were printed.
    reported: BTreeSet<String>,
    /// The reason why no more flights can be flown or kept.
    trouble: Option<AppError>,
    /// The command that gives the run again.
    command: String,
}

/// A flight that is over.
struct Done {
    line: u64,
    record: Result<Record, AppError>,
    reported: Vec<String>,
}

impl Run<'_> {
    fn fly(
        &mut self,
        lines: std::ops::Range<u64>,
        threads: usize,
        interrupted: &Arc<AtomicBool>,
    ) -> Result<(), AppError> {
        let gives_up = AtomicBool::new(false);
        let is_stopped = || interrupted.load(Ordering::Relaxed) || gives_up.load(Ordering::Relaxed);
        let loaded = self.loaded;
        let fly = |thread, line| {
            let mut reported = Vec::new();
            let mut attempt = 1;
            loop {
                let record = loaded.fly(line, thread, interrupted, &is_stopped, &mut reported)?;
                if record.is_ok() || attempt == ATTEMPTS || is_stopped() {
                    return Some(Done { line, record, reported });
                }
                attempt += 1;
            }
        };
        parallel::in_order(lines, threads, &is_stopped, fly, |done, _| {
            if let Err(trouble) = self.take(done) {
                self.trouble.get_or_insert(trouble);
                gives_up.store(true, Ordering::Relaxed);
            }
        })
    }

    /// Takes the next flight. After one that is missing, later ones do not count.
    fn take(&mut self, done: Done) -> Result<(), AppError> {
        if done.line != self.next || self.trouble.is_some() {
            return Ok(());
        }
        for sentence in done.reported {
            if self.reported.insert(sentence.clone()) {
                self.progress.clear();
                error::tell(&sentence);
            }
        }
        let record = done.record?;
        if let Some(file) = &mut self.file {
            file.append(&record_line(&record, &self.loaded.header))?;
        }
        self.outputs.add(&record)?;
        self.next += 1;
        self.flown_s += record.flown_s;
        let done = self.file.as_ref().map_or(self.next, RunFile::lines);
        self.progress.show(done, self.outputs.failed());
        Ok(())
    }

    fn finish(
        mut self,
        out: Option<&Path>,
        shard: Shard,
        before: u64,
        is_whole: bool,
        interrupted: &AtomicBool,
    ) -> Result<u8, AppError> {
        self.progress.clear();
        let kept = self.file.take().map_or(Ok(()), RunFile::finish);
        let seconds = self.progress.seconds();
        let titles = Titles { loaded: self.loaded, run: out, shard, command: &self.command };
        let answer = self.outputs.finish(&titles)?;
        let new = answer.flown.saturating_mul(self.loaded.header.sides()).saturating_sub(before);
        let old = if before > 0 { format!("; {before} were flown before") } else { String::new() };
        error::tell(&format!(
            "{new} flights, {:.0} s, in {seconds:.2} s ({:.1} flights a second, {:.0}x real time){old}",
            self.flown_s,
            new as f64 / seconds.max(1e-3),
            self.flown_s / seconds.max(1e-3)
        ));
        if let Some(trouble) = self.trouble {
            return Err(trouble);
        }
        kept?;
        Ok(match () {
            () if interrupted.load(Ordering::Relaxed) => error::INTERRUPTED,
            // The goals of a part are judged when the parts are merged.
            () if shard != Shard::WHOLE && is_whole => 0,
            () if answer.is_met() && is_whole => 0,
            () => error::FAILED,
        })
    }
}
