//! Calibration: the search on a synthetic cost, and the command with its stored file.

use std::cell::Cell;
use std::path::Path;
use std::process::{Command, Output};

use halfshade::calibrate::{Measured, Thoroughness, race, search_costs, winner};
use halfshade::gpu::{DeviceInfo, list_devices};
use halfshade::shared::Costs;
use serde_json::{Value, json};
use tempfile::TempDir;

const SEARCH: Thoroughness = Thoroughness {
    grid: 5,
    grid_rounds: 3,
    rounds: 7,
    races_max: 12,
};
/// Cheapest costs of the synthetic device, and what they cost it.
const BEST: Costs = Costs {
    edge: 11.0,
    visibility: 0.6,
};
const BEST_MS: f64 = 20.0;

/// A bowl in log space, a tenth more an octave away from its bottom.
fn bowl(costs: &Costs) -> f64 {
    let octaves = |a: f32, b: f32| f64::from(a / b).log2();
    let [e, v] = [
        octaves(costs.edge, BEST.edge),
        octaves(costs.visibility, BEST.visibility),
    ];
    BEST_MS * (1.0 + 0.1 * (e * e + v * v + 0.5 * e * v))
}

/// [-1, 1] The same sequence every time.
fn noise(count: u64) -> f64 {
    let mixed = (count + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed >> 32) as f64 / f64::from(u32::MAX) * 2.0 - 1.0
}

/// A search with `share` of noise and as much drift, both relative. Returns the costs and how often it
/// measured.
fn found(share: f64, start: Costs, function: &dyn Fn(&Costs) -> f64) -> (Costs, usize) {
    let count = Cell::new(0u64);
    let result = search_costs(start, SEARCH, &|| true, &mut |costs| {
        let turn = count.get();
        count.set(turn + 1);
        let drift = 1.0 + share * (turn as f64 / 60.0).sin();
        Ok(function(costs) * drift * (1.0 + share * noise(turn)))
    });
    let costs = result.expect("nothing fails").costs;
    (costs, count.get() as usize)
}

const START: Costs = Costs {
    edge: 4.0,
    visibility: 2.0,
};

#[test]
fn the_search_finds_the_minimum_without_noise() {
    let (costs, count) = found(0.0, START, &bowl);
    assert!(bowl(&costs) < BEST_MS * 1.01, "{costs:?}");
    assert!(count <= SEARCH.measurements_max(), "{count}");
}

#[test]
fn the_search_finds_the_minimum_in_noise_and_drift() {
    for share in [0.02, 0.05] {
        let (costs, _) = found(share, START, &bowl);
        assert!(
            bowl(&costs) < BEST_MS * (1.0 + 2.0 * share),
            "{share}: {costs:?}, {}",
            bowl(&costs)
        );
    }
}

#[test]
fn noise_alone_replaces_nothing() {
    for share in [0.0, 0.03, 0.2] {
        let (costs, _) = found(share, START, &|_| BEST_MS);
        assert_eq!(costs, START, "{share}");
    }
}

#[test]
fn without_time_nothing_is_measured() {
    let mut measure = |_: &Costs| panic!("there is no time for this");
    let found = search_costs(START, SEARCH, &|| false, &mut measure).expect("nothing fails");
    assert_eq!((found.costs, found.races.len()), (START, 0));
}

#[test]
fn a_race_turns_round_and_compares_within_rounds() {
    let mut order = Vec::new();
    let mut measure = |candidate: &f64| {
        order.push(*candidate);
        // The machine slows down tenfold from one round to the next.
        Ok(candidate * 10f64.powi((order.len() as i32 - 1) / 3))
    };
    let measured = race(&[1.0, 0.9, 0.8], 4, &|| true, &mut measure).expect("nothing fails");
    assert_eq!(order[..6], [1.0, 0.9, 0.8, 0.8, 0.9, 1.0]);
    assert_eq!(winner(&measured), 2);
    let entry = |costs: &[f64]| Measured {
        candidate: (),
        costs: costs.to_vec(),
    };
    assert_eq!(entry(&[3.0, 1.0, 2.0, 9.0]).median(), 2.5);
    assert_eq!(entry(&[3.0, 1.0, 2.0, 9.0]).spread(), 1.0);
    assert!(!entry(&[1.0; 5]).beats(&entry(&[1.001; 5])));
}

/// A folder that stands for the user's home, with a tiny shot in it.
struct Home(TempDir);

impl Home {
    fn new() -> Self {
        let home = Self(tempfile::tempdir().expect("a folder"));
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        let shot = json!({
            "scene": scenes.join("colonnade.glb"),
            "camera": {"eye": [0.7, 1.75, 7.6], "target": [-0.75, 1.75, 0], "vfov_deg": 56,
                "width": 16, "height": 16},
        });
        std::fs::write(home.shot(), shot.to_string()).expect("a file");
        home
    }

    fn shot(&self) -> std::path::PathBuf {
        self.0.path().join("shot.json")
    }

    fn run(&self, arguments: &[&str]) -> Output {
        Command::new(env!("CARGO_BIN_EXE_halfshade"))
            .args(arguments)
            .arg(self.shot())
            .current_dir(self.0.path())
            .env("HOME", self.0.path())
            .env("XDG_DATA_HOME", self.0.path().join("data"))
            .env("XDG_CACHE_HOME", self.0.path().join("cache"))
            // Mesa's compiled shaders are no part of what is tested, and take long to compile.
            .env("MESA_SHADER_CACHE_DIR", env!("CARGO_TARGET_TMPDIR"))
            .output()
            .expect("the program runs")
    }

    fn stored(&self) -> std::path::PathBuf {
        let file = format!("calibration-{}.json", default_device().uuid);
        self.0.path().join("data/halfshade").join(file)
    }

    fn store(&self, text: &str) {
        std::fs::create_dir_all(self.stored().parent().expect("a folder")).expect("a folder");
        std::fs::write(self.stored(), text).expect("a file");
    }

    /// The settings that `render` used, and what it said on stderr.
    fn settings_of_render(&self) -> (Value, String) {
        let flags = ["render", "--split", "1", "--map", "64", "--stats", "s.json"];
        let output = self.run(&flags);
        assert_clean(&output);
        let stats = std::fs::read(self.0.path().join("s.json")).expect("stats");
        let stats: Value = serde_json::from_slice(&stats).expect("JSON");
        (stats["settings"].clone(), text(&output.stderr))
    }
}

/// The one that the program picks, of those that can run the engine.
fn default_device() -> DeviceInfo {
    let kinds = ["discrete", "integrated", "virtual", "cpu", "other"];
    let devices = list_devices().expect("Vulkan");
    let able = devices.into_iter().filter(|info| info.missing.is_empty());
    able.min_by_key(|info| kinds.iter().position(|&kind| kind == info.kind))
        .expect("a device")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn assert_clean(output: &Output) {
    assert!(output.status.success(), "{}", text(&output.stderr));
}

fn example() -> Value {
    let info = default_device();
    json!({
        "format": 2, "device": info.name, "driver": info.driver, "version": "0.0.0", "measured": [],
        "calibration": {"edge_cost": 3.5, "visibility_cost": 0.25, "packet": [2, 3],
            "leaf": "reprocess", "mapping": "lanes"},
    })
}

#[test]
fn what_is_stored_is_what_render_uses() {
    let home = Home::new();
    home.store(&example().to_string());
    let (settings, said) = home.settings_of_render();
    assert_eq!(settings["packet"], json!([2, 3]));
    assert_eq!(settings["leaf"], "reprocess");
    assert_eq!(settings["mapping"], "lanes");
    assert!(!said.contains("calibration"), "{said}");
}

#[test]
fn what_is_wrong_is_ignored_with_a_note() {
    let home = Home::new();
    let (defaults, _) = home.settings_of_render();
    let changed = |key: &str, field: &str, value: Value| {
        let mut json = example();
        match key {
            "" => json[field] = value,
            _ => json[key][field] = value,
        }
        json.to_string()
    };
    let wrong = [
        "{".to_owned(),
        "null".to_owned(),
        example()["calibration"].to_string(),
        changed("", "format", json!(0)),
        changed("", "driver", json!("another driver")),
        changed("", "mood", json!("good")),
        changed("calibration", "mood", json!("good")),
        changed("calibration", "packet", json!([9, 9])),
        changed("calibration", "packet", json!([0, 4])),
        changed("calibration", "edge_cost", json!(0)),
        changed("calibration", "edge_cost", json!(-1)),
        changed("calibration", "visibility_cost", json!(null)),
        changed("calibration", "visibility_cost", json!(1e300)),
        changed("calibration", "edge_cost", json!(3.5)).replace("3.5", "NaN"),
    ];
    for file in wrong {
        home.store(&file);
        let (settings, said) = home.settings_of_render();
        assert_eq!(settings, defaults, "{file}");
        let notes = said.lines().filter(|line| line.contains("calibration"));
        assert_eq!(notes.count(), 1, "{file}: {said}");
    }
}

#[test]
fn a_quick_dry_run_is_clean_and_stores_nothing() {
    let home = Home::new();
    let output = home.run(&[
        "calibrate",
        "--quick",
        "--dry-run",
        "--validate",
        "--seconds",
        "600",
    ]);
    assert_clean(&output);
    let said = text(&output.stdout);
    for part in ["median ms", "cost model 1", "chosen: packet", "not stored"] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!home.stored().exists());
    assert!(!text(&output.stderr).contains('\u{1b}'));
}

#[test]
fn a_quick_run_is_stored_and_then_used() {
    let home = Home::new();
    assert_clean(&home.run(&["calibrate", "--quick", "--seconds", "1"]));
    let stored = std::fs::read(home.stored()).expect("a stored calibration");
    let stored: Value = serde_json::from_slice(&stored).expect("JSON");
    let info = default_device();
    assert_eq!(stored["device"], info.name);
    assert_eq!(stored["driver"], info.driver);
    assert_eq!(stored["version"], env!("CARGO_PKG_VERSION"));
    let rows = stored["measured"].as_array().expect("a table");
    assert!(rows.len() >= 3, "{rows:?}");
    assert!(rows.iter().all(|row| row["ratio"].as_f64() >= Some(1.0)));
    let (settings, said) = home.settings_of_render();
    for field in ["packet", "leaf", "mapping"] {
        assert_eq!(settings[field], stored["calibration"][field]);
    }
    assert!(!said.contains("calibration"), "{said}");
}
