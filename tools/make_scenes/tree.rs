//! A tree: trunk, thin twigs, and leaves that are holes in a texture.

use glam::{DVec2, DVec3};
use serde_json::{Value, json};
use std::f64::consts::TAU;

use super::document::{Document, Index};
use super::shot::{Light, Shot};
use halfshade::scene::Shape;

pub fn scene() -> (Shot, Document) {
    let shot = Shot {
        name: "tree",
        what: "Thin occluders: twigs and alpha-masked leaves cast a dappled shadow that must not \
               thicken, leak or lose single leaves; the trunk's is sharp at its foot.",
        eye: DVec3::new(1.1, 4.1, 5.6),
        target: DVec3::new(1.1, 0.85, 0.0),
        vfov_deg: 42.0,
        light: Light::Rect {
            center: DVec3::new(-4.8, 7.4, 1.0),
            u: DVec3::new(0.0, 0.0, 0.5),
            v: DVec3::new(-0.4, -0.3, 0.0),
        },
    };
    let mut document = Document::default();
    let sand = document.material("sand", [0.83, 0.77, 0.66]);
    let bark = document.material("bark", [0.50, 0.37, 0.27]);
    let atlas = document.texture(&leaf_atlas());
    let mut tree = Tree::default();
    tree.grow(DVec3::ZERO, DVec3::new(0.08, 1.25, 0.0), 0.1, 0);

    let ground = document.indexed(&Shape::square(14.0), Index::U16, sand);
    let mut parts = vec![document.indexed(&tree.wood, Index::U16, bark)];
    parts.push(narrow_leaves(&mut document, atlas, &tree.leaves[0]));
    parts.push(round_leaves(&mut document, atlas, &tree.leaves[1]));
    let ground = document.mesh("ground", &[ground]);
    let mesh = document.mesh("tree", &parts);
    let mut nodes = vec![
        document.node(json!({ "name": "ground", "mesh": ground })),
        document.node(json!({ "name": "tree", "mesh": mesh })),
    ];
    nodes.extend(shot.add_to(&mut document));
    document.scene("tree", &nodes);
    (shot, document)
}

/// The corners of a leaf, in the order of `LEAF_UV`: stalk left and right, tip right and left.
const LEAF_UV: [DVec2; 4] = [
    DVec2::new(0.0, 1.0),
    DVec2::new(1.0, 1.0),
    DVec2::new(1.0, 0.0),
    DVec2::new(0.0, 0.0),
];

/// Leaves of the atlas's left half: texture coordinates that lie there, interleaved with positions.
fn narrow_leaves(document: &mut Document, atlas: usize, leaves: &Shape) -> Value {
    let material = leaf_material(document, "narrow leaf", json!({ "index": atlas }));
    let half = LEAF_UV.map(|uv| uv * DVec2::new(0.5, 1.0));
    let uvs = half.repeat(leaves.positions.len() / 4);
    let (position, uv) = document.interleaved(&leaves.positions, &uvs);
    let indices = document.indices(leaves, Index::U16);
    textured(position, uv, indices, material)
}

/// Leaves of the atlas's right half: a KHR_texture_transform takes them there.
fn round_leaves(document: &mut Document, atlas: usize, leaves: &Shape) -> Value {
    let transform = json!({
        "KHR_texture_transform": { "offset": [0.5, 0.0], "scale": [0.5, 1.0] },
    });
    let texture = json!({ "index": atlas, "extensions": transform });
    let material = leaf_material(document, "round leaf", texture);
    let uvs = LEAF_UV.repeat(leaves.positions.len() / 4);
    let position = document.positions(&leaves.positions);
    let uv = document.normalized_texcoords(&uvs);
    let indices = document.indices(leaves, Index::U16);
    textured(position, uv, indices, material)
}

/// A primitive of indexed triangles with texture coordinates.
fn textured(position: usize, uv: usize, indices: usize, material: usize) -> Value {
    json!({
        "attributes": { "POSITION": position, "TEXCOORD_0": uv },
        "indices": indices, "material": material,
    })
}

fn leaf_material(document: &mut Document, name: &str, texture: Value) -> usize {
    document.raw_material(json!({
        "name": name, "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.5,
        "pbrMetallicRoughness": { "baseColorTexture": texture, "metallicFactor": 0.0 },
    }))
}

/// A 64 × 64 PNG: a narrow leaf in its left half, a round one in its right half, stalks at the bottom.
fn leaf_atlas() -> Vec<u8> {
    const SIZE: u32 = 64;
    let atlas = image::RgbaImage::from_fn(SIZE, SIZE, |x, y| {
        let right = x >= SIZE / 2;
        // [−1, 1] across the leaf, [0, 1] from the stalk to the tip.
        let across = (f64::from(x % (SIZE / 2)) + 0.5) / f64::from(SIZE / 4) - 1.0;
        let along = 1.0 - (f64::from(y) + 0.5) / f64::from(SIZE);
        let outline = if right {
            3.6 * along * (1.0 - along) - 0.05
        } else {
            4.2 * along * (1.0 - along) * (1.0 - 0.6 * along) - 0.1
        };
        // Half a texel on either side of the outline, the alpha falls from 1 to 0.
        let inside = (outline - across.abs()) * f64::from(SIZE / 4) + 0.5;
        let vein = if across.abs() < 0.07 { 26 } else { 0 };
        let [r, g, b] = if right {
            [150, 178, 84]
        } else {
            [118, 160, 82]
        };
        image::Rgba([
            r + vein,
            g + vein,
            b,
            (inside.clamp(0.0, 1.0) * 255.0) as u8,
        ])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    atlas
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("writing to memory cannot fail");
    png.into_inner()
}

/// The tree while it grows.
#[derive(Default)]
struct Tree {
    wood: Shape,
    /// Narrow and round leaves, four points each.
    leaves: [Shape; 2],
    /// Counts the numbers drawn so far.
    draws: u64,
}

impl Tree {
    /// Trunk, branches, boughs, twigs.
    const LEVELS: usize = 4;
    /// Shoots of a limb, by its level.
    const SHOOTS: [u32; Self::LEVELS - 1] = [6, 5, 4];

    /// A limb from `from` along `axis` and all that grows on it.
    fn grow(&mut self, from: DVec3, axis: DVec3, radius: f64, level: usize) {
        let tip = from + axis;
        let limb = Shape::limb(from, tip, (radius, 0.6 * radius), [10, 7, 5, 4][level]);
        self.wood.append(&limb);
        if level == Self::LEVELS - 1 {
            for share in [0.45, 0.75, 1.0] {
                self.leaf(from + axis * share, axis.normalize());
            }
            return;
        }
        let (x, z) = axis.normalize().any_orthonormal_pair();
        let shoots = Self::SHOOTS[level];
        for i in 0..shoots {
            // The last shoot goes on from the tip; the others leave the limb's outer part.
            let share = 0.55 + 0.45 * f64::from(i + 1) / f64::from(shoots);
            let (sin, cos) = (TAU * (f64::from(i) * 0.382 + 0.12 * self.random())).sin_cos();
            let spread = if i + 1 == shoots {
                0.25
            } else {
                0.75 + 0.3 * self.random()
            };
            let aside = (x * cos + z * sin) * spread;
            let along = (axis.normalize() + aside + DVec3::Y * 0.12).normalize();
            let length = axis.length() * (0.56 + 0.16 * self.random());
            self.grow(from + axis * share, along * length, 0.5 * radius, level + 1);
        }
    }

    /// A leaf whose stalk is at `at`, on a twig of this direction.
    fn leaf(&mut self, at: DVec3, twig: DVec3) {
        let tilt = DVec3::new(self.random(), self.random(), self.random()) * 2.0 - 1.0;
        let along = (twig * 0.5 + tilt).normalize();
        let across = along.any_orthonormal_vector() * 0.055;
        let along = along * 0.2;
        let kind = usize::from(self.random() < 0.5);
        let leaves = &mut self.leaves[kind];
        let first = leaves.positions.len() as u32;
        let tip = at + along;
        let corners = [at - across, at + across, tip + across, tip - across];
        leaves.positions.extend(corners);
        leaves.quad([first, first + 1, first + 2, first + 3]);
    }

    /// [0, 1) The next of a fixed sequence of numbers (splitmix64).
    fn random(&mut self) -> f64 {
        self.draws += 1;
        let mut z = self.draws.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
