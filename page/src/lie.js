// Vectors as lists of 3, twists and wrenches as lists of 6 (angular first), configurations as { R, p }: R row-major.

export const dot = (a, b) => {
  let sum = 0;
  for (let k = 0; k < a.length; k++) sum += a[k] * b[k];
  return sum;
};
export const add = (a, b) => a.map((x, k) => x + b[k]);
export const scaled = (a, s) => a.map((x) => x * s);
export const norm = (a) => Math.sqrt(dot(a, a));
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const angular = (V) => [V[0], V[1], V[2]];
export const linear = (V) => [V[3], V[4], V[5]];

export const turned = (R, x) => [
  R[0] * x[0] + R[1] * x[1] + R[2] * x[2],
  R[3] * x[0] + R[4] * x[1] + R[5] * x[2],
  R[6] * x[0] + R[7] * x[1] + R[8] * x[2],
];

export const product3 = (A, B) => {
  const C = new Array(9);
  for (let r = 0; r < 3; r++)
    for (let c = 0; c < 3; c++)
      C[3 * r + c] = A[3 * r] * B[c] + A[3 * r + 1] * B[3 + c] + A[3 * r + 2] * B[6 + c];
  return C;
};

export const transposed3 = (A) => [A[0], A[3], A[6], A[1], A[4], A[7], A[2], A[5], A[8]];

export const identity = () => ({ R: [1, 0, 0, 0, 1, 0, 0, 0, 1], p: [0, 0, 0] });
export const compose = (A, B) => ({ R: product3(A.R, B.R), p: add(turned(A.R, B.p), A.p) });
export const moved = (T, x) => add(turned(T.R, x), T.p);

// From the first three rows of a homogeneous matrix, row-major.
export const fromRows = (T) => ({
  R: [T[0], T[1], T[2], T[4], T[5], T[6], T[8], T[9], T[10]],
  p: [T[3], T[7], T[11]],
});

// From a quaternion (w, x, y, z), not necessarily unit, and an origin: a free base's seven positions.
export const fromQuaternion = ([qw, qx, qy, qz, ...p]) => {
  const s = 1 / Math.hypot(qw, qx, qy, qz);
  const [w, x, y, z] = [qw * s, qx * s, qy * s, qz * s];
  return {
    R: [
      1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
    ],
    p,
  };
};

// The unit quaternion (w, x, y, z) of a rotation vector, and back; both signs of a quaternion are one rotation, of at most π.
export const quaternionOf = (r) => {
  const angle = norm(r);
  return [Math.cos(angle / 2), ...scaled(r, angle > 1e-9 ? Math.sin(angle / 2) / angle : 0.5)];
};
export const rotationVector = ([w, x, y, z]) => {
  const sine = Math.hypot(x, y, z);
  const angle = 2 * Math.atan2(sine, Math.abs(w));
  return scaled([x, y, z], (w < 0 ? -1 : 1) * (sine > 1e-9 ? angle / sine : 2));
};

// A vector, shortened where it is longer than this.
export const capped = (x, most) => scaled(x, norm(x) > most ? most / norm(x) : 1);

// e^{[A]θ} of a unit screw axis: Rodrigues' formula (Modern Robotics, 3.88).
export const exponential = (A, theta) => {
  const [w, v] = [angular(A), linear(A)];
  if (dot(w, w) === 0) return { R: identity().R, p: scaled(v, theta) };
  const [s, c] = [Math.sin(theta), Math.cos(theta)];
  const about = (x) => add(add(x, scaled(cross(w, x), s)), scaled(cross(w, cross(w, x)), 1 - c));
  const [x, y, z] = [about([1, 0, 0]), about([0, 1, 0]), about([0, 0, 1])];
  const wv = cross(w, v);
  const p = add(add(scaled(v, theta), scaled(wv, 1 - c)), scaled(cross(w, wv), theta - s));
  return { R: [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]], p };
};

// Ad_T V.
export const adjoint = (T, V) => {
  const w = turned(T.R, angular(V));
  return [...w, ...add(cross(T.p, w), turned(T.R, linear(V)))];
};

// A wrench F in the coordinates of a frame at T, in those that T is seen from: Ad_{T⁻¹}ᵀ F.
export const wrenchFrom = (T, F) => {
  const f = turned(T.R, linear(F));
  return [...add(cross(T.p, f), turned(T.R, angular(F))), ...f];
};

// ad_V X, the bracket of two twists.
export const bracket = (V, X) => {
  const [w, v] = [angular(V), linear(V)];
  return [...cross(w, angular(X)), ...add(cross(v, angular(X)), cross(w, linear(X)))];
};

// −ad_Vᵀ F: how a wrench or momentum that moves along with V changes.
export const carried = (V, F) => {
  const [w, v] = [angular(V), linear(V)];
  return [...add(cross(w, angular(F)), cross(v, linear(F))), ...cross(w, linear(F))];
};

// Eigenvalues, ascending, and unit eigenvectors of a symmetric 3 × 3 matrix, by Jacobi's turns.
export const eigen = (matrix) => {
  const A = [...matrix];
  let Q = identity().R;
  for (let sweep = 0; sweep < 12; sweep++) {
    for (const [i, j] of [[0, 1], [0, 2], [1, 2]]) {
      const off = A[3 * i + j];
      if (Math.abs(off) < 1e-300) continue;
      const angle = 0.5 * Math.atan2(2 * off, A[4 * j] - A[4 * i]);
      const G = identity().R;
      [G[4 * i], G[4 * j], G[3 * i + j], G[3 * j + i]] = [Math.cos(angle), Math.cos(angle), Math.sin(angle), -Math.sin(angle)];
      A.splice(0, 9, ...product3(transposed3(G), product3(A, G)));
      Q = product3(Q, G);
    }
  }
  return [0, 1, 2]
    .map((k) => ({ value: A[4 * k], vector: [Q[k], Q[3 + k], Q[6 + k]] }))
    .sort((a, b) => a.value - b.value);
};
