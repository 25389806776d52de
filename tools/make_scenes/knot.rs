//! A ball and a torus knot that touch the ground, under a disc.

use glam::DVec3;
use serde_json::json;

use super::document::{Document, Index, Mode};
use super::shot::{Light, Shot};
use halfshade::scene::Shape;

pub fn scene() -> (Shot, Document) {
    let shot = Shot {
        name: "knot",
        what: "Contact hardening: both shadows are sharp where ball and knot touch the ground and \
               dissolve with the distance from it.",
        eye: DVec3::new(0.5, 4.0, 5.2),
        target: DVec3::new(0.5, 0.55, 0.0),
        vfov_deg: 42.0,
        light: Light::Disc {
            center: DVec3::new(-5.0, 6.0, 2.5),
            normal: DVec3::new(0.6, -0.75, -0.28).normalize(),
            radius: 1.1,
        },
    };
    let mut document = Document::default();
    let plaster = document.material("plaster", [0.80, 0.79, 0.76]);
    let coral = document.material("coral", [0.86, 0.48, 0.38]);
    let mint = document.material("mint", [0.48, 0.74, 0.64]);

    let ground = document.unindexed(&Shape::square(12.0).soup(), Mode::Triangles, plaster);
    let ball = document.indexed(&Shape::ball(0.55, 48), Index::U16, coral);
    let upright = Shape::torus_knot(0.75, 0.36, 0.17, 180, 18);
    let knot = document.indexed(&upright, Index::U16, mint);

    let mut nodes = Vec::new();
    for (name, primitive, place) in [
        ("ground", ground, [0.0, 0.0, 0.0]),
        ("ball", ball, [-0.75, 0.0, 1.15]),
        ("knot", knot, [0.15, 0.0, -0.35]),
    ] {
        let mesh = document.mesh(name, &[primitive]);
        nodes.push(document.node(json!({ "name": name, "mesh": mesh, "translation": place })));
    }
    nodes.extend(shot.add_to(&mut document));
    document.scene("knot", &nodes);
    (shot, document)
}
