//! A light as a receiver sees it, flat: twin of `lib/facing.glsl`.

use glam::Vec3;

use crate::shared::{Light, SPREAD_SPHERE, SPREAD_SUN};

pub struct Facing {
    /// With the plane and the half sizes that the receiver sees.
    pub light: Light,
    /// [scene units] From the receiver to the light's centre; of a sun's disc at a distance of 1.
    pub way: Vec3,
    /// [scene units] Coordinates that the way is found from.
    pub magnitude: Vec3,
    /// The disc's area over that which the light's `intensity` goes with.
    pub area: f32,
    /// The receiver is inside the light.
    pub inside: bool,
}

impl Facing {
    pub fn new(light: &Light, position: Vec3, normal: Vec3) -> Self {
        let way = Vec3::from(light.center) - position;
        let mut facing = Self {
            light: *light,
            way,
            magnitude: way.abs() + Vec3::from(light.center).abs(),
            area: 1.0,
            inside: false,
        };
        match light.spread {
            SPREAD_SUN => {
                facing.way = -Vec3::from(light.n);
                facing.magnitude = facing.way.abs();
            }
            SPREAD_SPHERE => facing.face_sphere(normal),
            _ => {}
        }
        facing
    }

    fn face_sphere(&mut self, normal: Vec3) {
        let square = self.way.length_squared();
        let radius = self.light.half_size[0];
        let beyond = square - radius * radius;
        self.inside = beyond <= 0.0;
        self.area = square / beyond.max(1e-6 * square);
        self.light.half_size = [radius * self.area.sqrt(); 2];
        let n = -self.way / square.max(1e-36).sqrt();
        let across = |axis: Vec3| axis - n * axis.dot(n);
        let least = if n.x.abs() < 0.6 { Vec3::X } else { Vec3::Y };
        let lean = match across(normal) {
            lean if lean.length_squared() > 1e-6 => lean,
            _ => across(least),
        };
        let v = lean.normalize();
        (self.light.u, self.light.v) = (v.cross(n).into(), v.into());
        self.light.n = n.into();
    }
}
