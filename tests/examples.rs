//! The examples in Rust run, and check their own results.

#[path = "../examples/lent_device/main.rs"]
mod lent_device;
#[path = "../examples/visibility.rs"]
mod visibility;

#[test]
fn a_scene_from_arrays() {
    visibility::main().expect("a picture of the visibility");
}

#[test]
fn a_device_that_an_engine_lends() {
    lent_device::main().expect("the shadow that geometry says");
}
