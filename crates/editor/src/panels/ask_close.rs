//! The dialogs in which the editor asks a question before it goes on, for instance what to do with unsaved edits, with
//! a file that another program changed, or with frames that would be replaced.

use crate::widgets::{Dialog, dialog};

/// A question over the window.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// The window is closing, or another scene is opening, and there are unsaved edits.
    SaveChanges {
        /// The document's name.
        name: String,
        /// How long it has had unsaved edits, in minutes.
        minutes: u64,
    },
    /// The window is closing, another scene is opening, or the scene is being saved, and edits of the scene's text have
    /// not been applied yet.
    UnreadText {
        /// The document's name.
        name: String,
    },
    /// A click with the region tool would take triangles from other regions.
    TakeFaces {
        /// Which triangles: *340 triangles of skin*.
        taken: String,
    },
    /// Another frame is to become the reference.
    Recapture {
        /// The frame.
        frame: i64,
    },
    /// A scene is being saved into another folder, which lacks the files that the scene names.
    TakeAlong {
        /// How many files.
        count: usize,
        /// The folder.
        folder: String,
    },
    /// Another program changed the file on disk after it was opened.
    ChangedOutside {
        /// The document's name.
        name: String,
    },
    /// The editor closed unexpectedly last time, and left a copy of unsaved work.
    Recovered {
        /// The name of the document that was copied.
        name: String,
        /// How old the copy is: *5 minutes ago*.
        age: String,
        /// How many entries of the copy's history the file lacks.
        changes: usize,
        /// Whether the copy holds edits of the text that were not applied.
        has_text: bool,
        /// Whether the file has changed since the copy was made.
        of_another: bool,
    },
    /// Saving would overwrite a file that another program changed after it was opened.
    SaveOver {
        /// The document's name.
        name: String,
    },
    /// Some of the frames to be rendered have files already.
    FramesThere {
        /// How many of them have files.
        there: u64,
        /// How many frames are to be rendered.
        total: u64,
    },
    /// The movie to be rendered would replace a file.
    MovieThere {
        /// The file's name.
        name: String,
    },
    /// The window is closing while frames are being rendered.
    StopRendering {
        /// How many are finished: *47 of 120*.
        count: String,
        /// Whether the finished frames stay; those of a movie do not.
        stays: bool,
    },
    /// Parts of the file could not be read; saving over it would lose them for good.
    Problems {
        /// How many problems are left.
        count: usize,
        /// The line of the first one.
        line: usize,
    },
}

/// The answer that was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Do nothing, and do not go on.
    Cancel,
    /// Save, then go on.
    Save,
    /// Drop what the question is about (unsaved edits, edits of the text, or the recovered copy), and go on.
    Discard,
    /// Take the triangles.
    TakeFaces,
    /// Take the frame as the reference.
    Recapture,
    /// Read the file again and drop the edits.
    ReadAgain,
    /// Apply the edits of the scene's text.
    ReadText,
    /// Copy the files, then save.
    Copy,
    /// Save under another name.
    SaveAs,
    /// Leave everything as it is.
    KeepWorking,
    /// Overwrite what the other program wrote.
    SaveOver,
    /// Open the copy.
    OpenCopy,
    /// Go to the problem.
    ShowProblem,
    /// Save a copy, and leave the file as it is.
    SaveCopy,
    /// Render all frames, and replace existing files.
    ReplaceFrames,
    /// Render only the frames that have no file.
    KeepFrames,
    /// Stop rendering.
    StopRendering,
}

/// Shows the question over everything else. Returns the answer once there is one. `Enter` chooses the last button,
/// which is the safe one.
pub fn ask(ctx: &egui::Context, question: &Question) -> Option<Answer> {
    let (title, words, verbs): (_, _, &[(&str, Answer)]) = match question {
        Question::SaveChanges { name, minutes } => (
            format!("Save changes to \u{201c}{name}\u{201d}?"),
            match minutes {
                0 => "You edited it just now.".to_owned(),
                1 => "You edited it for a minute.".to_owned(),
                minutes => format!("You edited it for {minutes} minutes."),
            },
            &[("Don\u{2019}t save", Answer::Discard), ("Cancel", Answer::Cancel), ("Save", Answer::Save)],
        ),
        Question::UnreadText { name } => (
            format!("Drop your changes to the text of \u{201c}{name}\u{201d}?"),
            "They have not been read: the scene does not have them.".to_owned(),
            &[("Drop them", Answer::Discard), ("Cancel", Answer::Cancel), ("Read them", Answer::ReadText)],
        ),
        Question::TakeFaces { taken } => (
            "Take from other regions?".to_owned(),
            format!("{taken} would be in the new part only. Their strokes follow it."),
            &[("Take them", Answer::TakeFaces), ("Cancel", Answer::Cancel)],
        ),
        Question::Recapture { frame } => (
            format!("Take frame {frame} as the new reference?"),
            format!("Directions stay as they look now; they are stored against frame {frame}."),
            &[("Cancel", Answer::Cancel), ("Recapture", Answer::Recapture)],
        ),
        Question::TakeAlong { count, folder } => (
            format!("Copy {} to {folder}?", counted(*count, "file")),
            "The scene would not find its meshes and pictures from there. Nothing that is there is written over.".to_owned(),
            &[("Cancel", Answer::Cancel), ("Copy and save", Answer::Copy)],
        ),
        Question::ChangedOutside { name } => (
            format!("{name} was changed by another program"),
            "Your edits are not in it.".to_owned(),
            &[
                ("Read it, drop my edits", Answer::ReadAgain),
                ("Save mine as\u{2026}", Answer::SaveAs),
                ("Keep working", Answer::KeepWorking),
            ],
        ),
        Question::Recovered { name, age, changes, has_text, of_another } => (
            "Impasto closed unexpectedly".to_owned(),
            format!(
                "A copy of {name} from {age} has {} that the file does not.{}",
                match (changes, has_text) {
                    (0, true) => "an edited text".to_owned(),
                    (_, true) => format!("{} and an edited text", counted(*changes, "change")),
                    (_, false) => counted(*changes, "change"),
                },
                if *of_another { " The file was changed since." } else { "" }
            ),
            &[
                ("Discard", Answer::Discard),
                ("Later", Answer::Cancel),
                ("Open what was being painted", Answer::OpenCopy),
            ],
        ),
        Question::SaveOver { name } => (
            format!("{name} was changed by another program"),
            "Saving now would take the place of what that one wrote.".to_owned(),
            &[
                ("Save over it", Answer::SaveOver),
                ("Cancel", Answer::Cancel),
                ("Save mine as\u{2026}", Answer::SaveAs),
            ],
        ),
        Question::FramesThere { there, total } => (
            format!("{there} of {} there already", frames_are(*total)),
            "What is replaced cannot be had back. Frames with missing or cut files are rendered in any case."
                .to_owned(),
            &[
                ("Replace all", Answer::ReplaceFrames),
                ("Cancel", Answer::Cancel),
                ("Keep them, render the rest", Answer::KeepFrames),
            ],
        ),
        Question::MovieThere { name } => (
            format!("{name} is there already"),
            "What is replaced cannot be had back.".to_owned(),
            &[("Replace it", Answer::ReplaceFrames), ("Cancel", Answer::Cancel)],
        ),
        Question::StopRendering { count, stays } => (
            "Stop rendering and close?".to_owned(),
            match stays {
                true => format!("{count} frames are finished and stay. The rest would not be rendered."),
                false => format!("{count} frames are finished. A movie that is not whole is not kept."),
            },
            &[("Stop and close", Answer::StopRendering), ("Keep rendering", Answer::Cancel)],
        ),
        Question::Problems { count, line } => (
            format!("This scene has {} left", counted(*count, "problem")),
            format!("Saving over it would lose what could not be read (line {line})."),
            &[
                ("Cancel", Answer::Cancel),
                ("Show the problem", Answer::ShowProblem),
                ("Save a copy\u{2026}", Answer::SaveCopy),
            ],
        ),
    };
    let names: Vec<_> = verbs.iter().map(|(words, _)| *words).collect();
    // `Esc` chooses Cancel. Without a Cancel it chooses the last button, which then changes nothing.
    let cancel = verbs.iter().position(|(_, answer)| *answer == Answer::Cancel).unwrap_or(names.len() - 1);
    let chosen = dialog(ctx, &Dialog { title: &title, words: &words, verbs: &names, cancel })?;
    verbs.get(chosen).map(|(_, answer)| *answer)
}

fn frames_are(count: u64) -> String {
    if count == 1 { "1 frame is".to_owned() } else { format!("{count} frames are") }
}

fn counted(count: usize, what: &str) -> String {
    if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") }
}
