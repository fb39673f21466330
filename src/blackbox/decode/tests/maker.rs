//! Small logs from their values, written apart from the product's own writer.

/// A file of logs that grows.
#[derive(Debug, Clone, Default)]
pub(super) struct Maker {
    pub(super) bytes: Vec<u8>,
}

/// The lines of a log with a number, a gyro, and the frames of a GPS.
pub(super) const HEADER: &str = "H Product:Blackbox flight data recorder by Nicholas Sherlock\n\
    H Data version:2\n\
    H Field I name:loopIteration,time,gyroADC[0],motor[0],motor[1]\n\
    H Field I signed:0,0,1,0,0\n\
    H Field I predictor:0,0,0,11,5\n\
    H Field I encoding:1,1,0,1,0\n\
    H Field P predictor:6,2,3,3,3\n\
    H Field P encoding:9,0,0,0,0\n\
    H Field H name:GPS_home[0],GPS_home[1]\n\
    H Field H signed:1,1\n\
    H Field H predictor:0,0\n\
    H Field H encoding:0,0\n\
    H Field G name:time,GPS_numSat,GPS_coord[0],GPS_coord[1]\n\
    H Field G signed:0,0,1,1\n\
    H Field G predictor:10,0,7,7\n\
    H Field G encoding:1,1,0,0\n\
    H Field S name:flightModeFlags\n\
    H Field S signed:0\n\
    H Field S predictor:0\n\
    H Field S encoding:1\n\
    H Firmware type:Betaflight\n\
    H Firmware revision:Betaflight 4.5.2 (024f8e13d) STM32F7X2\n\
    H I interval:8\n\
    H P interval:2\n\
    H motorOutput:1000,2000\n";

impl Maker {
    /// Begins a log with these lines.
    pub(super) fn begin(&mut self, lines: &str) -> &mut Self {
        self.bytes.extend_from_slice(lines.as_bytes());
        self
    }

    pub(super) fn raw(&mut self, bytes: &[u8]) -> &mut Self {
        self.bytes.extend_from_slice(bytes);
        self
    }

    pub(super) fn unsigned(&mut self, mut value: u32) -> &mut Self {
        while value >= 0x80 {
            self.bytes.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.bytes.push(value as u8);
        self
    }

    pub(super) fn signed(&mut self, value: i32) -> &mut Self {
        self.unsigned((value << 1) as u32 ^ (value >> 31) as u32)
    }

    /// Writes a whole main frame: iteration, time, gyro, two motors.
    pub(super) fn whole(&mut self, [iteration, time, gyro, first, second]: [i32; 5]) -> &mut Self {
        self.raw(b"I").unsigned(iteration as u32).unsigned(time as u32).signed(gyro);
        self.unsigned((first - 1000) as u32).signed(second - first)
    }

    /// Writes a frame with these differences of time, gyro and motors.
    pub(super) fn differences(&mut self, differences: [i32; 4]) -> &mut Self {
        self.raw(b"P");
        differences.into_iter().fold(self, |maker, difference| maker.signed(difference))
    }

    pub(super) fn end(&mut self) -> &mut Self {
        self.raw(b"E\xffEnd of log\0")
    }

    /// Writes the frames of `count` intervals of eight iterations, the first one at `iteration`, a millisecond each: I, P, P, P.
    pub(super) fn intervals(&mut self, iteration: i32, count: i32) -> &mut Self {
        for interval in 0..count {
            let at = iteration + 8 * interval;
            self.whole([at, 1000 * at, at, 1100, 1200]);
            // The time steps to 2 ms after the first frame; then it goes on along a line.
            self.differences([2000, 1, 2, 3]).differences([0, 0, 0, 0]).differences([0, 0, 0, 0]);
        }
        self
    }
}
