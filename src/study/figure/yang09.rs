//! [Yang09]: what is visited, how coherent packets are, and views against layers.

use super::check::{Check, all, number, numbers};
use super::row::{Curve, ERROR, ERROR_ASIDE, TIME, TIME_MAX, TIME_MIN, distinct, only_scene};
use super::{Candidate, Column, Experiment, Row, Trial, Truth};
use crate::Result;
use crate::scene::LightShape;
use crate::shot::{Overrides, Shot};
use crate::technique::{Leaf, Settings, Technique};

/// The light sizes of [Yang09 fig. 9], in the paper's own unit.
const LIGHTS: [f64; 3] = [40.0, 80.0, 160.0];
/// The share of coherent packets that the paper found with each.
const COHERENT: [f64; 3] = [0.52, 0.68, 0.88];
/// [share] How far from it counts as the same.
const COHERENT_NEAR: f64 = 0.15;

/// Single pixels that read every cell of their kernel, found by the MSSM.
pub const FLAT: &str = "every cell of the kernel (MSSM only)";
/// Single pixels that walk the MSSM.
pub const HIERARCHICAL: &str = "hierarchical contours";
const DU07: &str = "hierarchical micropatches (DU07)";
/// Packets of the paper's size that walk it.
pub const PACKETS: &str = "hierarchical contours, 3x3 packets";

pub const SAMPLES: Column = Column {
    name: "samples_read_per_penumbra_pixel",
    plotted: true,
    of: |row| row.per_penumbra_pixel("samples_read"),
};
pub const PLACES: Column = Column {
    name: "nodes_visited_per_penumbra_pixel",
    plotted: true,
    of: |row| row.per_penumbra_pixel("nodes_visited"),
};
const COHERENT_SHARE: Column = Column {
    name: "coherent_share",
    plotted: true,
    of: coherent_share,
};

/// Of the coherent packets, those whose pixels did see different contours.
const REPROCESSED_SHARE: Column = Column {
    name: "reprocessed_share",
    plotted: false,
    of: |row| row.count("reprocessed_packets") / row.count("coherent_packets"),
};

pub const FIG8: Experiment = Experiment {
    name: "yang09-fig8",
    source: "Yang et al. 2009, figure 8: visited shadow map samples per pixel",
    paper: "pictures of the number of samples visited per pixel, on one scene: hierarchical contours, hierarchical \
            micropatches of Dmitriev and Uralsky 2007, and kernels from the MSSM alone",
    claim: "hierarchical contours visit significantly fewer samples than both",
    here: "the built-in knot under square lights of the proportions of figure 9, 320x256 pixels, 256x256 map, one \
           view, no pruning by the light's footprint; counted by the device",
    missing: "",
    differs: "the scene is another one, and kernels grow with map and light: the smaller they are, the less there is \
              to prune; contours tell ground uphill from occluders sample by sample, where the paper's depth test takes \
              it for one",
    abscissa: "light_size",
    columns: &[SAMPLES, PLACES, ERROR_ASIDE],
    frames: 1,
    counters: true,
    takes_shots: false,
    trials: |scale, _| {
        let size = scale.pick((32, 24), (320, 256), (1280, 1024));
        let map = scale.pick(64, 256, 512);
        let lights = scale.pick(&LIGHTS[1..], &LIGHTS[..], &LIGHTS[..]);
        let techniques = [
            (HIERARCHICAL, hierarchical(map)),
            (PACKETS, packets(map)),
            (DU07, rival(Technique::MicropatchHierarchical, map)),
            (FLAT, rival(Technique::PixelContour, map)),
        ];
        let trial = |&light: &f64| knot(size, light, 64, &techniques);
        lights.iter().map(trial).collect()
    },
    judge: judge_fig8,
};

pub const FIG9: Experiment = Experiment {
    name: "yang09-fig9",
    source: "Yang et al. 2009, figure 9 and section 6: coherent packets over the size of the light",
    paper: "a scene under square lights of size 40, 80 and 160, 1280x1024 pixels, 3x3 packets, one view",
    claim: "52, 68 and 88 % of the packets that are not trivial are coherent",
    here: "the built-in knot under square lights of the same proportions, 256x256 map, one view, costs of an edge \
           and of its integration 4 and 2, in three image sizes up to the paper's",
    missing: "",
    differs: "by the paper's equation 5 alone a packet diverges the more likely, the more texels its kernel has, so the \
              share can only rise with the light where equation 6 decides, where small kernels hardly overlap: with \
              pixels that are large beside their kernels, and with a cost model that weighs sums over lookups; here \
              pixels are small beside them, and a projective depth range takes the place of equation 4's linear one",
    abscissa: "light_size",
    columns: &[COHERENT_SHARE, REPROCESSED_SHARE, ERROR_ASIDE],
    frames: 1,
    counters: true,
    takes_shots: false,
    trials: |scale, _| {
        let sizes = [(320, 256), (640, 512), (1280, 1024)];
        let sizes = scale.pick(&[(48, 36)][..], &sizes[..], &sizes[2..]);
        let map = scale.pick(64, 256, 512);
        let mut trials = Vec::new();
        for &size in sizes {
            for light in LIGHTS {
                // Of the error nothing is said; 16 rays are enough to see that the picture is right.
                trials.push(knot(size, light, 16, &[(PACKETS, packets(map))])?);
            }
        }
        Ok(trials)
    },
    judge: judge_fig9,
};

const SINGLE: &str = "one view (GBP07)";
const VIEWS_2: &str = "packets, S = 2";
const VIEWS_4: &str = "packets, S = 4";
const BITMASK: &str = "4 layers, bitmask (SS07)";
const PEELING: &str = "4 layers, depth peeling (BCS08)";

pub const FIG11: Experiment = Experiment {
    name: "yang09-fig11",
    source: "Yang et al. 2009, figure 11: several views against several layers",
    paper: "a scene where a single shadow map misses occluders, 1024x1024 maps: frames per second of one view \
            without packets and hierarchy (22), of packets with S = 2 (67) and 4 (18), of 4 layers of bitmasks (13) \
            and of depth peeling (14), pictures beside the mean of 1024 hard shadow maps",
    claim: "views give better quality than layers and are faster; S = 2 is three times as fast as one view without \
            packets and hierarchy",
    here: "the built-in staircase, made for this artefact, 64x64 pixels, 128x128 maps, 3x3 packets, no pruning by \
           the light's footprint; error against rays",
    missing: "",
    differs: "a CPU driver is slower at drawing and building maps than at looking things up, compared with a GPU, \
              and small images leave the maps, whose cost does not shrink with them, the larger share",
    abscissa: "maps",
    columns: &[ERROR, TIME, TIME_MIN, TIME_MAX],
    frames: 15,
    counters: false,
    takes_shots: false,
    trials: |scale, _| {
        let side = scale.pick(32, 64, 512);
        let map = scale.pick(64, 128, 1024);
        let overrides = Overrides {
            size: Some((side, side)),
            ..Overrides::default()
        };
        let views = |split| Settings {
            split,
            ..packets(map)
        };
        let layers = |technique| Settings {
            layers: 4,
            ..rival(technique, map)
        };
        Ok(vec![Trial {
            scene: "staircase".into(),
            shot: Shot::built_in("staircase", &overrides)?,
            truth: Truth::Rays,
            samples: scale.pick(64, 1024, 1024),
            candidates: vec![
                Candidate::new(SINGLE, 1.0, rival(Technique::PixelContour, map)),
                Candidate::new(VIEWS_2, 4.0, views(2)),
                Candidate::new(VIEWS_4, 16.0, views(4)),
                Candidate::new(BITMASK, 4.0, layers(Technique::Bitmask)),
                Candidate::new(PEELING, 4.0, layers(Technique::DepthPeeling)),
            ],
        }])
    },
    judge: judge_fig11,
};

/// Packets as the paper has them.
pub fn packets(map: u32) -> Settings {
    Settings {
        packet: (3, 3),
        leaf: Leaf::Reprocess,
        split: 1,
        map,
        footprint_pruning: false,
        ..Settings::published(Technique::PacketContour)
    }
}

/// Single pixels that walk the MSSM.
pub fn hierarchical(map: u32) -> Settings {
    Settings {
        hierarchical: true,
        ..rival(Technique::PixelContour, map)
    }
}

pub fn rival(technique: Technique, map: u32) -> Settings {
    Settings {
        map,
        ..Settings::published(technique)
    }
}

/// The knot under a square light, whose largest size is as wide as the shot's own disc.
pub fn knot(
    size: (u32, u32),
    light_size: f64,
    samples: u32,
    series: &[(&str, Settings)],
) -> Result<Trial> {
    let overrides = Overrides {
        size: Some(size),
        ..Overrides::default()
    };
    let mut shot = Shot::built_in("knot", &overrides)?;
    for light in &mut shot.lights {
        let (u, v, _) = light.frame();
        let half = light.half_size().0 * light_size / LIGHTS[2];
        light.shape = LightShape::Rect {
            u: u * half,
            v: v * half,
        };
    }
    let candidates = series.iter();
    Ok(Trial {
        scene: format!("knot, {}x{} pixels", size.0, size.1),
        shot,
        truth: Truth::Rays,
        samples,
        candidates: candidates
            .map(|(name, settings)| Candidate::new(*name, light_size, settings.clone()))
            .collect(),
    })
}

fn coherent_share(row: &Row) -> f64 {
    row.count("coherent_packets") / row.count("packets")
}

fn judge_fig8(rows: &[Row]) -> Vec<Check> {
    let scene = only_scene(rows);
    let against = |rival: &str, what: &str, value: fn(&Row) -> f64| {
        let curve = |series| Curve::of(rows, scene, series, value);
        let (own, other) = (curve(HIERARCHICAL), curve(rival));
        let ratios: Vec<f64> = own.0.iter().map(|p| other.at(p.0) / p.1).collect();
        Check::new(
            format!("at most half the {what} of: {rival}"),
            format!(
                "1/{}",
                numbers(ratios.iter().copied()).replace(", ", ", 1/")
            ),
            all(&ratios, |ratio| ratio >= 2.0),
        )
    };
    let mut checks = Vec::new();
    for rival in [DU07, FLAT] {
        checks.push(against(rival, "samples", SAMPLES.of));
        checks.push(against(rival, "places", PLACES.of));
    }
    checks
}

fn judge_fig9(rows: &[Row]) -> Vec<Check> {
    let scenes = distinct(rows, |row| &row.scene);
    let Some(largest) = scenes.last() else {
        return Vec::new();
    };
    let curve = Curve::of(rows, largest, PACKETS, coherent_share);
    let found = numbers(curve.0.iter().map(|point| 100.0 * point.1)) + " %";
    let near = |(light, paper): (&f64, &f64)| (curve.at(*light) - paper).abs() <= COHERENT_NEAR;
    vec![
        Check::new(
            format!("the share rises with the light in every step ({largest})"),
            found.clone(),
            curve.trend() == 1.0,
        ),
        Check::new(
            "each share is within 15 points of 52, 68 and 88 %",
            found,
            LIGHTS.iter().zip(&COHERENT).all(near),
        ),
    ]
}

fn judge_fig11(rows: &[Row]) -> Vec<Check> {
    let value = |series: &str, value: fn(&Row) -> f64| {
        let row = rows.iter().find(|row| row.series == series);
        row.map_or(f64::NAN, value)
    };
    let less = |claim: &str, series: &str, others: &[&str], unit, of: fn(&Row) -> f64| {
        let own = value(series, of);
        let others: Vec<f64> = others.iter().map(|other| value(other, of)).collect();
        Check::new(
            claim,
            format!(
                "{}{unit} against {}{unit}",
                number(own),
                numbers(others.iter().copied())
            ),
            all(&others, |other| own < other),
        )
    };
    let layers = [BITMASK, PEELING];
    vec![
        less(
            "S = 4 errs less than layers",
            VIEWS_4,
            &layers,
            "",
            Row::error,
        ),
        less(
            "S = 2 errs less than one view",
            VIEWS_2,
            &[SINGLE],
            "",
            Row::error,
        ),
        less(
            "S = 4 is faster than layers",
            VIEWS_4,
            &layers,
            " ms",
            Row::ms,
        ),
        less(
            "S = 2 is faster than one view without packets and hierarchy",
            VIEWS_2,
            &[SINGLE],
            " ms",
            Row::ms,
        ),
    ]
}
