//! Shots on many machines. [`pack`] puts everything that a shot needs into one file or folder; [`job`] writes what a farm is asked for, in
//! the words of [`openjd`] or [`slurm`]. There is no scheduler here: the farms that people have do that.

pub mod job;
pub mod openjd;
pub mod pack;
mod quoting;
pub mod slurm;
