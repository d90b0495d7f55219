//! Tests of the floor as a whole.

mod areal;
mod brownian;
mod models;
mod shipped;
