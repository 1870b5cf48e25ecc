//! Tests of documents under any commands, any files and any moment of death. One program, since each more is linked anew.

mod any_command;
mod history;
mod hostile;
mod killed;
