//! Networks.
pub mod ours;
pub mod batch;
#[cfg(test)]
mod tests;
