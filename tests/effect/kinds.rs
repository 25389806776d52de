//! What a host may lend: depths with a stencil beside them, normals in each encoding, maps the other way round, and
//! views along the light's plane that it draws itself.

use ash::vk;
use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};
use halfshade::frame::{Casters, Surface};
use halfshade::gpu::HostImageInfo;
use halfshade::plan::HostFrame;
use halfshade::render::{DrawnView, Effect, FrameInput, GivenMap, SlotImages};
use halfshade::shared::{NORMAL_OCTAHEDRAL, NORMAL_UNSIGNED};

use super::host::Host;
use super::painter::Painter;
use super::{
    OwnCasters, SIDE, Stage, clip_from_world, exported, gpu, prepared, record, visibility,
    with_frame,
};

/// Depth formats that have the 32 bits of the library's own, without and with a stencil.
const DEPTHS: [vk::Format; 2] = [vk::Format::D32_SFLOAT, vk::Format::D32_SFLOAT_S8_UINT];

/// A frame of the stage's meshes with the slot's images; `change` says what is different about it.
pub fn frame_of(
    host: &mut Host,
    stage: &Stage,
    surface: Surface,
    slot: &SlotImages,
    change: impl FnOnce(&mut FrameInput),
) -> Vec<f32> {
    let meshes = stage.meshes(host);
    let shape = HostFrame {
        surface,
        ..stage.frame(Casters::Gathered)
    };
    let mut effect = prepared(host, shape, slot, &meshes);
    with_frame(
        &stage.light(),
        meshes.len(),
        1,
        OwnCasters::default(),
        |frame| {
            change(frame);
            record(host, &mut effect, frame)
        },
    );
    visibility(host, slot)
}

/// Where the camera sees a point. `depth`: the row of the matrix that z comes from, given the one of the distance along the view
/// axis, which w comes from.
pub fn clip_from_positions(stage: &Stage, depth: impl FnOnce(DVec4) -> DVec4) -> DMat4 {
    let camera = &stage.shot.camera;
    let origin = stage.shot.origin();
    let (eye, target) = (camera.eye - origin, camera.target - origin);
    let forward = (target - eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let down = forward.cross(right);
    let focal = 1.0 / (0.5 * camera.vfov_deg).to_radians().tan();
    let row = |axis: DVec3| axis.extend(-axis.dot(eye));
    let (x, y, along) = (focal * row(right), focal * row(down), row(forward));
    DMat4::from_cols(x, y, depth(along), along).transpose()
}

/// Depths in each format give what the positions give that they stand for.
pub fn check_depths(host: &mut Host, stage: &Stage) {
    // Reversed, without a far plane.
    let clip = clip_from_positions(stage, |_| DVec4::W * 0.1);
    let world_from_clip = clip.inverse();
    let depth_of = |position: &[f32; 4]| {
        let point = DVec4::from_array(position.map(f64::from));
        let seen = clip * point.truncate().extend(1.0);
        if position[3] > 0.0 {
            (seen.z / seen.w) as f32
        } else {
            0.0
        }
    };
    let depths: Vec<f32> = stage.positions.iter().map(depth_of).collect();
    // On the rays through the pixels' centres. Those that were drawn lie beside them, by as much as the driver has
    // moved the triangles onto its grid of vertices.
    let position_of = |(index, &depth): (usize, &f32)| {
        let side = SIDE as usize;
        let pixel = DVec2::new((index % side) as f64, (index / side) as f64);
        let window = 2.0 * (pixel + 0.5) / f64::from(SIDE) - 1.0;
        let point = world_from_clip.project_point3(window.extend(depth.into()));
        match depth > 0.0 {
            true => point.as_vec3().extend(1.0).to_array(),
            false => [0.0; 4],
        }
    };
    let positions: Vec<[f32; 4]> = depths.iter().enumerate().map(position_of).collect();
    let mut frame_with = |surface, format, texels: &[u8]| {
        let slot = SlotImages {
            surface: host.image(format, (SIDE, SIDE), texels),
            ..stage.slot(host, Vec::new())
        };
        frame_of(host, stage, surface, &slot, |frame| {
            frame.world_from_clip = world_from_clip.as_mat4().to_cols_array_2d();
        })
    };
    let float = vk::Format::R32G32B32A32_SFLOAT;
    let expected = frame_with(Surface::Positions, float, bytemuck::cast_slice(&positions));
    let images =
        DEPTHS.map(|format| frame_with(Surface::Depths, format, bytemuck::cast_slice(&depths)));
    assert!(gpu::same_bits(&images[0], &images[1]), "a stencil matters");
    // Positions come back through an inverse in f32: some 1e-6 of the scene beside the others, against a penumbra of
    // tenths. Measured 5e-7.
    let largest = gpu::largest_difference(&images[0], &expected);
    assert!(largest < 1e-5, "{largest}");
}

/// Onto the octahedron |x| + |y| + |z| = 1, its lower half folded over the upper.
fn onto_octahedron(n: DVec3) -> [f64; 2] {
    let e = n / n.abs().element_sum();
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    match e.z < 0.0 {
        true => [(1.0 - e.y.abs()) * sign(e.x), (1.0 - e.x.abs()) * sign(e.y)],
        false => [e.x, e.y],
    }
}

/// Normals of a host's own space, in the encodings that are not signed.
pub fn check_normals(host: &mut Host, stage: &Stage) {
    // Turns what points upwards to below, so that the octahedron's folded half is met.
    let turn = DMat3::from_axis_angle(DVec3::new(3.0, 1.0, 2.0).normalize(), 2.2);
    let of_host = |normal: &[f32; 4]| {
        let normal = DVec3::from_array([normal[0], normal[1], normal[2]].map(f64::from));
        turn.transpose() * normal
    };
    let normals: Vec<DVec3> = stage.normals.iter().map(of_host).collect();
    assert!(normals.iter().any(|normal| normal.z < -0.1));
    let half = |x: f64| (0.5 * x + 0.5) as f32;
    let unsigned: Vec<[f32; 4]> = (normals.iter())
        .map(|n| [half(n.x), half(n.y), half(n.z), 0.0])
        .collect();
    let folded: Vec<[f32; 2]> = (normals.iter())
        .map(|&n| {
            if n == DVec3::ZERO {
                [0.0; 2]
            } else {
                onto_octahedron(n).map(half)
            }
        })
        .collect();
    let size = (SIDE, SIDE);
    let kinds: [(u32, HostImageInfo); 2] = [
        (
            NORMAL_UNSIGNED,
            host.image(
                vk::Format::R32G32B32A32_SFLOAT,
                size,
                bytemuck::cast_slice(&unsigned),
            ),
        ),
        (
            NORMAL_OCTAHEDRAL,
            host.image(
                vk::Format::R32G32_SFLOAT,
                size,
                bytemuck::cast_slice(&folded),
            ),
        ),
    ];
    for (encoding, normal) in kinds {
        let slot = SlotImages {
            normal,
            ..stage.slot(host, Vec::new())
        };
        let found = frame_of(host, stage, Surface::Positions, &slot, |frame| {
            frame.normal_encoding = encoding;
            frame.normal_to_world = turn.as_mat3().to_cols_array_2d();
        });
        // Normals come back with errors of some 1e-7 and matter to the bias alone, at most a texel.
        let largest = gpu::largest_difference(&found, &exported(&stage.expected));
        assert!(largest < 1e-4, "encoding {encoding}: {largest}");
    }
}

/// Maps that the host has already: the renderer's own, in both depth formats, as they are and from right to left.
pub fn check_maps(host: &mut Host, stage: &Stage) {
    let side = stage.shot.settings.map as usize;
    let frame = HostFrame {
        side_faces: false,
        ..stage.frame(Casters::Maps)
    };
    for format in DEPTHS {
        for mirrored in [false, true] {
            let mut texels = stage.map.clone();
            let mut matrix = clip_from_world(stage);
            if mirrored {
                texels.chunks_mut(side).for_each(<[f32]>::reverse);
                matrix.iter_mut().for_each(|column| column[0] = -column[0]);
            }
            let size = (side as u32, side as u32);
            let map = host.image(format, size, bytemuck::cast_slice(&texels));
            let slot = stage.slot(host, vec![map]);
            let mut effect = prepared(host, frame.clone(), &slot, &[]);
            let given = [GivenMap {
                clip_from_world: matrix,
                depth_empty: 0.0,
            }];
            let own = OwnCasters {
                near: stage.fit.near,
                maps: &given,
                draw: None,
            };
            let allocations = with_frame(&stage.light(), 0, 1, own, |frame| {
                record(host, &mut effect, frame)
            });
            assert_eq!(allocations, 0);
            let (found, expected) = (visibility(host, &slot), exported(&stage.expected));
            // The projection goes through a matrix of f32, whose rounding moves the map by some 1e-5 of a texel;
            // measured 0.
            let largest = gpu::largest_difference(&found, &expected);
            assert!(largest < 1e-4, "{format:?}, mirrored {mirrored}: {largest}");
        }
    }
}

/// A frame whose views the host draws, but for those that it `leaves_out`.
fn drawn_frame(
    host: &mut Host,
    stage: &Stage,
    slot: &SlotImages,
    effect: &mut Effect,
    leaves_out: fn(u32) -> bool,
) -> Vec<f32> {
    let painter = Painter::new(host, &stage.shot, effect.projections());
    let mut draw = |view: DrawnView| {
        if !leaves_out(view.index) {
            painter.draw(view);
        }
    };
    // As near as a caster stands to the front view's plane, with some room for those of the sides.
    let own = OwnCasters {
        near: 0.5 * stage.fit.near,
        maps: &[],
        draw: Some(&mut draw),
    };
    with_frame(&stage.light(), 0, 1, own, |frame| {
        record(host, effect, frame)
    });
    visibility(host, slot)
}

fn mean_difference(a: &[f32], b: &[f32]) -> f32 {
    let sum: f32 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
    sum / a.len() as f32
}

/// Views along the light's plane, drawn by the host.
pub fn check_side_faces(host: &mut Host, stage: &Stage) {
    assert!(stage.side_faces);
    let slot = stage.slot(host, Vec::new());
    let mut effect = prepared(host, stage.frame(Casters::DrawnByHost), &slot, &[]);
    let expected = exported(&stage.expected);
    let whole = drawn_frame(host, stage, &slot, &mut effect, |_| false);
    let front = drawn_frame(host, stage, &slot, &mut effect, |index| index > 0);
    let (with_sides, without) = (
        mean_difference(&whole, &expected),
        mean_difference(&front, &expected),
    );
    // Another map, whose texels are larger: measured 0.0004 with the side views and 0.18 without.
    assert!(with_sides < 0.002, "{with_sides}");
    assert!(
        without > 4.0 * with_sides,
        "{without}, with sides {with_sides}"
    );
}
