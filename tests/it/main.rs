//! The integration tests of Impasto.

#![expect(clippy::unwrap_used, reason = "a failed step is a failed test")]

mod aovs;
mod bending;
mod blender;
mod cli;
mod corpus;
mod covered;
mod cut_quads;
mod directions;
mod editor_gestures;
mod editor_journeys;
mod editor_keys;
mod editor_playing;
mod editor_render;
mod editor_script;
mod editor_window;
mod goldens;
mod guides;
mod horn;
mod hostile_directions;
mod hostile_scenes;
mod inverse_bilinear;
mod light_billboards;
mod measure;
mod movies;
mod noise_displace;
mod openness;
mod own_shaders;
mod paint;
mod point_caches;
mod progressive_order;
mod recall;
mod references;
mod roll_and_lateral;
mod rotating_strokes;
mod scenes_in_motion;
mod shift;
mod shipped_scenes;
mod shot_looks;
mod shots;
mod steadiness;
mod sumi_e;
mod turntable;
mod warm_prepare;
mod whole_shot;
