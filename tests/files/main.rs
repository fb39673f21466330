//! Plan files and the store.

mod formats;
mod killed;
mod plans;
mod storage;
