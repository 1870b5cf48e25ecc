//! Jobs as array scripts of Slurm.

use crate::job::Job;
use crate::quoting::of_shell;

/// The most tasks that one array is given. Slurm's `MaxArraySize`, unless raised, allows indices up to 1000.
const MOST_TASKS: usize = 1000;

/// Frames of a task, if the user does not say how many; more if that would make too many tasks for one array.
const USUAL_FRAMES: usize = 10;

/// The script of a job. Submitted by `sbatch`, the script paints the frames. If a movie is wanted, a shell can run the
/// script instead. It then submits itself, and a second job that makes the movie when all frames are done.
///
/// # Errors
/// Words that say that tasks of `frames_a_task` frames are too many for one array.
pub fn script(job: &Job, frames_a_task: Option<usize>) -> Result<String, String> {
    let count = job.frames.count();
    let least = count.div_ceil(MOST_TASKS);
    let most = frames_a_task.unwrap_or_else(|| least.max(USUAL_FRAMES));
    if most < least {
        return Err(format!(
            "{count} frames in tasks of {most} are over {MOST_TASKS} tasks, which Slurm takes as one array: use --chunk {least} or more"
        ));
    }
    let chunks = job.frames.chunks(most);
    let [name, scene, output] = [&job.name, &job.scene, &job.output].map(|text| of_shell(text));
    let more: String = job.arguments.iter().map(|word| format!(" {}", of_shell(word))).collect();
    let log: String =
        job.name.chars().map(|letter| if letter.is_alphanumeric() { letter } else { '_' }).collect();
    let (submit, about_movie) = match &job.movie {
        Some(movie) => {
            let encode = format!(
                "impasto movie {output} --fps {} -f {} -o {}",
                job.fps,
                of_shell(&job.frames.text()),
                of_shell(movie)
            );
            let submit = format!(
                "if [ -z \"${{SLURM_ARRAY_TASK_ID:-}}\" ]; then\n    \
                 job=$(sbatch --parsable \"$@\" \"$0\")\n    \
                 echo \"Submitted batch job $job\"\n    \
                 sbatch \"$@\" --kill-on-invalid-dep=yes --job-name={name}-movie --dependency=\"afterok:${{job%%;*}}\" --output={log}_movie.log --wrap {}\n    \
                 exit\nfi\n\n",
                of_shell(&encode)
            );
            (submit, "#   sh THIS_FILE        paints, then makes the movie; both take options of sbatch\n")
        }
        None => (String::new(), ""),
    };
    let last = chunks.len() - 1;
    Ok(format!(
        "#!/bin/sh\n\
         # {}. A frame that is there and whole is not painted again: submit the file a second time, and\n\
         # only what is missing is painted.\n\
         #   sbatch THIS_FILE    paints\n\
         {about_movie}\
         #SBATCH --job-name={log}\n\
         #SBATCH --array=0-{last}\n\
         #SBATCH --requeue\n\
         #SBATCH --output={log}_%A_%a.log\n\
         set -eu\n\n\
         {submit}\
         frames=$(sed -n \"$((SLURM_ARRAY_TASK_ID + 1))p\" <<'FRAMES'\n{}\nFRAMES\n)\n\
         if [ -z \"$frames\" ]; then echo \"{log}: tasks are 0 to {last}, and this is $SLURM_ARRAY_TASK_ID\" >&2; exit 2; fi\n\
         exec impasto render {scene} -f \"$frames\" -o {output}{more} --skip-existing\n",
        in_words(count, chunks.len()),
        chunks.join("\n"),
    ))
}

fn in_words(frames: usize, tasks: usize) -> String {
    let of = |count: usize, one: &str| format!("{count} {one}{}", if count == 1 { "" } else { "s" });
    format!("{} in {}", of(frames, "frame"), of(tasks, "task"))
}
