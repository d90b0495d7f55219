//! Tests of the floor as a whole.

mod areal;
mod brownian;
mod keeping;
mod models;
mod seventy_four;
mod shipped;
