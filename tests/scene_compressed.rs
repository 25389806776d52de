//! Geometry that is compressed is that of the file that is not, and a broken stream is an error of one sentence.

mod support;

#[path = "support/compressed.rs"]
mod compressed;

use compressed::{DRACO_BITS, Meshopt, SIZE, draco, plain};
use halfshade::scene::Scene;
use serde_json::json;
use support::*;

/// How far the corners of two scenes' triangles are apart at most; these may be in another order, and begin with another corner.
fn distance(found: &Scene, wanted: &Scene) -> f64 {
    let apart = |a: [f64; 3], b: [f64; 3]| {
        let differences = a.into_iter().zip(b).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max)
    };
    let turned = |[a, b, c]: [[f64; 3]; 3]| [[a, b, c], [b, c, a], [c, a, b]];
    let between = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        let corners = a.into_iter().zip(b).map(|(a, b)| apart(a, b));
        corners.fold(0.0, f64::max)
    };
    let wanted = corners(wanted);
    assert_eq!(found.triangles.len(), wanted.len());
    let nearest = |triangle: [[f64; 3]; 3]| {
        let all = wanted.iter().flat_map(|&other| turned(other));
        all.map(|other| between(triangle, other))
            .fold(f64::INFINITY, f64::min)
    };
    corners(found).into_iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn what_meshoptimizer_compresses_is_the_same() {
    let wanted = plain().load().unwrap();
    let khronos = "KHR_meshopt_compression";
    for kind in [
        Meshopt::USUAL,
        Meshopt {
            versions: [0, 0],
            indices: "INDICES",
            ..Meshopt::USUAL
        },
        Meshopt {
            extension: khronos,
            versions: [1, 1],
            ..Meshopt::USUAL
        },
    ] {
        let found = kind.compress().load().unwrap();
        assert_eq!(distance(&found, &wanted), 0.0, "{kind:?}");
        assert!(!noted(&found, "not supported"), "{:?}", found.notes);
    }
}

/// With 15 bits a mantissa is off by half a step of 2⁻¹⁴ of its number at most.
#[test]
fn filtered_positions_are_as_exact_as_their_mantissas() {
    let filtered = Meshopt {
        exponential: Some(15),
        ..Meshopt::USUAL
    };
    let found = filtered.compress().load().unwrap();
    let apart = distance(&found, &plain().load().unwrap());
    assert!(
        apart > 0.0 && apart <= f64::from(SIZE) * 2f64.powi(-14),
        "{apart}"
    );
}

/// Draco numbers steps over the longest side: half a step, and the rounding of 32 bits.
#[test]
fn what_draco_compresses_is_the_same_but_for_its_quantization() {
    let wanted = plain().load().unwrap();
    let step = f64::from(SIZE) / (2f64.powi(DRACO_BITS) - 1.0);
    for level in [0, 5, 7, 10] {
        let found = draco(level).load().unwrap();
        let apart = distance(&found, &wanted);
        assert!(apart > 0.0 && apart < 0.51 * step, "level {level}: {apart}");
        assert!(!noted(&found, "not supported"), "{:?}", found.notes);
    }
}

#[test]
fn broken_streams_are_refused_in_a_sentence() {
    let told = |gltf: &Gltf, text: &str| {
        let message = gltf.error();
        assert!(message.contains(text), "{message}");
    };
    let good = Meshopt::USUAL.compress();
    let extension = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut gltf = good.clone();
        change(&mut gltf.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]);
        gltf
    };
    told(
        &extension(&|json| json["mode"] = "POINTS".into()),
        "meshopt compression",
    );
    told(
        &extension(&|json| json["byteLength"] = 8.into()),
        "cannot be undone",
    );
    told(
        &extension(&|json| json["byteOffset"] = u64::MAX.into()),
        "do not fit",
    );
    told(
        &extension(&|json| json["buffer"] = 77.into()),
        "does not exist",
    );
    told(
        &extension(&|json| json["byteStride"] = 7.into()),
        "cannot be undone",
    );
    told(
        &extension(&|json| json["count"] = (1u64 << 40).into()),
        "--max-expansion",
    );

    let good = draco(7);
    let extension = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut gltf = good.clone();
        let primitive = &mut gltf.json["meshes"][0]["primitives"][0];
        change(&mut primitive["extensions"]["KHR_draco_mesh_compression"]);
        gltf
    };
    told(
        &extension(&|json| json["bufferView"] = 77.into()),
        "does not exist",
    );
    told(
        &extension(&|json| json["attributes"]["POSITION"] = 9.into()),
        "has no attribute 9",
    );
    told(
        &extension(&|json| json["attributes"] = json!(3)),
        "Draco compression",
    );
    told(
        &extension(&|json| {
            json["attributes"]["POSITION"] = json["attributes"]["TEXCOORD_0"].clone()
        }),
        "must not have",
    );
    let mut short = good.clone();
    short.json["bufferViews"][0]["byteLength"] = 40.into();
    told(&short, "cannot be undone");
    let mut garbled = good.clone();
    garbled.bytes[0] = 0;
    told(&garbled, "cannot be undone");
}
