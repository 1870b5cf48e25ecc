//! Tests of the editor's window: what its parts ask for, and how they look. Controls are found by name. All tests are
//! one program, because each further program would have to be linked as well.

mod column;
mod frame_viewer;
mod headless;
mod key_sheet;
mod page;
mod panels_bars;
mod problems;
mod render_sheet;
mod viewport;
mod widgets;
