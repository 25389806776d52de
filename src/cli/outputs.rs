//! The files that a command writes: each in its own format, none of them another one or a file that is read.

use std::path::{Path, PathBuf};

use halfshade::image::is_same_file;
use halfshade::{Error, Result};

/// What a file is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Png,
    Exr,
    Json,
    Csv,
}

/// A file to write.
#[derive(Debug, Clone, Copy)]
pub struct Output<'a> {
    /// That names it, with its dashes.
    pub flag: &'static str,
    pub path: &'a Path,
    pub format: Format,
}

/// Extensions that say of a file what it holds. Any other, or none, says nothing.
const KNOWN: &[&str] = &[
    "png", "exr", "json", "csv", "txt", // Images.
    "jpg", "jpeg", "jpe", "jfif", "jp2", "jxl", "gif", "bmp", "dib", "tif", "tiff", "tga", "webp",
    "avif", "heic", "heif", "ico", "pnm", "pbm", "pgm", "ppm", "pam", "pfm", "hdr", "rgbe", "qoi",
    "dds", "ktx", "ktx2", "psd", "xcf", "pcx", "ff", "dng", "svg", "eps", "ps",
    "pdf", // Films.
    "mp4", "mov", "mkv", "webm", "avi", // Scenes.
    "gltf", "glb", "obj", "fbx", "usd", "usda", "usdc", "usdz", "ply", "stl", "blend", "dae",
    // Text, tables and archives.
    "tsv", "xls", "xlsx", "ods", "jsonl", "ndjson", "xml", "yaml", "yml", "toml", "html", "htm",
    "md", "tex", "npy", "npz", "zip", "gz", "xz", "zst", "tar",
];

impl Format {
    fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Exr => "OpenEXR",
            Self::Json => "JSON",
            Self::Csv => "CSV",
        }
    }

    /// Extensions of this format, its own first.
    fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Png => &["png"],
            Self::Exr => &["exr"],
            Self::Json => &["json", "txt"],
            Self::Csv => &["csv", "txt"],
        }
    }
}

impl Output<'_> {
    /// # Errors
    /// The extension says another format, whatever its case.
    fn check_extension(&self) -> Result<()> {
        let extension = self.path.extension().unwrap_or_default();
        let is = |known: &&str| extension.eq_ignore_ascii_case(known);
        let own = self.format.extensions();
        if own.iter().any(is) || !KNOWN.iter().any(is) {
            return Ok(());
        }
        Err(Error::Invalid(format!(
            "{} writes {}, but {} says another format; name a file that ends in .{}",
            self.flag,
            self.format.name(),
            self.path.display(),
            own[0]
        )))
    }
}

/// Checks what the command line alone tells; `inputs` are the files that it names to be read.
///
/// # Errors
/// An extension says another format, or a file is named twice.
pub fn check(outputs: &[Output], inputs: &[&Path]) -> Result<()> {
    for (index, output) in outputs.iter().enumerate() {
        output.check_extension()?;
        let path = output.path;
        let mut others = outputs[..index].iter();
        if let Some(other) = others.find(|other| is_same_file(other.path, path)) {
            let (first, second) = (other.path.display(), path.display());
            let what = match other.path == path {
                true => format!("{second} is named twice"),
                false => format!("{second} is the same file as {first}"),
            };
            return Err(Error::Invalid(format!(
                "{what}; each output needs a file of its own"
            )));
        }
        check_apart(path, inputs.iter().copied())?;
    }
    Ok(())
}

/// Checks files that are to be written against those that a shot was read from.
///
/// # Errors
/// One of them is to be written.
pub fn check_read<'a>(written: impl IntoIterator<Item = &'a Path>, read: &[PathBuf]) -> Result<()> {
    let mut written = written.into_iter();
    written.try_for_each(|path| check_apart(path, read.iter().map(PathBuf::as_path)))
}

fn check_apart<'a>(path: &Path, mut inputs: impl Iterator<Item = &'a Path>) -> Result<()> {
    let Some(input) = inputs.find(|input| is_same_file(input, path)) else {
        return Ok(());
    };
    let (read, written) = (input.display(), path.display());
    Err(Error::Invalid(match input == path {
        true => format!("{written} is read, so it is not written; name another output"),
        false => format!(
            "{written} is the same file as {read}, which is read, so it is not written; name another output"
        ),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(path: &str, format: Format) -> Output<'_> {
        Output {
            flag: "-o",
            path: Path::new(path),
            format,
        }
    }

    #[test]
    fn extensions_that_say_another_format_are_refused() {
        let check = |path, format| output(path, format).check_extension().is_ok();
        for (path, format) in [
            ("a.png", Format::Png),
            ("A.PNG", Format::Png),
            ("a.Exr", Format::Exr),
            ("a.json", Format::Json),
            ("a.txt", Format::Json),
            ("a.csv", Format::Csv),
            // What says nothing.
            ("a", Format::Png),
            (".png", Format::Exr),
            ("a.", Format::Exr),
            ("a.png.tmp", Format::Exr),
            ("v1.2", Format::Png),
            ("/dev/stdout", Format::Json),
            ("jpg", Format::Png),
            ("jpg/a", Format::Png),
        ] {
            assert!(check(path, format), "{path}");
        }
        for (path, format) in [
            ("a.jpg", Format::Png),
            ("a.JPEG", Format::Png),
            ("a.exr", Format::Png),
            ("a.txt", Format::Png),
            ("a.png", Format::Exr),
            ("a.csv", Format::Json),
            ("a.json", Format::Csv),
            ("scene.GLB", Format::Png),
        ] {
            assert!(!check(path, format), "{path}");
        }
        let error = output("a.jpg", Format::Png).check_extension().unwrap_err();
        assert_eq!(
            error.to_string(),
            "-o writes PNG, but a.jpg says another format; name a file that ends in .png"
        );
    }

    #[test]
    fn known_extensions_are_told_once() {
        for (index, known) in KNOWN.iter().enumerate() {
            assert!(!KNOWN[..index].contains(known), "{known}");
            assert_eq!(*known, known.to_ascii_lowercase());
        }
        for format in [Format::Png, Format::Exr, Format::Json, Format::Csv] {
            let own = format.extensions().iter();
            assert!(own.clone().all(|own| KNOWN.contains(own)));
        }
    }

    #[test]
    fn files_are_named_once() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name).display().to_string();
        std::fs::write(at("in.json"), "").unwrap();
        std::fs::create_dir(at("sub")).unwrap();
        let (a, spelt, input) = (at("a"), at("sub/../a"), at("in.json"));
        let error = |outputs: &[Output]| {
            let checked = check(outputs, &[Path::new(&input)]);
            checked.map_or_else(|error| error.to_string(), |()| String::new())
        };
        let (png, exr) = (output(&a, Format::Png), output(&a, Format::Exr));
        assert!(error(&[png, exr]).contains("a is named twice"));
        assert!(error(&[png, output(&spelt, Format::Exr)]).contains("the same file as"));
        assert!(error(&[output(&input, Format::Json)]).contains("in.json is read"));
        let null = [Format::Png, Format::Exr].map(|format| output("/dev/null", format));
        assert_eq!(error(&null), "");
        let spelt = PathBuf::from(at("sub/../in.json"));
        let read = [PathBuf::from(&input)];
        let refused = check_read([spelt.as_path()], &read).unwrap_err();
        assert!(refused.to_string().contains("in.json, which is read"));
        check_read([Path::new(&a)], &read).unwrap();
    }
}
