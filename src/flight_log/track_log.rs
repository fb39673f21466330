//! The track of a log while it is read.

use super::place::TrackFix;
use super::sample::LogSample;

/// The most places of a track that are kept.
const MAX_FIXES: usize = 20_000;

/// Collects the places of a track. A long track is thinned out evenly.
#[derive(Debug)]
pub(super) struct TrackLog {
    fixes: Vec<TrackFix>,
    /// Each so many places are kept.
    every: usize,
    offered: usize,
}

impl Default for TrackLog {
    fn default() -> Self {
        Self { fixes: Vec::new(), every: 1, offered: 0 }
    }
}

impl TrackLog {
    /// Takes the place of a sample, if it has one.
    pub(super) fn offer(&mut self, sample: &LogSample) {
        let Some(position) = sample.position else { return };
        let is_kept = self.offered.is_multiple_of(self.every);
        self.offered += 1;
        if !is_kept {
            return;
        }
        let LogSample { time, alt_amsl_m, alt: alt_m, ground_speed_mps, .. } = *sample;
        self.fixes.push(TrackFix { time, position, alt_amsl_m, alt_m, ground_speed_mps });
        if self.fixes.len() > MAX_FIXES {
            let mut index = 0;
            self.fixes.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.every *= 2;
        }
    }

    pub(super) fn finish(self) -> Vec<TrackFix> {
        self.fixes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geo::LatLon;
    use crate::signals::SimTime;

    #[test]
    fn a_long_track_keeps_its_shape_in_bounded_memory() {
        let mut track = TrackLog::default();
        for at in 0..100_000_u64 {
            let position = Some(LatLon::new(at as i32, 1));
            track.offer(&LogSample { time: SimTime(at), position, ..LogSample::default() });
        }
        let fixes = track.finish();
        assert!(fixes.len() <= MAX_FIXES && fixes.len() > MAX_FIXES / 2);
        let steps: Vec<u64> = fixes.windows(2).map(|pair| pair[1].time.0 - pair[0].time.0).collect();
        assert!(steps.iter().all(|step| *step == steps[0]), "evenly");
        assert!(fixes.last().unwrap().time.0 > 99_990);
    }
}
