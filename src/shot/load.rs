//! Shot files (JSON), and glTF files that bring their own camera and lights.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::{DVec3, Vec3};
use serde::Deserialize;
use serde::de::IgnoredAny;

use super::{MAX_SIZE, Settings, Shot, budget_map};
use crate::scene::gltf::{self, Blend, Limits, LoadOptions};
use crate::scene::{
    AreaLight, Beam, Camera, LightShape, MAX_COORDINATE, SUN_ANGLE_DEG, Scene, file,
};
use crate::{Error, Result};

/// [pixel] Height (and without an aspect ratio, width) of an image for which nobody states a size.
const DEFAULT_HEIGHT: u32 = 512;

/// Keys of a shot file that say something to people.
const FOR_PEOPLE: [&str; 2] = ["name", "what"];

/// What a caller states over the heads of the files.
#[derive(Debug, Clone, Default)]
pub struct Overrides {
    /// [pixel] Width and height.
    pub size: Option<(u32, u32)>,
    /// [scene units] ≥ 0. Point and spot lights of the scene become spheres of this radius.
    pub radius: Option<f64>,
    /// [degree] \[0, 180) Angular diameter of the scene's directional lights.
    pub sun_angle_deg: Option<f64>,
    /// Which scene of the glTF, counted from 0.
    pub scene_index: Option<usize>,
    /// Which camera of the scene, counted from 0. A camera in the shot file goes before it.
    pub camera_index: Option<usize>,
    /// An image of shares of the budget, in place of the shot file's ([`Shot::budget_map`]).
    pub budget_map: Option<PathBuf>,
    /// A glTF may name files outside of its own folder.
    pub outside_paths: bool,
    /// What surfaces of a glTF are that blend with what is behind them.
    pub blend: Blend,
    /// A glTF's materials whose texture decides where light passes are opaque where it cannot be read.
    pub allow_missing: bool,
    /// What a glTF may ask for at most.
    pub limits: Limits,
}

#[derive(Deserialize)]
struct ShotFile {
    scene: String,
    casters: Option<Vec<String>>,
    budget_map: Option<PathBuf>,
    camera: Option<CameraFile>,
    light: Option<LightFile>,
    lights: Option<Vec<LightFile>>,
}

#[derive(Deserialize)]
struct CameraFile {
    eye: [f64; 3],
    target: [f64; 3],
    #[serde(default = "y_axis")]
    up: [f64; 3],
    vfov_deg: Option<f64>,
    ortho_height: Option<f64>,
    width: Option<u32>,
    height: Option<u32>,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum LightKind {
    Rect,
    Disc,
    Polygon,
    Sphere,
    Sun,
}

#[derive(Deserialize)]
struct LightFile {
    #[serde(rename = "type")]
    kind: LightKind,
    /// Of all but polygons and suns.
    center: Option<[f64; 3]>,
    u: Option<[f64; 3]>,
    v: Option<[f64; 3]>,
    normal: Option<[f64; 3]>,
    radius: Option<f64>,
    corners: Option<Vec<[f64; 3]>>,
    direction: Option<[f64; 3]>,
    angle_deg: Option<f64>,
    /// [degree] Inner and outer, from the direction of a disc's normal or of a sphere's "direction".
    cone_deg: Option<[f64; 2]>,
    #[serde(default = "white")]
    color: [f32; 3],
    intensity: Option<f32>,
    texture: Option<serde_json::Value>,
}

fn y_axis() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

impl Shot {
    /// Reads a shot file, or a .gltf or .glb that brings its own camera and light; which of them it is,
    /// its contents tell. The settings are the defaults. A shot file without camera or lights takes
    /// those of its scene.
    ///
    /// # Errors
    /// When a file cannot be read or what it describes cannot be rendered.
    pub fn load(path: &Path, overrides: &Overrides) -> Result<Shot> {
        let mut draft = Draft::parse(path, &file::read(path)?, overrides)?;
        draft.scene.files.push(path.into());
        Self::completed(draft, path, overrides)
    }

    /// As [`Self::load`], from bytes that were read from `path` before.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn parse(path: &Path, bytes: &[u8], overrides: &Overrides) -> Result<Shot> {
        Self::completed(Draft::parse(path, bytes, overrides)?, path, overrides)
    }

    /// A glTF that is already in memory and brings its own camera and light; `path` names it in messages
    /// and is where files that it refers to are looked for.
    ///
    /// # Errors
    /// When it is malformed, refers to a file that cannot be read, or cannot be rendered.
    pub fn from_gltf(path: &Path, bytes: &[u8], overrides: &Overrides) -> Result<Shot> {
        Self::completed(Draft::of_gltf(path, bytes, overrides)?, path, overrides)
    }

    fn completed(mut shot: Draft, path: &Path, overrides: &Overrides) -> Result<Shot> {
        if let Some(size) = overrides.size {
            shot.size = size.into();
        }
        if overrides.budget_map.is_some() {
            shot.budget_map.clone_from(&overrides.budget_map);
        }
        let shot = shot.finish(path, overrides)?;
        match shot.validate() {
            Err(Error::Invalid(message)) => Err(Error::parse(path, message)),
            other => other.map(|()| shot),
        }
    }
}

impl Overrides {
    /// # Errors
    /// [`Error::Invalid`] when the radius is no length, or the angle not one of a sun.
    pub fn validate(&self) -> Result<()> {
        match self.radius {
            Some(radius) if !(0.0..=MAX_COORDINATE).contains(&radius) => Err(Error::Invalid(
                format!("a light's radius is from 0 to 1e18, not {radius}"),
            )),
            _ => Ok(()),
        }?;
        match self.sun_angle_deg {
            Some(angle) if !(0.0..180.0).contains(&angle) => Err(Error::Invalid(format!(
                "a sun's angle is from 0 to less than 180 degrees, not {angle}"
            ))),
            _ => Ok(()),
        }
    }

    fn load_options(&self) -> LoadOptions {
        LoadOptions {
            scene: self.scene_index,
            punctual_radius: self.radius,
            sun_angle_deg: self.sun_angle_deg,
            outside_paths: self.outside_paths,
            blend: self.blend,
            allow_missing: self.allow_missing,
            limits: self.limits.clone(),
            ..LoadOptions::default()
        }
    }
}

fn is_gltf(path: &Path, bytes: &[u8]) -> bool {
    #[derive(Deserialize)]
    struct Probe {
        asset: Option<IgnoredAny>,
    }
    let extension = path.extension().unwrap_or_default();
    extension.eq_ignore_ascii_case("glb")
        || extension.eq_ignore_ascii_case("gltf")
        || bytes.starts_with(b"glTF")
        || serde_json::from_slice(bytes).is_ok_and(|probe: Probe| probe.asset.is_some())
}

fn read_shot_file(path: &Path, bytes: &[u8], overrides: &Overrides) -> Result<Draft> {
    let broken = |e| Error::parse(path, format!("is not a shot file: {e}"));
    let mut notes = Vec::new();
    let mut json = serde_json::Deserializer::from_slice(bytes);
    let shot: ShotFile = serde_ignored::deserialize(&mut json, |key| {
        // Where a value is optional, serde_ignored marks it with a question mark.
        let key = key.to_string().replace(".?", "");
        let last = key.rsplit('.').next().unwrap_or_default();
        if !FOR_PEOPLE.contains(&last) {
            notes.push(format!("The key {key:?} is ignored."));
        }
    })
    .map_err(broken)?;
    json.end().map_err(broken)?;
    let lights = match (shot.light, shot.lights) {
        (Some(_), Some(_)) => {
            return Err(Error::parse(
                path,
                "has both \"light\" and \"lights\"; give one of them",
            ));
        }
        (Some(light), None) => vec![light],
        (None, lights) => lights.unwrap_or_default(),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let options = LoadOptions {
        own_lights: !lights.is_empty(),
        casters: shot.casters,
        ..overrides.load_options()
    };
    let scene = gltf::load(&folder.join(shot.scene), &options)?;
    let mut draft = Draft::new(scene);
    draft.notes = notes;
    draft.budget_map = shot.budget_map.map(|file| folder.join(file));
    let of_lights = [
        ("--radius", overrides.radius),
        ("--sun-angle", overrides.sun_angle_deg),
    ];
    for (flag, given) in of_lights {
        if given.is_some() && options.own_lights {
            let note = format!("{flag} is ignored, for the shot file has lights of its own.");
            draft.notes.push(note);
        }
    }
    if let Some(camera) = shot.camera {
        if overrides.camera_index.is_some() {
            let note = "--camera is ignored, for the shot file has a camera of its own.";
            draft.notes.push(note.into());
        }
        draft.size = Size(camera.width, camera.height);
        let camera = camera
            .into_camera()
            .map_err(|message| Error::parse(path, message))?;
        draft.camera = Some(camera);
    }
    for (index, light) in lights.into_iter().enumerate() {
        if let Some(texture) = &light.texture {
            let file = texture.as_str().map(|file| folder.join(file));
            draft.scene.files.extend(file);
            draft.notes.push(format!(
                "Light {index}: textures of lights are not supported yet; it shines uniformly."
            ));
        }
        let light = light
            .into_light(index)
            .map_err(|message| Error::parse(path, message))?;
        draft.lights.push(light);
    }
    Ok(draft)
}

/// [pixel] Width and height, as far as they are stated.
struct Size(Option<u32>, Option<u32>);

impl From<(u32, u32)> for Size {
    fn from((width, height): (u32, u32)) -> Self {
        Self(Some(width), Some(height))
    }
}

/// A shot as far as its own file describes it.
struct Draft {
    scene: Scene,
    camera: Option<Camera>,
    size: Size,
    lights: Vec<AreaLight>,
    budget_map: Option<PathBuf>,
    notes: Vec<String>,
}

impl Draft {
    fn parse(path: &Path, bytes: &[u8], overrides: &Overrides) -> Result<Self> {
        match is_gltf(path, bytes) {
            true => Self::of_gltf(path, bytes, overrides),
            false => read_shot_file(path, bytes, overrides),
        }
    }

    fn of_gltf(path: &Path, bytes: &[u8], overrides: &Overrides) -> Result<Self> {
        let scene = gltf::parse(path, bytes, &overrides.load_options())?;
        Ok(Self::new(scene))
    }

    fn new(scene: Scene) -> Self {
        Self {
            scene,
            camera: None,
            size: Size(None, None),
            lights: Vec::new(),
            budget_map: None,
            notes: Vec::new(),
        }
    }

    /// Takes what is missing from the scene.
    fn finish(self, path: &Path, overrides: &Overrides) -> Result<Shot> {
        let Self {
            mut scene,
            camera,
            size,
            mut lights,
            budget_map,
            notes,
        } = self;
        let shares = budget_map.as_deref().map(budget_map::read).transpose()?;
        scene.files.extend(budget_map);
        let camera = match camera {
            Some(camera) => camera,
            None => scene_camera(&scene, overrides.camera_index)
                .map_err(|message| Error::parse(path, message))?,
        };
        let mut physical = false;
        if lights.is_empty() {
            lights = scene.lights.clone();
            physical = lights.iter().any(|light| light.intensity.is_some());
        }
        if lights.is_empty() {
            let notes = noted(&scene);
            return Err(Error::parse(
                path,
                format!(
                    "brings no area light; write a shot file with \"scene\", \"camera\" and \"lights\"{notes}"
                ),
            ));
        }
        let aspect = camera.aspect.filter(|aspect| *aspect > 0.0).unwrap_or(1.0);
        let pixels = |size: f64| size.round().clamp(1.0, f64::from(MAX_SIZE)) as u32;
        let (width, height) = match (size.0, size.1) {
            (Some(width), Some(height)) => (width, height),
            (Some(width), None) => (width, pixels(f64::from(width) / aspect)),
            (None, height) => {
                let height = height.unwrap_or(DEFAULT_HEIGHT);
                (pixels(f64::from(height) * aspect), height)
            }
        };
        let settings = Settings::default();
        let scene = Arc::new(scene);
        Ok(Shot {
            scene,
            camera,
            width,
            height,
            lights,
            settings,
            budget_map: shares.map(Arc::new),
            physical,
            notes,
        })
    }
}

/// What became of the lights and cameras that a scene has, for an error.
fn noted(scene: &Scene) -> String {
    scene
        .notes
        .iter()
        .map(|note| format!(" ({note})"))
        .collect()
}

fn scene_camera(scene: &Scene, index: Option<usize>) -> Result<Camera, String> {
    let count = scene.cameras.len();
    match (scene.cameras.get(index.unwrap_or(0)), index) {
        (Some(camera), _) => Ok(camera.clone()),
        (None, Some(index)) if count > 0 => Err(format!(
            "has no camera {index}; it holds {count} camera(s), counted from 0"
        )),
        _ => {
            let notes = noted(scene);
            Err(format!(
                "brings no camera; write a shot file with \"scene\", \"camera\" and \"lights\"{notes}"
            ))
        }
    }
}

impl CameraFile {
    fn into_camera(self) -> Result<Camera, &'static str> {
        let vfov_deg = match (self.vfov_deg, self.ortho_height) {
            (Some(vfov_deg), None) => vfov_deg,
            // Of no meaning to parallel rays.
            (None, Some(_)) => 0.0,
            _ => return Err("its camera needs either \"vfov_deg\" or \"ortho_height\""),
        };
        Ok(Camera {
            name: "camera".into(),
            eye: DVec3::from(self.eye),
            target: DVec3::from(self.target),
            up: DVec3::from(self.up),
            vfov_deg,
            ortho_height: self.ortho_height,
            aspect: None,
            near: None,
        })
    }
}

impl LightFile {
    fn into_light(self, index: usize) -> Result<AreaLight, String> {
        let missing = |key| format!("light {index} lacks {key:?}");
        let center = || {
            self.center
                .map(DVec3::from)
                .ok_or_else(|| missing("center"))
        };
        let (center, shape) = match self.kind {
            LightKind::Rect => {
                let center = center()?;
                let u = self.u.ok_or_else(|| missing("u"))?.into();
                let v = self.v.ok_or_else(|| missing("v"))?.into();
                (center, LightShape::Rect { u, v })
            }
            LightKind::Disc => {
                let center = center()?;
                let radius = self.radius.ok_or_else(|| missing("radius"))?;
                // A point shines in all directions.
                let normal = match self.normal {
                    None if radius == 0.0 => [0.0; 3],
                    normal => normal.ok_or_else(|| missing("normal"))?,
                };
                let normal = normal.into();
                (center, LightShape::Disc { normal, radius })
            }
            LightKind::Polygon => {
                let corners = self.corners.ok_or_else(|| missing("corners"))?;
                let corners: Vec<DVec3> = corners.into_iter().map(DVec3::from).collect();
                LightShape::polygon(&corners).map_err(|fault| format!("light {index}: {fault}"))?
            }
            LightKind::Sphere => {
                let center = center()?;
                let radius = self.radius.ok_or_else(|| missing("radius"))?;
                (center, LightShape::Sphere { radius })
            }
            LightKind::Sun => {
                let direction = self.direction.ok_or_else(|| missing("direction"))?.into();
                let angle_deg = self.angle_deg.unwrap_or(SUN_ANGLE_DEG);
                let shape = LightShape::Sun {
                    direction,
                    angle_deg,
                };
                (DVec3::ZERO, shape)
            }
        };
        let beam = self.cone_deg.map(|[inner_deg, outer_deg]| {
            let direction = match self.kind {
                LightKind::Disc => self.normal,
                _ => self.direction,
            };
            Beam {
                direction: direction.unwrap_or([0.0, -1.0, 0.0]).into(),
                inner_deg,
                outer_deg,
            }
        });
        Ok(AreaLight {
            name: format!("light {index}"),
            center,
            shape,
            color: Vec3::from(self.color),
            intensity: self.intensity,
            beam,
        })
    }
}
