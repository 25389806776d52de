//! A lattice close under a large light: the largest kernels.

use glam::{DMat4, DVec3};
use serde_json::json;

use super::document::{Document, Index, primitive};
use super::shot::{Light, Shot};
use halfshade::scene::Shape;

/// [unit] The height of the light above the floor.
const LIGHT: f64 = 3.2;
/// [unit] The height of the lattice: 8 % of the light's height below it.
const LATTICE: f64 = 0.92 * LIGHT;
/// Bars in each direction.
const BARS: u32 = 12;
/// [unit] From bar to bar.
const PITCH: f64 = 0.2;

pub fn scene() -> (Shot, Document) {
    let shot = Shot {
        name: "grid",
        what: "Huge kernels: a lattice of 12 + 12 bars just under the light dims and stripes the \
               floor, and box, frustum, ball and mast cast their own soft shadows into it.",
        eye: DVec3::new(0.0, 4.7, 6.2),
        target: DVec3::new(0.0, 0.25, 0.0),
        vfov_deg: 46.0,
        light: Light::Rect {
            center: DVec3::new(0.0, LIGHT, 0.0),
            u: DVec3::new(0.8, 0.0, 0.0),
            v: DVec3::new(0.0, 0.0, 0.8),
        },
    };
    let mut document = Document::default();
    let mut nodes = lattice(&mut document);
    nodes.extend(objects(&mut document));
    nodes.extend(shot.add_to(&mut document));
    document.scene("grid", &nodes);
    (shot, document)
}

/// One bar, placed by matrices.
fn lattice(document: &mut Document) -> Vec<usize> {
    let steel = document.material("steel", [0.62, 0.66, 0.72]);
    let half = DVec3::new(PITCH * f64::from(BARS) / 2.0, 0.02, 0.03);
    let bar = document.indexed(&Shape::cuboid(-half, half), Index::U8, steel);
    let bar = document.mesh("bar", &[bar]);
    let quarter = DMat4::from_cols_array_2d(&[
        [0.0, 0.0, -1.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let mut nodes = Vec::new();
    for i in 0..BARS {
        let aside = (f64::from(i) - f64::from(BARS - 1) / 2.0) * PITCH;
        let along = DMat4::from_translation(DVec3::new(0.0, LATTICE, aside));
        let across = DMat4::from_translation(DVec3::new(aside, LATTICE, 0.0)) * quarter;
        for matrix in [along, across] {
            nodes.push(document.node(json!({
                "name": "bar", "mesh": bar, "matrix": matrix.to_cols_array(),
            })));
        }
    }
    nodes
}

/// The floor and what stands on it. The frustum is the box with its top moved: a sparse accessor.
fn objects(document: &mut Document) -> Vec<usize> {
    let stone = document.material("pale stone", [0.82, 0.80, 0.76]);
    let ochre = document.material("ochre", [0.86, 0.66, 0.36]);
    let rose = document.material("rose", [0.84, 0.54, 0.54]);
    let blue = document.material("pale blue", [0.52, 0.66, 0.84]);
    let green = document.material("sage", [0.58, 0.72, 0.54]);

    let floor = Shape::cuboid(DVec3::new(-9.0, -0.1, -9.0), DVec3::new(9.0, 0.0, 9.0));
    let floor = document.indexed(&floor, Index::U8, stone);
    let mut shape = Shape::cuboid(DVec3::new(-0.4, 0.0, -0.4), DVec3::new(0.4, 0.8, 0.4));
    let square_top = document.positions(&shape.positions);
    for top in &mut shape.positions[4..] {
        *top *= DVec3::new(0.4, 1.4, 0.4);
    }
    let small_top = document.positions_but_last(square_top, &shape.positions, 4);
    let indices = document.indices(&shape, Index::U8);
    let cube = primitive(square_top, indices, ochre);
    let frustum = primitive(small_top, indices, rose);
    let ball = document.indexed(&Shape::ball(0.4, 32), Index::U16, blue);
    let mast = Shape::lathe(&[(0.05, 0.0), (0.05, 1.7), (0.0, 1.7)], 12);
    let mast = document.indexed(&mast, Index::U8, green);

    let mut nodes = Vec::new();
    for (name, primitive, place) in [
        ("floor", floor, [0.0, 0.0, 0.0]),
        ("box", cube, [-1.5, 0.0, 0.7]),
        ("frustum", frustum, [1.5, 0.0, 0.3]),
        ("ball", ball, [0.2, 0.0, 1.3]),
        ("mast", mast, [-0.4, 0.0, -1.2]),
    ] {
        let mesh = document.mesh(name, &[primitive]);
        nodes.push(document.node(json!({ "name": name, "mesh": mesh, "translation": place })));
    }
    nodes
}
