//! Tests of the floor as a whole.

mod areal;
mod models;
mod shipped;
