//! The machine that runs the benchmarks.

use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// Bind this process to its current processor, so that the operating system does not migrate it.
#[cfg(target_os = "linux")]
pub fn stay_on_one_processor() {
    // SAFETY: a zeroed set is an empty set; the processor's number is the system's own, and -1 (unknown) is left out.
    unsafe {
        let here = libc::sched_getcpu();
        if let Ok(here) = usize::try_from(here) {
            let mut set: libc::cpu_set_t = std::mem::zeroed();
            libc::CPU_SET(here, &mut set);
            libc::sched_setaffinity(0, size_of::<libc::cpu_set_t>(), &set);
        }
    }
}

/// On other systems nothing is bound.
#[cfg(not(target_os = "linux"))]
pub fn stay_on_one_processor() {}

/// The processor's name, as Linux knows it.
pub fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or(format!("unknown {}", std::env::consts::ARCH), |(_, name)| name.to_string())
}

/// The compiler that is installed here, which compiled this.
pub fn rustc() -> String {
    let output = Command::new("rustc").arg("--version").output();
    output.map_or("rustc, version unknown".into(), |output| String::from_utf8_lossy(&output.stdout).trim().to_string())
}

/// Today as year-month-day, in Greenwich (Hinnant, "chrono-compatible low-level date algorithms", civil_from_days).
pub fn date() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let days = seconds / 86400 + 719_468; // since 1 March of the year 0
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153; // 0 is March
    let day = day - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{}-{month:02}-{day:02}", era * 400 + year + next)
}
