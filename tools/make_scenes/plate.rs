//! A square plate under a parallel square light: the shadow has a closed form.

use glam::DVec3;
use serde_json::json;

use super::document::{Document, Index, Mode};
use super::shot::{Light, Shot};
use halfshade::scene::Shape;

pub fn scene() -> (Shot, Document) {
    let shot = Shot {
        name: "plate",
        what: "The penumbra on the ground y = 0 of the square plate |x|, |z| <= 0.5 at y = 1.5, under the \
               square light |x|, |z| <= 0.75 at y = 3, in closed form: from (x, 0, z) the light's point \
               (p, 3, q) is hidden where |p + x| <= 1 and |q + z| <= 1, so the hidden share is \
               h(x) h(z), with h(s) = clamp((1.75 - |s|) / 1.5, 0, 1).",
        eye: DVec3::new(0.0, 4.6, 5.4),
        target: DVec3::new(0.0, 0.25, 0.0),
        vfov_deg: 36.0,
        light: Light::Rect {
            center: DVec3::new(0.0, 3.0, 0.0),
            u: DVec3::new(0.75, 0.0, 0.0),
            v: DVec3::new(0.0, 0.0, 0.75),
        },
    };
    let mut document = Document::default();
    let stone = document.material("warm stone", [0.82, 0.78, 0.70]);
    let blue = document.material("pale blue", [0.50, 0.66, 0.84]);

    let corners = [(-8.0, -8.0), (-8.0, 8.0), (8.0, -8.0), (8.0, 8.0)];
    let strip = corners.map(|(x, z)| DVec3::new(x, 0.0, z));
    let ground = document.unindexed(&strip, Mode::Strip, stone);
    let ground = document.mesh("ground", &[ground]);
    let ground = document.node(json!({ "name": "ground", "mesh": ground }));

    let plate = document.indexed(&Shape::square(0.5), Index::U8, blue);
    let plate = document.mesh("plate", &[plate]);
    let plate =
        document.node(json!({ "name": "plate", "mesh": plate, "translation": [0.0, 1.5, 0.0] }));

    let [camera, light] = shot.add_to(&mut document);
    document.scene("plate", &[ground, plate, camera, light]);
    document.scene("ground only", &[ground, camera, light]);
    (shot, document)
}
