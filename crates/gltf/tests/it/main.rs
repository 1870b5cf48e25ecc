//! Tests of the reader from the outside.

mod build;
mod corpus;
mod forms;
mod lies;
mod motion;
mod peers;
