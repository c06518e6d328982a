//! `mozzi`: the dynamics of robots on the command line. It converts arguments, calls the library and reports
//! errors; every formula is the library's.

mod angles;
mod bag;
mod columns;
mod commands;
mod conditions;
mod controller;
#[cfg(test)]
mod documents;
mod edits;
mod effect;
mod exit;
mod failure;
mod figure_file;
mod goals;
mod ground;
mod guess;
mod input;
mod inputs;
mod interrupt;
mod json;
mod json_file;
mod limits;
mod log;
mod missing;
mod motors;
mod numbers;
mod output;
mod outputs;
mod progress;
mod quantity;
mod recogniser;
mod report;
mod robot;
mod robot_json;
mod rows;
mod sarif;
mod serve;
mod sqlite;
mod state;
mod table;
mod tables;
mod task;
mod terminal;
mod text_table;
mod tip;
#[doc(hidden)]
pub mod untrusted;
mod version;
mod workload;
mod xacro_arguments;

use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
use commands::{assemble, check, compute, convert, explain, info, robots, screws, simulate, terms, tour};
use failure::{Failure, Result};
use mozzi_report::text;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

/// Dynamics of robots, in the notation of Lynch & Park, Modern Robotics, chapter 8.
///
/// Without a subcommand: a tour with the UR5 arm. MODEL is a file (URDF, xacro, MuJoCo's MJCF, SDFormat,
/// or JSON of `mozzi convert`), - for standard input, or the name of an embedded robot.
#[derive(Parser, Debug)]
#[command(name = "mozzi", version, long_version = version::long(), after_help = help(), after_long_help = help())]
#[command(term_width = text::page_width(), args_conflicts_with_subcommands = true)]
struct Arguments {
    /// Write the motion of the tour to a table
    #[arg(long, value_name = "FILE.csv")]
    out: Option<String>,
    #[command(subcommand)]
    command: Option<Command>,
}

/// The text after the list of commands.
fn help() -> String {
    format!("{EXAMPLES}\n{}", exit::help())
}

#[derive(Subcommand, Debug)]
#[allow(clippy::large_enum_variant)] // there is one value
enum Command {
    /// List the embedded robots, and the kinds of files
    #[command(aliases = ["robot", "models", "model", "list", "ls"])]
    Robots(robots::RobotsArguments),
    /// Show the robot: joints, limits, links, masses, frames; without a robot, list the embedded ones
    #[command(mut_arg("model", info::model))]
    Info(info::InfoArguments),
    /// Print the book's lists: M_i, M_i-1,i, S_i, B_i, A_i, G_i
    Screws(screws::ScrewsArguments),
    /// Compute every quantity at one state: T, J, M, C, c, g, h, JᵀF, τ, θ̈, energies, Λ, η, …
    #[command(alias = "dynamics")]
    Terms(terms::TermsArguments),
    /// Compute one quantity, at one state or at every state of a table: τ, θ̈, M, Jacobians, derivatives, …
    #[command(after_help = format!("{COMPUTE}\n\n{TABLES}"), mut_arg("model", compute::model))]
    Compute(compute::ComputeArguments),
    /// Measure how long each quantity takes on this machine, for one state and for many
    #[command(alias = "benchmark")]
    Bench(commands::bench::BenchArguments),
    /// Inverse kinematics: joint positions that place the end effector at a desired pose, or at a table of poses
    #[command(aliases = ["inverse-kinematics", "inverse_kinematics"])]
    Ik(commands::ik::IkArguments),
    /// Identify the robot from logs of its motion: masses, inertias, friction that predict the measured torques
    #[command(after_help = IDENTIFICATIONS)]
    Identify(commands::identify::IdentifyArguments),
    /// Find a motion that determines the robot's parameters, within limits, and the confidence that it will give
    #[command(after_help = EXCITATIONS)]
    Excite(commands::excite::ExciteArguments),
    /// Plan a trajectory in joint space or along lines and screws, within limits of velocity, acceleration and torque
    #[command(after_help = TRAJECTORIES, aliases = ["plan", "traj"])]
    Trajectory(commands::trajectory::TrajectoryArguments),
    /// Close a robot's loops: positions and velocities that satisfy its constraints, and how many it has
    Assemble(assemble::AssembleArguments),
    /// Simulate the motion from a state, under joint torques and a tip wrench
    #[command(after_help = SIMULATIONS, alias = "sim")]
    Simulate(simulate::SimulateArguments),
    /// Show the robot in a browser: a motion with plots, or a slider for each joint
    #[command(after_help = TABLES, aliases = ["show", "visualize"])]
    View(commands::view::ViewArguments),
    /// Play with a robot in a browser: drop its file, drag it, simulate it in real time, read every quantity
    #[command(mut_arg("model", commands::play::model))]
    Play(commands::play::PlayArguments),
    /// Draw the robot at one configuration for papers: SVG; PNG and PDF if built with these features
    #[command(alias = "draw")]
    Picture(commands::picture::PictureArguments),
    /// Draw a figure, as SVG, PNG or PDF as `picture`: trajectories, energy, phase portraits, convergence, ellipsoids
    #[command(after_help = TABLES)]
    Plot(commands::plot::PlotArguments),
    /// Check a robot's file: all errors and warnings, each with its place
    #[command(aliases = ["lint", "validate"])]
    Check(check::CheckArguments),
    /// Convert a robot to URDF, SDFormat, MJCF, JSON, or Python for NumPy
    Convert(convert::ConvertArguments),
    /// Derive the equations in symbols: M(θ), c, g, τ, T, J, … as text, LaTeX, SymPy, Python, MATLAB or Julia
    #[command(after_help = DERIVATIONS, aliases = ["equations", "symbolic"])]
    Derive(commands::derive::DeriveArguments),
    /// Generate source text of a robot's quantities in Rust, C or CUDA, or for CasADi; count operations
    Codegen(commands::codegen::CodegenArguments),
    /// Expand a xacro file, with values of its arguments
    Xacro(commands::xacro::XacroCommand),
    /// Compare with Pinocchio and MuJoCo on the same file, and explain differences (needs Python)
    Compare(commands::compare::CompareArguments),
    /// Explain a diagnostic's code, such as mozzi::urdf::zero_axis
    Explain(explain::ExplainArguments),
    /// Print the script that lets a shell complete this command line
    Completions(commands::completions::CompletionsArguments),
    /// Print the manual's page, or write all of them to a folder
    Man(commands::man::ManArguments),
}

const EXAMPLES: &str = "\
Examples:
  mozzi                                  the tour
  mozzi robots                           the embedded robots
  mozzi info panda                       joints, limits, links, masses, frames
  mozzi check my_robot.urdf              errors and warnings of a file
  mozzi terms ur5 --q 0,-1.2,1.5,0.3,1.1,0
                                         the terms of the dynamics at a state
  mozzi compute ur5 M,h,g --q 0,-70,85,20,60,0 --deg
                                         quantities by their symbols; degrees
  mozzi compute ur5 rnea --in motion.csv --out torques.csv
                                         a quantity at every state of a table
  mozzi compute --list                   every quantity: formula, inputs, outputs
  mozzi ik ur5 --position 0.4,0.2,0.5 --rpy pi,0,0
                                         joint positions for a pose of the tool
  mozzi simulate ur5 --controller computed-torque --response 0.1
                                         motors hold the arm where it starts
  mozzi simulate double_pendulum --q 1.5,0 --time 5 --out swing.csv
  mozzi view my_robot.urdf --out arm.html
                                         the robot as one HTML file
  mozzi view double_pendulum swing.csv   a motion in the browser
  mozzi picture ur5 --q 0,-1.2,1.5,0.3,1.1,0 --out arm.svg
                                         a drawing for a paper
  mozzi play my_robot.urdf               drag, simulate, edit, read everything
  mozzi convert my_robot.urdf my_robot.json
                                         links, joints and the book's lists
  mozzi identify ur5 log.csv             parameters from logs of its motion
`mozzi COMMAND --help` has more.

Units: rad, m, s, kg, N. Twists and wrenches: angular part first.
F_tip is the wrench that the robot applies to the environment, in the end effector's frame.
Results go to standard output, messages to standard error.";

const TABLES: &str = "\
CSV files have a header and one row for each state; columns in any order:
  t                                     time, s
  theta_1 … theta_n                     positions; likewise dtheta_, ddtheta_, tau_, x_;
                                        a joint by its number, or by its name: theta_elbow_joint;
                                        floating base: theta_base.qw qx qy qz x y z, and
                                        dtheta_base.wx wy wz vx vy vz, likewise ddtheta_, tau_
  m_x m_y m_z f_x f_y f_z               the tip's wrench on the environment, in the tip's frame
Columns of .arrow, .feather, .parquet and structured .npy files have the same names; .npz has
arrays t (N,), theta (N, nq), dtheta (N, n), …
Missing groups dtheta, ddtheta and wrench are 0, and so are the six entries of a floating
base in tau. Every subcommand reads the files that another writes.";

const TRAJECTORIES: &str = "\
Examples:
  mozzi trajectory ur5 --to 1,-1,1,0,0.5,0                         joint space, the shortest quintic
  mozzi trajectory ur5 --to 1,-1,1,0,0.5,0 --profile fastest --max-acceleration 15 --out way.csv
  mozzi trajectory ur5 --from 0,-1.2,1.5,0.3,1.1,0 --path line --position 0.4,0.2,0.5 --time 2
  mozzi trajectory ur5 --via points.csv --profile trapezoidal      a spline through points
  mozzi simulate ur5 --follow way.csv --controller computed.json   see mozzi simulate --help";

const IDENTIFICATIONS: &str = "\
Examples:
  mozzi identify ur10.urdf log.csv --out identified.urdf --report fit.html
  mozzi identify panda.urdf log.csv --torque link --lock panda_finger_joint1=0 --cutoff 4
  mozzi identify ur5 log.csv --only payload --payload tool0          weigh what the robot carries
  mozzi identify ur5 log.csv --only friction --stribeck 0.1
  mozzi identify ur5 a.csv b.csv --validate c.csv --fit 70           several logs; 30 % of each is predicted
  mozzi identify ur5 a.csv b.csv --torque current --known-payload 2:tool0=4,0,0.05,0.1
Logs are described in docs/identify.md: names of columns such as theta_elbow, q1, pos_elbow_deg, effort_elbow, current_1.";

const EXCITATIONS: &str = "\
Examples:
  mozzi excite ur5 --duration 20 --out way.csv
  mozzi excite panda --lock panda_finger_joint1=0.02 --max-velocity 1 --max-acceleration 4 --within panda_hand=-0.7,-0.7,0.1,0.7,0.7,1.2
  mozzi excite ur5 --apart wrist_3_link,base_link=0.1,0.2 --goal condition --json
The motion is smooth, and begins and ends at rest. Then: run it, log it, `mozzi identify`.";

const DERIVATIONS: &str = "\
Examples:
  mozzi derive two_link_planar --equal link
  mozzi derive two_link_planar tau --equal link --as latex
  mozzi derive furuta_pendulum M c g --as sympy > furuta.py
  mozzi derive ur5 M --symbols none --cse --as python
  mozzi derive two_link_planar c --collect velocities
Every printed expression is compared with the kernel, exactly, at random points.";

const SIMULATIONS: &str = "\
Examples:
  mozzi simulate double_pendulum --theta 1.5,0 --time 5 --out swing.csv
  mozzi simulate double_pendulum --theta 2,1 --method dopri --report-event 'joint1 = 0' --until 'tip.z > 0.4'
  mozzi simulate panda --method dopri --until joint-limit
  mozzi simulate ur5 --follow way.csv --controller computed.json
An event is the moment a condition becomes true: the zero of the polynomial between two steps, as exact as the method.
Conditions that are true for less than a quarter of a step may be missed.

Tables are described in `mozzi compute --help`: t, theta_1 …, dtheta_1 …, tau_1 …; --follow reads what `mozzi trajectory` writes.

--controller is a name: pd-gravity, computed-torque, task-space, impedance of the end effector, standing on the feet of
--ground; gains then follow from --response, a time constant. Or it is a file of a JSON object; gains are one number for
all, or lists:
  {\"controller\": \"pd-gravity\", \"p\": 200, \"d\": 40}               g(θ) + k(θ − θ₀) + p e + d ė; N m/rad, N m s/rad
  {\"controller\": \"computed-torque\", \"p\": 100, \"d\": 20}          ë + d ė + p e = 0; 1/s², 1/s
  {\"controller\": \"task-space\", \"frame\": \"tool0\", \"p\": 100, \"d\": 20, \"posture_p\": 25, \"posture_d\": 10}
  {\"controller\": \"impedance\", \"frame\": \"tool0\", \"stiffness\": [20, 20, 20, 500, 500, 500], \"damping\": [1, 1, 1, 50, 50, 50],
   \"posture_p\": 25, \"posture_d\": 10}
Without posture_p and posture_d the posture has the gains of --response. An additional \"model\": \"FILE or embedded robot\" is the controller's own model of the robot.";

const COMPUTE: &str = "\
Examples:
  mozzi compute --list                                          every quantity: its formula, inputs and outputs
  mozzi compute panda mass-matrix --theta 0,0.5,0,-1.5,0,2,0,0.02
  mozzi compute ur5 body-jacobian --frame forearm_link
  mozzi compute two_link_planar task-space-dynamics --theta 0.3,0.8 --task vx,vz
  mozzi compute ur5 inverse-dynamics --wrench tool0=0,0,0,0,0,20 --wrench forearm_link=0,0,0,1,0,0 --json
  mozzi compute ur5 inverse-dynamics --in motion.csv --out torques.csv
  mozzi compute ur5 mass-matrix --in states.npy --out M.npz --precision f32
A flag that has no effect on the quantity is an error.

Files with N states:
  .npy             one array (N, columns): the quantity's inputs in order, such as theta | dtheta | ddtheta,
                   then the tip's wrench m_x m_y m_z f_x f_y f_z if there are six more columns; or a
                   structured array (N,) with names as in CSV, such as `mozzi simulate` writes
  .npz             arrays theta (N, nq), dtheta, ddtheta, tau, x (N, n), wrench (N, 6) of the tip; also
                   gravity (N, 3), parameters (N, p) and wrench_FRAME (N, 6), different in each state
  .arrow .feather  columns as in CSV (pandas.to_feather, polars.write_ipc), if built with feature arrow
  .csv             columns theta_1 …, see below; wrench_FRAME_m_x … wrench_FRAME_f_z of a frame's wrench
  .parquet         columns as in CSV, if built with this feature and not compressed
Numbers are float64, float32 or integers. Wrenches given by flags are the same in all states.
Results, by rows: (N,), (N, n), (N, n, n), (N, 6, n) angular rows first, (N, 4, 4)
  .npy             one array; .npz: one array per output, by name
  .arrow .csv      one column per entry: tau_1 …, M_1_1, M_1_2 …; CSV of vectors begins with t and the inputs
NaN in a state gives NaN in the results of that state only; text tables (.csv) have none.";

/// The arguments, and whether their outputs can be written; flags that have no effect are an error.
fn parsed(words: Vec<OsString>) -> Result<(Arguments, Result<()>), clap::Error> {
    let mut program = numeric(Arguments::command());
    let words = guess::meant(guess::joined(words), &program)
        .map_err(|said| program.error(ErrorKind::MissingRequiredArgument, said))?;
    let matches = program.try_get_matches_from_mut(&words).map_err(|error| tip::explained(error, &program, &words))?;
    effect::check(&mut program, &matches)?;
    let is_set = |matches: &clap::ArgMatches| matches.try_get_one("deg").ok().flatten().copied() == Some(true);
    angles::set_degrees(matches.subcommand().is_some_and(|(_, matches)| is_set(matches)));
    let outputs = outputs::check(&program, &matches);
    let arguments = Arguments::from_arg_matches(&matches).map_err(|error| error.format(&mut program))?;
    Ok((arguments, outputs))
}

/// The program whose flags may have negative numbers: `--cutoff -1` is a wrong number, not an unknown flag.
fn numeric(program: clap::Command) -> clap::Command {
    let negative = |argument: clap::Arg| {
        let takes_numbers = argument.get_long().is_some() && argument.get_action().takes_values();
        if takes_numbers { argument.allow_negative_numbers(true) } else { argument }
    };
    program.mut_subcommands(|command| command.mut_args(negative))
}

/// The program.
pub fn main() -> ExitCode {
    ExitCode::from(run_with(std::env::args_os()))
}

/// The program with these words, of which the first is its name; returns its exit code.
pub fn run_with(words: impl IntoIterator<Item = OsString>) -> u8 {
    mozzi_urdf::files::remember(); // so that no file that is read is overwritten
    let words: Vec<OsString> = words.into_iter().collect();
    let has_odd_words = words.iter().any(|word| is_odd(&word.to_string_lossy()));
    let (arguments, outputs) = match parsed(words) {
        Ok(arguments) => arguments,
        Err(error) if error.use_stderr() && has_odd_words => {
            failure::write(&error.render().to_string()); // without colours
            return exit::USAGE;
        }
        Err(error) => {
            let _ = error.print(); // as clap's own exit, which would also end Python
            return if error.use_stderr() { exit::USAGE } else { exit::SUCCESS };
        }
    };
    let answer = outputs.and_then(|()| run(&arguments));
    let (text, code) = match answer {
        Ok(text) => (text, exit::SUCCESS),
        Err(failure) => {
            failure.say();
            match failure {
                Failure::Answered(text) => (text, exit::FAILED),
                Failure::Stopped(text) => (text, exit::STOPPED),
                _ => (String::new(), exit::FAILED),
            }
        }
    };
    let mut output = std::io::stdout().lock();
    match output.write_all(terminal::result(&text).as_bytes()).and_then(|()| output.flush()) {
        Ok(()) => code,
        // the reader has closed the pipe
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => code,
        Err(error) => {
            Failure::wrong(format!("standard output cannot be written: {error}")).say();
            exit::FAILED
        }
    }
}

/// True for a text that could control a terminal, or flood it.
fn is_odd(word: &str) -> bool {
    terminal::message(word) != word
}

fn run(arguments: &Arguments) -> Result<String> {
    match &arguments.command {
        None => tour::run(arguments.out.as_deref()),
        Some(Command::Robots(arguments)) => robots::run(arguments),
        Some(Command::Info(arguments)) => info::run(arguments),
        Some(Command::Screws(arguments)) => screws::run(arguments),
        Some(Command::Terms(arguments)) => terms::run(arguments),
        Some(Command::Compute(arguments)) => compute::run(arguments),
        Some(Command::Bench(arguments)) => commands::bench::run(arguments),
        Some(Command::Ik(arguments)) => commands::ik::run(arguments),
        Some(Command::Identify(arguments)) => commands::identify::run(arguments),
        Some(Command::Excite(arguments)) => commands::excite::run(arguments),
        Some(Command::Trajectory(arguments)) => commands::trajectory::run(arguments),
        Some(Command::Assemble(arguments)) => assemble::run(arguments),
        Some(Command::Simulate(arguments)) => simulate::run(arguments),
        Some(Command::Check(arguments)) => check::run(arguments),
        Some(Command::Derive(arguments)) => commands::derive::run(arguments),
        Some(Command::Codegen(arguments)) => commands::codegen::run(arguments),
        Some(Command::Compare(arguments)) => commands::compare::run(arguments),
        Some(Command::Convert(arguments)) => convert::run(arguments),
        Some(Command::Explain(arguments)) => explain::run(arguments),
        Some(Command::Completions(arguments)) => commands::completions::run(arguments, Arguments::command()),
        Some(Command::Man(arguments)) => commands::man::run(arguments, Arguments::command()),
        Some(Command::Xacro(arguments)) => commands::xacro::run(arguments),
        Some(Command::Picture(arguments)) => commands::picture::run(arguments),
        Some(Command::Plot(arguments)) => commands::plot::run(arguments),
        Some(Command::Play(arguments)) => commands::play::run(arguments),
        Some(Command::View(arguments)) => commands::view::run(arguments),
    }
}
