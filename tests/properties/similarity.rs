//! What describes the same scene gives the same image: another frame of reference, other triangles, another order,
//! other packets, another resolution.

use glam::DMat3;
use halfshade::technique::{Leaf, Mapping};

use super::*;

/// Moves, turns and scales everything.
#[derive(Clone, Copy)]
struct Similarity {
    scale: f64,
    /// Orthogonal, right-handed.
    rotation: DMat3,
    translation: DVec3,
}

const IDENTITY: Similarity = Similarity {
    scale: 1.0,
    rotation: DMat3::IDENTITY,
    translation: DVec3::ZERO,
};

impl Similarity {
    fn point(&self, p: DVec3) -> DVec3 {
        self.translation + self.vector(p)
    }

    fn vector(&self, v: DVec3) -> DVec3 {
        self.rotation * v * self.scale
    }

    fn back(&self, p: DVec3) -> DVec3 {
        self.rotation.transpose() * (p - self.translation) / self.scale
    }
}

fn plates() -> [Occluder; 3] {
    [
        Occluder::square(1.5, DVec2::new(0.4, -0.3), 0.35, 15.0),
        Occluder::square(0.8, DVec2::new(-0.6, 0.4), 0.3, 40.0),
        Occluder::square(0.4, DVec2::new(0.5, 0.8), 0.25, 70.0),
    ]
}

fn triangles() -> Triangles {
    plates().iter().fold(
        Triangles::new().floor([-2.0, 2.0], [-2.0, 2.0]),
        |scene, plate| scene.plate(plate.height, &plate.corners()),
    )
}

/// The plates over a floor, made of these triangles and seen in this frame of reference.
fn plates_shot(triangles: &Triangles, how: &Similarity, side: u32, settings: Settings) -> Shot {
    let moved = triangles
        .0
        .iter()
        .map(|t| t.map(|corner| how.point(corner)));
    let moved = Triangles(moved.collect());
    let (eye, target) = (DVec3::new(-2.5, 3.2, 2.0), DVec3::new(0.0, 0.2, 0.1));
    let mut view = camera(how.point(eye), how.point(target), 44.0);
    view.up = how.rotation * DVec3::Y;
    let mut light = rectangle_light(how.point(LIGHT), HALF);
    light.shape = LightShape::Rect {
        u: how.vector(DVec3::X * HALF.x),
        v: how.vector(DVec3::Z * HALF.y),
    };
    shot(moved.build(), view, light, side, settings)
}

/// An image, and where each pixel is in the plates' own frame of reference.
struct Placed {
    image: Image,
    places: Vec<Option<DVec3>>,
    /// [pixel] See [`raster_grid`].
    grid: f64,
}

impl Placed {
    fn render(gpu: &Arc<Gpu>, shot: &Shot, how: &Similarity) -> Self {
        let image = render(gpu, shot);
        let place =
            |&[x, y, z, surface]: &[f64; 4]| (surface > 0.0).then(|| how.back(DVec3::new(x, y, z)));
        let places = image.positions.iter().map(place).collect();
        Self {
            image,
            places,
            grid: raster_grid(gpu),
        }
    }
}

/// How far apart two images are.
struct Difference {
    /// [texel] In the penumbrae: on the mean, and all but one in a thousand.
    mean: f64,
    most: f64,
    /// [pixel] That see another place, at silhouettes.
    elsewhere: usize,
}

/// What `pixel` of the one is `of(pixel)` in the other. Outside of all penumbrae they must be the same but for
/// rounding.
fn difference(one: &Placed, other: &Placed, of: impl Fn(usize) -> usize) -> Difference {
    let plates = plates();
    let mut shares = Vec::new();
    let mut elsewhere = 0;
    for pixel in 0..one.places.len() {
        let (Some(here), Some(there)) = (one.places[pixel], other.places[of(pixel)]) else {
            elsewhere +=
                usize::from(one.places[pixel].is_some() != other.places[of(pixel)].is_some());
            continue;
        };
        // A pixel's footprint is 0.25 long at most, and its place in it is as exact as the grid.
        if here.distance(there) > 0.25 * one.grid {
            elsewhere += 1;
            continue;
        }
        let worth: f64 = plates
            .iter()
            .filter(|plate| plate.height > here.y + 1e-3)
            .map(|plate| {
                let half = 0.5 * texel(&one.image, LIGHT, plate.height);
                let seen = |by| rectangle_visibility(here, LIGHT, HALF, &plate.grown(by));
                // The penumbra's border is less than a texel off.
                let border = seen(-4.0 * half) - seen(4.0 * half);
                (seen(-half) - seen(half)).max(0.25 * border)
            })
            .sum();
        let values = (
            one.image.visibility[pixel],
            other.image.visibility[of(pixel)],
        );
        let apart = f64::from((values.0 - values.1).abs());
        if worth > 0.0 {
            shares.push(apart / worth.max(1e-4));
        } else {
            assert!(
                apart <= 1e-5,
                "off by {apart} at {here}, outside all penumbrae"
            );
        }
    }
    shares.sort_by(f64::total_cmp);
    assert!(
        shares.len() > 100,
        "only {} pixels in the penumbra",
        shares.len()
    );
    Difference {
        mean: shares.iter().sum::<f64>() / shares.len() as f64,
        most: shares[shares.len() * 999 / 1000],
        elsewhere,
    }
}

/// Rounding of coordinates moves what the map samples by some 1e-7 of the scene's size, 1e-4 texels. Now and
/// then that tips a vertex over to the rasteriser's next position, 1/256 texel away on lavapipe, and with it one sample
/// in 256 along an edge; each moves the contour by a texel there, out of some tens of texels that the light sees.
/// So: on the mean a grid's width (1/256 of a texel's worth of penumbra), and all but one pixel in a thousand within 16.
fn assert_same(what: &str, one: &Placed, other: &Placed) {
    let Difference {
        mean,
        most,
        elsewhere,
    } = difference(one, other, |pixel| pixel);
    println!(
        "{what}: mean {mean:.1e}, 99.9 % {most:.1e} texels, {elsewhere} pixels see another place"
    );
    assert!(
        elsewhere * 100 <= one.places.len(),
        "{what}: {elsewhere} pixels see another place"
    );
    assert!(mean <= one.grid, "{what}: {mean} texels on the mean");
    assert!(most <= 16.0 * one.grid, "{what}: {most} texels");
}

#[test]
fn the_frame_of_reference_does_not_matter() {
    let axis = DVec3::new(0.3, 0.8, -0.5).normalize();
    let turn = DMat3::from_axis_angle(axis, 1.234);
    let permutation = DMat3::from_cols(DVec3::Y, DVec3::Z, DVec3::X);
    let far = DVec3::new(4000.0, -3000.0, 2000.0);
    let cases = [
        (1e-3, DMat3::IDENTITY, DVec3::ZERO),
        (1e3, DMat3::IDENTITY, DVec3::ZERO),
        (1.0, DMat3::IDENTITY, far),
        (1.0, turn, DVec3::ZERO),
        (1.0, permutation, DVec3::ZERO),
        (1.0, permutation * permutation, DVec3::ZERO),
        (37.0, turn, far),
    ];
    let triangles = triangles();
    let shot_of = |how: &Similarity| plates_shot(&triangles, how, 96, settings(256, 1));
    with_gpu(|gpu| {
        let expected = Placed::render(gpu, &shot_of(&IDENTITY), &IDENTITY);
        for (scale, rotation, translation) in cases {
            let how = Similarity {
                scale,
                rotation,
                translation,
            };
            let moved = Placed::render(gpu, &shot_of(&how), &how);
            assert_same(
                &format!("scale {scale}, to {translation}"),
                &expected,
                &moved,
            );
        }
    });
}

/// Powers of two scale every number and round none: not a bit may change, which an absolute constant would show.
#[test]
fn powers_of_two_change_nothing() {
    let triangles = triangles();
    with_gpu(|gpu| {
        for technique in [
            Technique::PacketContour,
            Technique::Micropatch,
            Technique::Bitmask,
        ] {
            let settings = Settings {
                map: 64,
                ..Settings::usual(technique)
            };
            let image = |exponent| {
                let how = Similarity {
                    scale: 2f64.powi(exponent),
                    ..IDENTITY
                };
                visibility(gpu, &plates_shot(&triangles, &how, 48, settings.clone()))
            };
            let expected = image(0);
            for exponent in [-20, -7, 9, 20] {
                assert!(
                    same_bits(&image(exponent), &expected),
                    "{technique}, 2^{exponent}"
                );
            }
        }
    });
}

/// Other triangles of the same shape. In another order and with corners turned they are drawn all the same; cut in
/// four, their edges are rasterised in two halves each.
#[test]
fn triangles_may_be_cut_and_reordered() {
    let whole = triangles();
    let quarters = |&[a, b, c]: &[DVec3; 3]| {
        let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    let reversed = Triangles(whole.0.iter().rev().copied().collect());
    let cut = Triangles(whole.0.iter().flat_map(quarters).collect());
    let of = |triangles: &Triangles| plates_shot(triangles, &IDENTITY, 96, settings(256, 1));
    with_gpu(|gpu| {
        let expected = Placed::render(gpu, &of(&whole), &IDENTITY);
        let other = Placed::render(gpu, &of(&reversed), &IDENTITY);
        assert!(
            same_bits(&other.image.visibility, &expected.image.visibility),
            "reversed"
        );
        assert_same(
            "cut in four",
            &expected,
            &Placed::render(gpu, &of(&cut), &IDENTITY),
        );
    });
}

/// A light turned by 180° about its normal is the same light, whose parts come in the opposite order and whose maps
/// are upside down.
#[test]
fn the_order_of_parts_does_not_matter() {
    let triangles = triangles();
    with_gpu(|gpu| {
        for split in [1, 3] {
            let shot = plates_shot(&triangles, &IDENTITY, 96, settings(256, split));
            let mut turned = shot.clone();
            let LightShape::Rect { u, v } = turned.lights[0].shape else {
                unreachable!("it is a rectangle")
            };
            turned.lights[0].shape = LightShape::Rect { u: -u, v: -v };
            let [one, other] = [shot, turned].map(|shot| Placed::render(gpu, &shot, &IDENTITY));
            assert_same(&format!("turned, split {split}"), &one, &other);
        }
    });
}

/// A packet's pixels share the walk and nothing else: sums of some hundred areas of a few 1e-7 rounding each come
/// in another order. Packets of 5×3 and 8×8 hang over the border of 51×51 pixels.
#[test]
fn the_size_of_packets_does_not_matter() {
    let triangles = triangles();
    with_gpu(|gpu| {
        let image = |packet, leaf, mapping| {
            let settings = Settings {
                packet,
                leaf,
                mapping,
                ..settings(128, 2)
            };
            visibility(gpu, &plates_shot(&triangles, &IDENTITY, 51, settings))
        };
        let expected = image((1, 1), Leaf::PerPixel, Mapping::Serial);
        for packet in [(2, 2), (4, 4), (5, 3), (8, 8)] {
            for (leaf, mapping) in [
                (Leaf::PerPixel, Mapping::Serial),
                (Leaf::Reprocess, Mapping::Lanes),
            ] {
                let apart = support::largest_difference(&image(packet, leaf, mapping), &expected);
                println!("{packet:?}, {leaf}, {mapping}: {apart:.1e}");
                assert!(apart <= 1e-5, "{packet:?}, {leaf}, {mapping}: {apart}");
            }
        }
    });
}

/// Three times the pixels a side have the same centres in every third. What is seen between them may widen the
/// fitted map, and each edge may then be off by 1.5 of its texels, before and after.
#[test]
fn pixels_do_not_depend_on_their_neighbours() {
    const SIDE: u32 = 33;
    let triangles = triangles();
    let of = |side| plates_shot(&triangles, &IDENTITY, side, settings(256, 1));
    with_gpu(|gpu| {
        let [small, large] = [SIDE, 3 * SIDE].map(|side| Placed::render(gpu, &of(side), &IDENTITY));
        let middle = |pixel: usize| {
            let (x, y) = (pixel % SIDE as usize, pixel / SIDE as usize);
            (3 * y + 1) * 3 * SIDE as usize + 3 * x + 1
        };
        let Difference {
            mean,
            most,
            elsewhere,
        } = difference(&small, &large, middle);
        println!(
            "thrice the size: mean {mean:.1e}, 99.9 % {most:.1e} texels, {elsewhere} see another place"
        );
        assert!(
            elsewhere * 100 <= small.places.len(),
            "{elsewhere} pixels see another place"
        );
        assert!(most <= 3.0, "{most} texels");
    });
}
