//! `cargo xtask release --dry-run VERSION`: everything that publishing needs, without publishing.

pub mod api;
mod changelog;
mod crates;
mod packages;
mod user;
mod version;

use crate::report::Report;
use crate::workspace::Workspace;

/// Each check is a step; none changes a committed file.
pub fn rehearse(workspace: &Workspace, version: &str, report: &mut Report) {
    report.step("tree", || version::tree(workspace));
    report.step("version", || version::check(workspace, version));
    report.step("changelog", || changelog::check(workspace, version));
    report.step("metadata", || crates::check(workspace));
    report.step("features", || crates::features(workspace));
    report.step("public items", || api::write(workspace));
    report.step("compatibility", || api::compare(workspace));
    report.step("packages", || packages::write(workspace, version));
    report.step("documentation of the packages", || packages::test(workspace, version));
    report.step("a user's program", || user::build(workspace, version));
    report.step("the command line", || user::install(workspace, version));
}
