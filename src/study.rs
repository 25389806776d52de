//! Error against run time: sweeps techniques and their settings over shots, measures what each costs and how far it
//! is from the truth, and reports all of it.
//!
//! A study lives in a folder, one file for each finished run, so that it can be interrupted, cut into shards and
//! merged; tables, plots and pages are made from these files.

mod bench;
pub mod figure;
mod flicker;
mod folder;
mod front;
mod page;
mod plot;
mod run;
mod sheet;
pub mod stability;
mod subject;
mod sweep;
mod table;
mod tune;

pub use bench::{Bench, Pictures, Protocol};
pub use folder::{Folder, Shard, key};
pub use front::front;
pub use run::{Errors, Machine, Measured, Outcome, Run, is_traversal, is_visibility};
pub use subject::Subject;
pub use sweep::Sweep;
pub use tune::{Goal, best};
