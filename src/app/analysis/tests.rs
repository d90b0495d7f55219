//! Analyses in the window.
