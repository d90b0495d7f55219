//! Tests of the floor as a whole.

mod models;
mod seventy_four;
mod shipped;
