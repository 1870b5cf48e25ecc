//! Jobs as Open Job Description templates (`jobtemplate-2023-09`), which AWS Deadline Cloud and the `openjd` command
//! run.

use std::fmt::Write as _;

use crate::job::Job;
use crate::quoting::of_yaml;

/// The first chunks have this many frames. Later ones are sized to take [`CHUNK_S`] each.
const FIRST_FRAMES: usize = 4;

/// How long a chunk is to take, seconds.
const CHUNK_S: u32 = 60;

/// Where frames go, written with the parameters of the template.
const OUTPUT: &str = "{{Param.OutputDir}}/{{Param.FrameName}}";

/// The template of a job: frames in chunks, then the movie, if one is wanted.
///
/// # Errors
/// Words that say which text cannot stand in a template.
pub fn template(job: &Job) -> Result<String, String> {
    let texts = [&job.name, &job.scene, &job.output].into_iter().chain(&job.arguments).chain(&job.movie);
    if let Some(text) = texts.into_iter().find(|text| text.contains("{{")) {
        return Err(format!(
            "{text:?}: two opening braces are a place for a value in an Open Job Description: rename it"
        ));
    }
    let mut text = String::from("specificationVersion: jobtemplate-2023-09\nextensions: [TASK_CHUNKING]\n");
    let mut line = |words: String| {
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{words}");
    };
    line(format!("name: {}", of_yaml(&job.name)));
    line("parameterDefinitions:".to_owned());
    let mut parameter = |name: &str, kind: &[&str], about: &str, default: &str| {
        line(format!("  - name: {name}"));
        kind.iter().for_each(|words| line(format!("    {words}")));
        line(format!("    description: {}", of_yaml(about)));
        line(format!("    default: {}", of_yaml(default)));
    };
    let words = ["type: STRING"];
    let (folder, frame_name) = job.output.rsplit_once('/').unwrap_or((".", &job.output));
    let scene = ["type: PATH", "objectType: FILE", "dataFlow: IN"];
    parameter("Scene", &scene, "The scene, in the folder that impasto pack made.", &job.scene);
    parameter("Frames", &words, "Which frames: 1-48, 1-9:2, commas.", &job.frames.text());
    let output = ["type: PATH", "objectType: DIRECTORY", "dataFlow: OUT"];
    parameter("OutputDir", &output, "The folder that frames go into.", folder);
    parameter("FrameName", &words, "The name of a frame; #### is its number.", frame_name);
    parameter("Impasto", &words, "The program.", "impasto");
    if let Some(movie) = &job.movie {
        let output = ["type: PATH", "objectType: FILE", "dataFlow: OUT"];
        parameter("Movie", &output, "The movie that is made of the frames.", movie);
    }
    line("steps:".to_owned());
    line("  - name: Paint".to_owned());
    line("    parameterSpace:".to_owned());
    line("      taskParameterDefinitions:".to_owned());
    line("        - name: Chunk".to_owned());
    line("          type: CHUNK[INT]".to_owned());
    line("          range: \"{{Param.Frames}}\"".to_owned());
    line("          chunks:".to_owned());
    line(format!("            defaultTaskCount: {FIRST_FRAMES}"));
    line(format!("            targetRuntimeSeconds: {CHUNK_S}"));
    line("            rangeConstraint: NONCONTIGUOUS".to_owned());
    let paint = ["render", "{{Param.Scene}}", "-f", "{{Task.Param.Chunk}}", "-o", OUTPUT];
    let paint = paint.map(str::to_owned).into_iter();
    let always = ["--skip-existing", "--progress", "openjd"].map(str::to_owned);
    action(&mut line, &paint.chain(job.arguments.iter().cloned()).chain(always).collect::<Vec<_>>());
    if job.movie.is_some() {
        line("  - name: Encode".to_owned());
        line("    dependencies:".to_owned());
        line("      - dependsOn: Paint".to_owned());
        let fps = job.fps.to_string();
        let words = ["movie", OUTPUT, "--fps", &fps, "-f", "{{Param.Frames}}", "-o", "{{Param.Movie}}"];
        action(&mut line, &words.map(str::to_owned));
    }
    Ok(text)
}

/// The action of a step: one run of the program.
fn action(line: &mut impl FnMut(String), arguments: &[String]) {
    line("    script:".to_owned());
    line("      actions:".to_owned());
    line("        onRun:".to_owned());
    line("          command: \"{{Param.Impasto}}\"".to_owned());
    let words: Vec<String> = arguments.iter().map(|word| of_yaml(word)).collect();
    line(format!("          args: [{}]", words.join(", ")));
    line("          cancelation: {mode: NOTIFY_THEN_TERMINATE, notifyPeriodInSeconds: 30}".to_owned());
}
