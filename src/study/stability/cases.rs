//! The cases, each a departure from the plain stage.

use glam::DVec3;

use super::stage::{Case, Kind, MAP, Stage, rotated};
use crate::scene::Shape;

/// All cases. `large`: those as well that take a CPU driver minutes.
pub fn cases(large: bool) -> Vec<Case> {
    let mut all = contacts();
    all.extend(near_the_light());
    all.extend(lights());
    all.extend(spheres());
    all.extend(suns());
    all.extend(places());
    all.extend(grazing());
    all.extend(edges());
    all.extend(triangles());
    all.extend(closed());
    all.extend(sizes(large));
    all
}

/// An occluder that touches the receiver, or nearly so.
fn contacts() -> Vec<Case> {
    let gaps = (0..=7).map(|power| 10f64.powi(-power)).chain([0.0]);
    let plate = |gap: f64| Stage {
        // At 1 it would touch the light.
        plate_height: (gap * 2.0).min(1.9),
        ..Stage::default()
    };
    gaps.map(|gap| {
        plate(gap).case(
            "contact",
            format!("plate {gap:.0e} of the light's height above the ground"),
        )
    })
    .collect()
}

/// An occluder that touches or crosses the light's plane, and a receiver in it.
fn near_the_light() -> Vec<Case> {
    let gaps = (1..=7).map(|power| 10f64.powi(-power)).chain([0.0]);
    let plate = |gap: f64| Stage {
        plate_height: 2.0 - 2.0 * gap,
        plate_half: 0.2,
        ..Stage::default()
    };
    let mut all: Vec<Case> = gaps
        .map(|gap| {
            plate(gap).case(
                "near the light",
                format!("plate {gap:.0e} of the light's height below the light"),
            )
        })
        .collect();
    let crossing = Stage {
        plate_height: 2.0,
        plate_tilt: 80.0,
        ..Stage::default()
    };
    all.push(crossing.case("near the light", "plate across the light's plane"));
    let beside = Stage {
        plate_height: 2.0,
        plate_aside: 1.5,
        ..Stage::default()
    };
    all.push(beside.case("near the light", "receiver in the light's plane"));
    all.extend(louvres());
    all.extend(covers());
    all
}

/// Upright slats close below the light, along and across it, of which no two points of the light see the same.
fn louvres() -> Vec<Case> {
    let slat = |aside: f64, top: f64| {
        Shape::cuboid(
            DVec3::new(aside - 0.01, top - 0.07, -0.5),
            DVec3::new(aside + 0.01, top, 0.5),
        )
    };
    let louvre = |gap: f64, turn: f64| {
        let mut slats = Shape::default();
        for i in 0..6 {
            slats.append(&slat(0.2 * f64::from(i) - 0.5, 2.0 - gap));
        }
        for point in &mut slats.positions {
            *point = rotated(*point, DVec3::Y, turn);
        }
        Stage {
            more: slats,
            ..Stage::default()
        }
    };
    let gaps = [1e-6, 0.01, 0.03, 0.1, 0.2, 0.4];
    let name = |gap: f64, turn: f64| format!("slats {gap} below the light, turned by {turn}");
    gaps.iter()
        .map(|&gap| (gap, 0.0))
        .chain([(0.02, 40.0), (0.02, 45.0), (0.02, 90.0)])
        .map(|(gap, turn)| louvre(gap, turn).case("near the light", name(gap, turn)))
        .collect()
}

/// Plates before half of the light and before all of it, and a ceiling that the light is behind.
fn covers() -> Vec<Case> {
    let sheet = |name: &str, x: [f64; 2], half: f64, gap: f64| {
        let corner = |x: f64, z: f64| DVec3::new(x, 2.0 - gap, z);
        let mut more = Shape::square(1.0);
        for point in &mut more.positions {
            *point = corner(if point.x < 0.0 { x[0] } else { x[1] }, half * point.z);
        }
        let stage = Stage {
            more,
            ..Stage::default()
        };
        stage.case(
            "near the light",
            format!("{name} {gap:.0e} below the light"),
        )
    };
    let mut all = Vec::new();
    for gap in [1e-6, 1e-4, 1e-2] {
        all.push(sheet("cover", [-0.6, 0.6], 0.6, gap));
        all.push(sheet("cover of a half", [-0.6, 0.07], 0.6, gap));
    }
    all.push(sheet("ceiling", [-4.0, 4.0], 4.0, 1e-3));
    all
}

/// Lights from points to skies, and from squares to lines.
fn lights() -> Vec<Case> {
    let mut all = Vec::new();
    for power in -6..=3 {
        let half = 0.5 * 10f64.powi(power);
        let stage = |light_shape| Stage {
            light_half: (half, half),
            light_shape,
            ..Stage::default()
        };
        all.push(stage(Kind::Rect).case("light's size", format!("light of half width {half:.0e}")));
        if power % 3 == 0 {
            all.push(stage(Kind::Disc).case("light's size", format!("disc of radius {half:.0e}")));
        }
    }
    for power in 1..=4 {
        let stage = Stage {
            light_half: (0.5, 0.5 * 10f64.powi(-power)),
            ..Stage::default()
        };
        all.push(stage.case(
            "light's shape",
            format!("aspect 1:{}", 10i32.pow(power as u32)),
        ));
    }
    for (power, tilt) in [(0, 0.0), (2, 0.0), (4, 0.0), (4, 80.0)] {
        let stage = Stage {
            light_half: (0.5, 0.5 * 10f64.powi(-power)),
            light_tilt: tilt,
            light_shape: Kind::Triangle,
            ..Stage::default()
        };
        let name = format!(
            "triangle of 1:{}, tilted by {tilt}",
            10i32.pow(power as u32)
        );
        all.push(stage.case("light's shape", name));
    }
    let point = Stage {
        light_half: (0.0, 0.0),
        ..Stage::default()
    };
    all.push(point.case("light's size", "light without area"));
    all
}

/// Spheres that touch, cut and surround what they shine on.
fn spheres() -> Vec<Case> {
    let sphere = |radius: f64, height: f64| Stage {
        light_shape: Kind::Sphere,
        light_half: (radius, radius),
        light_height: height,
        ..Stage::default()
    };
    let beside = |radius: f64, height: f64| Stage {
        plate_aside: 0.9,
        plate_height: 0.3,
        ..sphere(radius, height)
    };
    vec![
        sphere(1e-6, 2.0).case("sphere", "sphere of radius 1e-6"),
        sphere(1.0, 2.0).case("sphere", "sphere that touches the plate"),
        sphere(1.3, 2.0).case("sphere", "sphere that the plate is in"),
        beside(0.5, 0.5 + 1e-6).case("sphere", "sphere 1e-6 above the ground"),
        beside(0.5, 0.5).case("sphere", "sphere that touches the ground"),
        beside(0.5, 0.2).case("sphere", "sphere that the ground cuts"),
        sphere(20.0, 2.0).case("sphere", "sphere around everything"),
        sphere(1e3, 1002.0).case("sphere", "sphere of radius 1e3"),
    ]
}

/// Suns from a point to half of the sky, and down to the horizon, where a wall casts the shadow.
fn suns() -> Vec<Case> {
    let sun = |angle_deg: f64, light_tilt: f64| Stage {
        light_shape: Kind::Sun { angle_deg },
        light_tilt,
        ..Stage::default()
    };
    let low = |angle_deg: f64, light_tilt: f64| Stage {
        plate_height: 0.0,
        plate_turn: 0.0,
        plate_tilt: 90.0,
        ..sun(angle_deg, light_tilt)
    };
    let high = [0.0, 1e-6, 0.533, 90.0, 179.0]
        .map(|angle| sun(angle, 30.0).case("sun", format!("sun of {angle} degrees")));
    let tilts = [
        (0.533, 60.0),
        (0.533, 89.0),
        (0.1, 89.9),
        (0.533, 89.9),
        (90.0, 89.9),
        (0.533, 90.0),
        (0.533, 120.0),
    ];
    let sinking = tilts.map(|(angle, tilt)| {
        let name = format!("sun of {angle} degrees {tilt} degrees from upright");
        low(angle, tilt).case("sun", name)
    });
    high.into_iter().chain(sinking).collect()
}

/// Small and large scenes, far from the origin, and with a large range of depths.
fn places() -> Vec<Case> {
    let mut all = Vec::new();
    for power in [-6, -3, 3, 6] {
        let stage = Stage {
            scale: 10f64.powi(power),
            ..Stage::default()
        };
        all.push(stage.case("place", format!("scale 1e{power}")));
    }
    for (name, offset) in [
        ("1e6 away along x", DVec3::X * 1e6),
        (
            "(148376, 1234, -223423) away",
            DVec3::new(148_376.0, 1234.0, -223_423.0),
        ),
    ] {
        let stage = Stage {
            offset,
            ..Stage::default()
        };
        all.push(stage.case("place", name));
    }
    let mut near = Shape::square(1e-7);
    near.positions
        .iter_mut()
        .for_each(|point| point.y = 2.0 - 2e-7);
    let stage = Stage {
        more: near,
        ..Stage::default()
    };
    all.push(stage.case("place", "depths from 1 to 1e7"));
    all
}

/// Surfaces nearly along the light's rays, and lights nearly along surfaces.
fn grazing() -> Vec<Case> {
    let wall = |degrees: f64| Stage {
        plate_tilt: degrees,
        plate_half: 0.8,
        plate_turn: 0.0,
        eye: DVec3::new(4.2, 2.6, 0.3),
        ..Stage::default()
    };
    let mut all: Vec<Case> = [60.0, 80.0, 89.0, 89.9, 90.0]
        .map(|degrees| wall(degrees).case("grazing", format!("plate tilted by {degrees} degrees")))
        .into();
    for degrees in [60.0, 80.0, 89.9] {
        let stage = Stage {
            light_tilt: degrees,
            light_height: 1.2,
            plate_aside: 0.8,
            plate_height: 0.5,
            ..Stage::default()
        };
        all.push(stage.case("grazing", format!("light tilted by {degrees} degrees")));
    }
    all
}

/// Edges through the light's centre, along its border and its diagonals, on texels and between them.
fn edges() -> Vec<Case> {
    let plate = |aside: f64, turn: f64| Stage {
        plate_aside: aside,
        plate_turn: turn,
        plate_half: 0.5,
        ..Stage::default()
    };
    let mut all: Vec<Case> = [("centre", 0.5), ("border", 0.25), ("corner", 0.0)]
        .map(|(where_, aside)| {
            plate(aside, 0.0).case("edge", format!("edge along the light's {where_}"))
        })
        .into();
    all.push(plate(0.5f64.sqrt(), 45.0).case("edge", "edges along the light's diagonals"));
    for share in [0.25, 0.5, 0.75] {
        let aside = 0.5 + share * 1.0 / f64::from(MAP);
        all.push(plate(aside, 0.0).case("edge", format!("edge {share} of a texel on")));
    }
    all
}

/// Meshes as they should not be.
fn triangles() -> Vec<Case> {
    let with = |more: Shape, name: &str| {
        let stage = Stage {
            more,
            ..Stage::default()
        };
        stage.case("triangles", name)
    };
    let lifted = |half: f64, height: f64| {
        let mut shape = Shape::square(half);
        shape
            .positions
            .iter_mut()
            .for_each(|point| point.y = height);
        shape
    };
    let mut twice = lifted(0.3, 0.6);
    twice.append(&lifted(0.3, 0.6));
    let mut needle = lifted(0.3, 0.6);
    needle
        .positions
        .iter_mut()
        .for_each(|point| point.z *= 1e-5);
    let mut flat = lifted(0.3, 0.6);
    flat.positions.iter_mut().for_each(|point| point.z = 0.0);
    // Three sheets that share an edge.
    let mut fan = lifted(0.3, 0.6);
    for degrees in [60.0, 120.0] {
        let mut sheet = Shape::square(0.3);
        for point in &mut sheet.positions {
            let along = *point + DVec3::X * 0.3;
            *point = rotated(along, DVec3::Z, degrees) + DVec3::new(-0.3, 0.6, 0.0);
        }
        fan.append(&sheet);
    }
    vec![
        with(twice, "every triangle twice"),
        with(needle, "needles"),
        with(flat, "triangles without area"),
        with(fan, "three sheets at an edge"),
    ]
}

/// Closed bodies, seen from inside: no light gets in.
fn closed() -> Vec<Case> {
    let inside = |more: Shape, name: &str| {
        let stage = Stage {
            more,
            plate_height: 0.1,
            plate_half: 0.05,
            eye: DVec3::new(0.0, 0.55, 0.35),
            target: DVec3::new(0.0, 0.45, -0.2),
            ..Stage::default()
        };
        stage.case("closed", name)
    };
    let ball = Shape::ball(0.6, 48);
    let cuboid = Shape::cuboid(DVec3::new(-0.6, 0.0, -0.6), DVec3::new(0.6, 1.1, 0.6));
    vec![inside(ball, "in a ball"), inside(cuboid, "in a box")]
}

/// Images and maps of all sizes, packets that hang over the border, many parts.
fn sizes(large: bool) -> Vec<Case> {
    let mut all = Vec::new();
    for size in [(1, 1), (1, 17), (31, 2), (47, 45)] {
        let stage = Stage {
            size,
            ..Stage::default()
        };
        all.push(stage.case("size", format!("image of {}x{}", size.0, size.1)));
    }
    let maps: &[u32] = match large {
        true => &[16, 17, 33, 1023, 4096, 8192],
        false => &[16, 17, 33, 1023],
    };
    for &map in maps {
        let mut stage = Stage::default();
        stage.changes.map = map;
        all.push(stage.case("size", format!("map of {map}")));
    }
    for packet in [(3, 5), (8, 8), (7, 1)] {
        let mut stage = Stage {
            size: (47, 45),
            ..Stage::default()
        };
        stage.changes.packet = Some(packet);
        all.push(stage.case("size", format!("packets of {}x{}", packet.0, packet.1)));
    }
    let mut stage = Stage::default();
    stage.changes.split = Some(16);
    all.push(stage.case("size", "256 parts"));
    all
}
