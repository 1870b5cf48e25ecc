//! Tests of the panels: what they ask for, and how they look. Controls are found by name. One program, since each more is linked anew.

mod column;
mod headless;
mod page;
mod panels_bars;
mod problems;
mod render_sheet;
mod viewport;
mod widgets;
