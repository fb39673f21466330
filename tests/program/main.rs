//! The built executable, run as its users and the programs around it run it. It is paced by real time in many tests.

mod binary;
mod doors;
mod lockstep;
mod real_parts;
mod sitl_drive;
