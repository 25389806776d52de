//! The stage of [Atty06]'s tests: an occluder between the ground and a square light one unit above it.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::Truth;
use super::truth::Square;
use crate::scene::{AreaLight, Camera, LightShape, Scene, Shape};
use crate::shot::Shot;
use crate::technique::Settings;

/// [scene units] The longest side of an occluder: the largest light of [Atty06 §5.2.4] is about as large.
pub const OCCLUDER: f64 = 0.2;
/// [scene units] Height of the light.
const LIGHT_HEIGHT: f64 = 1.0;
/// [scene units] What of the ground is shown at most, to each side of the shadow's middle.
const REACH_MAX: f64 = 1.2;
/// [scene units] How far away the camera is: so far that all of a shadow counts about the same.
const CAMERA: f64 = 10.0;
/// [radian] By which the turned square is turned: no side nor diagonal of it follows the texels.
const TURN: f64 = 0.35;
/// [degree] How high it stands: so low that it sees most of the shadow below the occluder.
const ELEVATION: f64 = 40.0;

/// What stands between light and ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Model {
    /// A horizontal square with sides along the map's. The map is fitted to it, so its texels end where it ends.
    Square,
    /// The same, turned, so that its sides cross the texels.
    Turned,
    /// A torus knot, upright, in place of the Buddha: folds, and parts that hide one another.
    Knot,
    /// A figure of closed boxes with ears, in place of the Bunny, which stands on the ground.
    Figure,
}

impl Model {
    pub const ALL: [Self; 4] = [Self::Square, Self::Turned, Self::Knot, Self::Figure];
    pub const CLOSED: [Self; 2] = [Self::Knot, Self::Figure];

    pub fn name(self) -> &'static str {
        match self {
            Self::Square => "square",
            Self::Turned => "turned square",
            Self::Knot => "knot",
            Self::Figure => "figure of boxes",
        }
    }

    /// [radian] By which it is turned about y.
    fn turn(self) -> f64 {
        match self {
            Self::Turned => TURN,
            Self::Square | Self::Knot | Self::Figure => 0.0,
        }
    }

    /// In its size, about the origin.
    fn shape(self) -> Shape {
        let shape = match self {
            Self::Square | Self::Turned => Shape::square(1.0),
            Self::Knot => knot(180),
            Self::Figure => figure(),
        };
        shape.fitted(OCCLUDER, DVec3::ZERO)
    }
}

/// The knot with `rings` rings of 20 corners each: 40 triangles a ring.
pub fn knot(rings: u32) -> Shape {
    Shape::torus_knot(0.75, 0.36, 0.17, rings, 20)
}

/// Legs, body, arms, head and ears, each a closed box.
fn figure() -> Shape {
    let mut figure = Shape::default();
    for (lo, hi) in [
        ([-0.5, 0.0, -0.35], [-0.12, 1.0, 0.35]),
        ([0.12, 0.0, -0.35], [0.5, 1.0, 0.35]),
        ([-0.55, 1.0, -0.4], [0.55, 2.3, 0.4]),
        ([-0.95, 1.2, 0.0], [-0.55, 2.2, 0.9]),
        ([0.55, 1.2, -0.3], [1.0, 2.2, 0.2]),
        ([-0.4, 2.3, -0.35], [0.4, 3.0, 0.45]),
        ([-0.35, 3.0, -0.1], [-0.12, 3.9, 0.1]),
        ([0.12, 3.0, -0.1], [0.35, 3.7, 0.1]),
    ] {
        figure.append(&Shape::cuboid(lo.into(), hi.into()));
    }
    figure
}

/// Where what stands.
#[derive(Debug, Clone, Copy)]
pub struct Stage {
    pub model: Model,
    /// [scene units] Side of the light.
    pub light: f64,
    /// [scene units] The occluder's middle beside the light's.
    pub aside: f64,
    /// [scene units] Height of the occluder's middle.
    pub height: f64,
}

impl Stage {
    /// A model where the paper has its like: the figure on the ground, the others half way up.
    pub fn usual(model: Model, light: f64) -> Self {
        let height = match model {
            Model::Figure => OCCLUDER / 2.0,
            _ => LIGHT_HEIGHT / 2.0,
        };
        Self {
            model,
            light,
            aside: 0.0,
            height,
        }
    }

    /// With the occluder at `share` [0, 1] of the way from where it touches the ground to where it touches the light.
    pub fn lifted(model: Model, light: f64, share: f64) -> Self {
        let (lo, hi) = model.shape().bounds();
        let height = -lo.y + share * (LIGHT_HEIGHT - hi.y + lo.y);
        Self {
            height,
            ..Self::usual(model, light)
        }
    }

    fn center(&self) -> DVec3 {
        DVec3::new(self.aside, self.height, 0.0)
    }

    /// The shot, `side` pixels wide and high.
    pub fn shot(&self, side: u32) -> Shot {
        self.shot_of(self.model.shape(), side)
    }

    /// The shot with another shape in the model's place.
    pub fn shot_of(&self, shape: Shape, side: u32) -> Shot {
        let mut shape = shape.fitted(OCCLUDER, DVec3::ZERO);
        let (sin, cos) = self.model.turn().sin_cos();
        for p in &mut shape.positions {
            *p = DVec3::new(p.x * cos - p.z * sin, p.y, p.x * sin + p.z * cos) + self.center();
        }
        let (middle, reach) = self.shadow(shape.bounds().1.y);
        let target = DVec3::new(middle, 0.0, 0.0);
        let (sin, cos) = ELEVATION.to_radians().sin_cos();
        let half = 0.5 * self.light;
        let ground = Shape::square(4.0);
        Shot {
            scene: Arc::new(
                Scene::of_shapes(&[
                    (ground, Vec3::splat(0.8)),
                    (shape, Vec3::new(0.8, 0.5, 0.4)),
                ])
                // The ground receives, what stands over it casts.
                .with_casters(&[1]),
            ),
            camera: Camera {
                name: String::new(),
                eye: target + DVec3::new(0.0, sin, cos) * CAMERA,
                target,
                up: DVec3::Y,
                vfov_deg: 2.0 * (reach / CAMERA).atan().to_degrees(),
                aspect: None,
                ortho_height: None,
                near: None,
            },
            width: side,
            height: side,
            lights: vec![AreaLight {
                name: String::new(),
                center: DVec3::Y * LIGHT_HEIGHT,
                shape: LightShape::Rect {
                    u: DVec3::X * half,
                    v: DVec3::Z * half,
                },
                color: Vec3::ONE,
                intensity: None,
                beam: None,
            }],
            settings: Settings::default(),
            budget_map: None,
            physical: false,
            notes: Vec::new(),
        }
    }

    /// [share of the light's width] What two patches overlap by at most, one at the occluder's highest place and one at its lowest
    /// [Atty06 eq. 3].
    pub fn largest_overlap(&self) -> f64 {
        let (lo, hi) = self.model.shape().bounds();
        let (nearest, step) = (LIGHT_HEIGHT - self.height - hi.y, hi.y - lo.y);
        0.5 * LIGHT_HEIGHT * step / (nearest * (LIGHT_HEIGHT - nearest - step))
    }

    /// The middle and the reach along x of the shadow of an occluder whose highest point has this height.
    fn shadow(&self, top: f64) -> (f64, f64) {
        let below = (LIGHT_HEIGHT - self.height).max(0.05);
        let middle = (self.aside * LIGHT_HEIGHT / below).clamp(-REACH_MAX, REACH_MAX);
        let below = (LIGHT_HEIGHT - top).max(0.05);
        let reach = (OCCLUDER / 2.0 * LIGHT_HEIGHT + 0.5 * self.light * top) / below;
        (middle, (1.1 * reach).min(REACH_MAX))
    }

    /// What is true of the shot: only the ground counts, as receivers and occluders are apart in the paper.
    pub fn truth(&self) -> Truth {
        match self.model {
            Model::Square | Model::Turned => Truth::Square(Square {
                center: self.center(),
                half: OCCLUDER / 2.0,
                turn: self.model.turn(),
                light: DVec3::Y * LIGHT_HEIGHT,
                light_half: 0.5 * self.light,
            }),
            Model::Knot | Model::Figure => Truth::OnGround,
        }
    }
}
