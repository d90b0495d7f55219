//! The workbench: the window in which a scene is felt, tuned and watched.

mod command;
mod history;
mod panes;
mod raster;
mod shortcuts;
mod theme;
mod view;
mod widgets;
mod workspace;

