//! How structs and constants are declared that shaders see as well.

/// A field as GLSL sees it.
pub struct Field {
    pub name: &'static str,
    /// A GLSL type name.
    pub glsl: &'static str,
    /// Number of array elements; 0 = not an array.
    pub count: usize,
    /// [byte] From the start of the struct.
    pub offset: usize,
}

/// A struct as GLSL sees it.
pub struct Layout {
    pub name: &'static str,
    pub fields: &'static [Field],
    /// [byte]
    pub size: usize,
}

macro_rules! field_type {
    ($ty:ident) => {
        $ty
    };
    ($ty:ident $count:expr) => {
        [$ty; $count]
    };
}

macro_rules! field_count {
    () => {
        0
    };
    ($count:expr) => {
        $count
    };
}

macro_rules! shared {
    ($($(#[$doc:meta])* struct $name:ident {
        $($(#[$field_doc:meta])* $field:ident: $ty:ident $([$count:expr])?,)*
    })*) => {
        $($(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
        pub struct $name {
            $($(#[$field_doc])* pub $field: field_type!($ty $($count)?),)*
        })*

        /// Every shared struct, for the GLSL generator and the layout test.
        pub const LAYOUTS: &[Layout] = &[$(Layout {
            name: stringify!($name),
            fields: &[$(Field {
                name: stringify!($field),
                glsl: stringify!($ty),
                count: field_count!($($count)?),
                offset: std::mem::offset_of!($name, $field),
            },)*],
            size: std::mem::size_of::<$name>(),
        },)*];
    };
}

macro_rules! shared_constants {
    ($($(#[$doc:meta])* $name:ident: $ty:ident $([$count:literal])? = $value:expr;)*) => {
        $($(#[$doc])* pub const $name: field_type!($ty $($count)?) = $value;)*

        /// Name, GLSL type and value of every shared constant, for the GLSL generator.
        pub fn constants() -> Vec<(&'static str, &'static str, String)> {
            let initializer = |value: String| value.replace('[', "{").replace(']', "}");
            vec![$((
                stringify!($name),
                concat!(stringify!($ty), $("[", stringify!($count), "]")?),
                initializer(format!("{:?}", $name)),
            ),)*]
        }
    };
}
