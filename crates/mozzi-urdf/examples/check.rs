//! Says of each file whether it loads, and all that is odd or wrong about it: `check [--plain] FILE…`.
use mozzi_urdf::{Style, open};

fn main() {
    let (mut plain, mut loaded, mut refused) = (false, 0, 0);
    for name in std::env::args().skip(1) {
        if name == "--plain" {
            plain = true;
            continue;
        }
        match open(&name) {
            Ok(robot) => {
                loaded += 1;
                for warning in &robot.warnings {
                    if plain { println!("{warning}") } else { println!("{}", warning.pretty(Style::Unicode)) }
                }
                println!("{name}: {} links, {} warnings", robot.description.links.len(), robot.warnings.len());
            }
            Err(error) => {
                refused += 1;
                if plain { println!("{error}") } else { println!("{}", error.pretty(Style::Unicode)) }
            }
        }
    }
    println!("{loaded} loaded, {refused} refused");
}
