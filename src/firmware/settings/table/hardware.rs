//! Buses, ports and peripherals of real boards.

use super::super::Role::Carry;
use super::super::Scope;
use super::super::Width::{U8, U16, U32};
use super::{BAUD, Group, choice, number, port, switch};

#[rustfmt::skip]
pub(super) const HARDWARE: Group = Group::new("Hardware", Scope::Master, &[
    number("rcdevice_init_dev_attempts", U8, 0, 10, 6, Carry, "Number of attempts to reach a camera at boot."),
    number("rcdevice_init_dev_attempt_interval", U32, 0, 5000, 1000, Carry, "Time between those attempts, ms."),
    number("rcdevice_protocol_version", U8, 0, 1, 0, Carry, "Protocol version of a camera."),
    number("rcdevice_feature", U16, 0, 65535, 0, Carry, "Features of a camera, one bit each."),
    port("rcdevice_uart", 0, Carry, "Serial port of a camera."),
    choice("gyro_1_bustype", U8, &["NONE", "I2C", "SPI", "SLAVE"], 0, Carry, "Bus of a real gyro.").hardware(),
    number("gyro_1_spibus", U8, 0, 0, 0, Carry, "SPI bus of a real gyro.").hardware(),
    number("gyro_1_i2cBus", U8, 0, 0, 0, Carry, "I2C bus of a real gyro.").hardware(),
    number("gyro_1_i2c_address", U8, 0, 119, 0, Carry, "I2C address of a real gyro.").hardware(),
    number("scheduler_relax_rx", U16, 0, 500, 25, Carry, "Slack of the scheduler for the receiver, µs.").hardware(),
    number("scheduler_relax_osd", U16, 0, 500, 25, Carry, "Slack of the scheduler for the display, µs.").hardware(),
    number("scheduler_debug_task", U16, 0, 21, 0, Carry, "Task that the scheduler's debug mode shows.").hardware(),
]);

#[rustfmt::skip]
pub(super) const SERIAL_PORTS: Group = Group::new("Serial ports", Scope::Master, &[
    switch("serialmsp_halfduplex", U8, false, Carry, "MSP on a single wire."),
    port("msp_uart_1", 1, Carry, "Serial port for MSP and CLI; the doors to open are chosen when the program starts."),
    choice("msp_baud_1", U8, BAUD, 5, Carry, "Baud rate of the first MSP port."),
    port("msp_uart_2", 0, Carry, "Second serial port for MSP."),
    choice("msp_baud_2", U8, BAUD, 5, Carry, "Baud rate of the second MSP port."),
    port("msp_uart_3", 0, Carry, "Third serial port for MSP."),
    choice("msp_baud_3", U8, BAUD, 5, Carry, "Baud rate of the third MSP port."),
]);
