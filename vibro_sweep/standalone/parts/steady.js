// The steady motion of the gap, g = middle + Re(G e^{i(omega t + tau)}), and rest, from the numbers of an oscillator.

import { MASSES as N, NORMAL, STOPS } from "./oscillator.js";

const SINGULAR = 1e-13; // of the largest number of an equation: a pivot below which it has no one solution
const UNBALANCED = 1e-9; // of the largest force: what no state balances

const EACH = [...Array(N).keys()];

// {real, imaginary, middle}; null where springs do not balance a constant force, so that there is none; undefined where
// it is not told here: in resonance, and where free modes leave several states that balance a constant force
export function steadyGap(numbers) {
  const { M, K, C, normal, omega, constant, sine, cosine } = named(numbers), along = (x) => normal.reduce((sum, n, i) => sum + n * x[i], 0);
  // (K - omega^2 M + i omega C) X = cosine - i sine, as real and imaginary parts
  const A = (i, j) => K(i, j) - omega * omega * M(i, j), B = (i, j) => omega * C(i, j);
  const X = solution([
    ...EACH.map((i) => [...EACH.map((j) => A(i, j)), ...EACH.map((j) => -B(i, j)), cosine[i]]),
    ...EACH.map((i) => [...EACH.map((j) => B(i, j)), ...EACH.map((j) => A(i, j)), -sine[i]]),
  ]);
  const rest = constant.some((force) => force !== 0) ? solution(EACH.map((i) => [...EACH.map((j) => K(i, j)), constant[i]])) : constant;
  if (!X || rest === undefined) return undefined;
  return rest && { real: along(X.slice(0, N)), imaginary: along(X.slice(N)), middle: along(rest) };
}

// positions of rest (oscillator/linear.py): 0, or where that is behind a stop the balance at it; undefined where it is
// not told here, as free modes leave several
export function restState(numbers) {
  const { K, normal, constant } = named(numbers), gap = Math.min(Math.max(0, numbers[STOPS]), numbers[STOPS + 1]);
  if (gap === 0) return EACH.map(() => 0);
  const size = Math.max(...EACH.flatMap((i) => EACH.map((j) => Math.abs(K(i, j))))) || 1, n = normal.map((by) => by * size);
  const x = solution([...EACH.map((i) => [...EACH.map((j) => K(i, j)), n[i], constant[i]]), [...n, 0, gap * size]]);
  return x ? x.slice(0, N) : undefined;
}

function named(numbers) {
  const matrix = (k) => (i, j) => numbers[(k * N + i) * N + j], vector = (at) => numbers.slice(at, at + N), forces = NORMAL + N + 1;
  const [constant, sine, cosine] = [0, 1, 2].map((k) => vector(forces + k * N));
  return { M: matrix(0), K: matrix(1), C: matrix(2), normal: vector(NORMAL), omega: numbers[NORMAL + N], constant, sine, cosine };
}

// x of equations, each a row of coefficients and what they are equal to; null where there is none, undefined where there
// may be several
function solution(rows) {
  const n = rows.length, force = Math.max(...rows.map((row) => Math.abs(row[n])));
  const size = Math.max(...rows.flatMap((row) => row.slice(0, n).map(Math.abs)));
  for (let k = 0; k < n; k++) {
    const best = rows.slice(k).reduce((most, row, i) => (Math.abs(row[k]) > Math.abs(rows[most][k]) ? k + i : most), k);
    [rows[k], rows[best]] = [rows[best], rows[k]];
    if (!(Math.abs(rows[k][k]) > SINGULAR * size)) return rows.slice(k).some((row) => Math.abs(row[n]) > UNBALANCED * force) ? null : undefined;
    for (let i = k + 1; i < n; i++) {
      const by = rows[i][k] / rows[k][k];
      for (let j = k; j <= n; j++) rows[i][j] -= by * rows[k][j];
    }
  }
  const x = Array(n).fill(0);
  for (let k = n - 1; k >= 0; k--) x[k] = (rows[k][n] - x.reduce((sum, one, j) => sum + (j > k ? rows[k][j] * one : 0), 0)) / rows[k][k];
  return x;
}
