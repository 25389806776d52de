//! The program as its users meet it: what it writes, what it refuses, and in which words.

#[path = "command_line/done.rs"]
mod done;
#[path = "command_line/notes.rs"]
mod notes;
#[path = "command_line/outputs.rs"]
mod outputs;
#[path = "command_line/program.rs"]
mod program;
#[path = "command_line/refused.rs"]
mod refused;
