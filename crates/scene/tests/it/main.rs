//! Tests of reading files, and of the pages that are made from the source. One program, since each more is linked anew.

mod aovs_page;
mod obj;
mod obj_surface;
mod scene_file_page;
mod texture;
