//! Shots on many machines. [`pack`] puts everything that a shot needs into one file or folder. A [`job`] says what a
//! farm is to paint, and [`openjd`] or [`slurm`] writes it in a format that farms take. There is no scheduler here:
//! users bring their own.

pub mod job;
pub mod openjd;
pub mod pack;
mod quoting;
pub mod slurm;
