//! Robots of many links, in both languages: chains and stars.

/// A robot of n moving links, as text.
pub type Robot = fn(usize) -> String;

/// Their names, and the functions that make them.
pub const ROBOTS: [(&str, Robot); 4] = [
    ("URDF, a chain", |n| urdf(n, |k| k - 1)),
    ("URDF, a star", |n| urdf(n, |_| 0)),
    ("MJCF, chains of 100", mjcf_chains),
    ("MJCF, a star", |n| mjcf(&format!("{BODY}</body>").repeat(n))),
];

const BODY: &str = "<body pos='0 0 0.1'><joint axis='0 1 0'/><geom size='0.05'/>";

fn urdf(n: usize, parent: fn(usize) -> usize) -> String {
    let link = |k: usize| {
        format!(
            "<link name='l{k}'><inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>\
             </link>\n<joint name='j{k}' type='continuous'><parent link='l{}'/><child link='l{k}'/><origin xyz='0 0 0.1'/>\
             <axis xyz='0 1 0'/></joint>\n",
            parent(k)
        )
    };
    format!("<robot name='r'><link name='l0'/>\n{}</robot>", (1..=n).map(link).collect::<String>())
}

fn mjcf(bodies: &str) -> String {
    format!("<mujoco><worldbody>{bodies}</worldbody></mujoco>")
}

/// Elements are nested at most 256 deep, so one chain cannot be longer.
fn mjcf_chains(n: usize) -> String {
    mjcf(&(BODY.repeat(100) + &"</body>".repeat(100)).repeat(n / 100))
}
