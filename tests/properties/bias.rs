//! The automatic bias over slopes from 0 to 89 degrees: a surface must not shade itself, and what lies on it must.

use halfshade::scene::Material;
use halfshade::shared::Counters;

use super::*;

/// [degree] Between the surface's normal and the direction to the light.
const SLOPES: [f64; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 80.0, 85.0, 89.0];
/// [texel] Heights of a plate above the surface, along the light's rays.
const HEIGHTS: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const DISTANT: DVec3 = DVec3::new(0.0, 10.0, 0.0);
/// [scene units] Small enough that all of it is before the surface at 89 degrees.
const SMALL: f64 = 0.02;
/// The plate: how far down the slope it begins and ends, and how far it reaches aside.
const ALONG: [f64; 2] = [0.2, 0.8];
const ASIDE: f64 = 0.3;

/// A surface that falls along x, a little steeper from the middle on: such that either half is behind the other's
/// plane, and both are drawn into the map.
struct Slope {
    degrees: f64,
}

impl Slope {
    fn down(degrees: f64) -> DVec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        DVec3::new(cos, -sin, 0.0)
    }

    fn normal(&self) -> DVec3 {
        let down = Self::down(self.degrees);
        DVec3::new(-down.y, down.x, 0.0)
    }

    fn point(&self, along: f64, aside: f64) -> DVec3 {
        Self::down(self.degrees) * along + DVec3::Z * aside
    }

    /// With a plate so far above the surface, along its normal, whose only side looks down: the camera sees through it.
    fn scene(&self, plate: Option<f64>) -> Arc<Scene> {
        let upper = Self::down(self.degrees - 2.0) * -1.0;
        let sides = DVec3::Z * 0.5;
        let hinge = [DVec3::ZERO - sides, DVec3::ZERO + sides];
        let lower = self.point(1.0, 0.0);
        let scene = Triangles::new()
            .polygon(&[hinge[0], hinge[1], lower + sides, lower - sides])
            .polygon(&[hinge[1], hinge[0], upper - sides, upper + sides]);
        let Some(height) = plate else {
            return scene.build();
        };
        let lifted = |along, aside| self.point(along, aside) + self.normal() * height;
        let of_surface = scene.0.len();
        let mut scene = scene
            .polygon(&[
                lifted(ALONG[0], -ASIDE),
                lifted(ALONG[1], -ASIDE),
                lifted(ALONG[1], ASIDE),
                lifted(ALONG[0], ASIDE),
            ])
            .build();
        let with_plate = Arc::get_mut(&mut scene).expect("nobody else has it");
        with_plate.materials.push(Material {
            double_sided: false,
            ..with_plate.materials[0].clone()
        });
        with_plate.triangle_materials[of_surface..].fill(1);
        scene
    }

    fn shot(&self, plate: Option<f64>) -> Shot {
        let eye = camera(DVec3::new(2.6, 3.0, 0.3), DVec3::new(0.1, -0.1, 0.0), 30.0);
        let light = rectangle_light(DISTANT, DVec2::splat(SMALL));
        shot(self.scene(plate), eye, light, 96, settings(256, 1))
    }

    fn render(&self, gpu: &Arc<Gpu>, plate: Option<f64>) -> Image {
        render(gpu, &self.shot(plate))
    }

    /// Whether the whole light is hidden from a point of the surface by more than two texels' width of the plate.
    fn is_covered(&self, point: DVec3, height: f64, texel: DVec2) -> bool {
        // On the half that is less steep no light is hidden.
        if point.x < 0.0 {
            return false;
        }
        let normal = self.normal();
        let steep = 1.0 / normal.y;
        let margin = 2.5 * DVec2::new(texel.x * steep, texel.y);
        [-1.0, 1.0].into_iter().all(|side| {
            let to_light = DISTANT + DVec3::new(side * SMALL, 0.0, side * SMALL) - point;
            let met = point + to_light * (height / to_light.dot(normal));
            let along = met.dot(Self::down(self.degrees));
            along > ALONG[0] + margin.x
                && along < ALONG[1] - margin.x
                && met.z.abs() < ASIDE - margin.y
        })
    }
}

/// [scene units] A texel of the only view, 10 away from the light, in x and z.
fn texel_of(image: &Image) -> DVec2 {
    DISTANT.y / DVec2::from_array(image.fits[0].focal.map(f64::from))
}

fn surface(image: &Image) -> impl Iterator<Item = (f32, DVec3)> {
    let pixels = image.visibility.iter().zip(&image.positions);
    pixels
        .filter(|(_, position)| position[3] > 0.0)
        .map(|(&value, p)| (value, DVec3::new(p[0], p[1], p[2])))
}

#[test]
fn surfaces_do_not_shade_themselves_and_what_lies_on_them_does() {
    with_gpu(|gpu| {
        for degrees in SLOPES {
            let slope = Slope { degrees };
            let bare = slope.render(gpu, None);
            let seen = surface(&bare).count();
            let shaded = surface(&bare).filter(|&(value, _)| value < 1.0).count();
            assert!(seen > 500, "{seen} pixels at {degrees} degrees");
            assert_eq!(
                shaded, 0,
                "of {seen} pixels at {degrees} degrees are in their own shadow"
            );

            let texel = texel_of(&bare);
            let mut lit = Vec::new();
            for texels in HEIGHTS {
                // The bias is what the surface falls by within a texel; a level one keeps that of the rounding.
                let height = texels * texel.x * slope.normal().x.max(1e-2);
                let image = slope.render(gpu, Some(height));
                let covered = |point| slope.is_covered(point, height, texel_of(&image));
                let hidden: Vec<f32> = surface(&image)
                    .filter(|&(_, point)| covered(point))
                    .map(|(value, _)| value)
                    .collect();
                let leaks = hidden.iter().filter(|&&value| value > 0.0).count();
                lit.push((texels, leaks, hidden.len()));
            }
            println!("{degrees} degrees: of the pixels under a plate, (texels, lit, all): {lit:?}");
            let (_, leaks, hidden) = lit[HEIGHTS.len() - 1];
            assert!(
                hidden > 50,
                "{hidden} pixels under the plate at {degrees} degrees"
            );
            assert_eq!(leaks, 0, "a plate a texel above {degrees} degrees leaks");
        }
    });
}

/// The bias is less than what a surface rises by within a cell, so bounds do not tell it from an occluder; its samples do.
#[test]
fn a_bare_slope_needs_no_integration() {
    with_gpu(|gpu| {
        for degrees in SLOPES {
            let mut shot = Slope { degrees }.shot(None);
            shot.settings.counters = true;
            let mut renderer = renderer(gpu, &shot);
            renderer.render().expect("a frame");
            let Counters { lit, penumbra, .. } = renderer.counters().expect("counters");
            assert!(lit > 500, "{lit} pixels are lit at {degrees} degrees");
            assert_eq!(penumbra, 0, "pixels are integrated at {degrees} degrees");
        }
    });
}

/// Lights without extent cast hard shadows: what runs decides about the bias, not what was asked for. So it is for
/// percentage-closer filtering, whose samples are farther away.
#[test]
fn hard_shadows_have_a_bias_of_their_own() {
    let asked = [
        Settings::default(),
        Settings::usual(Technique::Pcss),
        Settings {
            percentage_closer: true,
            ..Settings::usual(Technique::Hard)
        },
    ];
    with_gpu(|gpu| {
        for (settings, degrees) in asked
            .iter()
            .flat_map(|s| SLOPES.map(|degrees| (s, degrees)))
        {
            let slope = Slope { degrees };
            let mut shot = slope.shot(None);
            shot.lights = vec![disc_light(DISTANT, 0.0)];
            shot.settings = Settings {
                map: 64,
                ..settings.clone()
            };
            let image = render(gpu, &shot);
            let shaded = surface(&image).filter(|&(value, _)| value < 1.0).count();
            assert_eq!(shaded, 0, "{} at {degrees} degrees", settings.technique);
        }
    });
}
