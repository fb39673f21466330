//! The code and its pages against the rules of the project.

mod pages;
mod rooms;
