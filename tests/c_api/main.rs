//! The C library as C sees it: headers, layouts, symbols, and programs that are compiled and run.

mod build;
mod header;
mod install;
mod layouts;
mod programs;
mod symbols;
