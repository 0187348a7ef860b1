//! `tradeoff`: what a scene's settings cost and what they buy, against a converged picture of the exact tier.
//!
//! A scene becomes a grid of settings, each of which is rendered in turns and compared: times, rays and errors, of which
//! those that nothing beats are marked. A report of them becomes a table, JSON or a page.

mod axes;
mod figures;
mod page;
mod pareto;
mod plot;
mod report;
mod run;
mod score;
mod setting;
mod sights;
mod table;
mod truth;

pub use figures::{Figures, Pictures};
pub use page::page;
pub use pareto::mark_front;
pub use report::{Report, Row, Times, Truth};
pub use run::{Effort, TradeoffError, tradeoff};
pub use setting::Setting;
pub use table::table;
