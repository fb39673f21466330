//! A session: its clients, its simulator, and its requests.

mod doors;
mod requests;
mod simulator;
