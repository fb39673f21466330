//! Opens the doors of a session and keeps their state in view.
#![allow(clippy::disallowed_methods, reason = "the state of the doors is published at a rhythm of wall time")]

use std::time::Duration;

use tokio::sync::{mpsc, watch};
use tokio_util::sync::CancellationToken;

use crate::args::DoorArgs;
use crate::link::{Desk, Doors, DoorsConfig};
use crate::session::Doorway;

/// Requests that may wait for the session.
const WAITING: usize = 256;
/// Rhythm in which the state of the doors is published.
const VIEW: Duration = Duration::from_millis(250);

/// Open doors, on the side of the sockets.
#[derive(Debug)]
pub struct OpenDoors {
    stop: CancellationToken,
    keeper: tokio::task::JoinHandle<()>,
}

/// What opening the doors gave.
#[derive(Debug)]
pub struct Opened {
    /// To close them.
    pub doors: OpenDoors,
    /// The session's side.
    pub doorway: Doorway,
    /// Where they are and what is wrong with some of them, as sentences.
    pub notices: Vec<String>,
}

/// Opens the doors that the options name; none with `--no-ports`. One that cannot be opened is told, the others work.
pub async fn open(args: &DoorArgs) -> Option<Opened> {
    if args.no_ports {
        return None;
    }
    let (request_tx, requests) = mpsc::channel(WAITING);
    let config = DoorsConfig {
        listen: args.listen,
        tcp_port: Some(args.tcp_port()),
        ws_port: Some(args.ws_port()),
        rc_port: Some(args.udp_ports().rc),
        fdm_port: None,
        allow_origin: args.allow_origin.clone(),
    };
    let (doors, first) = Doors::open(&config, request_tx).await;
    let mut notices: Vec<String> = doors.problems().map(|problem| format!("{problem}.")).collect();
    if let Some(address) = args.listen.filter(|address| !address.is_loopback()) {
        notices.push(format!("The doors listen on {address}: everybody on that network can fly this craft."));
    }
    let open = first.iter().filter(|door| !door.fault).map(|door| format!("{} {}", door.name, door.address));
    let open: Vec<String> = open.collect();
    if !open.is_empty() {
        notices.push(format!("Doors open: {}.", open.join(", ")));
    }
    let desk = Desk::new(doors.restart_bell(), true);
    let (view_tx, views) = watch::channel(first);
    let stop = CancellationToken::new();
    let keeper = tokio::spawn(keep(doors, view_tx, stop.clone()));
    Some(Opened { doors: OpenDoors { stop, keeper }, doorway: Doorway { requests, desk, views }, notices })
}

/// Publishes the state of the doors when it changes, until it is told to close them.
async fn keep(
    doors: Doors,
    views: watch::Sender<Vec<crate::session::command::DoorView>>,
    stop: CancellationToken,
) {
    loop {
        tokio::select! {
            () = stop.cancelled() => break,
            () = tokio::time::sleep(VIEW) => {
                let now = doors.views();
                views.send_if_modified(|shown| {
                    let changed = *shown != now;
                    *shown = now;
                    changed
                });
            }
        }
    }
    doors.close().await;
}

impl OpenDoors {
    /// Closes the doors and waits until their clients are told.
    pub async fn close(self) {
        self.stop.cancel();
        // The keeper does not panic.
        drop(self.keeper.await);
    }
}
