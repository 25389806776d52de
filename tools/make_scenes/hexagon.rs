//! The knot under a hexagon, which glTF has no light for: a shot without a scene of its own.

use glam::DVec3;
use serde_json::json;

use super::knot;
use super::shot::Shot;

/// The shot file.
pub fn shot() -> (String, String) {
    let (knot, _) = knot::scene();
    let shot = Shot {
        name: "hexagon",
        what: "The knot under a hexagon: penumbrae have its corners.",
        ..knot
    };
    // Around the knot's own light, as large, seen from below counter-clockwise.
    let normal = DVec3::new(0.6, -0.75, -0.28).normalize();
    let (u, v) = normal.any_orthonormal_pair();
    let corner = |i: i32| {
        let angle = f64::from(i) * std::f64::consts::FRAC_PI_3;
        let at = DVec3::new(-5.0, 6.0, 2.5) + 1.2 * (angle.cos() * u + angle.sin() * v);
        // Rounded, as a person writes it.
        (at * 1e4).round().to_array().map(|number| number / 1e4)
    };
    let corners: Vec<[f64; 3]> = (0..6).map(corner).collect();
    let light = json!({ "type": "polygon", "corners": corners });
    ("hexagon.json".into(), shot.under(&light, "knot.glb"))
}
