//! What each technique is known to get wrong.

use glam::{DVec2, DVec3};
use halfshade::technique::{Neighbours, Occluders, Pattern, Settings, Technique};

use super::support::{Triangles, camera, rectangle, rectangle_light, shot, visibility, with_gpu};

/// A light of 1 × 1 at a height of 4.
const LIGHT: DVec3 = DVec3::new(0.0, 4.0, 0.0);

/// The visibilities of what a low camera sees that looks along the floor to the middle under the light.
fn floor_of(triangles: Triangles, settings: Settings) -> Vec<f32> {
    floor_from(DVec3::new(-2.6, 0.35, 0.0), triangles, settings)
}

/// As `floor_of`, from another eye.
fn floor_from(eye: DVec3, triangles: Triangles, settings: Settings) -> Vec<f32> {
    let scene = triangles.floor([-3.0, 3.0], [-3.0, 3.0]).build();
    let camera = camera(eye, DVec3::new(0.0, 0.0, 0.0), 16.0);
    let light = rectangle_light(LIGHT, DVec2::splat(0.5));
    let shot = shot(scene, camera, light, 64, settings);
    with_gpu(|gpu| visibility(gpu, &shot))
        .into_iter()
        .filter(|value| !value.is_nan())
        .collect()
}

fn usual(technique: Technique) -> Settings {
    Settings {
        map: 64,
        ..Settings::usual(technique)
    }
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

/// A wide plate that slopes steeply, so that neighbouring texels are far apart in depth.
fn slope(rise: f64) -> Triangles {
    let corners = [(-1.2, -1.5), (-1.2, 1.5), (1.2, 1.5), (1.2, -1.5)];
    let corner = |(x, z): (f64, f64)| DVec3::new(x, 1.7 + rise * x, z);
    Triangles::new().polygon(&corners.map(corner))
}

/// [GBP06] Between patches of different depths light leaks; gap filling closes the gaps.
#[test]
fn micropatches_leak_light_through_gaps() {
    let floor = |gap_filling, rise| {
        let settings = Settings {
            gap_filling,
            ..usual(Technique::Micropatch)
        };
        floor_of(slope(rise), settings)
    };
    // The gaps to the left are filled, those to the right need the other slope.
    let leaked = [1.0, -1.0].map(|rise| {
        let (open, filled) = (floor(false, rise), floor(true, rise));
        let leaks = open.iter().zip(&filled).map(|(open, filled)| open - filled);
        leaks.fold(0.0, f32::max)
    });
    assert!(leaked[0].max(leaked[1]) > 0.02, "no leaks: {leaked:?}");
}

/// Areas add up, whatever lies behind whatever: two strips of which each hides the same quarter of the light hide half
/// of it [Yang09 §2.3]. A bit is covered only once [SS07].
#[test]
fn added_areas_count_overlapping_occluders_twice() {
    // Seen from the middle of the floor, both stand before the light's part x = 0.125 … 0.25 of ±0.5; the light's
    // centre sees them apart.
    let build = || {
        Triangles::new()
            .plate(0.8, &rectangle([0.05, 0.1], [-1.5, 1.5]))
            .plate(3.2, &rectangle([0.2, 0.4], [-0.6, 0.6]))
    };
    let fine = |technique| Settings {
        map: 256,
        ..Settings::usual(technique)
    };
    // Steep enough for pixels as narrow as the place where both hide the same.
    let eye = DVec3::new(-1.6, 0.6, 0.0);
    let areas = floor_from(eye, build(), fine(Technique::Micropatch));
    let bits = floor_from(eye, build(), fine(Technique::Bitmask));
    let darker = areas.iter().zip(&bits).map(|(area, bit)| bit - area);
    let most = darker.fold(0.0, f32::max);
    assert!(most > 0.15, "areas are at most {most} darker");
}

/// A bitmask knows as many visibilities as it has samples [SS07].
#[test]
fn bitmasks_have_steps() {
    let settings = Settings {
        light_samples: 8,
        pattern: Pattern::Regular,
        ..usual(Technique::Bitmask)
    };
    let plate = Triangles::new().plate(1.5, &rectangle([-0.7, 0.3], [-0.8, 0.5]));
    let values = floor_of(plate, settings);
    let between = values.iter().filter(|value| (0.01..0.99).contains(*value));
    assert!(between.count() > 100, "no penumbra");
    for value in values {
        // Eighths of eighths are exact in f32, and so is their sum of a single view.
        assert_eq!((64.0 * value).fract(), 0.0, "{value}");
    }
}

/// A microquad needs two samples in each direction [SS07; Schwarz08 §5.1]: what is a sample wide is missed.
#[test]
fn microquads_miss_what_is_thin() {
    // The wide plate sets the map's scale: about 5 units over 61 texels at the floor's distance.
    let build = || {
        Triangles::new()
            .plate(2.0, &rectangle([-0.02, 0.02], [-1.2, 1.2]))
            .plate(2.0, &rectangle([1.0, 1.3], [-1.2, 1.2]))
    };
    let near = |values: Vec<f32>| mean(&values);
    let quads = near(floor_of(build(), usual(Technique::Bitmask)));
    let patches = near(floor_of(build(), usual(Technique::Micropatch)));
    assert!(patches < quads - 0.005, "patches {patches}, quads {quads}");
}

/// A single view misses what its centre cannot see; a second layer finds it [BCS08].
#[test]
fn layers_find_what_the_centre_cannot_see() {
    // The far plate hides the near one from the centre of the light, but not from its borders.
    let build = || {
        Triangles::new()
            .plate(3.0, &rectangle([-0.2, 0.2], [-0.2, 0.2]))
            .plate(2.0, &rectangle([-0.38, 0.38], [-0.38, 0.38]))
    };
    for occluders in [Occluders::Micropatches, Occluders::Contours] {
        let peeled = |layers| {
            let settings = Settings {
                layers,
                occluders,
                ..usual(Technique::DepthPeeling)
            };
            mean(&floor_of(build(), settings))
        };
        let (one, two) = (peeled(1), peeled(2));
        assert!(
            two < one - 0.005,
            "{occluders}: {one} with one layer, {two} with two"
        );
    }
}

/// The layers' areas add up: the front and the back of a solid hide its part of the light twice [BCS08, as read here].
#[test]
fn peeled_solids_are_too_dark() {
    let build = || {
        Triangles::new()
            .plate(2.0, &rectangle([-0.5, 0.5], [-0.5, 0.5]))
            .plate(1.8, &rectangle([-0.5, 0.5], [-0.5, 0.5]))
    };
    let peeled = |layers| {
        let settings = Settings {
            layers,
            occluders: Occluders::Contours,
            ..usual(Technique::DepthPeeling)
        };
        floor_of(build(), settings)
    };
    // The right shadow has the union of both, which no point of the floor sees much apart.
    let twice = |one: f32| (1.0 - 2.0 * (1.0 - one)).max(0.0);
    let (one, two) = (peeled(1), peeled(2));
    let doubled = one
        .iter()
        .zip(&two)
        .filter(|(one, two)| **one < 0.9 && **one > 0.5 && (twice(**one) - **two).abs() < 0.15);
    assert!(doubled.count() > 50, "nothing is counted twice");
}

/// A hard shadow has two values; nine samples have ten [Williams78].
#[test]
fn hard_shadows_have_steps() {
    let plate = || Triangles::new().plate(1.5, &rectangle([-0.7, 0.3], [-0.8, 0.5]));
    let hard = floor_of(plate(), usual(Technique::Hard));
    assert!(hard.iter().all(|&value| value == 0.0 || value == 1.0));
    assert!(mean(&hard) > 0.0 && mean(&hard) < 1.0);
    let settings = Settings {
        percentage_closer: true,
        ..usual(Technique::Hard)
    };
    let ninths = floor_of(plate(), settings);
    assert!(ninths.iter().any(|&value| value > 0.0 && value < 1.0));
    // A ninth has no exact float.
    assert!(
        ninths
            .iter()
            .all(|value| (9.0 * value - (9.0 * value).round()).abs() < 1e-5)
    );
}

/// Blockers of different depths are averaged into one that is nowhere, so that the umbra under a near plate leaks light
/// or darkens where a far one is added [Fernando05].
#[test]
fn percentage_closer_shadows_guess() {
    let near = rectangle([-0.9, 0.0], [-1.5, 1.5]);
    let far = rectangle([-0.35, 0.0], [-0.6, 0.6]);
    let build = || Triangles::new().plate(0.8, &near).plate(3.2, &far);
    let settings = Settings {
        blocker_samples: 256,
        filter_samples: 256,
        map: 256,
        ..Settings::usual(Technique::Pcss)
    };
    let truth = Settings {
        maps: 256,
        map: 256,
        ..Settings::usual(Technique::ReferenceMaps)
    };
    let (guess, truth) = (floor_of(build(), settings), floor_of(build(), truth));
    let off = guess
        .iter()
        .zip(&truth)
        .map(|(guess, truth)| (guess - truth).abs());
    assert!(off.fold(0.0, f32::max) > 0.2);
    // Few samples are noise: neighbours in the penumbra differ by steps of 1/8.
    let few = Settings {
        blocker_samples: 4,
        filter_samples: 8,
        map: 256,
        ..Settings::usual(Technique::Pcss)
    };
    assert!(
        floor_of(build(), few)
            .iter()
            .all(|value| (8.0 * value).fract() == 0.0)
    );
}

/// A plate of 1.6 × 1.6 at a height, under which the light of 1 × 1 is not hidden to its last part unless it is low.
fn plate_at(height: f64) -> Triangles {
    Triangles::new().plate(height, &rectangle([-0.8, 0.8], [-0.8, 0.8]))
}

/// [Kirsch03 §2] Shadows are only where the light's centre is hidden: smaller than they are.
#[test]
fn a_single_light_sample_shades_the_inner_penumbra_alone() {
    let floor = |technique| {
        floor_of(
            plate_at(1.7),
            Settings {
                map: 256,
                ..usual(technique)
            },
        )
    };
    let (soft, hard) = (floor(Technique::ShadowWidth), floor(Technique::Hard));
    let lit = hard.iter().zip(&soft).filter(|(hard, _)| **hard == 1.0);
    let count = lit.clone().count();
    assert!(count > 200, "{count} pixels are lit");
    assert!(lit.into_iter().all(|(_, soft)| *soft == 1.0));
    let between = soft
        .iter()
        .filter(|soft| **soft > 0.05 && **soft < 0.95)
        .count();
    assert!(between > 100, "{between} pixels of penumbra");
}

/// [Kirsch03 §5, figs. 5 and 6] One depth is known at a texel: where a far blocker comes before a near one, the shadow gets softer,
/// so that more blockers let through more light. With the depths of the farthest back faces it gets harder instead.
#[test]
fn overlapping_blockers_soften_shadows() {
    let strip = rectangle([-0.1, 0.1], [-0.6, 0.6]);
    let most_brighter = |back_faces| {
        let settings = || Settings {
            map: 256,
            back_faces,
            ..usual(Technique::ShadowWidth)
        };
        let near = || slab(plate_at(0.5), 0.48, &rectangle([-0.8, 0.8], [-0.8, 0.8]));
        let alone = floor_of(near(), settings());
        let both = slab(near().plate(3.0, &strip), 2.98, &strip);
        let crossed = floor_of(both, settings());
        let brighter = alone
            .iter()
            .zip(&crossed)
            .map(|(alone, crossed)| crossed - alone);
        brighter.fold(0.0, f32::max)
    };
    let (nearest, farthest) = (most_brighter(false), most_brighter(true));
    assert!(
        nearest > 0.2 && farthest < 0.02,
        "brighter by {nearest} and {farthest}"
    );
}

/// With a side at `bottom` that shows its back to what is above.
fn slab(triangles: Triangles, bottom: f64, corners: &[DVec2; 4]) -> Triangles {
    let mut turned = *corners;
    turned.reverse();
    triangles.plate(bottom, &turned)
}

/// [Kirsch03 §5, fig. 7] In a coarse map widths begin with a texel: where blocker and receiver are close, that is most of the
/// penumbra, and the border is a step; farther away it is not.
#[test]
fn shadows_of_close_blockers_begin_with_a_step() {
    let brightest_inside = |height| {
        let floor = |technique| floor_of(plate_at(height), usual(technique));
        let (soft, hard) = (floor(Technique::ShadowWidth), floor(Technique::Hard));
        let inside = soft.iter().zip(&hard).filter(|(_, hard)| **hard == 0.0);
        inside.map(|(soft, _)| *soft).fold(0.0, f32::max)
    };
    let (close, far) = (brightest_inside(0.05), brightest_inside(1.7));
    assert!(close < 0.5 && far > 0.8, "{close} and {far}");
}

/// [Kirsch03 §4] With neighbours, widths end where the difference is 1: a shadow whose penumbra is wider never gets dark.
#[test]
fn widths_end_with_the_starting_difference() {
    let darkest = |neighbours| {
        let settings = Settings {
            map: 256,
            neighbours,
            start: 4,
            ..usual(Technique::ShadowWidth)
        };
        let floor = floor_of(plate_at(1.0), settings);
        floor.iter().copied().fold(1.0, f32::min)
    };
    let (three, flood) = (darkest(Neighbours::Three), darkest(Neighbours::Flood));
    assert!(three > 0.5 && flood < 0.01, "{three} and {flood}");
}
