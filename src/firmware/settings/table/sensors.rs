//! Gyro, accelerometer, magnetometer, barometer, alignment and the attitude estimate.

use super::super::Role::{Carry, Live};
use super::super::Scope;
use super::super::Width::{I16, U8, U16};
use super::{ACC_HARDWARE, Group, array, choice, number, switch};
use crate::firmware::settings::Role;
use crate::telemetry::FirmwareProfile;

const IN_MASTER: Role = Role::Only(FirmwareProfile::Master);

#[rustfmt::skip]
pub(super) const GYRO: Group = Group::new("Gyro", Scope::Master, &[
    choice("gyro_hardware_lpf", U8, &["NORMAL", "OPTION_1", "OPTION_2", "EXPERIMENTAL"], 0, Carry, "Low-pass inside a real gyro chip."),
    choice("gyro_lpf1_type", U8, &["PT1", "BIQUAD", "PT2", "PT3"], 0, Live, "Filter type of the first gyro low-pass."),
    number("gyro_lpf1_static_hz", U16, 0, 1000, 250, Live, "Cutoff of the first gyro low-pass while it is not dynamic, Hz; 0 turns it off."),
    choice("gyro_lpf2_type", U8, &["PT1", "BIQUAD", "PT2", "PT3"], 0, Live, "Filter type of the second gyro low-pass."),
    number("gyro_lpf2_static_hz", U16, 0, 1000, 500, Live, "Cutoff of the second gyro low-pass, Hz; 0 turns it off."),
    number("gyro_notch1_hz", U16, 0, 1000, 0, Carry, "Centre of the first gyro notch, Hz; 0 turns it off."),
    number("gyro_notch1_cutoff", U16, 0, 1000, 0, Carry, "Lower edge of the first gyro notch, Hz."),
    number("gyro_notch2_hz", U16, 0, 1000, 0, Carry, "Centre of the second gyro notch, Hz; 0 turns it off."),
    number("gyro_notch2_cutoff", U16, 0, 1000, 0, Carry, "Lower edge of the second gyro notch, Hz."),
    number("gyro_calib_duration", U16, 50, 3000, 125, Live, "Time the craft must stand still for the gyro calibration, 0.01 s."),
    number("gyro_calib_noise_limit", U8, 0, 200, 48, Live, "Movement above which the gyro calibration starts again, gyro units; 0 accepts any."),
    number("gyro_offset_yaw", I16, -1000, 1000, 0, Carry, "Fixed correction of the yaw rate, for gyros that drift."),
    choice("gyro_overflow_detect", U8, &["OFF", "YAW", "ALL"], 2, Carry, "Axes on which a gyro overflow is detected."),
    choice("yaw_spin_recovery", U8, &["OFF", "ON", "AUTO"], 2, Carry, "Stop controlling roll and pitch while the craft spins faster than the threshold."),
    number("yaw_spin_threshold", U16, 500, 1950, 1950, Carry, "Yaw rate that counts as a spin, deg/s."),
    number("gyro_lpf1_dyn_min_hz", U16, 0, 1000, 250, Live, "Cutoff of the first gyro low-pass at idle, Hz; 0 makes it static."),
    number("gyro_lpf1_dyn_max_hz", U16, 0, 1000, 500, Live, "Cutoff of the first gyro low-pass at full throttle, Hz."),
    number("gyro_lpf1_dyn_expo", U8, 0, 10, 5, Live, "Shape of the cutoff over throttle: higher rises earlier, 0 is linear."),
    choice("gyro_filter_debug_axis", U8, &["ROLL", "PITCH", "YAW"], 0, Carry, "Axis that the gyro debug modes show."),
]);

#[rustfmt::skip]
pub(super) const ACCELEROMETER: Group = Group::new("Accelerometer", Scope::Master, &[
    choice("acc_hardware", U8, ACC_HARDWARE, 0, Carry, "Accelerometer chip of a real board; here it is always the simulated one."),
    number("acc_lpf_hz", U16, 0, 500, 25, Live, "Low-pass of the accelerometer before the attitude estimate, Hz; 0 turns it off."),
    number("acc_trim_pitch", I16, -300, 300, 0, Live, "Level trim in pitch, 0.1 deg."),
    number("acc_trim_roll", I16, -300, 300, 0, Live, "Level trim in roll, 0.1 deg."),
    array("acc_calibration", I16, &[0, 0, 0, 0], Live, "Zero offsets of the accelerometer on x, y, z, and a flag that is set after calibration."),
]);

#[rustfmt::skip]
pub(super) const MAGNETOMETER: Group = Group::new("Magnetometer", Scope::Master, &[
    choice("align_mag", U8, &["DEFAULT", "CW0", "CW90", "CW180", "CW270", "CW0FLIP", "CW90FLIP", "CW180FLIP", "CW270FLIP", "CUSTOM"], 0, IN_MASTER, "Mounting orientation of the compass; CUSTOM takes mag_align_roll, _pitch and _yaw.").hardware(),
    number("mag_align_roll", I16, -3600, 3600, 0, IN_MASTER, "Custom compass mounting, roll, 0.1 deg.").hardware(),
    number("mag_align_pitch", I16, -3600, 3600, 0, IN_MASTER, "Custom compass mounting, pitch, 0.1 deg.").hardware(),
    number("mag_align_yaw", I16, -3600, 3600, 0, IN_MASTER, "Custom compass mounting, yaw, 0.1 deg.").hardware(),
    choice("mag_bustype", U8, &["NONE", "I2C", "SPI", "SLAVE"], 0, Carry, "Bus of a real compass.").hardware(),
    number("mag_i2c_device", U8, 0, 0, 0, Carry, "I2C bus of a real compass.").hardware(),
    number("mag_i2c_address", U8, 0, 119, 0, Carry, "I2C address of a real compass.").hardware(),
    number("mag_spi_device", U8, 0, 0, 0, Carry, "SPI bus of a real compass.").hardware(),
    choice("mag_hardware", U8, &["AUTO", "NONE", "HMC5883", "AK8975", "AK8963", "QMC5883L", "LIS2MDL", "LIS3MDL", "MPU925X_AK8963", "IST8310", "MMC560X", "QMC5883P"], 0, Live, "Compass chip; NONE switches the simulated compass off, any other value leaves it on."),
    array("mag_calibration", I16, &[0, 0, 0], Live, "Zero offsets of the compass on x, y, z (forward, left, up), in its own units."),
]);

#[rustfmt::skip]
pub(super) const BAROMETER: Group = Group::new("Barometer", Scope::Master, &[
    choice("baro_bustype", U8, &["NONE", "I2C", "SPI", "SLAVE"], 0, Carry, "Bus of a real barometer.").hardware(),
    number("baro_spi_device", U8, 0, 5, 0, Carry, "SPI bus of a real barometer.").hardware(),
    number("baro_i2c_device", U8, 0, 5, 0, Carry, "I2C bus of a real barometer.").hardware(),
    number("baro_i2c_address", U8, 0, 119, 0, Carry, "I2C address of a real barometer.").hardware(),
    choice("baro_hardware", U8, &["AUTO", "NONE", "BMP085", "MS5611", "BMP280", "LPS", "QMP6988", "BMP388", "DPS310", "2SMPB_02B", "LPS22DF", "BMP580", "BMP581", "VIRTUAL", "SPA06_003"], 1, Carry, "Barometer chip of a real board; the simulated one is always there."),
]);

#[rustfmt::skip]
pub(super) const BOARD: Group = Group::new("Board alignment", Scope::Master, &[
    number("align_board_roll", I16, -180, 360, 0, Carry, "Mounting of the flight controller, roll, deg."),
    number("align_board_pitch", I16, -180, 360, 0, Carry, "Mounting of the flight controller, pitch, deg."),
    number("align_board_yaw", I16, -180, 360, 0, Carry, "Mounting of the flight controller, yaw, deg."),
]);

#[rustfmt::skip]
pub(super) const ATTITUDE: Group = Group::new("Attitude estimate", Scope::Master, &[
    number("imu_dcm_kp", U16, 0, 32000, 2500, Live, "Gain with which the attitude estimate follows the accelerometer."),
    number("imu_dcm_ki", U16, 0, 32000, 0, Live, "Gain with which the attitude estimate learns the gyro bias."),
    number("small_angle", U8, 0, 180, 25, Live, "Maximum tilt for arming, deg; 180 for no limit."),
    number("imu_process_denom", U8, 1, 4, 2, Live, "Attitude estimates per second in level modes: 1000 divided by this."),
    number("mag_declination", I16, -300, 300, 0, Live, "Magnetic declination, east positive, 0.1 deg."),
    switch("trust_mag", U8, false, Live, "Use the compass for the heading."),
]);
