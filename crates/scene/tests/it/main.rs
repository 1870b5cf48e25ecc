//! Tests of reading files, and of the pages that are made from the source. All are one program, since linking one for
//! each file of tests would take longer.

mod aovs_page;
mod obj;
mod obj_surface;
mod scene_file_page;
mod texture;
