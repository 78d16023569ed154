//! The bridge for serial ports: its codecs by themselves, the whole of it over pseudo terminals with every fault, and
//! against independent peers where they are installed.

mod board;
mod codecs;
mod config;
mod faults;
mod firmata;
mod lines;
mod peers;
mod terminal;
mod waits;
