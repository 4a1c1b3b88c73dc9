//! Links and chains: their mechanics, what sand does to them, and the trends that are stated of them.

mod chain_mechanics;
mod common;
mod hinged_links;
mod links_in_sand;
mod two_link_trends;
