//! What may be typed: one definition for the parser, the help, the completions and the man page.

use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use nephroid::desc::{self, IntegratorKind};
use nephroid::{Crop, Exposure, Extent, PhotonKind, ViewTransform, WhiteBalance};

use crate::values::{CameraSets, GroupFactor, Previews, Size};
use crate::{span, values};

/// Renders global illumination and caustics with photon maps.
///
/// `nephroid SCENE` is short for `nephroid render SCENE`.
///
/// Exit status: 0 all is well; 1 something failed on the way (a full disk, say); 2 the command line or the scene is
/// wrong, nothing was written; 130 interrupted, pictures and checkpoint of the passes done were written.
#[derive(Debug, Parser)]
#[command(name = "nephroid", version, arg_required_else_help = true, max_term_width = 100)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene.
    Render(RenderArgs),
    /// Go on with a checkpoint.
    Resume(ResumeArgs),
    /// Add up checkpoints that hold different passes of one scene.
    Merge(MergeArgs),
    /// Show a picture in another way, or mix its lights anew, without rendering.
    Develop(DevelopArgs),
    /// Say what is in a scene or a checkpoint, without rendering it.
    Info(InfoArgs),
    /// Trace one path of a render again and print it, vertex by vertex.
    Replay(ReplayArgs),
    /// Write a scene as TOML; its large meshes become PLY files in a folder beside it.
    Convert(ConvertArgs),
    /// Compare pictures with a reference, in linear radiance.
    Compare(CompareArgs),
    /// Print the reference of scene files.
    Describe(DescribeArgs),
    /// Print the completions of a shell.
    Completions {
        /// The shell.
        shell: Shell,
    },
    /// Print the man page, as roff.
    Man,
}

/// A scene and what replaces parts of it.
#[derive(Debug, Args)]
pub struct SceneArgs {
    /// The scene file: TOML, .pbrt (version 4, or 3 where its names differ), .xml (Mitsuba), .gltf, .glb, .obj, .ply or .stl.
    pub scene: PathBuf,

    /// Its changes.
    #[command(flatten)]
    pub changes: Changes,
}

/// What replaces parts of a scene.
#[derive(Debug, Args)]
pub struct Changes {
    /// Treat warnings about the scene as errors: that a file of another program asks for what Nephroid lacks, for example.
    #[arg(long)]
    pub strict: bool,

    /// Algorithm [default: the scene's, or auto].
    #[arg(long, value_name = "NAME")]
    pub integrator: Option<Integrator>,

    /// Size of the picture in pixels: width and height, as 640x480, or the width alone, as 640, to which the height
    /// keeps the scene's aspect [default: the scene's, or 512x512].
    #[arg(long, visible_alias = "resolution", value_name = "WxH|W", value_parser = values::size)]
    pub size: Option<Size>,

    /// Width of the picture in pixels; the height keeps the scene's aspect.
    #[arg(long, value_name = "PIXELS", conflicts_with = "size", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub width: Option<u32>,

    /// Render a part of the picture alone: columns X0 up to X1 and rows Y0 up to Y1, in pixels from the top left, or
    /// all in percent, as 25%,0%,75%,50%. The rest stays black; the part has the same bytes as in the whole.
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = values::crop)]
    pub crop: Option<Crop>,

    /// Where the camera stands, what it looks at and its field of view in degrees, as 0,2,5:0,1,0:40. Parts may be left
    /// out: 0,2,5 moves it alone, ::25 narrows it. Short for --set camera.position=[0,2,5] and so on.
    #[arg(long, value_name = "X,Y,Z:X,Y,Z:FOV", allow_hyphen_values = true, value_parser = values::camera)]
    pub camera: Option<CameraSets>,

    /// Lay no ground under a model (glTF, OBJ, PLY, STL) that has neither camera nor light. Short for --set stage.ground=false.
    #[arg(long)]
    pub no_ground: bool,

    /// Lay a ground under a model although it has a camera or light of its own.
    #[arg(long, conflicts_with = "no_ground")]
    pub ground: bool,

    /// Passes, each one camera sample a pixel [default: the scene's, or 128].
    #[arg(long, visible_aliases = ["spp", "samples"], value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4_194_304))]
    pub passes: Option<u32>,

    /// End once the grain of a typical pixel is so small, as 2%; it is looked at from the eighth pass on. Without
    /// --passes, passes go on until then; with it or --time, whichever comes first [default: the scene's, or none].
    #[arg(long, value_name = "PERCENT", value_parser = values::noise)]
    pub noise: Option<f32>,

    /// Seed of every random number: same seed, same bytes [default: the scene's, or 0].
    #[arg(long, value_name = "S")]
    pub seed: Option<u64>,

    /// Scattering events on a path, at most; 1 is direct light alone [default: the scene's, or no limit].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub max_depth: Option<u32>,

    /// How PNG pictures are shown.
    #[command(flatten)]
    pub display: DisplayArgs,

    /// Take noise out of pictures by Open Image Denoise, where it is found (NEPHROID_OIDN, OIDN_DIR, the system's, or that of
    /// `pip install pyoidn`); EXR pictures keep what was rendered, and the denoised as the layer "denoised". With
    /// =require, nothing is rendered where it is not found [default: the scene's, or off].
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    pub denoise: Option<Denoise>,

    /// Replace any value of the scene, as photon_map.knn=80 or materials.glass.ior=1.5 (a TOML value); may be given
    /// several times. Of scenes of other programs, names are those that `nephroid convert` writes.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub set: Vec<String>,
}

impl Changes {
    /// All values that are replaced in the scene, as --set has them.
    pub fn sets(&self) -> Vec<String> {
        let camera = self.camera.iter().flat_map(|camera| camera.0.iter().cloned());
        let ground = [(self.ground, true), (self.no_ground, false)];
        let ground =
            ground.iter().filter(|(asked, _)| *asked).map(|(_, laid)| format!("stage.ground={laid}"));
        camera.chain(ground).chain(self.set.iter().cloned()).collect()
    }
}

/// How PNG pictures show radiance; nothing of it changes what is rendered.
#[derive(Clone, Debug, Default, Args)]
pub struct DisplayArgs {
    /// Exposure of PNG pictures in EV (stops): radiance is multiplied by 2^EV; or auto, as the picture asks for
    /// [default: the scene's, or auto].
    #[arg(long, value_name = "EV|auto", allow_negative_numbers = true, value_parser = values::exposure)]
    pub exposure: Option<Exposure>,

    /// Light that PNG pictures show as white: a temperature, as 3200K, an illuminant, as D50, A or F11, auto or none
    /// [default: the scene's, or none].
    #[arg(long, value_name = "LIGHT", value_parser = values::white_balance)]
    pub white_balance: Option<WhiteBalance>,

    /// How PNG pictures turn radiance into display colours: agx, agx-punchy, aces-like, srgb or false-colour [default:
    /// the scene's, or agx-punchy].
    #[arg(long, value_name = "VIEW", value_parser = values::view)]
    pub view: Option<ViewTransform>,

    /// Look-up table for the display colours of PNG pictures, applied after the view [default: the scene's, or none].
    #[arg(long, value_name = "FILE.cube")]
    pub lut: Option<PathBuf>,
}

/// Arguments of `render`.
#[derive(Debug, Args)]
pub struct RenderArgs {
    /// The scene files: TOML, .pbrt (version 4, or 3 where its names differ), .xml (Mitsuba), .gltf, .glb, .obj, .ply or .stl.
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<PathBuf>,

    /// What replaces parts of them.
    #[command(flatten)]
    pub changes: Changes,

    /// Picture to write: .exr (linear radiance, all layers) or .png (8 bits, displayed); may be given several times
    /// [default: the scene's name with .png, in the working directory].
    #[arg(short, long = "output", value_name = "OUT")]
    pub output: Vec<PathBuf>,

    /// End after so long: 90 or 90s, 5m, 1h30m. Without --passes, passes go on until then; with it, whichever comes
    /// first. One pass is always rendered. The time begins with the first pass or photon.
    #[arg(long, value_name = "TIME", value_parser = span::parse)]
    pub time: Option<Duration>,

    /// Render only passes A to B - 1 of what may be 4194304, to be put together by `nephroid merge`.
    #[arg(long, value_name = "A..B", conflicts_with = "passes", value_parser = values::range)]
    pub pass_range: Option<Range<u64>>,

    /// More layers for .exr pictures, which add up to the picture: one for each technique that finds light, or one for
    /// each group of lights (light_group in scene files); both as techniques,lights [default: the scene's, or none].
    #[arg(long, value_name = "LAYERS", value_delimiter = ',')]
    pub layers: Vec<Layers>,

    /// Save the render to this file every minute, when it is interrupted, and at the end; `nephroid resume` goes on
    /// with it. It must not exist.
    #[arg(long, value_name = "FILE.neph")]
    pub checkpoint: Option<PathBuf>,

    /// How often to save.
    #[arg(long, value_name = "TIME", default_value = "1m", value_parser = span::parse, requires = "checkpoint")]
    pub checkpoint_every: Duration,

    /// How to run.
    #[command(flatten)]
    pub run: RunArgs,
}

/// How to run, whatever is rendered.
#[derive(Clone, Copy, Debug, Args)]
pub struct RunArgs {
    /// Threads; 0 is one for each core. Their number never changes the picture.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = values::threads)]
    pub threads: usize,

    /// Say at the end how long each part took, in seconds.
    #[arg(long)]
    pub timings: bool,

    /// How to tell of passes, on standard error [default: bar at a terminal, else lines].
    #[arg(long, value_name = "HOW")]
    pub progress: Option<How>,

    /// Rewrite .png pictures so often while passes come, from the first on: 5s, 1m, or off. It takes a twentieth of a
    /// core's time at most [default: 5s at a terminal, else off].
    #[arg(long, value_name = "TIME", value_parser = values::previews)]
    pub preview_every: Option<Previews>,

    /// Say nothing but what went wrong.
    #[arg(short, long)]
    pub quiet: bool,
}

/// How to tell of passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum How {
    /// A bar that redraws itself.
    Bar,
    /// A line now and then, at most one each five seconds.
    Lines,
    /// JSON for programs, one object a line.
    Json,
    /// Nothing but what went wrong.
    None,
}

/// Arguments of `resume`.
#[derive(Debug, Args)]
pub struct ResumeArgs {
    /// The checkpoint, which is kept up to date.
    #[arg(value_name = "FILE.neph")]
    pub checkpoint: PathBuf,

    /// How many passes in all; or with a plus sign, as +64, how many more [default: as was asked for when the render
    /// began].
    #[arg(long, value_name = "N|+N", value_parser = values::extent)]
    pub passes: Option<Extent>,

    /// End after so much more time [default: what is left of the time that was asked for].
    #[arg(long, value_name = "TIME", value_parser = span::parse)]
    pub time: Option<Duration>,

    /// End once the grain of a typical pixel is so small, as 2% [default: what was asked for when the render began].
    #[arg(long, value_name = "PERCENT", value_parser = values::noise)]
    pub noise: Option<f32>,

    /// Take noise out of pictures by Open Image Denoise, where it is found (NEPHROID_OIDN, OIDN_DIR, the system's, or that of
    /// `pip install pyoidn`); EXR pictures keep what was rendered, and the denoised as the layer "denoised". With
    /// =require, nothing is done where it is not found [default: as when the render began].
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    pub denoise: Option<Denoise>,

    /// Picture to write: .exr or .png; may be given several times [default: as when the render began].
    #[arg(short, long = "output", value_name = "OUT")]
    pub output: Vec<PathBuf>,

    /// How PNG pictures are shown.
    #[command(flatten)]
    pub display: DisplayArgs,

    /// How often to save.
    #[arg(long, value_name = "TIME", default_value = "1m", value_parser = span::parse)]
    pub checkpoint_every: Duration,

    /// How to run.
    #[command(flatten)]
    pub run: RunArgs,
}

/// Arguments of `merge`.
#[derive(Debug, Args)]
pub struct MergeArgs {
    /// Checkpoints of one scene with the same settings; no pass may be in two of them. Their order does not matter.
    #[arg(value_name = "FILE.neph", required = true)]
    pub checkpoints: Vec<PathBuf>,

    /// What to write: a picture (.exr or .png) or a checkpoint (.neph); may be given several times.
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub output: Vec<PathBuf>,

    /// How PNG pictures are shown.
    #[command(flatten)]
    pub display: DisplayArgs,

    /// Take noise out of pictures by Open Image Denoise, where it is found (NEPHROID_OIDN, OIDN_DIR, the system's, or that of
    /// `pip install pyoidn`); EXR pictures keep what was rendered, and the denoised as the layer "denoised". With
    /// =require, nothing is done where it is not found [default: as when the renders began].
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    pub denoise: Option<Denoise>,

    /// Say nothing but what went wrong.
    #[arg(short, long)]
    pub quiet: bool,
}

/// Arguments of `develop`.
#[derive(Debug, Args)]
pub struct DevelopArgs {
    /// The picture: .exr, of any program, or a checkpoint.
    #[arg(value_name = "FILE.exr|FILE.neph")]
    pub file: PathBuf,

    /// Picture to write: .png (8 bits, displayed) or .exr (linear, lights mixed); may be given several times.
    #[arg(short, long = "output", value_name = "OUT", required = true)]
    pub output: Vec<PathBuf>,

    /// Multiply the light of a group (light_group in scene files), as sun=0.5 or lamp=2,#ffd0a0; the colour is
    /// r,g,b, #rrggbb or a temperature as 3000K; may be given several times. The picture must have been rendered with
    /// --layers lights.
    #[arg(long, value_name = "GROUP=FACTOR[,COLOUR]", value_parser = values::light)]
    pub light: Vec<GroupFactor>,

    /// How PNG pictures are shown.
    #[command(flatten)]
    pub display: DisplayArgs,

    /// Take noise out of pictures by Open Image Denoise, where it is found (NEPHROID_OIDN, OIDN_DIR, the system's, or that of
    /// `pip install pyoidn`); EXR pictures keep what was rendered, and the denoised as the layer "denoised". With
    /// =require, nothing is done where it is not found [default: as when the render began, of EXR pictures off].
    #[arg(long, value_name = "HOW", num_args = 0..=1, require_equals = true, default_missing_value = "auto")]
    pub denoise: Option<Denoise>,

    /// Say nothing but what went wrong.
    #[arg(short, long)]
    pub quiet: bool,
}

/// Arguments of `info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// The scene and its changes, or a checkpoint.
    #[command(flatten)]
    pub scene: SceneArgs,
}

/// Arguments of `replay`.
#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("path").required(true).args(["pixel", "photon"]))]
pub struct ReplayArgs {
    /// The scene and its changes as they were rendered, or a checkpoint of that render.
    #[command(flatten)]
    pub scene: SceneArgs,

    /// The pass, counted from 0.
    #[arg(long, value_name = "P")]
    pub pass: u64,

    /// The camera path through this pixel: column and row, counted from 0 at the top left, as 10,20.
    #[arg(long, value_name = "X,Y", value_parser = values::pixel)]
    pub pixel: Option<[u32; 2]>,

    /// The photon path of this index, as warnings name it.
    #[arg(long, value_name = "N")]
    pub photon: Option<u64>,

    /// Which photons [default: all that have a path of that index].
    #[arg(long, value_name = "MAP", requires = "photon")]
    pub map: Option<PhotonMap>,

    /// Print JSON, one object a path.
    #[arg(long)]
    pub json: bool,
}

/// Whether noise is taken out of pictures, as in scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Denoise {
    /// Pictures are what was rendered.
    Off,
    /// Where the library is found.
    Auto,
    /// An error where it is not found.
    Require,
}

impl From<Denoise> for desc::Denoise {
    fn from(how: Denoise) -> Self {
        match how {
            Denoise::Off => Self::Off,
            Denoise::Auto => Self::Auto,
            Denoise::Require => Self::Require,
        }
    }
}

/// Layers on request, as in scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Layers {
    /// One for each technique that finds light.
    Techniques,
    /// One for each group of lights.
    Lights,
}

/// Photons, as warnings name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PhotonMap {
    /// From all lights everywhere; the light paths of vcm too.
    Global,
    /// Aimed at mirrors, metal and glass.
    Caustic,
}

impl From<PhotonMap> for PhotonKind {
    fn from(map: PhotonMap) -> Self {
        match map {
            PhotonMap::Global => Self::Global,
            PhotonMap::Caustic => Self::Caustic,
        }
    }
}

/// Arguments of `convert`.
#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// The scene and its changes.
    #[command(flatten)]
    pub scene: SceneArgs,

    /// The scene to write. It must not exist.
    #[arg(value_name = "OUT.toml")]
    pub out: PathBuf,
}

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// The reference: .exr or .png (sRGB, made linear).
    #[arg(value_name = "REF")]
    pub reference: PathBuf,

    /// The pictures: .exr or .png, of the reference's size.
    #[arg(value_name = "IMG", required = true)]
    pub images: Vec<PathBuf>,

    /// Compare only where the mean of this picture is above 0.5.
    #[arg(long, value_name = "MASK")]
    pub mask: Option<PathBuf>,

    /// Write a picture of the difference; of the last IMG.
    #[arg(long, value_name = "OUT.png")]
    pub diff: Option<PathBuf>,

    /// Print JSON, one object a line.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `describe`.
#[derive(Debug, Args)]
pub struct DescribeArgs {
    /// What to describe: a table, a kind or a key, as camera, dielectric or film.exposure, or words to look for, as gold,
    /// clearcoat or depth of field [default: the list of topics].
    pub topic: Vec<String>,
}

/// The algorithms, as in scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Integrator {
    /// Path tracing, and photons for the caustics; needs no setting.
    Auto,
    /// Path tracing with light sampling.
    Path,
    /// Two-pass photon mapping.
    #[value(name = "photon_map", alias = "photon-map")]
    PhotonMap,
    /// Stochastic progressive photon mapping.
    Sppm,
    /// Vertex connection and merging, bidirectional path tracing.
    Vcm,
}

impl From<Integrator> for IntegratorKind {
    fn from(integrator: Integrator) -> Self {
        match integrator {
            Integrator::Auto => Self::Auto,
            Integrator::Path => Self::Path,
            Integrator::PhotonMap => Self::PhotonMap,
            Integrator::Sppm => Self::Sppm,
            Integrator::Vcm => Self::Vcm,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_definition_holds_together() {
        Cli::command().debug_assert();
    }

    #[test]
    fn every_argument_has_help() {
        fn check(command: &clap::Command) {
            assert!(command.get_about().is_some(), "{}", command.get_name());
            for argument in command.get_arguments() {
                assert!(argument.get_help().is_some(), "{} {}", command.get_name(), argument.get_id());
            }
            command.get_subcommands().for_each(check);
        }
        check(&Cli::command());
    }
}
