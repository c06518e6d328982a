//! benches/GPU.md.

use super::rollout::Seconds;
use super::{Speed, cases};
use mozzi_gpu::{Device, Nvrtc};
use std::error::Error;

pub fn text(
    device: &Device,
    nvrtc: &Nvrtc,
    states: usize,
    bandwidth: f64,
    speeds: &[Speed],
    rollouts: &[Seconds],
) -> Result<String, Box<dyn Error>> {
    let (major, minor) = nvrtc.version();
    let mut text = format!(
        "# GPU kernels, measured\n\nWritten by `cargo xtask gpu-bench`. {}, {}, {} multiprocessors, {:.2} GHz at most, NVRTC \
         {major}.{minor}. At most {states} states and 1 GiB of arrays, a multiple of 1024 then, 10⁹ states a second: median of 7 repetitions of at least 20 ms \
         on arrays of the device, in brackets the slowest; then once from arrays of the host and back, copies and \
         allocation included. *memory* is the share of the {:.2} TB/s that a kernel reaches which only copies. Errors are \
         the largest of 500 states against the CPU in f64 at the same numbers, relative to the state's largest entry, in \
         ε. *of the bound*: the share of the bound that docs/gpu.md counts in the code for an H200.\n",
        device.name(),
        device.arch(),
        device.multiprocessors()?,
        device.clock_rate()? / 1e9,
        bandwidth / 1e12,
    );
    let mut robot = "";
    for speed in speeds {
        if speed.robot != robot {
            robot = &speed.robot;
            text += &format!(
                "\n## {robot}\n\n| quantity | | registers | on the device | from the host | memory | error, ε |\n"
            );
            text += "|---|---|---|---|---|---|---|\n";
        }
        let [median, least] = speed.states_per_second.map(|x| x / 1e9);
        text += &format!(
            "| {} | {} | {} | {median:.3} ({least:.3}) | {:.4} | {:.0} % | {:.1} |\n",
            cases::title(speed.quantity, speed.form),
            cases::name(speed.form),
            speed.registers,
            speed.with_transfer / 1e9,
            100.0 * speed.states_per_second[0] * speed.bytes as f64 / bandwidth,
            speed.error,
        );
    }
    text += "\n## Rollouts\n\nRunge-Kutta steps of 1 ms without torques, f32, SoA, one kernel, best of 3.\n\n\
             | robot | robots | steps | seconds | forward dynamics a second, 10⁹ |\n|---|---|---|---|---|\n";
    for Seconds { robot, robots, steps, seconds } in rollouts {
        let rate = 4.0 * (robots * steps) as f64 / seconds / 1e9;
        text += &format!("| {robot} | {robots} | {steps} | {seconds:.3} | {rate:.2} |\n");
    }
    Ok(text)
}
