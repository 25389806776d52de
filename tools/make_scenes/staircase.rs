//! Plates at very different depths over each other: what one depth per texel cannot hold.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use serde_json::json;

use super::document::{Document, Index, Mode};
use super::shot::{Light, Shot};
use halfshade::scene::Shape;

/// Steps of the stair.
const STEPS: u32 = 9;

pub fn scene() -> (Shot, Document) {
    let shot = Shot {
        name: "staircase",
        what: "The single-sample artefact: each floating step hides part of the next lower one from \
               the light's centre, so a single shadow map misses it, and light leaks into the \
               overlapping shadows on the floor.",
        eye: DVec3::new(-1.2, 5.6, 5.6),
        target: DVec3::new(0.1, 1.0, 0.0),
        vfov_deg: 46.0,
        light: Light::Rect {
            center: DVec3::new(0.0, 5.0, 0.0),
            u: DVec3::new(0.9, 0.0, 0.0),
            v: DVec3::new(0.0, 0.0, 0.9),
        },
    };
    let mut document = Document::default();
    let mut nodes = floor_and_objects(&mut document);
    let oak = document.material("oak", [0.80, 0.62, 0.42]);
    let half = DVec3::new(0.7, 0.03, 0.4);
    let step = document.indexed(&Shape::cuboid(-half, half), Index::U32, oak);
    let step = document.mesh("step", &[step]);
    for i in 0..STEPS {
        let share = f64::from(i) / f64::from(STEPS - 1);
        let turn = DQuat::from_rotation_y(TAU * 0.8 * share);
        let place = turn * DVec3::new(1.0, 0.0, 0.0) + DVec3::Y * (0.25 + 2.9 * share);
        // Higher steps are nearer to the light and hide more: they are made smaller.
        nodes.push(document.node(json!({
            "name": format!("step {i}"), "mesh": step,
            "translation": place.to_array().map(rounded),
            "rotation": turn.to_array().map(rounded),
            "scale": [1.0 - 0.3 * share, 1.0, 1.0 - 0.3 * share],
        })));
    }
    nodes.extend(shot.add_to(&mut document));
    document.scene("staircase", &nodes);
    (shot, document)
}

/// A round floor (a triangle fan), a ball and a cone.
fn floor_and_objects(document: &mut Document) -> Vec<usize> {
    let slate = document.material("pale slate", [0.74, 0.78, 0.80]);
    let coral = document.material("coral", [0.86, 0.50, 0.42]);
    let sage = document.material("sage", [0.56, 0.72, 0.56]);
    let mut fan = vec![DVec3::ZERO];
    for i in 0..=48 {
        let (sin, cos) = (TAU * f64::from(i % 48) / 48.0).sin_cos();
        fan.push(DVec3::new(12.0 * cos, 0.0, -12.0 * sin));
    }
    let floor = document.unindexed(&fan, Mode::Fan, slate);
    let ball = document.indexed(&Shape::ball(0.35, 32), Index::U16, coral);
    let cone = Shape::lathe(&[(0.0, 0.0), (0.4, 0.0), (0.0, 1.0)], 32);
    let cone = document.indexed(&cone, Index::U16, sage);
    let mut nodes = Vec::new();
    for (name, primitive, place) in [
        ("floor", floor, [0.0, 0.0, 0.0]),
        ("ball", ball, [-1.3, 0.0, 1.7]),
        ("cone", cone, [1.9, 0.0, 1.3]),
    ] {
        let mesh = document.mesh(name, &[primitive]);
        nodes.push(document.node(json!({ "name": name, "mesh": mesh, "translation": place })));
    }
    nodes
}

/// To nine digits: more than f32 holds, fewer than platforms differ in.
fn rounded(x: f64) -> f64 {
    (x * 1e9).round() / 1e9 + 0.0
}
