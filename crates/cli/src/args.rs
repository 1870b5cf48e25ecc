//! The command line: its subcommands and their arguments.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use impasto_measure::Metric;
use impasto_scene::document::Style;

use crate::farm_args::{FarmCommand, PackArguments};
use crate::picture_args::PictureArguments;
use crate::progress::Progress;
use crate::scene_args::{PlacingArguments, SceneArguments};
use crate::talk::Talk;

/// Paints 3D scenes with brush strokes that turn with what they lie on.
#[derive(Debug, Parser)]
#[command(name = "impasto", version, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Open the editor's window: paint directions on a scene or a mesh, move things, animate them.
    #[cfg(feature = "editor")]
    Edit(EditArguments),
    /// Paint frames of a scene or a shot, or an OBJ model from a sensible camera.
    Render(RenderArguments),
    /// Make a movie of PNG frames on the disk, as painted or touched up; needs ffmpeg.
    Movie(MovieArguments),
    /// Write a scene file for a model: the scene that `render MODEL` paints.
    New(NewArguments),
    /// Put everything that a shot needs into one file or folder.
    Pack(PackArguments),
    /// Write the job of a shot for a farm of many machines.
    #[command(subcommand)]
    Farm(FarmCommand),
    /// Write values into a scene file; the rest of its text stays as it is.
    Set(SetArguments),
    /// Render what another program asks for, by lines of JSON on standard input.
    Serve(ServeArguments),
    /// List every problem of scenes, with its line and column.
    Check(CheckArguments),
    /// Show what is in a scene or a mesh.
    Info(InfoArguments),
    /// Write the strokes of a frame as they are drawn.
    Strokes(StrokesArguments),
    /// Measure how steady scenes are: popping, turning, flatness and more, beside the source paper's rule.
    Measure(MeasureArguments),
    /// Paint a sheet of all brushes, and of your own pictures as brushes.
    Brushes(BrushesArguments),
    /// Light the paint of an EXR file anew.
    Relight(RelightArguments),
    /// Find out which OpenGL drivers work here, by drawing a test picture.
    Doctor(DoctorArguments),
    /// Print a completion script for a shell.
    Completions {
        /// Which shell.
        shell: clap_complete::Shell,
    },
    /// Write the manual pages into a folder.
    #[command(hide = true)]
    Man {
        /// The folder, which is made if it does not exist.
        folder: PathBuf,
    },
}

/// Which library to take OpenGL from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum DriverChoice {
    /// EGL where it works, else OSMesa.
    #[default]
    Auto,
    /// EGL, on a graphics card or in software.
    Egl,
    /// OSMesa, in software.
    Osmesa,
}

fn style_names() -> PossibleValuesParser {
    let name = |style: &Style| {
        let info = style.info();
        PossibleValue::new(info.file_name).help(info.summary).aliases(info.alias)
    };
    Style::all().iter().map(name).collect::<Vec<_>>().into()
}

/// How strokes turn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum RotationChoice {
    /// With what they lie on.
    #[default]
    On,
    /// Not at all.
    Off,
    /// By chance, in every frame.
    Random,
    /// They lie on the surface as a texture does.
    Mapped,
}

/// What strokes are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ColorsChoice {
    /// The scene.
    #[default]
    Scene,
    /// How far the turn of each stroke can be trusted: green, yellow, red.
    Trust,
}

/// What draws the editor's paintings.
#[cfg(feature = "editor")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum EditDriver {
    /// The graphics card where there is one, else software.
    Auto,
    /// EGL, on a graphics card or in software.
    Egl,
    /// OSMesa, in software.
    Osmesa,
    /// Software, whatever the machine has.
    Software,
}

#[cfg(feature = "editor")]
#[derive(Args, Debug)]
pub(crate) struct EditArguments {
    /// A scene (.ron), or a model or shot (.obj, .glb, .gltf) to begin one with.
    pub(crate) scene: Option<PathBuf>,
    /// What draws the paintings; left out, what the preferences say.
    #[arg(long, value_enum)]
    pub(crate) driver: Option<EditDriver>,
    /// A folder of shaders that stand in for the program's own, read again whenever they change.
    #[arg(long, value_name = "DIR")]
    pub(crate) shaders: Option<PathBuf>,
    /// Go to the frame and the view that another program names, by lines of JSON on standard input.
    #[arg(long)]
    pub(crate) follow: bool,
    /// Ask for files in the window, never by the desktop's dialogs.
    #[arg(long, hide = true)]
    pub(crate) in_app_dialogs: bool,
    /// Write to standard error what the window shows and where its controls are, each time that its exact pictures are
    /// ready.
    #[arg(long, hide = true)]
    pub(crate) tell: bool,
}

#[derive(Args, Debug)]
pub(crate) struct RenderArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Where frames go: #### or %04d or $F4 stands for the frame number, - for standard output (one frame). A name that
    /// ends in .exr gives linear pictures for compositing; one in .mp4, .mkv (H.264), .mov (ProRes 4444) or .webm (VP9)
    /// a movie, by ffmpeg.
    #[arg(short, long, default_value = "out/frame_####.png")]
    pub(crate) output: String,
    /// Which frames: a, a-b or a..b, with xN or :N behind for every Nth; commas between several. Left out, the scene's
    /// own.
    #[arg(short, long, allow_hyphen_values = true)]
    pub(crate) frames: Option<String>,
    /// Width x height in pixels, such as 1280x720; the scene's own when left out. Strokes scale with the height.
    #[arg(long, value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Which library to take OpenGL from.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) driver: DriverChoice,
    /// A folder of shaders that stand in for the program's own.
    #[arg(long, value_name = "DIR")]
    pub(crate) shaders: Option<PathBuf>,
    /// Leave what is not painted transparent: in PNG and EXR files, and in .mov and .webm movies.
    #[arg(long)]
    pub(crate) alpha: bool,
    /// A style in place of the scene's own.
    #[arg(long, value_parser = style_names())]
    pub(crate) style: Option<String>,
    /// How strokes turn, for comparison: off leaves them as in the reference pose, random turns them anew in each
    /// frame, mapped lays them on the surface as a texture.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) rotation: RotationChoice,
    /// What strokes are coloured by: the scene, or how far their turn can be trusted.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) colors: ColorsChoice,
    /// Let the camera go once round instead of rendering the scene's own shot: a degree a frame.
    #[arg(long)]
    pub(crate) turntable: bool,
    /// Keep strokes at their size in pixels, whatever the size of the picture.
    #[arg(long)]
    pub(crate) keep_stroke_px: bool,
    /// Skip frames whose files exist and are whole.
    #[arg(long)]
    pub(crate) skip_existing: bool,
    /// Also write a sheet of small copies of the frames beside them: of all, or of every Nth if there are over 144.
    #[arg(long)]
    pub(crate) contact_sheet: bool,
    /// Write one animated PNG instead of single frames.
    #[arg(long, conflicts_with_all = ["contact_sheet", "skip_existing"])]
    pub(crate) apng: bool,
    #[command(flatten)]
    pub(crate) picture: PictureArguments,
    /// Print a line of JSON for the driver, and one per frame that is painted.
    #[arg(long)]
    pub(crate) json: bool,
    /// How to show progress: a bar in a terminal, or the lines that runners of Open Job Descriptions read.
    #[arg(long, value_enum, default_value_t, value_name = "KIND")]
    pub(crate) progress: Progress,
    #[command(flatten)]
    pub(crate) talk: Talk,
}

#[derive(Args, Debug)]
pub(crate) struct MovieArguments {
    /// The frames, PNG files of one size: #### or %04d or $F4 stands for the frame number.
    #[arg(value_name = "FRAMES")]
    pub(crate) pattern: String,
    /// Further names, as a shell makes them of `*`. They are refused, and the message says what to write instead.
    #[arg(hide = true)]
    pub(crate) more: Vec<String>,
    /// The movie: .mp4, .mkv (H.264), .mov (ProRes 4444) or .webm (VP9).
    #[arg(short, long, value_name = "MOVIE")]
    pub(crate) output: PathBuf,
    /// Which frames, in which order: a, a-b or a..b, with xN or :N behind for every Nth; commas between several. Left
    /// out, all that are there; a gap between them is refused.
    #[arg(short = 'f', long = "frames", value_name = "LIST", allow_hyphen_values = true)]
    pub(crate) list: Option<String>,
    /// Frames a second, such as 25, 23.976 or 24000/1001.
    #[arg(long, default_value = "24", value_parser = parse_fps)]
    pub(crate) fps: f64,
    /// Make a transparent movie (.mov or .webm) in any case. Left out, these two are transparent where the frames are,
    /// and in an .mp4 or .mkv frames lie over black.
    #[arg(long)]
    pub(crate) alpha: bool,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

/// Reads a frame rate in frames a second: a number, or one number over another.
fn parse_fps(text: &str) -> Result<f64, String> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let fps = match text.split_once('/') {
        Some((over, under)) => number(over).zip(number(under)).map(|(over, under)| over / under),
        None => number(text),
    };
    fps.filter(|fps| (0.001..=1e6).contains(fps))
        .ok_or_else(|| "write a number of frames a second, such as 24, 23.976 or 24000/1001".to_owned())
}

#[derive(Args, Debug)]
pub(crate) struct NewArguments {
    /// A model (.obj) or a shot (.glb, .gltf).
    pub(crate) model: PathBuf,
    /// The scene file to write.
    #[arg(short, long)]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) placing: PlacingArguments,
    /// Replace a file that is there already.
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Args, Debug)]
pub(crate) struct SetArguments {
    /// The scene file.
    pub(crate) scene: PathBuf,
    /// What is written: strokes.scale=1.5 sets a value, strokes.scale= takes it out, regions+=(…) adds to a list,
    /// regions[0]+=(…) before its first item.
    #[arg(value_name = "PATH=VALUE")]
    pub(crate) values: Vec<String>,
    /// Print the scene as JSON, as it then is.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct ServeArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Which library to take OpenGL from.
    #[arg(long, value_enum, default_value_t = DriverChoice::Auto)]
    pub(crate) driver: DriverChoice,
}

#[derive(Args, Debug)]
pub(crate) struct CheckArguments {
    /// Scenes (.ron), models (.obj) or shots (.glb, .gltf).
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// A further folder that meshes and textures may come from; can be repeated.
    #[arg(long = "asset-dir", value_name = "DIR")]
    pub(crate) asset_dirs: Vec<PathBuf>,
    /// Print a line of JSON per problem.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct InfoArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Print JSON.
    #[arg(long)]
    pub(crate) json: bool,
}

/// How strokes are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum StrokeFormat {
    /// A header and a line per stroke.
    #[default]
    Csv,
    /// One object.
    Json,
    /// A path per stroke, in painting order.
    Svg,
}

#[derive(Args, Debug)]
pub(crate) struct StrokesArguments {
    #[command(flatten)]
    pub(crate) scene: SceneArguments,
    /// Which frame, whole or not; the timeline's first when left out.
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) frame: Option<f64>,
    /// Width x height in pixels; the scene's own when left out.
    #[arg(long, value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// How they are written.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: StrokeFormat,
    /// Where they go; - is standard output.
    #[arg(short, long, default_value = "-")]
    pub(crate) output: String,
    /// Which library to take OpenGL from.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) driver: DriverChoice,
}

#[derive(Args, Debug)]
pub(crate) struct MeasureArguments {
    /// Scenes (.ron), models (.obj) or shots (.glb, .gltf).
    #[arg(required = true)]
    pub(crate) scenes: Vec<PathBuf>,
    /// A further folder that meshes and textures may come from; can be repeated.
    #[arg(long = "asset-dir", value_name = "DIR")]
    pub(crate) asset_dirs: Vec<PathBuf>,
    /// Override a value of the scene, such as strokes.width_px=12; can be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    /// How many threads work; all cores when left out. The result is the same.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// Let the camera go once round instead of measuring the scene's own shot: for scenes without motion, and for
    /// models.
    #[arg(long)]
    pub(crate) turntable: bool,
    /// Only these of the metrics M1 to M17, such as M4,M5.
    #[arg(long, value_name = "METRICS", value_delimiter = ',')]
    pub(crate) only: Vec<Metric>,
    /// Width x height of the pictures in pixels; half the scene's own when left out.
    #[arg(long, value_parser = parse_size)]
    pub(crate) size: Option<[u32; 2]>,
    /// Print a line of JSON per scene.
    #[arg(long)]
    pub(crate) json: bool,
    /// Draw what was measured frame by frame (angle error, popping, shower door, chatter, steps, flicker) into this SVG
    /// file; for one scene.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Which library to take OpenGL from.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) driver: DriverChoice,
    /// Say nothing but the results and errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}

#[derive(Args, Debug)]
pub(crate) struct BrushesArguments {
    /// Your own pictures as brushes: light is paint, or dark on a light background.
    pub(crate) pictures: Vec<PathBuf>,
    /// The sheet, a PNG file.
    #[arg(short, long, default_value = "out/brushes.png")]
    pub(crate) output: String,
}

#[derive(Args, Debug)]
pub(crate) struct RelightArguments {
    /// An EXR file that was rendered with --aov paint.color,paint.normal.
    pub(crate) frame: PathBuf,
    /// Direction to the light, such as -1,1,1: right, up, towards you; the last is more than 0.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = crate::relight::direction)]
    pub(crate) light: [f32; 3],
    /// The picture, a PNG file.
    #[arg(short, long)]
    pub(crate) output: String,
}

#[derive(Args, Debug)]
pub(crate) struct DoctorArguments {
    /// Print a line of JSON for each driver, and one for the window.
    #[arg(long)]
    pub(crate) json: bool,
}

/// The most pixels along a side and in all; a scene file has the same limits.
const MAX_SIDE_PX: u32 = 16_384;
const MAX_PX: u64 = 1 << 27;

fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).ok_or("write it as WIDTHxHEIGHT, such as 1280x720")?;
    let side = |text: &str| text.trim().parse::<u32>().map_err(|error| format!("{text:?}: {error}"));
    let size = [side(sides.0)?, side(sides.1)?];
    if size.contains(&0) {
        return Err("a picture has at least one pixel each way".to_owned());
    }
    if size.iter().any(|&side| side > MAX_SIDE_PX) || u64::from(size[0]) * u64::from(size[1]) > MAX_PX {
        return Err(format!("the limit is {MAX_SIDE_PX} pixels a side and {MAX_PX} in all"));
    }
    Ok(size)
}
