// What the page has to know of a robot at a state, in the coordinates of {s}: there bodies and axes add up without being carried
// from frame to frame. The numbers come from mozzi (joints' screws, inertias); page/test holds these formulas to mozzi's.

import {
  add, adjoint, angular, bracket, carried, compose, cross, dot, exponential, fromQuaternion, identity, linear, moved, product3,
  scaled, transposed3, turned, wrenchFrom,
} from "./lie.js";

const sum = (lists, length) => lists.reduce(add, new Array(length).fill(0));

// Where every body is: T_si, the base first.
export function poses(robot, theta) {
  const T = [robot.isFloating ? fromQuaternion(theta.slice(0, 7)) : identity()];
  for (const body of robot.bodies) {
    T.push(compose(T[body.parent], compose(body.M, exponential(body.A, body.ratio * theta[body.q] + body.offset))));
  }
  return T;
}

// The state's motions: of each velocity that moves a body directly, { body, j, S }, with S = Ad_T A times the follower's ratio.
export function axes(robot, T) {
  const joints = robot.bodies.map((body, k) => ({
    body: k + 1, j: body.j, S: scaled(adjoint(T[k + 1], body.A), body.ratio),
  }));
  if (!robot.isFloating) return joints;
  const unit = (k) => [0, 1, 2, 3, 4, 5].map((i) => (i === k ? 1 : 0));
  return [...[0, 1, 2, 3, 4, 5].map((k) => ({ body: 0, j: k, S: adjoint(T[0], unit(k)) })), ...joints];
}

const parentOf = (robot, body) => (body === 0 ? -1 : robot.bodies[body - 1].parent);

// (m, m c, I about the origin of {s}) of a body that is at T: ten numbers, I as a matrix of nine, so that bodies add.
function inertiaAt(T, [m, hx, hy, hz, xx, xy, xz, yy, yz, zz]) {
  const I = product3(T.R, product3([xx, xy, xz, xy, yy, yz, xz, yz, zz], transposed3(T.R)));
  const [h, p] = [turned(T.R, [hx, hy, hz]), T.p];
  const diagonal = 2 * dot(h, p) + m * dot(p, p);
  for (let r = 0; r < 3; r++)
    for (let c = 0; c < 3; c++)
      I[3 * r + c] += (r === c ? diagonal : 0) - h[r] * p[c] - p[r] * h[c] - m * p[r] * p[c];
  return [m, ...add(h, scaled(p, m)), ...I];
}

// 𝒢V.
function momentum(G, V) {
  const [w, v, h, I] = [angular(V), linear(V), G.slice(1, 4), G.slice(4)];
  return [...add(turned(I, w), cross(h, v)), ...add(scaled(v, G[0]), cross(w, h))];
}

const inertias = (robot, T) => [robot.baseInertia, ...robot.bodies.map((body) => body.inertia)].map((pi, k) => inertiaAt(T[k], pi));

// M(θ), rows of n, by composite bodies: M_ij = S_iᵀ 𝒢 S_j with 𝒢 of all that both move.
export function massMatrix(robot, theta) {
  const T = poses(robot, theta);
  const composite = inertias(robot, T);
  for (let k = robot.bodies.length; k > 0; k--) {
    const parent = parentOf(robot, k);
    composite[parent] = add(composite[parent], composite[k]);
  }
  const all = axes(robot, T);
  const of = Array.from(T, () => []);
  all.forEach((axis) => of[axis.body].push(axis));
  const M = robot.armature.map((armature, i) => robot.armature.map((_, j) => (i === j ? armature : 0)));
  for (const axis of all) {
    const F = momentum(composite[axis.body], axis.S);
    for (const other of of[axis.body]) M[axis.j][other.j] += dot(other.S, F);
    for (let k = parentOf(robot, axis.body); k >= 0; k = parentOf(robot, k)) {
      for (const other of of[k]) {
        const entry = dot(other.S, F);
        M[axis.j][other.j] += entry;
        M[other.j][axis.j] += entry;
      }
    }
  }
  return M;
}

// V_i of every body, in {s}: V_i = V_parent + S_i θ̇.
export function twists(robot, T, dtheta) {
  const V = T.map(() => new Array(6).fill(0));
  for (const { body, j, S } of axes(robot, T)) V[body] = add(V[body === 0 ? 0 : parentOf(robot, body)], scaled(S, dtheta[j]));
  return V;
}

// The wrench that each joint transmits to its body, in {s}, and on the base: F_i = Σ 𝒢V̇ − ad_Vᵀ𝒢V + F over all that it carries,
// gravity as an upward acceleration of the base. `tip` is what the end effector applies, in its own frame.
export function wrenches(robot, T, dtheta, ddtheta, tip) {
  const V = twists(robot, T, dtheta);
  const dV = T.map(() => [0, 0, 0, ...scaled(robot.gravity, -1)]);
  for (const { body, j, S } of axes(robot, T)) {
    const from = body === 0 ? 0 : parentOf(robot, body);
    const rate = body === 0 ? scaled(S, 0) : bracket(V[from], S); // [V, V] = 0: a base's own axes move with it
    dV[body] = add(dV[from], add(scaled(S, ddtheta[j]), scaled(rate, dtheta[j])));
  }
  const F = inertias(robot, T).map((G, k) => add(momentum(G, dV[k]), carried(V[k], momentum(G, V[k]))));
  if (tip && robot.endEffector !== null) {
    const frame = robot.frames[robot.endEffector];
    F[frame.body] = add(F[frame.body], wrenchFrom(compose(T[frame.body], frame.T), tip));
  }
  for (let k = robot.bodies.length; k > 0; k--) F[parentOf(robot, k)] = add(F[parentOf(robot, k)], F[k]);
  return F;
}

// Centre of mass of what moves, or null where nothing weighs anything.
export function centerOfMass(robot, T) {
  const all = sum(inertias(robot, T).slice(robot.isFloating ? 0 : 1).map((G) => G.slice(0, 4)), 4);
  return all[0] > 0 ? all.slice(1).map((x) => x / all[0]) : null;
}

// J_v Jᵥᵀ, 3 × 3: of the velocity of a frame's origin by the joints, a free base held.
export function linearGram(robot, T, frame) {
  const p = moved(T[frame.body], frame.T.p);
  const columns = new Map();
  const carries = new Set();
  for (let k = frame.body; k > 0; k = parentOf(robot, k)) carries.add(k);
  for (const { body, j, S } of axes(robot, T)) {
    if (!carries.has(body)) continue;
    const v = add(linear(S), cross(angular(S), p));
    columns.set(j, add(columns.get(j) ?? [0, 0, 0], v));
  }
  const A = new Array(9).fill(0);
  for (const v of columns.values()) for (let r = 0; r < 9; r++) A[r] += v[Math.floor(r / 3)] * v[r % 3];
  return A;
}
