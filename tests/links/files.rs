//! Plan files and the store.

mod foreign_qgc;
mod formats;
mod killed;
mod maps;
mod plans;
mod storage;
