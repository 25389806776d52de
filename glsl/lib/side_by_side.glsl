// A dispatch over views side by side: the work groups of one z are one view's.

uint view_index() { return push.index + gl_WorkGroupID.z; }
