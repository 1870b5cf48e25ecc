//! Tests that documents survive any commands, any files, and being killed at any moment. They share one program,
//! because linking several takes longer.

mod any_command;
mod arrange;
mod directions;
mod history;
mod hostile;
mod killed;
mod paint_layers;
