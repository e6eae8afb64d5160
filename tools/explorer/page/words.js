// SPDX-License-Identifier: GPL-3.0-or-later
// A decision in words, with the facts that `exactvo explain` prints. Numbers are rounded; proofs are in proof.js.
import {distanceOf, timeToContact} from './shapes.js';
import {shortName} from './draw.js';

const NOT_SEEN = 0.005;  // m/s: a difference that two decimals do not show

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
  if (violation > NOT_SEEN) return 'violated';
  return h.active && violation >= -NOT_SEEN ? 'binding' : 'slack';
}

function effectWords(d, h) {
  const effect = effectOf(d, h);
  return effect === 'violated' ? `violated by ${number(violationOf(h, d.chosen))} m/s` : effect;
}

function statusWords(d) {
  if (d.status === 'optimal') return 'every constraint is satisfied';
  if (d.status === 'relaxed')
    return `the constraints contradict each other; the soft ones are violated by at most ${number(d.violation)} m/s, the least possible`;
  if (d.status === 'infeasible') return `the hard constraints contradict each other or the speed bound by ${number(d.violation)} m/s`;
  return 'the hard constraints leave no room for rounding';
}

function contactWords(d, h) {
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
};

// "R1 waits for R2, which waits for R1: a deadlock"; empty where it waits for nobody.
function waitWords(run, row, robot) {
  const most = 6, chain = [robot];
  for (;;) {
    const next = run.waitsFor(row, chain[chain.length - 1]);
    if (next < 0) break;
    chain.push(next);
    if (chain.indexOf(next) < chain.length - 1 || chain.length > most) break;
  }
  if (chain.length < 2) return '';
  const id = (i) => shortName(run.robots[i].id, 40), last = chain[chain.length - 1];
  const words = chain.slice(1).map((i, k) => `${k ? 'which waits' : 'waits'} for ${id(i)}`).join(', ');
  return words + (chain.indexOf(last) < chain.length - 1 ? ': a deadlock' : '');
}

// Why the chosen velocity is what it is, in a few sentences.
function whyWords(run, d, mode) {
  const violated = d.halfPlanes.map((h, k) => (effectOf(d, h) === 'violated' ? `[${k + 1}]` : '')).filter(Boolean);
  if (d.status === 'relaxed')
    return [`No velocity satisfies all half-planes; the chosen one has the least greatest violation (${enumerated(violated)}).`];
  if (d.status !== 'optimal') return [];
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
    const by = d.halfPlanes.filter((h) => h.multiplier >= NOT_SEEN).map((h) => run.nameOf(h));
    if (by.length) words.push(`The robot is held by ${enumerated(by)}: no allowed velocity has a component towards the preferred one.`);
  }
  return words;
}

export {number, pair, speedWords, effectOf, effectWords, statusWords, contactWords, lineWords, modeWords, waitWords, whyWords};
