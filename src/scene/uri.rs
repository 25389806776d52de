//! URIs of a glTF: data in them, and the files that they name.

use std::path::{Component, PathBuf};

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};

/// Files in the wild omit the padding.
const LENIENT: GeneralPurposeConfig =
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
const BASE64: GeneralPurpose = GeneralPurpose::new(&base64::alphabet::STANDARD, LENIENT);

/// What follows the scheme of a `data:` URI, in any case.
pub(super) fn data_of(uri: &str) -> Option<&str> {
    let scheme = uri.get(..5)?;
    scheme.eq_ignore_ascii_case("data:").then(|| &uri[5..])
}

/// What a `data:` URI holds behind its scheme: in base64 as tools write it (with line breaks, in the alphabet of URLs), or with
/// percent signs.
pub(super) fn inline_data(data: &str) -> std::result::Result<Vec<u8>, String> {
    let (head, data) = data.split_once(',').ok_or("has no comma before its data")?;
    let decoded = percent_encoding::percent_decode_str(data);
    if !head.to_ascii_lowercase().ends_with(";base64") {
        return Ok(decoded.collect());
    }
    let standard = |byte| match byte {
        b'-' => b'+',
        b'_' => b'/',
        other => other,
    };
    let digits = decoded.filter(|byte| !byte.is_ascii_whitespace());
    let digits: Vec<u8> = digits.map(standard).collect();
    BASE64
        .decode(digits)
        .map_err(|e| format!("is not valid base64: {e}"))
}

/// The file that a URI reference names.
pub(super) struct NamedFile {
    pub path: PathBuf,
    /// The reference is a path, not a URL.
    relative: bool,
}

impl NamedFile {
    /// None: it names no file of this machine.
    pub fn new(uri: &str) -> Option<Self> {
        let local = uri.strip_prefix("file://");
        // RFC 3986 §4.2: a colon in the first segment makes it a URL (or a Windows drive).
        if local.is_none() && uri.split('/').next()?.contains(':') {
            return None;
        }
        // The rest of a file: URL starts with the name of a host, which must be empty.
        if local.is_some_and(|path| !path.starts_with('/')) {
            return None;
        }
        let decoded = percent_encoding::percent_decode_str(local.unwrap_or(uri))
            .decode_utf8()
            .ok()?;
        if decoded.contains('\0') {
            return None;
        }
        // Tools of Windows write its separators.
        let path = PathBuf::from(decoded.replace('\\', "/"));
        path.file_name()?;
        Some(Self {
            path,
            relative: local.is_none(),
        })
    }

    /// Whether it stays below the folder that it starts from, but for links.
    pub fn is_below(&self) -> bool {
        let below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
        self.relative && self.path.components().all(below)
    }
}
