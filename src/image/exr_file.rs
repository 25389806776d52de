//! OpenEXR: images of numbers, with named channels.

use std::fs::File;
use std::io::{BufReader, Cursor};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, ReadChannels,
    ReadLayers, Text, WritableImage, read,
};

use super::{Plane, check_samples, write_atomically};
use crate::{Error, Result};

/// Writes 32-bit float channels, ZIP-compressed, under the given names.
///
/// # Errors
/// When there is no channel, when sizes differ, when a name is empty, has characters beyond Latin-1 or
/// comes twice, or when the file cannot be written.
pub fn write_exr(path: &Path, channels: &[(&str, &Plane)]) -> Result<()> {
    let bytes = encode(channels).map_err(|message| Error::parse(path, message))?;
    write_atomically(path, |file| file.write_all(&bytes))
}

fn encode(channels: &[(&str, &Plane)]) -> Result<Vec<u8>, String> {
    let (_, first) = channels
        .first()
        .ok_or("an image needs at least one channel")?;
    let size = (first.width, first.height);
    let mut list = Vec::with_capacity(channels.len());
    for (index, (name, plane)) in channels.iter().enumerate() {
        if (plane.width, plane.height) != size
            || plane.data.len() != size.0 * size.1
            || plane.data.is_empty()
        {
            return Err(format!(
                "channel {name} has not the size of the image, or none at all"
            ));
        }
        if channels[..index].iter().any(|(other, _)| other == name) {
            return Err(format!("two channels are called {name}"));
        }
        let text = Text::new_or_none(name)
            .filter(|text| !text.as_slice().is_empty())
            .ok_or_else(|| format!("“{name}” is no channel name"))?;
        list.push(AnyChannel::new(text, FlatSamples::F32(plane.data.clone())));
    }
    let layer = Layer::new(
        size,
        LayerAttributes::default(),
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(list.into()),
    );
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer)
        .write()
        .to_buffered(&mut bytes)
        .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Reads all channels of all layers, in the order of the file; a channel of a named layer is called
/// `layer.channel`. Half and integer samples become f32.
///
/// # Errors
/// When the file is missing, is not an OpenEXR image, is damaged, has deep data, or claims more than
/// `max_samples` in all.
pub fn read_exr(path: &Path, max_samples: u64) -> Result<Vec<(String, Plane)>> {
    let file = File::open(path).map_err(|source| Error::io(path, source))?;
    // The decoder is written not to panic; should a damaged file prove otherwise, it ends here.
    let decoded = catch_unwind(AssertUnwindSafe(|| decode(file, max_samples)));
    decoded
        .unwrap_or_else(|_| Err("is damaged in a way that its decoder cannot handle".into()))
        .map_err(|message| Error::parse(path, message))
}

fn decode(file: File, max_samples: u64) -> Result<Vec<(String, Plane)>, String> {
    let describe = |error: exr::error::Error| match error {
        exr::error::Error::Io(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            "is cut short".to_string()
        }
        error => format!("is not a readable OpenEXR image ({error})"),
    };
    let chunks = exr::block::read(BufReader::new(file), false).map_err(describe)?;
    let mut left = max_samples;
    for header in chunks.headers() {
        let [width, height] = [header.layer_size.0 as u64, header.layer_size.1 as u64];
        let channels = header.channels.list.len() as u64;
        check_samples([width, height], channels, left)?;
        left -= width * height * channels;
    }
    // One thread: these images are small, and a panic on another thread could not be caught.
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .non_parallel()
        .from_chunks(chunks)
        .map_err(describe)?;
    let layers = image.layer_data.into_iter();
    layers.flat_map(planes_of).collect()
}

fn planes_of(layer: Layer<AnyChannels<FlatSamples>>) -> Vec<Result<(String, Plane), String>> {
    let prefix = layer
        .attributes
        .layer_name
        .map(|name| format!("{name}."))
        .unwrap_or_default();
    let plane_of = |channel: AnyChannel<FlatSamples>| {
        let name = format!("{prefix}{}", channel.name);
        let data = match channel.sample_data {
            FlatSamples::F32(values) => values,
            other => other.values_as_f32().collect(),
        };
        match Plane::new(layer.size.0, layer.size.1, data) {
            Ok(plane) => Ok((name, plane)),
            Err(_) => Err(format!("channel {name} has not the size of its image")),
        }
    };
    layer.channel_data.list.into_iter().map(plane_of).collect()
}

#[cfg(test)]
mod tests {
    use super::super::MAX_SAMPLES;
    use super::*;

    fn ramp(width: usize, height: usize) -> Plane {
        let data = (0..width * height).map(|i| i as f32 / 7.0).collect();
        Plane::new(width, height, data).unwrap()
    }

    #[test]
    fn what_was_written_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut y = ramp(37, 19);
        y.data[5] = f32::NAN;
        let facing = ramp(37, 19);
        write_exr(&path, &[("facing", &facing), ("Y", &y)]).unwrap();
        let channels = read_exr(&path, MAX_SAMPLES).unwrap();
        assert_eq!(channels.len(), 2);
        // By bits, since NaN is not equal to itself.
        let bits = |plane: &Plane| plane.data.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        for (name, plane) in &channels {
            let expected = if name == "Y" { &y } else { &facing };
            assert_eq!((plane.width, plane.height), (37, 19));
            assert_eq!(bits(plane), bits(expected), "{name}");
        }
    }

    #[test]
    fn half_and_integer_samples_become_f32() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let half = [0.0, 0.25, 0.5, 1.0]
            .map(exr::prelude::f16::from_f32)
            .to_vec();
        let list = vec![
            AnyChannel::new("count", FlatSamples::U32(vec![0, 1, 2, 70000])),
            AnyChannel::new("Y", FlatSamples::F16(half)),
        ];
        let image = Image::from_channels((2, 2), AnyChannels::sort(list.into()));
        image.write().to_file(&path).unwrap();
        let channels = read_exr(&path, MAX_SAMPLES).unwrap();
        let data = |name| &channels.iter().find(|(n, _)| n == name).unwrap().1.data;
        assert_eq!(data("Y"), &[0.0, 0.25, 0.5, 1.0]);
        assert_eq!(data("count"), &[0.0, 1.0, 2.0, 70000.0]);
    }

    #[test]
    fn what_cannot_be_written_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let (small, large) = (ramp(2, 2), ramp(3, 2));
        assert!(write_exr(&path, &[]).is_err());
        assert!(write_exr(&path, &[("a", &small), ("b", &large)]).is_err());
        assert!(write_exr(&path, &[("a", &small), ("a", &small)]).is_err());
        assert!(write_exr(&path, &[("", &small)]).is_err());
        assert!(write_exr(&path, &[("日", &small)]).is_err());
        assert!(write_exr(&path, &[("a", &ramp(0, 0))]).is_err());
        assert!(!path.exists());
    }

    /// Every cut and many single-byte changes of a valid file: an error or an image, never a panic.
    #[test]
    fn damaged_files_are_errors() {
        let plane = ramp(24, 33);
        let good = encode(&[("Y", &plane), ("facing", &plane)]).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        for length in (0..good.len()).step_by(7) {
            std::fs::write(&path, &good[..length]).unwrap();
            read_exr(&path, MAX_SAMPLES).unwrap_err();
        }
        let mut state = 1u64;
        for _ in 0..2000 {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            let mut bad = good.clone();
            let place = (state >> 33) as usize % bad.len().min(600);
            bad[place] ^= 1 << ((state >> 20) & 7);
            std::fs::write(&path, &bad).unwrap();
            // A change may go unnoticed (a name, a comment); what counts is that it comes back.
            let file = File::open(&path).unwrap();
            let _ = decode(file, MAX_SAMPLES);
        }
    }
}
