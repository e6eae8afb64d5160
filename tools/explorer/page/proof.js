// SPDX-License-Identifier: GPL-3.0-or-later
// Checks what a recording claims, in exact arithmetic. Written from the claims' definitions (docs/guide/exactness.md,
// lp/certificate.h, vo/certificate.h), and shares no code with the program that made them.
//
// A decision: v is the velocity nearest p within the speed bound and all half-planes n.v >= c. With multipliers
// lambda_i >= 0 of half-planes and nu >= 0 of the disc |v| <= V, w = sum lambda_i n_i and C = sum lambda_i c_i, every
// velocity u that satisfies them has |u - p|^2 >= |p|^2 + 2 C - |p + w|^2 / (1 + nu) - nu V^2 (weak duality). If v
// satisfies them too and |v - p|^2 is no more than 2^-40 (V + |p|)^2 above that, then v is the best, or as good.
import {Exact, ZERO, ONE, TWO, larger, exactVector, exactDot} from './exact.js';

// Share of its unit by which a multiplier in doubles may miss.
const WIDEST_GAP = 2 ** -40;

const PROVEN = {ok: true, why: ''};
function refuted(why) {
  return {ok: false, why};
}

// The problem: {lines: [{x, y, c, hard}], disc, boxX, boxY (m/s, null for none), px, py}.
// The answer: {vx, vy, status, violation, terms: [{kind, index, multiplier}]}, kinds 'line', 'disc', 'right', 'left',
// 'top', 'bottom'; status 'optimal', 'relaxed' or 'infeasible'. Where it `hasExactMultipliers` none are recorded.
function checkDecision(problem, answer) {
  const numbers = [problem.px, problem.py, answer.vx, answer.vy, answer.violation,
    ...problem.lines.flatMap((l) => [l.x, l.y, l.c])];
  if (!numbers.every(Number.isFinite)) return refuted('a number is missing');
  if (problem.lines.some((l) => l.x === 0 && l.y === 0)) return refuted('a half-plane has no normal');
  if (answer.status === 'no-interior') return {ok: null, why: 'no room: that nothing is better is not claimed'};
  const v = exactVector(answer.vx, answer.vy);
  const beyond = boundBroken(problem, v);
  if (beyond) return refuted(beyond);
  const excess = problem.lines.map((l) => Exact.of(l.c).minus(exactDot(exactVector(l.x, l.y), v)));
  const gives = (l) => answer.status === 'infeasible' ? l.hard : answer.status === 'relaxed' && !l.hard;
  const ignored = (l) => answer.status === 'infeasible' && !l.hard;
  let most = ZERO;
  for (let i = 0; i < excess.length; ++i) {
    const line = problem.lines[i];
    if (ignored(line)) continue;
    if (gives(line)) most = larger(most, excess[i]);
    else if (excess[i].sign() > 0) return refuted(`the velocity breaks half-plane ${i + 1}`);
  }
  const terms = usableTerms(problem, answer, ignored);
  if (!terms) return refuted('a multiplier is negative, or of nothing that can bind');
  if (answer.hasExactMultipliers) return {ok: null, why: 'no multipliers in doubles prove it: exactvo audit computes the exact ones'};
  const sum = combined(problem, terms, gives);
  return answer.status === 'optimal' ? checkOptimum(problem, v, sum) : checkLeastViolation(problem, sum, most);
}

function boundBroken(problem, v) {
  if (problem.disc !== null && exactDot(v, v).isMoreThan(Exact.of(problem.disc).squared()))
    return 'the velocity is faster than the robot';
  const leaves = (component, most) => most !== null && component.absolute().isMoreThan(Exact.of(most));
  return leaves(v.x, problem.boxX) || leaves(v.y, problem.boxY) ? 'the velocity leaves the speed bound' : '';
}

const SIDES = {right: [-1, 0], left: [1, 0], top: [0, -1], bottom: [0, 1]};

function reachOfSide(problem, kind) {
  return kind === 'right' || kind === 'left' ? problem.boxX : problem.boxY;
}

// Null where one cannot be used; those of 0 say nothing.
function usableTerms(problem, answer, ignored) {
  const terms = [];
  if (answer.terms.length > 3) return null;
  for (const term of answer.terms) {
    if (!(term.multiplier >= 0) || !Number.isFinite(term.multiplier)) return null;
    const line = term.kind === 'line' ? problem.lines[term.index] : null;
    if (term.kind === 'line' && (!line || ignored(line))) return null;
    if (term.kind === 'disc' ? problem.disc === null : term.kind !== 'line' && reachOfSide(problem, term.kind) === null) return null;
    if (term.kind === 'disc' && answer.status !== 'optimal') continue;  // of a least violation it proves nothing
    if (term.multiplier > 0) terms.push(term);
  }
  return terms;
}

function combined(problem, terms, gives) {
  const sum = {w: {x: ZERO, y: ZERO}, offset: ZERO, nu: ZERO, giving: ZERO, length: 0};
  for (const term of terms) {
    const lambda = Exact.of(term.multiplier);
    if (term.kind === 'disc') {
      sum.nu = sum.nu.plus(lambda);
      continue;
    }
    const line = term.kind === 'line' ? problem.lines[term.index]
      : {x: SIDES[term.kind][0], y: SIDES[term.kind][1], c: -reachOfSide(problem, term.kind), hard: true};
    sum.w = {x: sum.w.x.plus(lambda.times(Exact.of(line.x))), y: sum.w.y.plus(lambda.times(Exact.of(line.y)))};
    sum.offset = sum.offset.plus(lambda.times(Exact.of(line.c)));
    if (term.kind === 'line' && gives(line)) {
      sum.giving = sum.giving.plus(lambda);
      sum.length = Math.max(sum.length, Math.hypot(line.x, line.y));
    }
  }
  return sum;
}

function largestSpeed(problem) {
  const or = (reach) => (reach === null ? Infinity : reach);
  return Math.min(or(problem.disc), Math.hypot(or(problem.boxX), or(problem.boxY)));
}

function checkOptimum(problem, v, sum) {
  const p = exactVector(problem.px, problem.py);
  const away = {x: v.x.minus(p.x), y: v.y.minus(p.y)}, pulled = {x: p.x.plus(sum.w.x), y: p.y.plus(sum.w.y)};
  const unit = largestSpeed(problem) + Math.hypot(problem.px, problem.py);
  const gap = Exact.of(WIDEST_GAP * unit * unit);
  let least = exactDot(p, p).plus(TWO.times(sum.offset));
  if (sum.nu.sign() > 0) least = least.minus(sum.nu.times(Exact.of(problem.disc).squared()));
  // Times 1 + nu, so that nothing is divided.
  const short = ONE.plus(sum.nu).times(exactDot(away, away).minus(gap).minus(least)).plus(exactDot(pulled, pulled));
  return short.sign() <= 0 ? PROVEN : refuted('the multipliers do not prove that no velocity is better');
}

// sigma(w) = max of w.v within the speed bound; whether it is less than the limit, or at most that.
function reachesLess(problem, w, limit, strictly) {
  const highest = strictly ? -1 : 0;
  const squared = exactDot(w, w);
  if (squared.sign() === 0) return -limit.sign() <= highest;
  if (limit.sign() < 0) return false;
  if (problem.disc !== null && Exact.of(problem.disc).squared().times(squared).minus(limit.squared()).sign() <= highest)
    return true;
  if ((problem.boxX === null && w.x.sign() !== 0) || (problem.boxY === null && w.y.sign() !== 0)) return false;
  const along = (component, reach) => (component.sign() === 0 ? ZERO : Exact.of(reach).times(component.absolute()));
  return along(w.x, problem.boxX).plus(along(w.y, problem.boxY)).minus(limit).sign() <= highest;
}

// The half-planes with a multiplier contradict each other: their sum asks for C <= w.v, and no velocity has that. Where
// each gives by t, C - t (sum of lambda of what gives) <= sigma(w), which bounds t from below.
function checkLeastViolation(problem, sum, most) {
  if (!reachesLess(problem, sum.w, sum.offset, true)) return refuted('the half-planes are not shown to contradict each other');
  if (sum.giving.sign() <= 0) return refuted('no multiplier is of a half-plane that gives');
  const gap = Exact.of(WIDEST_GAP * Math.max(most.approximately(), largestSpeed(problem) * sum.length));
  const level = most.minus(gap).times(sum.giving);
  if (level.sign() <= 0 || reachesLess(problem, sum.w, sum.offset.minus(level), false)) return PROVEN;
  return refuted('the multipliers do not prove that no velocity violates less');
}

// A half-plane: { v : n.v >= c } and the interior of the velocity obstacle { w + u : t w in S, 0 < t <= tau } have no
// velocity in common, S the shape seen from the robot and grown by its radius. True iff h_S(n) <= 0 and
// h_S(n) <= tau (c - n.u), with h_S the support function: a sum k + sqrt(b) + sqrt(d).
// claim: {shape, x, y, radius, timeHorizon, ux, uy, nx, ny, c}; shape {disc|segment|polygon|ellipse: [numbers]}.
function checkHalfPlane(claim) {
  if (!isWellFormed(claim)) return refuted('the claim is not well formed');
  const n = exactVector(claim.nx, claim.ny);
  return excludes(claim, Exact.of(claim.c).minus(exactDot(n, exactVector(claim.ux, claim.uy))));
}

// A robot's half of a pair, by which two velocities keep the pair apart for tau. Either it takes half of what the
// relative velocity must change along n, with 2 c - n.(v_a + v_b) for c: enough where the other robot takes as much
// along -n. Or it is enough together with the half of the opposite normal that the other robot has. halves: the other's [{nx, ny, c}] against this one; velocities: [v_a, v_b].
function checkHalfOfPair(claim, velocities, halves) {
  if (!isWellFormed(claim)) return refuted('the claim is not well formed');
  const n = exactVector(claim.nx, claim.ny), c = Exact.of(claim.c);
  const [a, b] = velocities.map(([x, y]) => exactVector(x, y));
  if (excludes(claim, TWO.times(c).minus(exactDot(n, {x: a.x.plus(b.x), y: a.y.plus(b.y)}))).ok) return PROVEN;
  const completes = (other) => other.nx === -claim.nx && other.ny === -claim.ny && Number.isFinite(other.c) &&
    excludes(claim, c.plus(Exact.of(other.c))).ok;
  return halves.some(completes) ? PROVEN : refuted('it takes less than its half of the pair');
}

// Lemma 8 of docs/guide/accelerations.md: with k steps of T until the robot stands and c for how far along n the grown
// disc reaches, n.x >= c and n.(x + (k + 1) / 2 T u) >= c + U k T for all u of the half-plane.
// claim: {shape: {disc}, x, y, radius, nx, ny, c, steps, mostSpeed, timeStep}.
function checkMover(claim) {
  const {shape, x, y, radius, nx, ny, steps, mostSpeed, timeStep} = claim;
  if (!isWellFormed(claim) || !(steps > 0)) return refuted('the claim is not well formed');
  const n = exactVector(nx, ny), length = exactDot(n, n), step = Exact.of(timeStep);
  const from = exactDot(n, {x: Exact.of(shape.disc[0]).minus(Exact.of(x)), y: Exact.of(shape.disc[1]).minus(Exact.of(y))});
  const radii = Exact.of(shape.disc[2]).plus(Exact.of(radius));
  const way = Exact.of((steps + 1) / 2).times(step).times(Exact.of(claim.c));
  const gone = Exact.of(steps).times(step).times(Exact.of(mostSpeed));
  const meets = (along, reach) => sumOfRootsIsPositive(along, ZERO, reach.squared().times(length));
  return meets(from, radii) || meets(from.minus(way), radii.plus(gone)) ? refuted('the mover could meet the robot before it stands') : PROVEN;
}

function isWellFormed({shape, x, y, radius, timeHorizon, ux, uy, nx, ny, c}) {
  const numbers = shape.disc || shape.segment || shape.polygon || shape.ellipse || [];
  return [x, y, radius, ux, uy, nx, ny, c, ...numbers].every(Number.isFinite) && radius >= 0 && timeHorizon > 0 &&
    (nx !== 0 || ny !== 0) && (!shape.disc || shape.disc[2] >= 0) && numbers.length > 0;
}

// Whether the velocities with n.v >= beyond keep away from the shape for tau.
function excludes({shape, x, y, radius, timeHorizon, nx, ny}, beyond) {
  const n = exactVector(nx, ny), position = exactVector(x, y);
  const along = (px, py) =>
    n.x.times(Exact.of(px).minus(position.x)).plus(n.y.times(Exact.of(py).minus(position.y)));
  const length = exactDot(n, n);
  let k, b = ZERO, d = Exact.of(radius).squared().times(length);
  if (shape.disc) {
    k = along(shape.disc[0], shape.disc[1]);
    d = Exact.of(shape.disc[2]).plus(Exact.of(radius)).squared().times(length);
  } else if (shape.ellipse) {
    const [cx, cy, l11, l21, l22] = shape.ellipse;
    k = along(cx, cy);
    b = Exact.of(l11).times(n.x).plus(Exact.of(l21).times(n.y)).squared().plus(Exact.of(l22).times(n.y).squared());
  } else {
    const points = shape.segment || shape.polygon;
    k = along(points[0], points[1]);
    for (let i = 2; i < points.length; i += 2) k = larger(k, along(points[i], points[i + 1]));
  }
  if (beyond.sign() < 0) {
    if (!Number.isFinite(timeHorizon)) return refuted('it cuts into the velocity obstacle');
    k = k.minus(Exact.of(timeHorizon).times(beyond));
  }
  return sumOfRootsIsPositive(k, b, d) ? refuted('it cuts into the velocity obstacle') : PROVEN;
}

// k + sqrt(b) + sqrt(d) > 0, by squaring twice.
function sumOfRootsIsPositive(k, b, d) {
  if (k.sign() >= 0) return k.sign() > 0 || b.sign() > 0 || d.sign() > 0;
  const rest = k.squared().minus(b).minus(d);  // against 2 sqrt(b d)
  if (rest.sign() < 0) return true;
  return new Exact(4n, 0).times(b).times(d).isMoreThan(rest.squared());
}

// What a recording says of a decision beside its multipliers: the violation it states, and what it says to bind.
function checkStatement(problem, answer, active) {
  const v = exactVector(answer.vx, answer.vy);
  const near = Exact.of(WIDEST_GAP * largestSpeed(problem));
  let most = ZERO;
  for (let i = 0; i < problem.lines.length; ++i) {
    const l = problem.lines[i], excess = Exact.of(l.c).minus(exactDot(exactVector(l.x, l.y), v));
    const gives = answer.status === 'infeasible' ? l.hard : answer.status === 'relaxed' && !l.hard;
    if (gives) most = larger(most, excess);
    if (!active[i].active && active[i].multiplier !== 0) return refuted(`half-plane ${i + 1} presses and does not bind`);
    if (active[i].active && answer.status === 'optimal' && excess.plus(near).sign() < 0)
      return refuted(`half-plane ${i + 1} is said to bind, and the velocity does not touch it`);
  }
  if (Exact.of(answer.violation).minus(most).absolute().isMoreThan(near)) return refuted('it states another violation than it has');
  return PROVEN;
}

// --- Of a run (columns.js) ---

function problemOf(run, d) {
  const speed = run.robots[d.robot].max_speed, isDisc = run.about.speed_bound === 'disc';
  return {
    lines: d.halfPlanes.map((h) => ({x: h.nx, y: h.ny, c: h.c, hard: h.hard})),
    disc: isDisc ? speed : null, boxX: isDisc ? null : speed, boxY: isDisc ? null : speed, px: d.preferred[0], py: d.preferred[1],
  };
}

function answerOf(d) {
  const terms = [];
  d.halfPlanes.forEach((h, index) => {
    if (h.active) terms.push({kind: 'line', index, multiplier: h.multiplier});
  });
  for (const part of d.parts) terms.push({kind: part.kind, index: 0, multiplier: part.multiplier});
  return {vx: d.chosen[0], vy: d.chosen[1], status: d.status, violation: d.violation, terms,
    hasExactMultipliers: d.hasExactMultipliers};
}

// {ok: true | false | null (nothing is claimed), why}.
function checkChoice(run, d) {
  if (d.isOfUser) return {ok: null, why: 'half-planes of the user take part, which a page does not have: see audit'};
  const problem = problemOf(run, d), answer = answerOf(d);
  const decided = checkDecision(problem, answer);
  return decided.ok === true ? checkStatement(problem, answer, d.halfPlanes) : decided;
}

function checkConstraint(run, d, h) {
  if (!h.certified) return {ok: null, why: 'not certified: nothing is claimed'};
  if (h.isOwnLimit) return {ok: null, why: 'a limit of its own: nothing is claimed'};
  const claim = {shape: h.shape, x: d.anchor[0], y: d.anchor[1], radius: h.radius, timeHorizon: h.timeHorizon, ux: h.ux, uy: h.uy,
    nx: h.nx, ny: h.ny, c: h.c};
  if (h.reach !== undefined) {
    const {steps, mostSpeed} = h;
    return checkMover({...claim, radius: run.robots[d.robot].radius, steps, mostSpeed, timeStep: run.about.time_step});
  }
  if (h.kind !== 'robot' || !run.robots[h.index].cooperates) return checkHalfPlane(claim);
  const other = run.decision(d.row, h.index);
  const halves = other.halfPlanes.filter((o) => o.kind === 'robot' && o.index === d.robot && !o.isOwnLimit);
  return checkHalfOfPair(claim, [d.anchorVelocity, other.anchorVelocity], halves);
}

export {checkDecision, checkHalfPlane, checkHalfOfPair, checkStatement, checkChoice, checkConstraint};
