//! A station on a bus with charging modules, in single situations.

mod ages;
mod bus;
mod chargers;
mod deliver;
mod drive;
mod found;
mod hear;
mod rivals;
mod settings;
mod stop;
