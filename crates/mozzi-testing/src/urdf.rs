//! The second reader of URDF, for wide numbers: `mozzi_symbolic::read_urdf`.

use crate::wide::Wide;
use mozzi::Description;
use mozzi_symbolic::NotRead;

/// The first reader's description of a file, with the file's decimals in wide numbers.
///
/// # Errors
/// [`NotRead`] if the second reader does not know an element, or the two readers disagree.
pub fn read_urdf<W: Wide>(text: &str, robot: &Description) -> Result<Description<W>, NotRead> {
    let read = mozzi_symbolic::read_urdf(text, robot, |_| true, W::from_f64, |_, number| W::parse(number))?;
    mozzi_symbolic::agree(&read, robot, 1e-14)?;
    Ok(read)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Double, Octuple};

    const TEXT: &str = r#"<robot name="r"><link name="a"/><link name="b"><inertial><origin xyz="0.1 0.2 0.3" rpy="0.1 0 0.7"/>
        <mass value="1.3"/><inertia ixx="0.3" ixy="0.01" ixz="0.02" iyy="0.2" iyz="0" izz="0.25"/></inertial></link>
        <joint name="j" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 0.333" rpy="1.5707963 0 0.1"/>
        <axis xyz="0 0.6 0.8"/><limit lower="-1" upper="1" effort="1" velocity="1"/><dynamics damping="0.7"/></joint></robot>"#;

    fn first() -> Description {
        mozzi_urdf::parse("r.urdf", TEXT).expect("sound").description
    }

    #[test]
    fn decimals_keep_their_digits() {
        let robot = read_urdf::<Octuple>(TEXT, &first()).expect("read");
        let error = robot.joints[0].origin.p.0[2] - Octuple::parse("0.333").expect("a number");
        assert_eq!(f64::from(error), 0.0);
        assert!(f64::from(robot.joints[0].origin.p.0[2] - Octuple::from(0.333)) != 0.0, "f64 has not all of 0.333");
        let model = read_urdf::<Double>(TEXT, &first()).expect("read").build().expect("sound");
        assert_eq!(model.n(), 1);
    }

    #[test]
    fn readers_that_disagree_are_told() {
        let mut other = first();
        other.joints[0].damping = 0.8;
        let error = read_urdf::<Double>(TEXT, &other).expect_err("another damping").to_string();
        assert!(error.starts_with("j: the second reader finds"), "{error}");
    }
}
