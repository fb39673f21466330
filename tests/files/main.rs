//! Plan files and the store.

mod formats;
mod killed;
mod maps;
mod plans;
mod storage;
