//! The handwritten monitor as a crate of its own, to measure its size.

#[path = "@BY_HAND@/common.rs"]
pub mod common;
#[path = "@BY_HAND@/@SPEC@.rs"]
pub mod monitor;
