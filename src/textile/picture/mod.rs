//! x
pub mod autocorrelation; pub mod basis; pub mod candidates; pub mod directions; pub mod lattice; pub mod light; pub mod maxima; pub mod multiples; pub mod significant;
