// A dispatch over views side by side (plan/side_by_side.rs): the work groups of one z are for one view.

uint view_index() { return push.index + gl_WorkGroupID.z * push.stride; }
