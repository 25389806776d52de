//! The algorithmic passes against their scalar twins, in every view of every scene: the twins are fed with
//! the map, the positions and the fit that the device found, and must come to the same.

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use common::{MAP, Point, SIZE, Traces, points, renderer, shot, traces, with_device};
use glam::{DVec3, Vec3};
use halfshade::gpu::Gpu;
use halfshade::render::{DEFAULT_COSTS, Renderer};
use halfshade::scene::LightShape;
use halfshade::shared::{
    KERNEL_LIT, KERNEL_NONE, KERNEL_PENUMBRA, KERNEL_UMBRA, Kernel, Packet, TILE_SIZE, TileBounds,
    View, Window,
};
use halfshade::shot::Shot;
use halfshade::technique::{Hierarchy as Density, Leaf, Mapping, Settings};
use halfshade::twin::classify::{Classified, Decision, classify};
use halfshade::twin::contour::ShadowMap;
use halfshade::twin::hierarchy::Hierarchy;
use halfshade::twin::kernels::{kernel_of, unpacked};
use halfshade::twin::radial::SubLight;
use halfshade::twin::receiver::{Receiver, in_view, project};
use halfshade::twin::{resolve, tile};

/// [visibility] The device sums some hundred areas in f32, each with a rounding error of a few 1e-7 of the
/// light, and interpolates the sectors of discs and polygons.
const TOLERANCE: f64 = 1e-4;
/// [pixel] Where a light is cut into parts, only one diagonal in so many is integrated: each place in a
/// packet of 4×4 is met, and the many views cost no more than the one of the whole light.
const DIAGONAL_STEP: u32 = 4;
/// [pixel] One in so many, in both directions, is also integrated over the whole map.
const WHOLE_MAP_STEP: u32 = 12;

/// A pixel that the view has to look at.
type Seen = Option<Receiver>;

fn receivers(traces: &Traces, points: &[Option<Point>]) -> Vec<Seen> {
    let (view, oblique) = (&traces.planned.view, traces.planned.oblique);
    let receiver = |point: &Point| {
        let to_point = point.position - Vec3::from(view.center);
        in_view(view, point.position, point.normal)
            .then(|| project(view, &traces.fit, oblique, to_point, point.normal))
    };
    points
        .iter()
        .map(|point| point.as_ref().and_then(receiver))
        .collect()
}

/// The twin's hierarchy, equal to the device's in every node and bit.
fn check_hierarchy<'a>(traces: &'a Traces, settings: &Settings) -> Hierarchy<'a> {
    let map = ShadowMap {
        size: MAP as i32,
        depths: &traces.map,
    };
    let density = settings.hierarchy.density(MAP);
    let (count, most) = (traces.fit.level_count, traces.planned.view.levels_max);
    let hierarchy = Hierarchy::new(map, density, count, most, settings.mssm_bits);
    let (width, height, _) = density.extent(MAP, most);
    let bits = |bounds: &[f32; 2]| bounds.map(f32::to_bits);
    for level in 0..count {
        let along = density.nodes_along(MAP, most, level);
        let (left, top, layer) = density.origin(MAP, most, level);
        for (i, wanted) in hierarchy.level(level).iter().enumerate() {
            let (x, y) = (i as u32 % along, i as u32 / along);
            let texel = (layer * height + top + y) * width + left + x;
            let found = &traces.hierarchy[texel as usize];
            assert_eq!(bits(found), bits(wanted), "level {level}, node {x}, {y}");
        }
    }
    hierarchy
}

/// The pixels of a tile, as far as it is in the image.
fn pixels_of([column, row]: [u32; 2]) -> impl Iterator<Item = usize> {
    let along = |tile: u32| (tile * TILE_SIZE..(tile + 1) * TILE_SIZE).take_while(|&i| i < SIZE);
    along(row).flat_map(move |y| along(column).map(move |x| (y * SIZE + x) as usize))
}

/// Bounds of tiles, equal to the twin's in every bit but the sign of zero.
fn check_tile_bounds(renderer: &Renderer, points: &[Option<Point>]) {
    let along = SIZE.div_ceil(TILE_SIZE);
    let found: Vec<TileBounds> = renderer
        .read_buffer("tile_bounds", (along * along) as usize)
        .expect("tile_bounds");
    for (i, found) in (0..).zip(found) {
        let seen = pixels_of([i % along, i / along]).filter_map(|pixel| points[pixel]);
        match tile::bounds(seen.map(|point| (point.position, point.normal))) {
            Some(wanted) => assert_eq!(found, wanted, "tile {i}"),
            None => assert!(found.lower[0] > found.upper[0], "tile {i}: {found:?}"),
        }
    }
}

/// What is decided about a tile is so for each of its pixels: a kernel that has all of its occluders has none, or nothing else.
fn is_so(status: u32, receiver: &Receiver, kernel: &Kernel, map: &ShadowMap) -> bool {
    let ([left, below], [right, above]) = (unpacked(kernel.first), unpacked(kernel.last));
    let limit = receiver.limit();
    let occludes =
        |[x, y]: [i32; 2]| limit.is_passed([x, y], map.depths[(y * map.size + x) as usize]);
    let mut samples = (below..=above + 1).flat_map(|y| (left..=right + 1).map(move |x| [x, y]));
    match (status, kernel.status) {
        (KERNEL_LIT, KERNEL_PENUMBRA) => !samples.any(occludes),
        (KERNEL_UMBRA, KERNEL_PENUMBRA) => samples.all(occludes),
        (decided, found) => decided == found,
    }
}

/// The twin's kernels, equal to the device's in every pixel and bit, but where a tile is decided as a whole.
fn check_kernels(
    traces: &Traces,
    receivers: &[Seen],
    hierarchy: &Hierarchy,
    decided: &mut [usize; 2],
) -> Vec<Kernel> {
    let (view, oblique) = (&traces.planned.view, traces.planned.oblique);
    let map = ShadowMap {
        size: MAP as i32,
        depths: &traces.map,
    };
    let of =
        |receiver, depth_max| kernel_of(view, oblique, receiver, &map, hierarchy, None, depth_max);
    let of_status = |status| Kernel {
        status,
        ..Kernel::default()
    };
    let mut kernels = vec![of_status(KERNEL_NONE); receivers.len()];
    // Where kernels are counted, all tiles are listed.
    assert_eq!(traces.tiles.len() as u32, SIZE.div_ceil(TILE_SIZE).pow(2));
    for tile in &traces.tiles {
        let mut statuses = BTreeSet::new();
        for pixel in pixels_of(tile.place) {
            let Some(receiver) = &receivers[pixel] else {
                continue;
            };
            kernels[pixel] = match tile.status {
                KERNEL_PENUMBRA => of(receiver, tile.depth_max),
                status => of_status(status),
            };
            let alone = of(receiver, 1.0);
            let status = tile.status;
            assert!(
                status == KERNEL_PENUMBRA || is_so(status, receiver, &alone, &map),
                "{tile:?}, pixel {pixel}: {alone:?}"
            );
            statuses.insert(alone.status);
        }
        let uniform = statuses.len() <= 1 && !statuses.contains(&KERNEL_PENUMBRA);
        decided[0] += usize::from(uniform && tile.status != KERNEL_PENUMBRA);
        decided[1] += usize::from(uniform);
    }
    let mut statuses = [0u32; 4];
    for (i, (found, wanted)) in traces.kernels.iter().zip(&kernels).enumerate() {
        let pixel = (i as u32 % SIZE, i as u32 / SIZE);
        assert_eq!(found, wanted, "pixel {pixel:?}, {:?}", receivers[i]);
        statuses[wanted.status as usize] += 1;
    }
    let [before, after] = &traces.counters;
    let counted = [
        after.lit - before.lit,
        after.umbra - before.umbra,
        after.penumbra - before.penumbra,
    ];
    let wanted =
        [KERNEL_LIT, KERNEL_UMBRA, KERNEL_PENUMBRA].map(|status| statuses[status as usize]);
    assert_eq!(counted, wanted);
    assert_eq!(after.pixels - before.pixels, wanted.iter().sum::<u32>());
    kernels
}

/// Packets by their position in the grid, with their penumbra pixels.
fn packets_of((width, height): (u32, u32), kernels: &[Kernel]) -> BTreeMap<u32, Vec<u32>> {
    let columns = SIZE.div_ceil(width);
    let mut packets = BTreeMap::new();
    for pixel in (0..SIZE * SIZE).filter(|&i| kernels[i as usize].status == KERNEL_PENUMBRA) {
        let packet = pixel / SIZE / height * columns + pixel % SIZE / width;
        packets.entry(packet).or_insert_with(Vec::new).push(pixel);
    }
    packets
}

/// [pixel] Where a window's penumbra pixels are, in its tile: a bit's number has the bits of x and y by turns.
fn places(window: &Window) -> impl Iterator<Item = [u32; 2]> {
    let [low, high] = window.penumbra.map(u64::from);
    let bits = low | high << 32;
    let set = (0..64u32).filter(move |place| bits >> place & 1 != 0);
    let along = |place: u32| (place & 1) | (place >> 1 & 2) | (place >> 2 & 4);
    set.map(move |place| [along(place), along(place >> 1)])
}

/// Whether a packet is the twin's, but for what the device divides: Vulkan allows 2.5 ulp.
fn is_close(found: &Packet, wanted: &Packet) -> bool {
    let divided = |packet: &Packet| {
        let depths = [packet.depth_min, packet.depth_max, packet.depth_far];
        let texels = packet.centers.into_iter().chain(packet.origin);
        let planes = packet.plane_depths.into_iter().chain(packet.planes);
        depths
            .into_iter()
            .chain(texels)
            .chain(planes)
            .collect::<Vec<f32>>()
    };
    let close = |(a, b): (f32, f32)| (a - b).abs() <= 1e-6 * a.abs().max(b.abs());
    let listed = |packet: &Packet| [packet.index, packet.first, packet.last];
    let mut pairs = divided(found).into_iter().zip(divided(wanted));
    listed(found) == listed(wanted) && pairs.all(close)
}

/// What local packets form in is listed: each tile's penumbra pixels once. Each of them comes to one packet, or where the driver
/// ends its walk to the list of pixels.
fn check_windows(traces: &Traces, windows: &BTreeMap<u32, Vec<u32>>) {
    let columns = SIZE.div_ceil(TILE_SIZE);
    let mut listed = BTreeMap::new();
    for window in &traces.windows {
        let [x, y] = window.place;
        let pixels =
            places(window).map(|[dx, dy]| (y * TILE_SIZE + dy) * SIZE + x * TILE_SIZE + dx);
        let tile: &mut Vec<u32> = listed.entry(y * columns + x).or_default();
        tile.extend(pixels);
    }
    listed
        .values_mut()
        .for_each(|pixels| pixels.sort_unstable());
    assert_eq!(&listed, windows);
    let penumbra: BTreeSet<&u32> = windows.values().flatten().collect();
    let mut single = traces.pixels.clone();
    single.sort_unstable();
    single.dedup();
    assert_eq!(single.len(), traces.pixels.len(), "a pixel is listed twice");
    assert!(single.iter().all(|pixel| penumbra.contains(pixel)));
    let [before, after] = &traces.counters;
    let [formed, shared] = [
        after.packets - before.packets,
        after.coherent_packets - before.coherent_packets,
    ];
    assert!(formed as usize >= windows.len() && formed as usize <= penumbra.len());
    assert!(shared <= formed);
    let gave_up = after.reprocessed_packets - before.reprocessed_packets;
    assert_eq!(gave_up == 0, single.is_empty());
}

/// The device's lists are what the twin decides; returns how many packets the twin leaves undecided, of
/// how many.
fn check_lists(shot: &Shot, traces: &Traces, seen: &[Seen], kernels: &[Kernel]) -> [usize; 2] {
    let pixelwise = shot.settings.packet == (1, 1);
    if shot.settings.packet_mapping() == Mapping::Cooperative && !pixelwise {
        check_windows(traces, &packets_of((TILE_SIZE, TILE_SIZE), kernels));
        return [0, 0];
    }
    let packets = packets_of(shot.settings.window(), kernels);
    let mut coherent: BTreeMap<u32, _> = BTreeMap::new();
    for packet in &traces.packets {
        assert!(
            coherent.insert(packet.index, *packet).is_none(),
            "listed twice"
        );
    }
    let mut pixels: BTreeSet<u32> = traces.pixels.iter().copied().collect();
    assert_eq!(pixels.len(), traces.pixels.len(), "a pixel is listed twice");
    let (mut undecided, mut reprocessed) = (0, 0);
    for (&index, members) in &packets {
        let surveyed: Vec<(Kernel, Receiver)> = members
            .iter()
            .filter_map(|&i| seen[i as usize].map(|receiver| (kernels[i as usize], receiver)))
            .collect();
        let Classified { packet, decision } =
            classify(index, &surveyed, &DEFAULT_COSTS).expect("it has pixels");
        undecided += usize::from(decision == Decision::Either && !pixelwise);
        let single = members.iter().filter(|&i| pixels.remove(i)).count();
        match coherent.remove(&index) {
            Some(found) => {
                assert_ne!(decision, Decision::Incoherent, "{packet:?}");
                assert!(is_close(&found, &packet), "{found:?} instead of {packet:?}");
                // The traversal may hand the whole packet on to the list of pixels.
                assert!(single == 0 || single == members.len());
                reprocessed += u32::from(single > 0);
            }
            None => {
                assert!(decision != Decision::Coherent || pixelwise, "{packet:?}");
                assert_eq!(single, members.len(), "{packet:?}");
            }
        }
    }
    assert!(
        coherent.is_empty() && pixels.is_empty(),
        "listed without penumbra pixels"
    );
    let [before, after] = &traces.counters;
    assert_eq!(after.packets - before.packets, packets.len() as u32);
    assert_eq!(
        after.coherent_packets - before.coherent_packets,
        traces.packets.len() as u32
    );
    assert_eq!(
        after.reprocessed_packets - before.reprocessed_packets,
        reprocessed
    );
    [undecided, packets.len()]
}

/// The pixels that are integrated.
fn integrated(shot: &Shot) -> impl Iterator<Item = usize> {
    let step = if shot.settings.split > 1 {
        DIAGONAL_STEP
    } else {
        1
    };
    let pixels = 0..SIZE * SIZE;
    pixels
        .filter(move |i| (i % SIZE + i / SIZE).is_multiple_of(step))
        .map(|i| i as usize)
}

/// What the view hides from each pixel by the twin, added to `hidden`, each weighed; returns the largest
/// difference from the device, as a share of the sub-light.
fn check_integration(
    shot: &Shot,
    traces: &Traces,
    seen: &[Seen],
    kernels: &[Kernel],
    hidden: &mut [f64],
) -> f64 {
    let View { weight, area, .. } = traces.planned.view;
    let map = ShadowMap {
        size: MAP as i32,
        depths: &traces.map,
    };
    let cut = traces.planned.cut();
    let light = SubLight::new(&traces.planned.view, &traces.fit, cut, map);
    // The device's area is the end of a table in f32.
    assert!((light.area() - f64::from(area)).abs() < 1e-5, "area {area}");
    let mut largest: f64 = 0.0;
    for i in integrated(shot) {
        let Some(receiver) = &seen[i] else {
            assert_eq!(traces.occlusion[i], 0.0);
            continue;
        };
        let kernel = kernels[i];
        let share = match kernel.status {
            KERNEL_PENUMBRA => {
                light.hidden_share(receiver, unpacked(kernel.first), unpacked(kernel.last))
            }
            KERNEL_UMBRA => 1.0,
            _ => 0.0,
        };
        let found = f64::from(traces.occlusion[i] / weight);
        let pixel = [i as u32 % SIZE, i as u32 / SIZE];
        assert!(
            (found - share).abs() < TOLERANCE,
            "pixel {pixel:?}: {found} of the light hidden, by the twin {share}; {kernel:?}, {receiver:?}"
        );
        largest = largest.max((found - share).abs());
        hidden[i] += f64::from(weight) * share;
        // No kernel, no lit and no umbra pixel may have lost an occluder to what was cut away.
        if pixel.iter().all(|at| at.is_multiple_of(WHOLE_MAP_STEP)) {
            let whole = light.hidden_share(receiver, [0; 2], [MAP as i32 - 2; 2]);
            assert!(
                (whole - share).abs() < TOLERANCE,
                "pixel {pixel:?}: the whole map hides {whole}, its kernel {share}; {kernel:?}, {receiver:?}"
            );
        }
    }
    largest
}

/// Every view's passes and the sum of the views.
fn check(gpu: &Arc<Gpu>, name: &str, shot: &Shot) {
    let mut renderer = renderer(gpu, shot);
    let light = renderer.plan().lights[0].light;
    let corners = renderer.plan().corners();
    let mut hidden = vec![0.0; (SIZE * SIZE) as usize];
    let mut largest: f64 = 0.0;
    let mut undecided = [0; 2];
    let mut decided = [0; 2];
    for index in 0..light.view_count {
        let traces = traces(&mut renderer, index);
        if traces.fit.level_count == 0 {
            assert!(traces.occlusion.iter().all(|&occluded| occluded == 0.0));
            continue;
        }
        let seen = receivers(&traces, &points(&renderer));
        let hierarchy = check_hierarchy(&traces, &shot.settings);
        let kernels = check_kernels(&traces, &seen, &hierarchy, &mut decided);
        let counted = check_lists(shot, &traces, &seen, &kernels);
        undecided = [undecided[0] + counted[0], undecided[1] + counted[1]];
        largest = largest.max(check_integration(
            shot,
            &traces,
            &seen,
            &kernels,
            &mut hidden,
        ));
    }
    renderer.render().expect("the scenes can be rendered");
    let found = renderer.visibility(0).expect("visibility");
    let points = points(&renderer);
    check_tile_bounds(&renderer, &points);
    let mut summed: f64 = 0.0;
    for i in integrated(shot) {
        let Some(Point { position, normal }) = points[i] else {
            assert!(found[i].is_nan());
            continue;
        };
        let wanted = resolve::visibility(&light, &corners, position, normal, hidden[i]);
        let difference = (f64::from(found[i]) - wanted).abs();
        assert!(
            difference < TOLERANCE,
            "{name}, pixel {i}: visibility {}, by the twin {wanted}",
            found[i]
        );
        summed = summed.max(difference);
    }
    println!(
        "{name}, split {}, {} views: largest difference {largest:.1e} in a view, {summed:.1e} in their sum; \
         {} of {} packets undecided; {} of {} tiles without penumbrae decided",
        shot.settings.split, light.view_count, undecided[0], undecided[1], decided[0], decided[1]
    );
    // Bounds of tiles are loose where surfaces bend or end.
    assert!(3 * decided[0] >= decided[1], "{name}: {decided:?}");
    // Widths are small integers, so that the two costs of a packet now and then are the same but for rounding.
    assert!(100 * undecided[0] <= undecided[1], "{name}: {undecided:?}");
}

/// The scene as it is, with packets of 4×4 and the leaf rule `per-pixel`, in one part and in four.
fn check_scene(name: &str) {
    with_device(|gpu| {
        let mut shot = shot(name);
        for split in [1, 2] {
            shot.settings.split = split;
            check(gpu, name, &shot);
        }
    });
}

#[test]
fn colonnade() {
    check_scene("colonnade");
}

#[test]
fn grid() {
    check_scene("grid");
}

#[test]
fn knot() {
    check_scene("knot");
}

#[test]
fn plate() {
    check_scene("plate");
}

#[test]
fn staircase() {
    check_scene("staircase");
}

#[test]
fn tree() {
    check_scene("tree");
}

#[test]
fn the_side_faces_of_a_disc() {
    with_device(|gpu| {
        let mut shot = shot("grid");
        shot.lights[0].shape = LightShape::Disc {
            normal: DVec3::new(0.1, -1.0, 0.2),
            radius: 0.8,
        };
        shot.settings.split = 2;
        check(gpu, "grid under a disc", &shot);
    });
}

/// Whole, and cut into parts of up to three sides, seen from all faces.
#[test]
fn the_sides_of_a_polygon() {
    with_device(|gpu| {
        let mut shot = shot("grid");
        let light = &mut shot.lights[0];
        let corners = [
            [-0.9, -0.5],
            [0.8, -0.7],
            [1.0, 0.3],
            [0.2, 0.9],
            [-0.6, 0.6],
        ];
        let tilted = |[x, z]: [f64; 2]| light.center + DVec3::new(x, 0.1 * x - 0.2 * z, z);
        let (center, shape) = LightShape::polygon(&corners.map(tilted)).expect("a polygon");
        (light.center, light.shape) = (center, shape);
        for split in [1, 2] {
            shot.settings.split = split;
            check(gpu, "grid under a polygon", &shot);
        }
    });
}

#[test]
fn other_packets_leaf_rules_and_mappings() {
    with_device(|gpu| {
        let mut shot = shot("staircase");
        shot.settings.split = 1;
        for (packet, leaf, mapping) in [
            ((1, 1), Leaf::PerPixel, Mapping::Serial),
            ((4, 4), Leaf::PerPixel, Mapping::Serial),
            ((6, 7), Leaf::PerPixel, Mapping::Cooperative),
            ((5, 3), Leaf::Reprocess, Mapping::Serial),
            ((8, 4), Leaf::Reprocess, Mapping::Lanes),
        ] {
            shot.settings.packet = packet;
            shot.settings.leaf = leaf;
            shot.settings.mapping = mapping;
            check(
                gpu,
                &format!("staircase, {packet:?} {leaf:?} {mapping:?}"),
                &shot,
            );
        }
    });
}

#[test]
fn hierarchies_of_other_densities() {
    with_device(|gpu| {
        let mut shot = shot("staircase");
        shot.settings.split = 1;
        for density in [Density::Hsm, Density::Mssm] {
            shot.settings.hierarchy = density;
            check(gpu, &format!("staircase, {density}"), &shot);
        }
    });
}

#[test]
fn a_hierarchy_of_16_bits() {
    with_device(|gpu| {
        let mut shot = shot("staircase");
        shot.settings.split = 1;
        shot.settings.mssm_bits = 16;
        check(gpu, "staircase, bounds of 16 bits", &shot);
    });
}

#[test]
fn the_parallel_maps_of_a_sun() {
    with_device(|gpu| {
        for (name, angle_deg) in [("knot", 4.0), ("grid", 30.0)] {
            let mut shot = shot(name);
            shot.lights[0].shape = LightShape::Sun {
                direction: DVec3::new(0.5, -1.0, 0.2),
                angle_deg,
            };
            shot.settings.split = 2;
            check(gpu, &format!("{name} under a sun"), &shot);
        }
    });
}

#[test]
fn the_cones_of_a_sphere() {
    with_device(|gpu| {
        let mut shot = shot("grid");
        shot.lights[0].shape = LightShape::Sphere { radius: 0.3 };
        shot.settings.split = 1;
        check(gpu, "grid under a sphere", &shot);
    });
}
