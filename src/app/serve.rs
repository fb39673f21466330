//! `betadeck serve`: all parts except the screen, in real time with all doors open.

use std::io::{BufWriter, Write};

use super::doors::LiveArgs;
use super::live::{self, Reports};
use crate::args::{OutputFile, ServeArgs};
use crate::events::Event;
use crate::files::output_file;
use crate::files::terrain::with_terrain;
use crate::headless::setup;
use crate::launch;
use crate::launch::Beside;
use crate::plan::format::PlanFile;
use crate::process::error::AppError;
use crate::process::{error, runtime, stop_signal};
use crate::report::{json, sentence};
use crate::session::{Command, Handle};
use crate::text::printable;

/// Serves until a signal. Every event is a line of output.
pub(super) fn run(args: &ServeArgs) -> Result<u8, AppError> {
    let (mut notices, mut warnings) = (Vec::new(), Vec::new());
    let mut store = setup::open_store(&args.flight)?;
    warnings.extend(setup::storage_notice(&store));
    let beside =
        Beside { ports: (&args.doors, &args.physics).into(), flight: &args.flight, physics: &args.physics };
    let firmware = launch::choose(&args.firmware, beside, &mut notices)?;
    notices.extend(args.physics.idle_options(&args.flight, firmware.is_some()));
    let stored = setup::stored(&mut store, &mut warnings);
    let no_plan = PlanFile::default();
    let mut setup = setup::for_session(&args.flight, &args.physics, &args.doors, no_plan, stored)?;
    setup = with_terrain(setup, &args.flight.terrain, &mut notices)?;
    setup.remote_controller = firmware.is_some();
    let vehicle = setup::build(setup, &mut notices)?;
    let mut output = open_output(args)?;
    let runtime = runtime::with_threads(1)?;
    runtime.block_on(async {
        let stop = stop_signal::stop_in_time()
            .map_err(|error| AppError::environment(format!("cannot listen for signals: {error}")))?;
        let options = LiveArgs {
            connect: None,
            doors: &args.doors,
            firmware: firmware.as_ref(),
            physics: &args.physics,
            flight: &args.flight,
            has_screen: false,
        };
        let (session, doors, _directory) =
            live::start(options, vehicle, store, Reports { notices, warnings }, None, None).await?;
        let outcome = report(session, &mut output, stop).await;
        if let Some(doors) = doors {
            doors.close().await;
        }
        outcome
    })
}

/// Writes events until a signal arrives or the output is gone.
async fn report(
    mut session: Handle,
    output: &mut Output,
    stop: impl Future<Output = ()>,
) -> Result<u8, AppError> {
    tokio::pin!(stop);
    let outcome = loop {
        tokio::select! {
            () = &mut stop => break Ok(error::INTERRUPTED),
            event = session.events.recv() => match event {
                None => break Err(live::ended_by_itself()),
                Some(event) => {
                    if let Err(problem) = output.event(&event) {
                        break problem;
                    }
                }
            },
        }
    };
    drop(session.commands.send(Command::Quit).await);
    drop(session.commands);
    match session.thread.join() {
        Ok(Some(why)) => Err(AppError::environment(why)),
        Ok(None) | Err(_) => outcome,
    }
}

/// The output for the events.
struct Output {
    lines: BufWriter<Box<dyn Write>>,
    json: bool,
    /// The name of the file for messages.
    name: String,
}

fn open_output(args: &ServeArgs) -> Result<Output, AppError> {
    let (target, name): (Box<dyn Write>, String) = match &args.json {
        None | Some(OutputFile::Stdout) => (Box::new(std::io::stdout()), "the output".to_owned()),
        Some(OutputFile::File(path)) => {
            setup::kept_files(&args.flight, None).claim("--json", path)?;
            (Box::new(output_file::create(path)?), path.display().to_string())
        }
    };
    Ok(Output { lines: BufWriter::new(target), json: args.json.is_some(), name })
}

impl Output {
    /// Writes an event. Returns the end of the program as an error; if the reader went away, the program ends quietly.
    fn event(&mut self, event: &Event) -> Result<(), Result<u8, AppError>> {
        let line = if self.json { json::event_line(event) } else { sentence::line(event) };
        let Some(line) = line else { return Ok(()) };
        let line = if self.json { printable::json(&line) } else { printable::line(&line) };
        match writeln!(self.lines, "{line}").and_then(|()| self.lines.flush()) {
            Ok(()) => Ok(()),
            Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Err(Ok(0)),
            Err(error) => Err(Err(AppError::environment(format!("cannot write {}: {error}", self.name)))),
        }
    }
}
