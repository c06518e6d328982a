//! What Pinocchio and MuJoCo compute of the same file, and why it differs.

pub mod answer;
pub mod bodies;
pub mod cause;
pub mod constants;
pub mod numbers;
pub mod python;
pub mod question;
pub mod report_json;
pub mod report_text;
#[cfg(test)]
mod tests;
pub mod verdict;
pub mod words;
