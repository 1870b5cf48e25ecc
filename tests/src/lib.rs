//! Measuring tools that the tests share: shapes whose answers are known, pictures read and compared.

pub mod command;
pub mod corpus;
pub mod gestures;
pub mod pictures;
pub mod scenes;
pub mod screen;
pub mod shapes;
