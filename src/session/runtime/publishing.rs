//! The view that the session publishes.
#![allow(clippy::disallowed_methods, reason = "this is where wall time meets simulated time")]

use std::sync::Arc;
use std::time::Instant;

use super::Session;
use crate::link::endpoint::EndpointStatus;
use crate::session::command::SessionView;
use crate::session::simulator::Simulator;

impl Session {
    pub(super) fn view(&self) -> SessionView {
        let vehicle = self.shown_vehicle();
        SessionView {
            vehicle: Arc::new(vehicle.snapshot()),
            paused: self.pacer.is_paused() && !self.is_running_on(),
            speed_wanted: match self.simulator {
                Some(_) => f64::INFINITY,
                None => self.pacer.speed(),
            },
            speed_achieved: self.pacer.achieved(),
            lost_time: self.real_time.lost(self.pacer.achieved()),
            sticks: vehicle.transmitter().sticks(),
            rc_cut: vehicle.transmitter().is_cut(),
            upload: self.upload_under_way(),
            pilot: vehicle.transmitter().pilot_doing(),
            endpoints: self.endpoints(),
            simulator: self.simulator.as_ref().map(Simulator::state),
            remote: self.remote.as_ref().map(|link| link.remote().view()),
            live: self.endpoints.is_some(),
            timeline: self.timeline_view(),
        }
    }

    fn endpoints(&self) -> Vec<EndpointStatus> {
        let mut all =
            self.endpoints.as_ref().map_or_else(Vec::new, |endpoints| endpoints.status.borrow().clone());
        all.extend(self.remote.iter().flat_map(|remote| remote.status(Instant::now())));
        all.extend(self.simulator.as_ref().map(|simulator| simulator.status(Instant::now())));
        all
    }
}
