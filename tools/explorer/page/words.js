// SPDX-License-Identifier: GPL-3.0-or-later
// A decision in words, with the facts that `exactvo explain` prints. Numbers are rounded; proofs are in proof.js.
import {distanceOf, timeToContact} from './shapes.js';
import {shortName} from './draw.js';

const NOT_SEEN = 0.005;  // m/s: a difference that two decimals do not show
const ON_LINE = 1e-6;    // m/s: a velocity this near a line lies on it

function number(x, digits = 2) {
  const text = x.toFixed(digits);
  return Number(text) === 0 ? (0).toFixed(digits) : text;
}

function pair(v) {
  return `(${number(v[0])}, ${number(v[1])})`;
}

function speedWords(v) {
  return `${pair(v)} m/s, speed ${number(Math.hypot(v[0], v[1]))}`;
}

function violationOf(h, v) {
  return (h.c - h.nx * v[0] - h.ny * v[1]) / Math.hypot(h.nx, h.ny);
}

// 'slack', 'binding' or 'violated'.
function effectOf(d, h) {
  const violation = violationOf(h, d.chosen);
  if (violation > ON_LINE) return 'violated';
  return h.active && violation >= -NOT_SEEN ? 'binding' : 'slack';
}

// A violation in words: what two decimals do not show has one digit that counts.
function amount(violation) {
  return violation < NOT_SEEN ? String(Number(violation.toPrecision(1))) : number(violation);
}

function effectWords(d, h) {
  const effect = effectOf(d, h), fallen = h.fellBack ? ' (the pair fell back)' : '';
  return (effect === 'violated' ? `violated by ${amount(violationOf(h, d.chosen))} m/s` : effect) + fallen;
}

function statusWords(d) {
  if (d.status === 'optimal') return 'every constraint is satisfied';
  if (d.status === 'relaxed')
    return `the constraints contradict each other; the soft ones are violated by at most ${amount(d.violation)} m/s, the least possible`;
  if (d.status === 'infeasible') return `the hard constraints contradict each other or the speed bound by ${amount(d.violation)} m/s`;
  return 'the hard constraints leave no room for rounding';
}

function contactWords(d, h) {
  if (h.isOwnLimit) return `a side of the polygon within what its ${h.limited === 'wheels' ? 'wheels allow' : 'acceleration allows'}`;
  if (h.reach !== undefined)
    return `${number(h.clearance)} m from the robot's rim, comes ${number(h.reach)} m nearer at most until the robot stands`;
  const distance = distanceOf(h, d.anchor);
  if (distance < 0) return `the robot overlaps it by ${number(-distance)} m: no cone exists`;
  const contact = timeToContact(h, d.anchor, d.preferred[0] - h.ux, d.preferred[1] - h.uy);
  const away = `${number(distance)} m from the robot's rim`;
  if (contact === null) return `${away}, not touched at the preferred velocity`;
  const reached = contact > 3600 ? 'more than an hour' : `${number(contact)} s`;
  return `${away}, reached in ${reached} at the preferred velocity, horizon ${number(h.timeHorizon)} s`;
}

function signed(x) {
  return (x < 0 || Object.is(x, -0) ? '-' : '+') + Math.abs(x).toFixed(3);
}

function lineWords(h) {
  return `${signed(h.nx)} v_x ${signed(h.ny)} v_y >= ${signed(h.c)} m/s; ${h.hard ? 'hard' : 'soft'}`;
}

function modeWords(run, row, robot) {
  const side = run.side(row, robot);
  return run.mode(row, robot) + (side > 0 ? ', keeping left' : side < 0 ? ', keeping right' : '');
}

// Beside movers; empty elsewhere.
function standsWords(d) {
  if (d.standsAfter === null) return '';
  return d.standsAfter === 0 ? 'nothing is promised to it against moving obstacles'
    : `after ${number(d.standsAfter)} s if it brakes: proven to touch no moving obstacle before`;
}

function enumerated(words) {
  return words.length < 2 ? words.join('') : `${words.slice(0, -1).join(', ')} and ${words[words.length - 1]}`;
}

const TURNED = {
  guided: 'the preferred velocity leads along a proven route',
  'by-plan': 'the preferred velocity follows a joint plan of several robots',
  'going-back': 'the robot goes back the way it came, to where its plan begins',
  staying: 'the robot stays, since its goal or slot is out of reach or taken',
  boost: 'boost turned the preferred velocity onto the tangent of the enclosure in the way',
  following: 'the preferred velocity follows the boundary, after a stall',
  'pushing-out': 'the robot is in contact, and the preferred velocity leads away from it',
  steered: 'the preferred velocity was set by the user',
};

// "R1 waits for R2, which waits for R1: a deadlock"; empty where it waits for none. A cycle of which some still move
// may come apart (formation/waiting.h).
function waitWords(run, row, robot) {
  const named = 4, chain = [robot];
  for (;;) {
    const next = run.waitsFor(row, chain[chain.length - 1]);
    if (next < 0) break;
    chain.push(next);
    if (chain.indexOf(next) < chain.length - 1) break;
  }
  if (chain.length < 2) return '';
  const id = (i) => shortName(run.robots[i].id, 40), last = chain[chain.length - 1];
  const between = chain.length - 1 - named;  // robots that are not named
  const words = chain.slice(1, between > 1 ? named : chain.length).map((i, k) => `${k ? 'which waits' : 'waits'} for ${id(i)}`)
    .join(', ') + (between > 1 ? ` and so on through ${between} more to ${id(last)}` : '');
  const first = chain.indexOf(last);
  const stands = (i) => Math.hypot(...run.decision(row, i).chosen) < run.robots[i].max_speed / 15;
  return words + (first < chain.length - 1 && chain.slice(first).every(stands) ? ': a deadlock' : '');
}

// Which half-planes have the greatest violation, which is the least possible, and which are violated by less.
function relaxedWords(d) {
  const violations = d.halfPlanes.map((h) => (effectOf(d, h) === 'violated' ? violationOf(h, d.chosen) : 0));
  const greatest = Math.max(0, ...violations), most = [], less = [];
  violations.forEach((v, k) => {
    if (v > 0) (v > greatest - ON_LINE ? most : less).push(`[${k + 1}]`);
  });
  return 'No velocity satisfies all half-planes; the chosen one has the least greatest violation' +
    (most.length ? `, that of ${enumerated(most)}` : '') +
    (less.length ? `; ${enumerated(less)} ${less.length === 1 ? 'is' : 'are'} violated by less` : '') + '.';
}

// Why the chosen velocity is what it is, in a few sentences.
function whyWords(run, d, mode) {
  if (d.status === 'relaxed') return [relaxedWords(d)];
  if (d.status !== 'optimal') return [];
  if (d.standsAfter === 0)
    return ['It stands, since a moving obstacle could reach it while it moves, at any velocity from which it stands again after a time step.'];
  const turned = TURNED[mode] || '';
  const shift = Math.hypot(d.chosen[0] - d.preferred[0], d.chosen[1] - d.preferred[1]);
  if (shift < NOT_SEEN)
    return [turned ? `${turned[0].toUpperCase()}${turned.slice(1)}; it is allowed.` : 'No constraint forbids the preferred velocity.'];
  const forces = d.halfPlanes.map((h, k) => [h.multiplier * Math.hypot(h.nx, h.ny), `n[${k + 1}]`])
    .filter(([factor]) => factor >= NOT_SEEN);
  for (const part of d.parts) {
    const factor = part.multiplier * (part.kind === 'disc' ? Math.hypot(d.chosen[0], d.chosen[1]) : 1);
    if (factor >= NOT_SEEN) forces.push([factor, 'n[speed bound]']);
  }
  const words = [];
  if (forces.length)
    words.push(`chosen - preferred = ${forces.map(([factor, n]) => `${number(factor)} ${n}`).join(' + ')}, with the n the ` +
      'constraints\u2019 normals and no factor negative, so no allowed velocity lies nearer to the preferred one (Karush-Kuhn-Tucker).');
  if (turned) words.push(`Before that, ${turned}.`);
  const limit = 0.05 * run.robots[d.robot].max_speed;
  if (Math.hypot(...d.chosen) < limit && Math.hypot(...d.preferred) > limit) {
    const by = [...new Set(d.halfPlanes.filter((h) => h.multiplier >= NOT_SEEN).map((h) => run.nameOf(h)))];
    if (by.length) words.push(`The robot is held by ${enumerated(by)}: no allowed velocity has a component towards the preferred one.`);
  }
  return words;
}

// Which claims of what is shown the checkers that are proven themselves cover (docs/guide/proofs.md).
function coveredWords(run) {
  const of = run.about.method === 'check' ? 'certificates of exactvo check --certificates: that bodies which do not turn never meet each other or the map.' :
    run.decisionTime.length ? 'a recording: half-planes against bodies at rest and pairs of opposite ones, choices with multipliers, bodies that stand for obstacles, straight motions from row to row, and braking.' :
    'a recording: that on straight motions from row to row no two robots overlap, and none overlaps an edge.';
  return `exactvo-verify, whose checkers are proven in Coq, covers of ${of}`;
}

export {number, pair, speedWords, effectOf, effectWords, statusWords, contactWords, lineWords, modeWords, standsWords, waitWords, whyWords, coveredWords};
