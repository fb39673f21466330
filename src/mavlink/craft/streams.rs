//! The intervals of telemetry to one ground station.

use std::time::Duration;

use super::super::message::*;

/// The shortest interval between two messages of a kind, wall-clock time.
const SHORTEST: Duration = Duration::from_millis(20);
/// The interval of heartbeats, wall-clock time. They keep the link alive while the simulation is slow or paused.
const HEARTBEAT: Duration = Duration::from_secs(1);

/// A message that is sent repeatedly: its number, its default rate in Hz and its group of `REQUEST_DATA_STREAM`.
struct Row(u32, u16, Group);

/// Groups of messages, `MAV_DATA_STREAM`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Group {
    None = 0,
    Raw = 1,
    Status = 2,
    Rc = 3,
    Position = 6,
    Attitude = 10,
    Hud = 11,
    Others = 12,
}

const ROWS: [Row; 23] = [
    Row(Heartbeat::ID, 1, Group::None),
    Row(GlobalPositionInt::ID, 5, Group::Position),
    Row(Attitude::ID, 10, Group::Attitude),
    Row(SysStatus::ID, 1, Group::Status),
    Row(SystemTime::ID, 1, Group::Others),
    Row(GpsRawInt::ID, 2, Group::Status),
    Row(ScaledPressure::ID, 1, Group::Raw),
    Row(AttitudeQuaternion::ID, 0, Group::None),
    Row(LocalPositionNed::ID, 5, Group::Position),
    Row(RcChannelsRaw::ID, 2, Group::Rc),
    Row(ServoOutputRaw::ID, 2, Group::Rc),
    Row(MissionCurrent::ID, 1, Group::Status),
    Row(GpsGlobalOrigin::ID, 1, Group::None),
    Row(NavControllerOutput::ID, 2, Group::Status),
    Row(RcChannels::ID, 2, Group::Rc),
    Row(VfrHud::ID, 4, Group::Hud),
    Row(BatteryStatus::ID, 1, Group::Others),
    Row(Wind::ID, 1, Group::Others),
    Row(WindCov::ID, 1, Group::Others),
    Row(HomePosition::ID, 1, Group::None),
    Row(ExtendedSysState::ID, 1, Group::None),
    Row(CurrentMode::ID, 0, Group::None),
    Row(AvailableModesMonitor::ID, 0, Group::None),
];

/// One repeated message.
#[derive(Debug, Clone, Copy)]
struct Stream {
    /// The interval in simulated time; `None` if it is off.
    interval: Option<Duration>,
    /// The simulated time of the next message; `None` for at once.
    due: Option<Duration>,
    /// The wall-clock time of the last message.
    sent: Option<Duration>,
}

/// All repeated messages to one ground station. They are due by simulated time, and not faster than at 50 Hz of wall-clock
/// time.
#[derive(Debug, Clone)]
pub(super) struct Streams {
    streams: [Stream; ROWS.len()],
    /// The simulated time of the last call.
    last: Duration,
}

impl Default for Streams {
    fn default() -> Self {
        let stream = |row: &Row| Stream { interval: of_rate(row.1), due: None, sent: None };
        Self { streams: ROWS.each_ref().map(stream), last: Duration::ZERO }
    }
}

fn of_rate(hz: u16) -> Option<Duration> {
    (hz > 0).then(|| Duration::from_secs(1) / u32::from(hz))
}

fn index(id: u32) -> Option<usize> {
    ROWS.iter().position(|row| row.0 == id)
}

impl Streams {
    /// Returns the numbers of the messages that are due.
    pub(super) fn due(&mut self, wall: Duration, sim: Duration) -> impl Iterator<Item = u32> {
        // After a step back in simulated time everything is due.
        let is_back = sim < self.last;
        self.last = sim;
        self.streams.iter_mut().zip(&ROWS).filter_map(move |(stream, row)| {
            if is_back {
                stream.due = None;
            }
            let is_soon = stream.sent.is_some_and(|sent| wall.saturating_sub(sent) < SHORTEST);
            let is_due = if row.0 == Heartbeat::ID {
                stream.due.is_none() || stream.sent.is_none_or(|sent| wall.saturating_sub(sent) >= HEARTBEAT)
            } else {
                !is_soon && stream.interval.is_some() && stream.due.is_none_or(|due| due <= sim)
            };
            if !is_due {
                return None;
            }
            stream.sent = Some(wall);
            let interval = stream.interval.unwrap_or(HEARTBEAT);
            // The rhythm is kept, but nothing is made up for.
            let next = stream.due.unwrap_or(sim).saturating_add(interval);
            stream.due = Some(if next <= sim { sim.saturating_add(interval) } else { next });
            Some(row.0)
        })
    }

    /// Makes a message due at once, if it is on.
    pub(super) fn make_due(&mut self, id: u32) {
        if let Some(at) = index(id) {
            self.streams[at].due = None;
        }
    }

    /// Sets an interval; zero is the default interval, `None` off. Returns `false` if the message is not repeated, or if it
    /// is the heartbeat.
    pub(super) fn set_interval(&mut self, id: u32, interval: Option<Duration>) -> bool {
        let Some(at) = index(id).filter(|_| id != Heartbeat::ID) else { return false };
        let interval = match interval {
            Some(Duration::ZERO) => of_rate(ROWS[at].1),
            other => other.map(|interval| interval.max(SHORTEST)),
        };
        self.streams[at] = Stream { interval, due: None, ..self.streams[at] };
        true
    }

    /// Returns the interval of a message: `None` if it is not repeated, `Some(None)` if it is off.
    pub(super) fn interval(&self, id: u32) -> Option<Option<Duration>> {
        index(id).map(|at| self.streams[at].interval)
    }

    /// Sets the rate of a group, as `REQUEST_DATA_STREAM` does. Group 0 is all groups. The rhythm stays if the rate does.
    pub(super) fn set_group(&mut self, group: u8, hz: u16) {
        let interval = of_rate(hz).map(|interval| interval.max(SHORTEST));
        for (stream, row) in self.streams.iter_mut().zip(&ROWS) {
            let is_meant = row.2 != Group::None && (group == 0 || group == row.2 as u8);
            if is_meant && stream.interval != interval {
                *stream = Stream { interval, due: None, ..*stream };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns how often a message is due within some seconds of wall-clock time, asked every 5 ms.
    fn count(streams: &mut Streams, id: u32, seconds: u64, speed: f64) -> usize {
        let steps = (0..seconds * 200).map(|step| Duration::from_millis(5 * step + 5));
        steps
            .flat_map(|wall| streams.due(wall, wall.mul_f64(speed)).collect::<Vec<_>>())
            .filter(|due| *due == id)
            .count()
    }

    #[test]
    fn messages_have_their_default_rates() {
        assert_eq!(count(&mut Streams::default(), Attitude::ID, 10, 1.0), 100);
        assert_eq!(count(&mut Streams::default(), Heartbeat::ID, 10, 1.0), 10);
        assert_eq!(count(&mut Streams::default(), CurrentMode::ID, 10, 1.0), 0);
    }

    #[test]
    fn rates_are_those_of_simulated_time_up_to_50_hz_of_wall_clock_time() {
        assert_eq!(count(&mut Streams::default(), Attitude::ID, 10, 0.5), 50);
        assert_eq!(count(&mut Streams::default(), Attitude::ID, 10, 3.0), 300);
        assert_eq!(count(&mut Streams::default(), Attitude::ID, 10, 100.0), 500);
        assert_eq!(count(&mut Streams::default(), Heartbeat::ID, 10, 100.0), 10);
        assert_eq!(count(&mut Streams::default(), Heartbeat::ID, 10, 0.0), 10);
    }

    #[test]
    fn an_interval_can_be_set_and_reset() {
        let mut streams = Streams::default();
        assert!(streams.set_interval(Attitude::ID, Some(Duration::from_millis(500))));
        assert_eq!(count(&mut streams, Attitude::ID, 10, 1.0), 20);
        assert!(streams.set_interval(Attitude::ID, Some(Duration::from_micros(1))));
        assert_eq!(streams.interval(Attitude::ID), Some(Some(SHORTEST)));
        assert!(streams.set_interval(Attitude::ID, None));
        assert_eq!(streams.interval(Attitude::ID), Some(None));
        assert!(streams.set_interval(Attitude::ID, Some(Duration::ZERO)));
        assert_eq!(streams.interval(Attitude::ID), Some(Some(Duration::from_millis(100))));
        assert!(!streams.set_interval(Heartbeat::ID, None));
        assert!(!streams.set_interval(9999, None));
        assert_eq!(streams.interval(9999), None);
    }

    #[test]
    fn a_group_can_be_sped_up_and_stopped() {
        let mut streams = Streams::default();
        streams.set_group(0, 4);
        assert_eq!(streams.interval(Attitude::ID), Some(Some(Duration::from_millis(250))));
        assert_eq!(streams.interval(HomePosition::ID), Some(Some(Duration::from_secs(1))));
        streams.set_group(10, 0);
        assert_eq!(streams.interval(Attitude::ID), Some(None));
        assert_eq!(streams.interval(VfrHud::ID), Some(Some(Duration::from_millis(250))));
        streams.set_group(3, u16::MAX);
        assert_eq!(streams.interval(RcChannels::ID), Some(Some(SHORTEST)));
    }

    #[test]
    fn a_repeated_request_for_the_same_rate_does_not_disturb_the_rhythm() {
        let mut streams = Streams::default();
        let mut total = 0;
        for step in 1..=2000_u64 {
            streams.set_group(0, 4);
            let now = Duration::from_millis(5 * step);
            total += streams.due(now, now).filter(|id| *id == Attitude::ID).count();
        }
        assert_eq!(total, 40);
    }

    #[test]
    fn telemetry_goes_on_after_a_step_back_in_time() {
        let mut streams = Streams::default();
        let sent = |streams: &mut Streams, wall: u64, sim: u64| {
            streams.due(Duration::from_secs(wall), Duration::from_secs(sim)).count()
        };
        assert!(sent(&mut streams, 1, 1000) > 10);
        assert_eq!(sent(&mut streams, 2, 1000), 1);
        assert!(sent(&mut streams, 3, 10) > 10);
        assert!(sent(&mut streams, 4, 11) > 10);
    }
}
