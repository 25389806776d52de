//! How much a test does: what a change can wait for, or everything.

/// `quick`, or `all` where the environment has `HALFSHADE_SLOW=1`, as `tools/test.sh --slow` sets it.
pub fn cases(quick: u32, all: u32) -> u32 {
    match std::env::var_os("HALFSHADE_SLOW").is_some_and(|slow| slow == "1") {
        true => all,
        false => quick,
    }
}
