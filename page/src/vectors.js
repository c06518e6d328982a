// Vectors as lists of 3 and configurations as { R, p }, R row-major: what is needed to place things in the picture.

export const dot = (a, b) => {
  let sum = 0;
  for (let k = 0; k < a.length; k++) sum += a[k] * b[k];
  return sum;
};
export const add = (a, b) => a.map((x, k) => x + b[k]);
export const scaled = (a, s) => a.map((x) => x * s);
export const norm = (a) => Math.sqrt(dot(a, a));

export const turned = (R, x) => [
  R[0] * x[0] + R[1] * x[1] + R[2] * x[2],
  R[3] * x[0] + R[4] * x[1] + R[5] * x[2],
  R[6] * x[0] + R[7] * x[1] + R[8] * x[2],
];

// By the transpose of R.
export const turnedBack = (R, x) => [0, 1, 2].map((k) => R[k] * x[0] + R[k + 3] * x[1] + R[k + 6] * x[2]);

export const identity = () => ({ R: [1, 0, 0, 0, 1, 0, 0, 0, 1], p: [0, 0, 0] });

// From the first three rows of a homogeneous matrix, row-major.
export const fromRows = (T) => ({
  R: [T[0], T[1], T[2], T[4], T[5], T[6], T[8], T[9], T[10]],
  p: [T[3], T[7], T[11]],
});
