//! The monitor written by hand as a crate of its own, to see what it weighs.

#[path = "@BY_HAND@/common.rs"]
pub mod common;
#[path = "@BY_HAND@/@SPEC@.rs"]
pub mod monitor;
