//! Effects in a host's frames give what the renderer gives, and recording them takes no memory.

#[path = "../support/gpu.rs"]
mod gpu;
mod host;
mod kinds;
mod painter;
mod rounded;
mod stage;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use glam::{DMat4, DVec3};
use halfshade::frame::Casters;
use halfshade::gpu::Gpu;
use halfshade::plan::{HostFrame, plan_for_host};
use halfshade::render::{
    DEFAULT_COSTS, DrawnView, Effect, FrameInput, GivenMap, Mesh, MeshInstance, SlotImages,
};
use halfshade::scene::{AreaLight, LightShape};
use halfshade::shared::NORMAL_SIGNED;
use halfshade::technique::{Evaluate, Settings, Technique};

use host::{Host, with_host};
use stage::Stage;

/// Counts what is allocated while it is told to.
struct Counting;

static COUNTS: AtomicBool = AtomicBool::new(false);
static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if COUNTS.load(Ordering::Relaxed) {
            ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        }
        // SAFETY: the caller's promise.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise.
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

const SIDE: u32 = 48;
const PIXELS: usize = (SIDE * SIDE) as usize;
const BACKGROUND: f32 = 0.25;
const IDENTITY: [[f32; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn settings(split: u32) -> Settings {
    Settings {
        split,
        map: 64,
        // A host's casters are not known when its frames are planned.
        near_points: 0,
        ..Settings::default()
    }
}

/// What the host does for the casters itself.
struct OwnCasters<'a> {
    near: f32,
    maps: &'a [GivenMap],
    draw: Option<&'a mut dyn FnMut(DrawnView)>,
}

/// Nothing: casters may be any distance away, and there are no maps.
impl Default for OwnCasters<'_> {
    fn default() -> Self {
        Self {
            near: 0.1,
            maps: &[],
            draw: None,
        }
    }
}

/// A frame of meshes that stand in the world as they are.
fn with_frame<T>(
    light: &AreaLight,
    meshes: usize,
    serial: u64,
    own: OwnCasters,
    work: impl FnOnce(&mut FrameInput) -> T,
) -> T {
    let transform = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
    ];
    let mut instances = (0..meshes).map(|mesh| MeshInstance { mesh, transform });
    let mut maps = own.maps.iter().copied();
    work(&mut FrameInput {
        serial,
        slot: 0,
        light: light.clone(),
        world_from_clip: DMat4::IDENTITY.as_mat4().to_cols_array_2d(),
        normal_to_world: IDENTITY,
        normal_encoding: NORMAL_SIGNED,
        depth_empty: 0.0,
        background: BACKGROUND,
        position_error: 0.0,
        instances: &mut instances,
        near: own.near,
        maps: &mut maps,
        draw: own.draw.map(|draw| draw as &mut dyn FnMut(DrawnView)),
    })
}

/// Records a frame and submits it; the number of allocations while it was recorded.
fn record(host: &Host, effect: &mut Effect, frame: &mut FrameInput) -> usize {
    host.begin();
    ALLOCATIONS.store(0, Ordering::Relaxed);
    COUNTS.store(true, Ordering::Relaxed);
    // SAFETY: the command buffer is recording, and the images are at rest.
    let recorded = unsafe { effect.record(host.commands, frame) };
    COUNTS.store(false, Ordering::Relaxed);
    recorded.expect("a frame");
    host.submit();
    ALLOCATIONS.load(Ordering::Relaxed)
}

fn visibility(host: &mut Host, slot: &SlotImages) -> Vec<f32> {
    bytemuck::pod_collect_to_vec(&host.read(&slot.visibility, 4 * PIXELS))
}

/// The expected image with the background where there is no surface.
fn exported(expected: &[f32]) -> Vec<f32> {
    let of = |value: &f32| if value.is_nan() { BACKGROUND } else { *value };
    expected.iter().map(of).collect()
}

/// An effect that is prepared for one slot of images.
fn prepared(host: &Host, frame: HostFrame, slot: &SlotImages, meshes: &[Mesh]) -> Effect {
    let gpu = host.adopted();
    let mut effect = Effect::new(&gpu, frame, DEFAULT_COSTS).expect("an effect");
    // SAFETY: all is of this device, as described, and outlives the effect.
    unsafe { effect.prepare(std::slice::from_ref(slot), meshes) }.expect("prepared");
    effect
}

/// Meshes in a host's buffers, against the renderer of the same scene.
fn check_meshes(host: &mut Host, stage: &Stage) {
    let seen = |test: fn(f32) -> bool| stage.expected.iter().any(|value| test(*value));
    assert!(seen(f32::is_nan) && seen(|value| value > 0.0 && value < 1.0));
    let slot = stage.slot(host, Vec::new());
    let meshes = stage.meshes(host);
    let mut effect = prepared(host, stage.frame(Casters::Gathered), &slot, &meshes);
    for serial in 1..=2 {
        let allocations = with_frame(&stage.light(), 3, serial, OwnCasters::default(), |frame| {
            record(host, &mut effect, frame)
        });
        assert_eq!(allocations, 0, "recording takes no memory");
        let found = visibility(host, &slot);
        assert!(
            gpu::same_bits(&found, &exported(&stage.expected)),
            "frame {serial} differs"
        );
    }
    check_collecting(host, stage, &mut effect, &slot, &meshes);
}

// All in one test: the counter counts what the whole program allocates.
#[test]
fn effects_give_what_the_renderer_gives() {
    with_host(|host| {
        let gpu = host.gpu.clone();
        let stage = Stage::new(&gpu, settings(1), |_| {});
        assert!(stage.side_faces);
        check_meshes(host, &stage);
        kinds::check_maps(host, &stage);
        kinds::check_depths(host, &stage);
        kinds::check_normals(host, &stage);
        let round = LightShape::Disc {
            normal: DVec3::NEG_Y,
            radius: 0.7,
        };
        let stage = Stage::new(&gpu, settings(2), |light| light.shape = round);
        check_meshes(host, &stage);
        // A polygon's sides stay what they were planned for, wherever it goes.
        let corners = [[-0.7, -0.5], [0.8, -0.4], [0.1, 0.7]].map(|[x, z]| DVec3::new(x, 0.0, z));
        let (_, triangle) = LightShape::polygon(&corners).expect("a polygon");
        let stage = Stage::new(&gpu, settings(2), |light| light.shape = triangle);
        check_meshes(host, &stage);
        refuses_other_outlines(&gpu, &stage);
        let joining = Settings {
            evaluate: Evaluate::Quarter,
            ..settings(1)
        };
        let side_by_side = Settings {
            views_at_once: Some(3),
            ..settings(2)
        };
        for settings in [joining, side_by_side] {
            let stage = Stage::new(&gpu, settings, |_| {});
            check_meshes(host, &stage);
        }
        // Maps of the bottoms and of the receivers are drawn from meshes as well, and from nothing else.
        let scattered = Settings {
            technique: Technique::OccluderDriven,
            two_sided: true,
            ..settings(1)
        };
        let stage = Stage::new(&gpu, scattered, |_| {});
        check_meshes(host, &stage);
        for casters in [Casters::DrawnByHost, Casters::Maps] {
            let refused = Effect::new(&host.adopted(), stage.frame(casters), DEFAULT_COSTS);
            let message = refused.err().map(|error| error.to_string());
            assert!(message.is_some_and(|message| message.contains("give meshes")));
        }
        // So near above the plate that its shadow reaches where the side faces look. Maps of the whole region that
        // casters may be in have larger texels than those that the device fits to casters that it knows.
        let fine = Settings {
            map: 512,
            ..settings(1)
        };
        let stage = Stage::new(&gpu, fine, |light| {
            light.center.y = 1.7;
            light.shape = LightShape::Rect {
                u: DVec3::X * 0.2,
                v: DVec3::Z * 0.2,
            };
        });
        kinds::check_side_faces(host, &stage);
        rounded::check(host, &gpu);
    });
}

fn refuses_other_outlines(gpu: &Gpu, stage: &Stage) {
    let frame = stage.frame(Casters::Gathered);
    let mut plan = plan_for_host(&frame, &gpu.limits).expect("a plan");
    let with = |corners: &[DVec3]| {
        let (center, shape) = LightShape::polygon(corners).expect("a polygon");
        AreaLight {
            center,
            shape,
            ..frame.light.clone()
        }
    };
    let corners = [[-0.7, -0.5], [0.8, -0.4], [0.1, 0.7]].map(|[x, z]| DVec3::new(x, z, 3.0));
    assert!(plan.place(&with(&corners)).is_ok());
    let wider = corners.map(|corner| corner * DVec3::new(2.0, 1.0, 1.0));
    assert!(plan.place(&with(&wider)).is_err());
    let square = [DVec3::ZERO, DVec3::X, DVec3::ONE, DVec3::Y + DVec3::Z];
    assert!(plan.place(&with(&square)).is_err());
}

/// The matrix that a view's map was drawn with (`shadow_map.vert`).
fn clip_from_world(stage: &Stage) -> [[f32; 4]; 4] {
    let (view, fit) = (&stage.view, &stage.fit);
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let (right, up, forward) = (vector(view.right), vector(view.up), vector(view.forward));
    let scale = 2.0 / f64::from(view.map_size);
    let row = |axis: DVec3, focal: f32, center: f32| {
        scale * (f64::from(focal) * axis + (f64::from(center) + 0.5) * forward) - forward
    };
    let rows = [
        row(right, fit.focal[0], fit.center[0]),
        row(up, fit.focal[1], fit.center[1]),
        DVec3::ZERO,
        forward,
    ];
    let moved = |row: DVec3| row.extend(-row.dot(vector(view.center)));
    let mut rows = rows.map(moved);
    rows[2].w = f64::from(fit.near);
    let [x, y, z, w] = rows;
    DMat4::from_cols(x, y, z, w)
        .transpose()
        .as_mat4()
        .to_cols_array_2d()
}

/// What earlier frames use stays until it is collected, and serials do not go down.
fn check_collecting(
    host: &mut Host,
    stage: &Stage,
    effect: &mut Effect,
    slot: &SlotImages,
    meshes: &[Mesh],
) {
    // SAFETY: as in `prepared`.
    let prepare = |effect: &mut Effect| {
        unsafe { effect.prepare(std::slice::from_ref(slot), meshes) }.expect("prepared");
    };
    let once = effect.memory_bytes();
    prepare(effect);
    assert_eq!(effect.memory_bytes(), 2 * once, "frame 2 may be under way");
    effect.collect(1).expect("it was recorded");
    assert_eq!(effect.memory_bytes(), 2 * once);
    let early = effect
        .collect(1_000_000_000)
        .expect_err("it was not recorded");
    assert!(
        early
            .to_string()
            .contains("the last that was recorded is 2")
    );
    effect.collect(2).expect("it was recorded");
    assert_eq!(effect.memory_bytes(), once);
    prepare(effect);
    assert_eq!(effect.memory_bytes(), once, "no frame has used the last");
    let refused = |effect: &mut Effect, meshes, serial| {
        with_frame(
            &stage.light(),
            meshes,
            serial,
            OwnCasters::default(),
            |frame| {
                // SAFETY: nothing is recorded.
                let refused = unsafe { effect.record(host.commands, frame) };
                refused.expect_err("it makes no sense").to_string()
            },
        )
    };
    assert!(refused(effect, 3, 1).contains("do not go down"));
    assert!(refused(effect, 4, 6).contains("no mesh 3"));
}
