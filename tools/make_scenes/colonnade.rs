//! A court between an arcade and a covered walk, lit through the arches.

use glam::DVec3;
use serde_json::{Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

use super::document::{Document, Index};
use super::shot::{Light, Shot};
use halfshade::scene::Shape;

/// [unit] From column to column along a row.
const SPACING: f64 = 2.0;
/// Columns of a row.
const COLUMNS: usize = 8;
/// [unit] From the court's middle line to the axis of a row.
const ROW: f64 = 2.4;
/// [unit] Where the arches spring from, above the stylobate.
const SPRINGING: f64 = 3.0;
/// [unit] The height of the stylobate, the step that a row stands on.
const STEP: f64 = 0.16;

pub fn scene() -> (Shot, Document) {
    let shot = Shot {
        name: "colonnade",
        what: "The shadows of the arcade: sharp at the foot of the columns, soft across the court, \
               softer still up the columns and the wall of the covered walk.",
        eye: DVec3::new(0.7, 1.75, 7.6),
        target: DVec3::new(-0.75, 1.75, 0.0),
        vfov_deg: 56.0,
        light: Light::Rect {
            center: DVec3::new(8.8, 6.6, -1.0),
            u: DVec3::new(0.0, 0.0, 1.2),
            v: DVec3::new(-0.36, 0.48, 0.0),
        },
    };
    let mut document = Document::default();
    let meshes = Meshes::new(&mut document);
    let east = row(&mut document, &meshes, "arcade", ROW, FRAC_1_SQRT_2);
    let west = row(&mut document, &meshes, "covered walk", -ROW, -FRAC_1_SQRT_2);
    let mut court = vec![east, west];
    for (name, mesh, place) in [
        ("floor", meshes.floor, [0.0, 0.0, 0.0]),
        ("side wall", meshes.wall, [-5.2, 0.0, 0.0]),
        ("urn", meshes.urn, [0.35, 0.0, -1.4]),
    ] {
        court.push(document.node(json!({ "name": name, "mesh": mesh, "translation": place })));
    }
    court.push(document.node(json!({
        "name": "end wall", "mesh": meshes.wall,
        "translation": [0.0, 0.0, -7.8], "rotation": [0.0, FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2],
    })));
    court.push(document.node(json!({
        "name": "roof", "mesh": meshes.roof, "translation": [-3.85, 4.5, 0.0],
    })));
    let court = document.node(json!({ "name": "court", "children": court }));
    let [camera, light] = shot.add_to(&mut document);
    document.scene("colonnade", &[court, camera, light]);
    (shot, document)
}

/// The meshes that the nodes share.
struct Meshes {
    base: usize,
    shaft: usize,
    capital: usize,
    arch: usize,
    cornice: usize,
    stylobate: usize,
    floor: usize,
    wall: usize,
    roof: usize,
    urn: usize,
}

impl Meshes {
    fn new(document: &mut Document) -> Self {
        let marble = document.material("marble", [0.86, 0.82, 0.74]);
        let sandstone = document.material("sandstone", [0.80, 0.68, 0.52]);
        let paving = document.material("paving", [0.78, 0.73, 0.65]);
        let plaster = document.material("plaster", [0.84, 0.66, 0.52]);
        let clay = document.material("clay", [0.72, 0.40, 0.28]);
        let mut mesh = |name: &str, parts: &[(Shape, usize)]| {
            let primitives: Vec<Value> = parts
                .iter()
                .map(|(shape, material)| document.indexed(shape, Index::U16, *material))
                .collect();
            document.mesh(name, &primitives)
        };
        let length = SPACING * COLUMNS as f64;
        let half = length / 2.0;
        let s = SPACING / 2.0;
        Self {
            base: mesh(
                "base",
                &[(slab(0.31, 0.0, 0.12, 0.31), sandstone), (torus(), marble)],
            ),
            shaft: mesh("shaft", &[(shaft(), marble)]),
            capital: mesh(
                "capital",
                &[
                    (echinus(), marble),
                    (slab(0.29, 0.2, 0.32, 0.29), sandstone),
                ],
            ),
            arch: mesh("arch", &[(arch(), plaster)]),
            cornice: mesh(
                "cornice",
                &[
                    (slab(s, 0.0, 0.14, 0.33), sandstone),
                    (slab(s, 0.14, 0.28, 0.42), marble),
                ],
            ),
            stylobate: mesh("stylobate", &[(slab(half, 0.0, STEP, 0.42), sandstone)]),
            floor: mesh("floor", &[(slab(12.0, -0.2, 0.0, 14.0), paving)]),
            wall: mesh("wall", &[(slab(0.2, 0.0, 4.5, half), plaster)]),
            roof: mesh("roof", &[(slab(1.55, 0.0, 0.18, half), clay)]),
            urn: mesh(
                "urn",
                &[(slab(0.3, 0.0, 0.3, 0.3), sandstone), (urn(), clay)],
            ),
        }
    }
}

/// A row of columns, arches between them and a cornice, turned so that its x axis runs along the
/// court: a quarter turn about y by the quaternion (0, `sin`, 0, √½).
fn row(document: &mut Document, meshes: &Meshes, name: &str, x: f64, sin: f64) -> usize {
    let mut children =
        vec![document.node(json!({ "name": "stylobate", "mesh": meshes.stylobate }))];
    for i in 0..COLUMNS {
        let place = (i as f64 - (COLUMNS - 1) as f64 / 2.0) * SPACING;
        let mut parts = Vec::new();
        for (name, mesh, y) in [
            ("base", meshes.base, 0.0),
            ("shaft", meshes.shaft, 0.26),
            ("capital", meshes.capital, SPRINGING - 0.32),
        ] {
            parts.push(node_at(document, name, mesh, [0.0, y, 0.0]));
        }
        if i + 1 < COLUMNS {
            let vault = [
                node_at(document, "arch", meshes.arch, [0.0, 0.0, 0.0]),
                node_at(document, "cornice", meshes.cornice, [0.0, 1.2, 0.0]),
            ];
            parts.push(document.node(json!({
                "name": "span", "children": vault,
                "translation": [SPACING / 2.0, SPRINGING, 0.0],
            })));
        }
        children.push(document.node(json!({
            "name": format!("column {i}"), "children": parts, "translation": [place, STEP, 0.0],
        })));
    }
    document.node(json!({
        "name": name, "children": children,
        "translation": [x, 0.0, 0.0], "rotation": [0.0, sin, 0.0, FRAC_1_SQRT_2],
    }))
}

fn node_at(document: &mut Document, name: &str, mesh: usize, place: [f64; 3]) -> usize {
    document.node(json!({ "name": name, "mesh": mesh, "translation": place }))
}

/// A block of these half widths along x and z, from one height to another.
fn slab(half_x: f64, bottom: f64, top: f64, half_z: f64) -> Shape {
    Shape::cuboid(
        DVec3::new(-half_x, bottom, -half_z),
        DVec3::new(half_x, top, half_z),
    )
}

/// The round part of a column's base.
fn torus() -> Shape {
    let profile = [
        (0.24, 0.12),
        (0.29, 0.14),
        (0.30, 0.17),
        (0.28, 0.20),
        (0.25, 0.22),
        (0.24, 0.26),
    ];
    Shape::lathe(&profile, 24)
}

/// A fluted shaft that narrows upwards, from y = 0.
fn shaft() -> Shape {
    const FLUTES: u32 = 16;
    let height = SPRINGING - 0.32 - 0.26;
    let profile = [(0.235, 0.0), (0.23, 0.4 * height), (0.185, height)];
    let mut shape = Shape::lathe(&profile, 3 * FLUTES);
    // Of a flute's three points, one is on the ridge and two lie in the groove.
    for (i, p) in shape.positions.iter_mut().enumerate() {
        if i % 3 != 0 {
            *p *= DVec3::new(0.93, 1.0, 0.93);
        }
    }
    shape
}

/// The round part of a capital, up to y = 0.2.
fn echinus() -> Shape {
    let profile = [
        (0.185, 0.0),
        (0.205, 0.02),
        (0.19, 0.05),
        (0.20, 0.09),
        (0.24, 0.15),
        (0.28, 0.2),
    ];
    Shape::lathe(&profile, 24)
}

/// The wall above a round arch that springs from y = 0, between x = ±SPACING / 2.
fn arch() -> Shape {
    const RADIUS: f64 = 0.74;
    const TOP: f64 = 1.2;
    const DEPTH: f64 = 0.26;
    const SEGMENTS: u32 = 18;
    let mut edge = vec![(-SPACING / 2.0, 0.0)];
    for i in 0..=SEGMENTS {
        let (sin, cos) = (PI * f64::from(i) / f64::from(SEGMENTS)).sin_cos();
        edge.push((-RADIUS * cos, RADIUS * sin));
    }
    edge.push((SPACING / 2.0, 0.0));

    let mut shape = Shape::default();
    for &(x, y) in &edge {
        for (y, z) in [(y, DEPTH), (TOP, DEPTH), (TOP, -DEPTH), (y, -DEPTH)] {
            shape.positions.push(DVec3::new(x, y, z));
        }
    }
    // Between two points of the edge lie four quads: front, top, back, underside.
    for left in (0..edge.len() as u32 - 1).map(|i| 4 * i) {
        for side in 0..4 {
            let next = (side + 1) % 4;
            shape.quad([left + side, left + 4 + side, left + 4 + next, left + next]);
        }
    }
    let last = 4 * (edge.len() as u32 - 1);
    shape.quad([3, 0, 1, 2]);
    shape.quad([last, last + 3, last + 2, last + 1]);
    shape
}

/// An urn on a block of height 0.3.
fn urn() -> Shape {
    let profile = [
        (0.0, 0.3),
        (0.17, 0.3),
        (0.18, 0.33),
        (0.09, 0.39),
        (0.08, 0.43),
        (0.2, 0.55),
        (0.29, 0.7),
        (0.31, 0.82),
        (0.27, 0.95),
        (0.17, 1.06),
        (0.14, 1.13),
        (0.22, 1.21),
        (0.2, 1.22),
        (0.12, 1.14),
        (0.1, 1.06),
    ];
    Shape::lathe(&profile, 32)
}
