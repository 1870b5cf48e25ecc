//! Tools that the tests share: shapes with known answers, pictures to read and compare, the command, a screen.

pub mod command;
pub mod corpus;
pub mod gestures;
pub mod glb;
pub mod pictures;
pub mod scenes;
pub mod screen;
pub mod shapes;
