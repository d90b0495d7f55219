//! Tests of the floor as a whole.

mod models;
mod shipped;
