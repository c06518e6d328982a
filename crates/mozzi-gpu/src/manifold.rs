//! The text of ⊕, ⊖ and the rate of the logarithm, as of [`mozzi::kinematics`] on the CPU, for a robot's θ.

use mozzi::model::ConfigurationSpace;
use mozzi::{Freedom, Place};

/// Device functions of the ROBOT, of NUMBERs.
pub fn text(space: &ConfigurationSpace) -> String {
    let is_there = |freedom: Freedom| space.places().iter().any(|place| place.freedom == freedom);
    let mut text = String::new();
    if !space.is_flat() {
        text += QUATERNIONS;
    }
    if is_there(Freedom::Free) {
        text += POSES;
    }
    let each = |line: fn(&Place) -> Option<String>| -> String {
        space.places().iter().filter_map(line).map(|line| format!("    {line}\n")).collect()
    };
    let [advance, rate, difference] = [each(advance), each(rate), each(difference)];
    text + &FUNCTIONS.replace("ADVANCE", &advance).replace("RATE", &rate).replace("DIFFERENCE", &difference)
}

/// q ← q ⊕ v h.
fn advance(&Place { freedom, q, j }: &Place) -> Option<String> {
    Some(match freedom {
        Freedom::One => format!("q[{q}] += v[{j}] * h;"),
        Freedom::Ball => format!("ROBOT_turn(q + {q}, v[{j}] * h, v[{}] * h, v[{}] * h);", j + 1, j + 2),
        Freedom::Free => format!("ROBOT_move(q + {q}, v + {j}, h);"),
    })
}

/// v ← v + ½ `[ad_u]`v + ¹⁄₁₂ `[ad_u]`²v with u = k h.
fn rate(&Place { freedom, j, .. }: &Place) -> Option<String> {
    match freedom {
        Freedom::One => None,
        Freedom::Ball => Some(format!("ROBOT_rate_of_logarithm<3>(k + {j}, h, v + {j});")),
        Freedom::Free => Some(format!("ROBOT_rate_of_logarithm<6>(k + {j}, h, v + {j});")),
    }
}

/// d ← to ⊖ from.
fn difference(&Place { freedom, q, j }: &Place) -> Option<String> {
    Some(match freedom {
        Freedom::One => format!("d[{j}] = to[{q}] - from[{q}];"),
        Freedom::Ball => format!("ROBOT_log(from + {q}, to + {q}, d + {j});"),
        Freedom::Free => format!("ROBOT_log_of_pose(from + {q}, to + {q}, d + {j});"),
    })
}

const FUNCTIONS: &str = r#"
// q plus v h on its manifold.
static __device__ __forceinline__ void ROBOT_advance(NUMBER *q, const NUMBER *v, const NUMBER h)
{
ADVANCE}

// The rate of the logarithm of q_start^-1 q, which is k h, while q moves with v.
static __device__ __forceinline__ void ROBOT_rate(const NUMBER *k, const NUMBER h, NUMBER *v)
{
    (void) k, (void) h, (void) v;
RATE}

// From one q to another in one second.
static __device__ __forceinline__ void ROBOT_difference(const NUMBER *from, const NUMBER *to, NUMBER *d)
{
DIFFERENCE}
"#;

/// Quaternions (w, x, y, z) of any length.
const QUATERNIONS: &str = r#"
// c = a x b.
static __device__ __forceinline__ void ROBOT_cross(const NUMBER *a, const NUMBER *b, NUMBER *c)
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

// q e^[x, y, z], of length 1.
static __device__ __forceinline__ void ROBOT_turn(NUMBER *q, const NUMBER x, const NUMBER y, const NUMBER z)
{
    const NUMBER square = x * x + y * y + z * z, angle = sqrt(square);
    const NUMBER s = square > 0 ? sin(angle / 2) / angle : (NUMBER) 0.5, c = cos(angle / 2);
    const NUMBER a = s * x, b = s * y, d = s * z;
    const NUMBER w = q[0] * c - q[1] * a - q[2] * b - q[3] * d;
    const NUMBER i = q[0] * a + q[1] * c + q[2] * d - q[3] * b;
    const NUMBER j = q[0] * b - q[1] * d + q[2] * c + q[3] * a;
    const NUMBER k = q[0] * d + q[1] * b - q[2] * a + q[3] * c;
    const NUMBER length = sqrt(w * w + i * i + j * j + k * k);
    q[0] = w / length;
    q[1] = i / length;
    q[2] = j / length;
    q[3] = k / length;
}

// v + 1/2 [ad_u] v + 1/12 [ad_u]^2 v with u = k h, of rotations (3 numbers) or twists (6).
template <int numbers>
static __device__ __forceinline__ void ROBOT_rate_of_logarithm(const NUMBER *k, const NUMBER h, NUMBER *v)
{
    NUMBER of[numbers], sum[numbers];
#pragma unroll
    for (int i = 0; i < numbers; ++i) of[i] = sum[i] = v[i];
#pragma unroll
    for (int order = 1; order < 3; ++order) {
        NUMBER w[3], x[3] = {0, 0, 0}, y[3] = {0, 0, 0};
        ROBOT_cross(k, of, w);
        if (numbers == 6) {
            ROBOT_cross(k + 3 % numbers, of, x);
            ROBOT_cross(k, of + 3 % numbers, y);
        }
        const NUMBER weight = order == 1 ? (NUMBER) 1 / 2 : (NUMBER) 1 / 12;
#pragma unroll
        for (int i = 0; i < numbers; ++i) {
            of[i] = h * (i < 3 ? w[i % 3] : x[i % 3] + y[i % 3]);
            sum[i] += weight * of[i];
        }
    }
#pragma unroll
    for (int i = 0; i < numbers; ++i) v[i] = sum[i];
}

// The logarithm of from^-1 to, by the shorter rotation.
static __device__ __forceinline__ void ROBOT_log(const NUMBER *from, const NUMBER *to, NUMBER *d)
{
    NUMBER w = from[0] * to[0] + from[1] * to[1] + from[2] * to[2] + from[3] * to[3];
    NUMBER x[3];
    ROBOT_cross(to + 1, from + 1, x);
#pragma unroll
    for (int i = 0; i < 3; ++i) x[i] += from[0] * to[i + 1] - to[0] * from[i + 1];
    const NUMBER s = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]), sign = w < 0 ? -1 : 1;
    const NUMBER scale = s > 0 ? sign * 2 * atan2(s, sign * w) / s : 2 / w;
#pragma unroll
    for (int i = 0; i < 3; ++i) d[i] = scale * x[i];
}
"#;

/// Poses: a quaternion and the origin. Below a square of 10⁻⁶ the next term of the series is rounding.
const POSES: &str = r#"
// x + a w x x + b w x (w x x), which J(w) and its inverse are.
static __device__ __forceinline__ void ROBOT_series(const NUMBER *w, const NUMBER a, const NUMBER b, NUMBER *x)
{
    NUMBER once[3], twice[3];
    ROBOT_cross(w, x, once);
    ROBOT_cross(w, once, twice);
#pragma unroll
    for (int i = 0; i < 3; ++i) x[i] += a * once[i] + b * twice[i];
}

// x turned by q, or back.
static __device__ __forceinline__ void ROBOT_rotate(const NUMBER *q, const NUMBER sign, NUMBER *x)
{
    const NUMBER scale = 2 / (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    ROBOT_series(q + 1, sign * scale * q[0], scale, x);
}

// T e^[v h].
static __device__ __forceinline__ void ROBOT_move(NUMBER *T, const NUMBER *v, const NUMBER h)
{
    NUMBER w[3], p[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) {
        w[i] = v[i] * h;
        p[i] = v[i + 3] * h;
    }
    const NUMBER square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], angle = sqrt(square);
    const NUMBER s = square > 0 ? sin(angle / 2) / angle : (NUMBER) 0.5;
    const NUMBER b = square > (NUMBER) 1e-6 ? (angle - sin(angle)) / (square * angle) : (NUMBER) 1 / 6 - square / 120;
    ROBOT_series(w, 2 * s * s, b, p);
    ROBOT_rotate(T, 1, p);
#pragma unroll
    for (int i = 0; i < 3; ++i) T[i + 4] += p[i];
    ROBOT_turn(T, w[0], w[1], w[2]);
}

// The logarithm of from^-1 to.
static __device__ __forceinline__ void ROBOT_log_of_pose(const NUMBER *from, const NUMBER *to, NUMBER *d)
{
    ROBOT_log(from, to, d);
    NUMBER p[3];
#pragma unroll
    for (int i = 0; i < 3; ++i) p[i] = to[i + 4] - from[i + 4];
    ROBOT_rotate(from, -1, p);
    const NUMBER square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2], half = sqrt(square) / 2;
    const NUMBER b = square > (NUMBER) 1e-6 ? (1 - half * cos(half) / sin(half)) / square : (NUMBER) 1 / 12 + square / 720;
    ROBOT_series(d, (NUMBER) -0.5, b, p);
#pragma unroll
    for (int i = 0; i < 3; ++i) d[i + 3] = p[i];
}
"#;
