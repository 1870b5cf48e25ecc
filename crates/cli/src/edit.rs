//! Runs `impasto edit`, which opens the editor's window.

use impasto_editor::files::dialogs::Source;
use impasto_editor::files::preferences::DriverChoice;
use impasto_editor::{EditError, EditOptions};

use crate::args::{EditArguments, EditDriver};
use crate::failure::Failure;

pub(crate) fn run(arguments: &EditArguments) -> Result<(), Failure> {
    let driver = arguments.driver.map(|driver| match driver {
        EditDriver::Auto => DriverChoice::Auto,
        EditDriver::Egl => DriverChoice::Egl,
        EditDriver::Osmesa => DriverChoice::Osmesa,
        EditDriver::Software => DriverChoice::Software,
    });
    let dialogs = if arguments.in_app_dialogs { Source::InApp } else { Source::Desktop };
    let tell: Option<fn(&str)> = arguments.tell.then_some(|words| eprintln!("impasto edit: {words}"));
    let options = EditOptions {
        path: arguments.scene.clone(),
        driver,
        dialogs,
        shaders: arguments.shaders.clone(),
        follow: arguments.follow,
        tell,
    };
    impasto_editor::run(&options).map_err(|error| match error {
        EditError::Refused(words) => Failure::Refused(words),
        EditError::Window(error) => Failure::NoWindow(error.to_string()),
    })
}
