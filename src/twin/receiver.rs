//! A receiver as a view sees it (algorithm.md §1, §8): mirror of `lib/receiver.glsl`, in f32 and operation by
//! operation, because statuses, cells and contours are decided on these very values.

use glam::{Vec2, Vec3};

use crate::shared::{ALL_CONES, BIAS_ROUNDING, BIAS_SLOPE_MAX, CONE_SPLIT, Fit, PLANE_MAX, View};

/// Where a receiver falls on a view's map, how deep, and its back-projection to the light:
/// q = (ku · Δt, kv · Δt) / (Δd + b · Δt), with Δt = t − t_p and Δd = d − d_p.
#[derive(Debug, Clone, Copy)]
pub struct Receiver {
    /// [texel] Its projection t_p.
    pub t: Vec2,
    /// Depth near / z.
    pub d: f32,
    /// Depth moved towards the light by the bias: samples with a larger depth may occlude.
    pub biased: f32,
    /// [per texel] By how much the depth of the receiver's own plane changes; see [`Limit`].
    pub plane: Vec2,
    /// The sub-light's centre is behind the plane.
    pub behind: bool,
    pub ku: Vec2,
    pub kv: Vec2,
    pub b: Vec2,
}

/// The depths between which samples occlude: nearer to the light than the receiver, and above its plane.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// The least, at and below the receiver's own height.
    pub least: f32,
    /// [per texel]
    pub plane: Vec2,
    /// [texel] Where the plane has the least depth.
    pub t: Vec2,
    /// Seen from behind the plane, samples above it occlude up to this depth at `t`; the least depth is the same
    /// everywhere then.
    pub ceiling: Option<f32>,
}

impl Limit {
    /// The same everywhere.
    pub fn flat(depth: f32) -> Self {
        Self {
            least: depth,
            plane: Vec2::ZERO,
            t: Vec2::ZERO,
            ceiling: None,
        }
    }

    fn rise(&self, [x, y]: [i32; 2]) -> f32 {
        let way = Vec2::new(x as f32, y as f32) - self.t;
        self.plane.x * way.x + self.plane.y * way.y
    }

    /// Whether a sample of this depth occludes.
    pub fn is_passed(&self, sample: [i32; 2], depth: f32) -> bool {
        let below = |ceiling| depth > ceiling + self.rise(sample);
        depth > self.at(sample) && !self.ceiling.is_some_and(below)
    }

    /// The lower one, at a sample.
    pub fn at(&self, sample: [i32; 2]) -> f32 {
        match self.ceiling {
            None => self.least + self.rise(sample).max(0.0),
            Some(_) => self.least,
        }
    }

    /// The highest at samples first … last.
    pub fn highest(&self, first: [i32; 2], last: [i32; 2]) -> f32 {
        let rising = self.plane.cmpgt(Vec2::ZERO);
        self.at([0, 1].map(|axis| {
            if rising.test(axis) {
                last[axis]
            } else {
                first[axis]
            }
        }))
    }
}

impl Receiver {
    pub fn limit(&self) -> Limit {
        Limit {
            least: self.biased,
            plane: self.plane,
            t: self.t,
            ceiling: self.behind.then_some(self.d - (self.biased - self.d)),
        }
    }
}

fn to_face(view: &View, world: Vec3) -> Vec3 {
    Vec3::new(
        world.dot(view.right.into()),
        world.dot(view.up.into()),
        world.dot(view.forward.into()),
    )
}

/// Where the view sees a point: mirror of `lib/parallel.glsl`.
fn mapped(view: &View, to_point: Vec3) -> Vec3 {
    if view.parallel == 0.0 {
        return to_point;
    }
    let (n, height) = (Vec3::from(view.light_n), height_of(view, to_point));
    (to_point + Vec3::from(view.ray) * height + n * view.parallel) * (view.parallel / height)
}

fn height_of(view: &View, to_point: Vec3) -> f32 {
    -to_point.dot(view.light_n.into())
}

fn mapped_normal(view: &View, to_point: Vec3, normal: Vec3) -> Vec3 {
    if view.parallel == 0.0 {
        return normal;
    }
    let n = Vec3::from(view.light_n);
    normal - n * normal.dot(n) - n * (normal.dot(to_point) / view.parallel)
}

/// Mirror of `lib/cone.glsl`.
fn cone_of([x, y, z, radius]: [f32; 4], position: Vec3) -> u32 {
    let way = position - Vec3::new(x, y, z);
    if way.length_squared() <= radius * radius {
        return ALL_CONES;
    }
    let size = way.abs();
    let (axis, turned) = if size.x >= size.y.max(size.z) {
        (0, way)
    } else if size.y >= size.z {
        (1, Vec3::new(way.y, way.z, way.x))
    } else {
        (2, Vec3::new(way.z, way.x, way.y))
    };
    let share = 0.5 * (Vec2::new(turned.y, turned.z) / turned.x.abs().max(1e-30)) + 0.5;
    let split = CONE_SPLIT as f32;
    let cell = (share * split).clamp(Vec2::ZERO, Vec2::splat(split - 1.0));
    let side = 2 * axis + u32::from(turned.x < 0.0);
    1 + (side * CONE_SPLIT + cell.y as u32) * CONE_SPLIT + cell.x as u32
}

/// Half extents of a view's box: towards −, towards +.
pub(super) fn extents(view: &View) -> (Vec2, Vec2) {
    let [x0, y0, x1, y1] = view.extent;
    (Vec2::new(x0, y0), Vec2::new(x1, y1))
}

fn face_of(in_light: Vec3, reach: f32) -> u32 {
    let side = in_light.truncate().abs();
    if side.x.max(side.y) <= reach * in_light.z {
        return 0;
    }
    let (first, along) = if side.x >= side.y {
        (1, in_light.x)
    } else {
        (3, in_light.y)
    };
    if along > 0.0 { first } else { first + 1 }
}

/// Whether the view has to look at a surface point: it lies in front of the light, belongs to the view's
/// face and cone, and at least a part of the sub-light is in front of it.
///
/// `position`: relative to the eye; `normal`: of the visible side.
pub fn in_view(view: &View, position: Vec3, normal: Vec3) -> bool {
    if view.cone != ALL_CONES && cone_of(view.sphere, position) != view.cone {
        return false;
    }
    let from_middle = position - Vec3::from_slice(&view.sphere[..3]);
    let length = from_middle.dot(from_middle).sqrt();
    if Vec3::from(view.beam).dot(from_middle) < view.beam_cosine * length {
        return false;
    }
    let way = position - Vec3::from(view.center);
    let (to_point, normal) = (mapped(view, way), mapped_normal(view, way, normal));
    let half = Vec2::from(view.half_size);
    let in_plane = |vector: Vec3| {
        Vec2::new(
            vector.dot(view.light_u.into()),
            vector.dot(view.light_v.into()),
        ) * half
            * half
    };
    let height = to_point.dot(view.light_n.into());
    let in_light = (in_plane(to_point) / half).extend(height);
    if height <= 0.0 || face_of(in_light, view.reach) != view.face {
        return false;
    }
    let (lower, upper) = extents(view);
    let along = in_plane(normal);
    let reach = (along * lower).max(along * upper);
    reach.x + reach.y > normal.dot(to_point)
}

/// Of a surface that the engine has drawn, whose positions are as exact as 32 bits. `oblique`: the map is not parallel to the
/// light.
pub fn project(view: &View, fit: &Fit, oblique: bool, to_point: Vec3, normal: Vec3) -> Receiver {
    let focal = Vec2::from(fit.focal);
    let p = to_face(view, mapped(view, to_point));
    let inverse_z = 1.0 / p.z;
    let mut t = focal * (p.truncate() * inverse_z) + Vec2::from(fit.center);
    if (2.0 * t.x).fract() == 0.0 {
        t.x = f32::from_bits(t.x.to_bits() + 1);
    }
    let d = fit.near * inverse_z;

    let n = to_face(view, mapped_normal(view, to_point, normal));
    let height = n.dot(p);
    let slope = n.truncate().abs() * fit.near / (focal * height.abs().max(1e-30));
    let behind = height >= 0.0;
    let away = match behind {
        true => height.max(1e-30),
        false => height.min(-1e-30),
    };
    let plane = n.truncate() * fit.near / (focal * away);
    let slope_bias = ((slope.x + slope.y) * view.bias).min(BIAS_SLOPE_MAX * d);
    let magnitude = to_point.abs() + Vec3::from(view.center).abs();
    let nearness = match view.parallel {
        0.0 => inverse_z,
        _ => 1.0 / height_of(view, to_point),
    };
    let rounding = BIAS_ROUNDING * d * (1.0 + (magnitude.x + magnitude.y + magnitude.z) * nearness);
    let half = Vec2::from(view.half_size);
    let mut receiver = Receiver {
        t,
        d,
        biased: d + slope_bias + rounding,
        plane: plane.clamp(Vec2::splat(-PLANE_MAX), Vec2::splat(PLANE_MAX)),
        behind,
        ku: Vec2::new(fit.near / (focal.x * half.x), 0.0),
        kv: Vec2::new(0.0, fit.near / (focal.y * half.y)),
        b: Vec2::ZERO,
    };
    if oblique {
        let g = p * inverse_z;
        let m = to_face(view, view.light_n.into());
        let lu = to_face(view, view.light_u.into());
        let lv = to_face(view, view.light_v.into());
        let mg = m.dot(g);
        let along =
            |axis: Vec3| fit.near * (axis.truncate() - m.truncate() * (axis.dot(g) / mg)) / focal;
        receiver.ku = along(lu);
        receiver.kv = along(lv);
        receiver.b = -d * (m.truncate() / focal) / mg;
    }
    receiver
}
