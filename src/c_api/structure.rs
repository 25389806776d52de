//! What all structures of the interface have in common.

/// A structure of the interface.
///
/// # Safety
/// It is `repr(C)`, begins with `type`, `size` and `next`, and any bytes make a value of it.
pub unsafe trait Structure: Copy {
    const TYPE: u32;
    const NAME: &'static str;
}

/// Declares which `type` belongs to which structure.
macro_rules! structures {
    ($($name:ident = $kind:ident,)*) => {$(
        // SAFETY: a repr(C) structure of numbers, pointers and arrays of them that begins with a head; the test of
        // the layouts looks at each.
        unsafe impl $crate::c_api::structure::Structure for $name {
            const TYPE: u32 = $kind;
            const NAME: &'static str = stringify!($name);
        }
    )*};
}
pub(crate) use structures;
