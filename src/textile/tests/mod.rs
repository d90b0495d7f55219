//! Tests of the floor as a whole.

mod brownian;
mod models;
mod shipped;
