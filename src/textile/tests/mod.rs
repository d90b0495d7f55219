//! Tests of the floor as a whole.

mod adding;
mod areal;
mod brownian;
mod models;
mod seventy_four;
mod shipped;
mod wall_harwin;
