//! The frame of reference does not matter.

use super::*;

/// Moves, turns and scales everything.
struct Similarity {
    scale: f64,
    rotation: DQuat,
    translation: DVec3,
}

impl Similarity {
    fn point(&self, p: DVec3) -> DVec3 {
        self.translation + self.vector(p)
    }

    fn vector(&self, v: DVec3) -> DVec3 {
        self.rotation * v * self.scale
    }

    fn back(&self, p: DVec3) -> DVec3 {
        self.rotation.inverse() * (p - self.translation) / self.scale
    }
}

/// Rounding of coordinates moves what the map samples by some 1e-7 of the scene's size, 1e-4 texels. Now and
/// then that tips a vertex over to the rasteriser's next position, 1/256 texel away, and with it one sample in
/// 256 along an edge; each moves the contour by a texel there, out of some tens of texels that the light sees.
/// So: on the mean 1/256 of a texel's worth of penumbra, and all but one pixel in a thousand within a 16th.
#[test]
fn the_frame_of_reference_does_not_matter() {
    let plates = [
        Occluder::square(1.5, DVec2::new(0.4, -0.3), 0.35, 15.0),
        Occluder::square(0.8, DVec2::new(-0.6, 0.4), 0.3, 40.0),
        Occluder::square(0.4, DVec2::new(0.5, 0.8), 0.25, 70.0),
    ];
    let base = plates.iter().fold(
        Triangles::new().floor([-2.0, 2.0], [-2.0, 2.0]),
        |scene, plate| scene.plate(plate.height, &plate.corners()),
    );
    let build = |how: &Similarity| {
        let moved = Triangles(
            base.0
                .iter()
                .map(|t| t.map(|corner| how.point(corner)))
                .collect(),
        );
        let (eye, target) = (DVec3::new(-2.5, 3.2, 2.0), DVec3::new(0.0, 0.2, 0.1));
        let mut view = camera(how.point(eye), how.point(target), 44.0);
        view.up = how.rotation * DVec3::Y;
        let mut light = rectangle_light(how.point(LIGHT), HALF);
        light.shape = LightShape::Rect {
            u: how.vector(DVec3::X * HALF.x),
            v: how.vector(DVec3::Z * HALF.y),
        };
        let origin = how.point(DVec3::new(0.0, 0.75, 0.0));
        shot(moved.build_at(origin), view, light, 96, settings(256, 1))
    };
    let turn = DQuat::from_axis_angle(DVec3::new(0.3, 0.8, -0.5).normalize(), 1.234);
    let (no_turn, here) = (DQuat::IDENTITY, DVec3::ZERO);
    let far = DVec3::new(4000.0, -3000.0, 2000.0);
    let cases = [
        (1e-3, no_turn, here),
        (1e3, no_turn, here),
        (1.0, no_turn, far),
        (1.0, turn, here),
        (37.0, turn, far),
    ];
    with_gpu(|gpu| {
        let identity = Similarity {
            scale: 1.0,
            rotation: no_turn,
            translation: here,
        };
        let shot = build(&identity);
        let expected = render(gpu, &shot);
        let place = |image: &Image, pixel: usize, how: &Similarity, origin: DVec3| {
            let [x, y, z, surface] = image.positions[pixel];
            (surface > 0.0).then(|| how.back(origin + Vec3::new(x, y, z).as_dvec3()))
        };
        for (scale, rotation, translation) in cases {
            let how = Similarity {
                scale,
                rotation,
                translation,
            };
            let moved = build(&how);
            let image = render(gpu, &moved);
            let mut shares = Vec::new();
            let mut elsewhere = 0;
            for pixel in 0..image.visibility.len() {
                let before = place(&expected, pixel, &identity, shot.scene.origin);
                let after = place(&image, pixel, &how, moved.scene.origin);
                let (Some(before), Some(after)) = (before, after) else {
                    elsewhere += usize::from(before.is_some() != after.is_some());
                    continue;
                };
                // At silhouettes a pixel may see another surface.
                if before.distance(after) > 1e-3 {
                    elsewhere += 1;
                    continue;
                }
                let worth: f64 = plates
                    .iter()
                    .filter(|plate| plate.height > before.y + 1e-3)
                    .map(|plate| {
                        let half = 0.5 * texel(&expected, LIGHT, plate.height);
                        let seen = |by| rectangle_visibility(before, LIGHT, HALF, &plate.grown(by));
                        // The penumbra's border is less than a texel off.
                        let border = seen(-4.0 * half) - seen(4.0 * half);
                        (seen(-half) - seen(half)).max(0.25 * border)
                    })
                    .sum();
                let difference =
                    f64::from((image.visibility[pixel] - expected.visibility[pixel]).abs());
                if worth > 0.0 {
                    shares.push(difference / worth.max(1e-4));
                } else {
                    assert!(
                        difference <= 1e-5,
                        "off by {difference} at {before}, outside all penumbrae"
                    );
                }
            }
            shares.sort_by(f64::total_cmp);
            assert!(
                shares.len() > 500,
                "only {} pixels in the penumbra",
                shares.len()
            );
            let mean = shares.iter().sum::<f64>() / shares.len() as f64;
            let most = shares[shares.len() * 999 / 1000];
            println!(
                "scale {scale}: mean {mean:.1e}, 99.9 % {most:.1e} texels, {elsewhere} pixels see another place"
            );
            assert!(
                elsewhere * 100 <= image.visibility.len(),
                "{elsewhere} pixels see another place"
            );
            assert!(
                mean <= 1.0 / 256.0,
                "scale {scale}: {mean} texels on the mean"
            );
            assert!(most <= 1.0 / 16.0, "scale {scale}: {most} texels");
        }
    });
}
