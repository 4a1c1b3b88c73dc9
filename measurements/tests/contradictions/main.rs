//! Sets that contradict their own frames are named, and sets that do not are left alone.

mod definitions;
mod world;
mod zeros;
