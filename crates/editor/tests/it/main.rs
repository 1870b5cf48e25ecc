//! Tests of the panels: what they ask for, and how they look. Controls are found by name. All are one program, since
//! each further program would have to be linked.

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
