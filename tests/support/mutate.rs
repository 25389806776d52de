//! Structured mutations: of JSON trees, of binary data, of PNG chunks with their checksums, of the GLB
//! container. What they make is wrong in one place and right everywhere else, so that it gets past the
//! first checks. Shared by the tests and by the targets in `fuzz/`.
#![allow(dead_code)] // Each program uses a part of it.

use serde_json::{Value, json};

use super::Gltf;

/// Marsaglia's xorshift: the same mutants in every run.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[self.below(list.len())]
    }
}

const NUMBERS: [&str; 24] = [
    "0",
    "-0.0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "255",
    "256",
    "5121",
    "5126",
    "65535",
    "65536",
    "16777217",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "18446744073709551615",
    "-9223372036854775808",
    "1e-45",
    "1e18",
    "1e38",
    "-1e300",
    "1e308",
];

const WORDS: [&str; 20] = [
    "",
    ".",
    "..",
    "/",
    "../../etc/passwd",
    "/dev/zero",
    "file:///etc/passwd",
    "https://example.com/a.bin",
    "data:",
    "data:;base64,",
    "data:;base64,AAAA",
    "data:;base64,=",
    "%00",
    "%ff%fe",
    "NaN",
    "MASK",
    "VEC3",
    "KHR_draco_mesh_compression",
    "\u{202e}\u{0}\n\u{1f600}",
    "POSITION",
];

/// Changes one to three values anywhere in a tree.
pub fn json(random: &mut Random, tree: &mut Value) {
    for _ in 0..=random.below(3) {
        let count = size(tree);
        let donor = nth(tree, random.below(count)).clone();
        let target = random.below(count);
        change(random, nth(tree, target), donor);
    }
}

/// Number of values in a tree.
fn size(tree: &Value) -> usize {
    1 + match tree {
        Value::Array(list) => list.iter().map(size).sum(),
        Value::Object(map) => map.values().map(size).sum(),
        _ => 0,
    }
}

/// A value of a tree, counted from the root, parents first.
fn nth(tree: &mut Value, mut index: usize) -> &mut Value {
    if index == 0 {
        return tree;
    }
    index -= 1;
    let children: Vec<&mut Value> = match tree {
        Value::Array(list) => list.iter_mut().collect(),
        Value::Object(map) => map.values_mut().collect(),
        _ => unreachable!("the index is below the size"),
    };
    for child in children {
        let inside = size(child);
        if index < inside {
            return nth(child, index);
        }
        index -= inside;
    }
    unreachable!("the index is below the size")
}

fn change(random: &mut Random, value: &mut Value, donor: Value) {
    let number = |random: &mut Random| {
        serde_json::from_str::<Value>(random.pick(&NUMBERS)).expect("they are numbers")
    };
    match random.below(8) {
        0 | 1 => *value = number(random),
        2 => *value = random.pick(&WORDS).into(),
        3 => *value = donor,
        4 => {
            let depth = random.pick(&[1, 2, 200]);
            let others = [
                json!(null),
                json!(true),
                json!([]),
                json!({}),
                nested(depth),
            ];
            *value = others[random.below(others.len())].clone();
        }
        // Whatever it is, a little of the same kind.
        _ => match value {
            Value::Array(list) if !list.is_empty() => {
                let (at, other) = (random.below(list.len()), random.below(list.len()));
                match random.below(4) {
                    0 => drop(list.remove(at)),
                    1 => list.swap(at, other),
                    2 => list.push(list[at].clone()),
                    _ => list.extend(vec![list[at].clone(); 300]),
                }
            }
            Value::Object(map) if !map.is_empty() => {
                let key = map.keys().nth(random.below(map.len())).cloned();
                let key = key.expect("it is below the length");
                match random.below(3) {
                    0 => drop(map.remove(&key)),
                    1 => drop(map.insert(key, donor)),
                    _ => drop(map.insert(random.pick(&WORDS).into(), donor)),
                }
            }
            Value::Number(found) => {
                let found = found.as_f64().unwrap_or(0.0);
                let factor = random.pick(&[-1.0, 1e-30, 1e9, 0.999]);
                *value = match random.below(3) {
                    0 => json!((found as i64).saturating_add(1)),
                    1 => json!((found as i64).saturating_sub(1)),
                    _ => json!(found * factor),
                };
            }
            Value::String(text) => match random.below(2) {
                0 => drop(text.pop()),
                _ => *text = text.repeat(random.pick(&[2, 500])),
            },
            other => *other = number(random),
        },
    }
}

fn nested(depth: usize) -> Value {
    (0..depth).fold(json!(0), |inner, _| json!([inner]))
}

/// Replaces a number in binary data by an odd one, or cuts or lengthens the data.
pub fn words(random: &mut Random, bytes: &mut Vec<u8>) {
    if bytes.len() < 4 {
        return bytes.extend([0; 4]);
    }
    let at = random.below(bytes.len() / 4) * 4;
    let odd: [u32; 11] = [
        0,
        1,
        0x8000_0000,
        f32::NAN.to_bits(),
        f32::INFINITY.to_bits(),
        f32::MAX.to_bits(),
        1e18f32.to_bits(),
        1,
        0xffff_ffff,
        0x7fff_ffff,
        0x0001_0000,
    ];
    match random.below(6) {
        0 => bytes[at] ^= 1 << random.below(8),
        1 => bytes.truncate(at),
        2 => bytes.extend(vec![random.below(256) as u8; 1 << random.below(12)]),
        _ => bytes[at..at + 4].copy_from_slice(&random.pick(&odd).to_le_bytes()),
    }
}

/// Changes a chunk of a PNG and corrects its checksum. What is no PNG stays as it is.
pub fn png(random: &mut Random, bytes: &mut [u8]) {
    let chunks = chunks(bytes);
    if chunks.is_empty() {
        return;
    }
    let (start, length) = chunks[random.below(chunks.len())];
    let data = start + 8..start + 8 + length;
    if data.is_empty() {
        return;
    }
    let header = &bytes[start + 4..start + 8] == b"IHDR";
    if header && random.below(2) == 0 {
        // Width or height.
        let side: u32 = random.pick(&[0, 1, 16384, 16385, 65535, 0x7fff_ffff, 0xffff_ffff]);
        let at = data.start + random.below(2) * 4;
        bytes[at..at + 4].copy_from_slice(&side.to_be_bytes());
    } else {
        bytes[data.start + random.below(length)] = random.below(256) as u8;
    }
    let checksum = crc32fast::hash(&bytes[start + 4..data.end]);
    bytes[data.end..data.end + 4].copy_from_slice(&checksum.to_be_bytes());
}

/// Start and length [byte] of the data of each chunk of a PNG.
fn chunks(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut at = 8;
    while let Some(length) = bytes.get(at..at + 4) {
        let length = u32::from_be_bytes(length.try_into().expect("four bytes")) as usize;
        if !bytes.starts_with(b"\x89PNG") || bytes.len() < at + 12 + length {
            break;
        }
        found.push((at, length));
        at += 12 + length;
    }
    found
}

/// Replaces, adds or removes bytes anywhere.
pub fn bytes(random: &mut Random, file: &mut Vec<u8>) {
    for _ in 0..=random.below(3) {
        if file.is_empty() {
            return;
        }
        let at = random.below(file.len());
        match random.below(4) {
            0 => file[at] ^= 1 << random.below(8),
            1 => file[at] = random.below(256) as u8,
            2 => drop(file.drain(at..file.len().min(at + 1 + random.below(8)))),
            _ => drop(file.splice(at..at, random.pick(&NUMBERS).bytes())),
        }
    }
}

/// Replaces a word of the header of a GLB or of its chunks.
fn container(random: &mut Random, glb: &mut [u8]) {
    let binary = glb.get(12..16).map_or(0, |length| {
        20 + u32::from_le_bytes(length.try_into().expect("four bytes")) as usize
    });
    let at = random.pick(&[0, 4, 8, 12, 16, binary, binary + 4]);
    let word: u32 = random.pick(&[0, 1, 2, 11, 12, 0x4e4f_534a, 0x004e_4942, 0xffff_ffff]);
    if let Some(target) = glb.get_mut(at..at + 4) {
        target.copy_from_slice(&word.to_le_bytes());
    }
}

/// A glTF or GLB that is wrong somewhere.
pub fn gltf(random: &mut Random, seed: &Gltf) -> Vec<u8> {
    let mut gltf = seed.clone();
    for _ in 0..=random.below(2) {
        match random.below(8) {
            0..=4 => json(random, &mut gltf.json),
            5 => words(random, &mut gltf.bytes),
            _ => image(random, &mut gltf),
        }
    }
    let glb = random.below(2) == 0;
    // The buffer goes into the tree only where the tree still has a place for it.
    let glb = glb || !gltf.json["buffers"][0].is_object();
    let mut file = if glb { gltf.to_glb() } else { gltf.to_gltf() };
    match random.below(8) {
        0 => bytes(random, &mut file),
        1 if glb => container(random, &mut file),
        _ => {}
    }
    file
}

/// Changes the PNG in a glTF's buffer, if there is one, without changing its length.
fn image(random: &mut Random, gltf: &mut Gltf) {
    let starts = |window: &[u8]| window == b"\x89PNG";
    if let Some(at) = gltf.bytes.windows(4).position(starts) {
        let mut image = gltf.bytes.split_off(at);
        png(random, &mut image);
        gltf.bytes.extend(image);
    }
}
