//! All tests of the ROS 2 bridge, one binary. Those with a real ROS run in networks of their own.

mod bare;
mod calls;
mod codec;
mod cyclone;
mod definitions;
mod figures;
mod forms;
mod graph;
mod navigation;
mod networks;
mod peers;
mod process;
mod programs;
mod topics;
mod world;
