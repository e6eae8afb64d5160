// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a packed run (explorer/packed_run.h): a JSON head and columns of numbers, deflated.

const MAGIC = 'EXVIEW01';
const MAGIC_FAMILY = 'EXVIEW';

// What is wrong with the data of a page, in words for a reader.
class DataProblem extends Error {}

function bytesOfBase64(text) {
  let binary;
  try {
    binary = atob(text.trim());
  } catch (error) {
    throw new DataProblem('The data of this page is damaged or cut short: it is not base64.');
  }
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflated(bytes) {
  if (typeof DecompressionStream === 'undefined')
    throw new DataProblem('This browser has no DecompressionStream. Chrome 80, Firefox 113, Safari 16.4 and later have.');
  try {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return await new Response(stream).arrayBuffer();
  } catch (error) {
    throw new DataProblem('The data of this page is damaged or cut short: it cannot be inflated.');
  }
}

function headOf(buffer) {
  const bytes = new Uint8Array(buffer);
  const magic = bytes.length < 16 ? '' : String.fromCharCode(...bytes.subarray(0, 8));
  if (magic !== MAGIC)
    throw new DataProblem(magic.startsWith(MAGIC_FAMILY)
      ? `The data of this page has another version (${magic}) than the page (${MAGIC}): make it again with exactvo view.`
      : 'The data of this page is not a packed run.');
  const length = new DataView(buffer).getUint32(8, true);
  if (12 + length > bytes.length) throw new DataProblem('The data of this page is cut short.');
  try {
    const head = JSON.parse(new TextDecoder().decode(bytes.subarray(12, 12 + length)));
    return {head, begin: (12 + length + 7) & ~7};
  } catch (error) {
    throw new DataProblem('The head of the data is not JSON.');
  }
}

const SIZES = {f64: 8, i32: 4, u32: 4, u8: 1};

// Bytes stand by their place in the entry; see packed_run.cpp for the rest of the coding.
function column(bytes, begin, {type, count, stride}) {
  const size = SIZES[type], joined = new Uint8Array(count * size);
  for (let plane = 0; plane < size; ++plane) {
    const from = begin + plane * count;
    for (let k = 0; k < count; ++k) joined[k * size + plane] = bytes[from + k];
  }
  if (type === 'u8') return differences(joined, stride);
  if (type === 'u32') return new Uint32Array(joined.buffer);
  if (type === 'i32') return secondDifferences(new Int32Array(joined.buffer), stride);
  const words = new Uint32Array(joined.buffer);
  if (stride > 0) for (let k = 2 * stride; k < words.length; ++k) words[k] ^= words[k - 2 * stride];
  return new Float64Array(joined.buffer);
}

function differences(values, stride) {
  if (stride > 0) for (let k = stride; k < values.length; ++k) values[k] += values[k - stride];
  return values;
}

function secondDifferences(values, stride) {
  for (let k = 0; k < values.length; ++k) {
    const difference = (values[k] >>> 1) ^ -(values[k] & 1);
    const one = k >= stride ? values[k - stride] : 0;
    values[k] = k >= 2 * stride ? difference + 2 * one - values[k - 2 * stride] : difference + one;
  }
  return values;
}

async function unpackRun(base64) {
  return unpackBytes(bytesOfBase64(base64));
}

// {head, NAME: typed array of every column}. Throws DataProblem.
async function unpackBytes(packed) {
  const buffer = await inflated(packed);
  const {head, begin} = headOf(buffer), bytes = new Uint8Array(buffer);
  const columns = {};
  let at = begin;
  for (const about of head.columns) {
    const length = about.count * SIZES[about.type];
    if (!(at + length <= bytes.length)) throw new DataProblem(`The data of this page is cut short in column ${about.name}.`);
    columns[about.name] = column(bytes, at, about);
    at += (length + 7) & ~7;
  }
  return new Run(head, columns);
}

// A run, with what its columns mean.
class Run {
  constructor(head, columns) {
    this.head = head;
    this.about = head.run;
    this.robots = head.scene.robots;
    this.obstacles = head.scene.obstacles;
    this.moving = head.scene.moving;
    this.bodies = head.bodies;
    this.n = this.robots.length;
    this.columns = columns;
    for (const name of COLUMNS)
      if (!columns[name]) throw new DataProblem(`The data of this page has no column ${name}: make it again with exactvo view.`);
    this.time = columns['time'];
    this.rows = this.time.length;
    if (this.rows === 0 || this.n === 0) throw new DataProblem('The run of this page has no rows or no robots.');
    if (columns['x'].length !== this.rows * this.n) throw new DataProblem('The data of this page contradicts itself.');
    this.end = this.time[this.rows - 1];
    this.scale = head.quantum.position;
    this.decisionTime = columns['decision.time'];
    this.starts = startsOf(columns['decision.half_planes']);
    this.partStarts = startsOf(columns['decision.parts']);
    this.hasMovers = Boolean(columns['decision.stopping_steps']);
    this.unreachable = [];  // world.js, unreachableOf
  }

  // m and m/s, rounded to the quanta of the page.
  x(row, robot) {
    return this.columns['x'][row * this.n + robot] * this.scale;
  }
  y(row, robot) {
    return this.columns['y'][row * this.n + robot] * this.scale;
  }
  vx(row, robot) {
    return this.columns['vx'][row * this.n + robot] * this.head.quantum.velocity;
  }
  vy(row, robot) {
    return this.columns['vy'][row * this.n + robot] * this.head.quantum.velocity;
  }
  // Radians, of a robot on wheels.
  heading(row, robot) {
    return this.columns['heading'][row * this.n + robot] * this.head.quantum.heading;
  }
  mode(row, robot) {
    return this.head.modes[this.columns['mode'][row * this.n + robot]];
  }
  side(row, robot) {
    return this.columns['side'][row * this.n + robot] - 1;
  }

  // Whether a robot is there: trajectories that were checked may begin late, pause or end early.
  isThere(robot, t) {
    const there = this.robots[robot].there;
    if (!there) return true;
    for (let k = 0; k < there.length; k += 2) if (there[k] <= t + 1e-9 && t <= there[k + 1] + 1e-9) return true;
    return false;
  }

  // The last row at or before t.
  rowAt(t) {
    return lastAtOrBefore(this.time, t);
  }
  // The last row with decisions at or before t; -1 where the page has none.
  decisionRowAt(t) {
    return this.decisionTime.length === 0 ? -1 : lastAtOrBefore(this.decisionTime, t);
  }

  // One robot's decision in a row with decisions.
  decision(row, robot) {
    const k = row * this.n + robot, c = this.columns, s = c['decision.state'], at = 12 * k;
    const decision = {
      row, robot, time: this.decisionTime[row],
      anchor: [s[at], s[at + 1]], anchorVelocity: [s[at + 2], s[at + 3]], position: [s[at + 4], s[at + 5]],
      velocity: [s[at + 6], s[at + 7]], preferred: [s[at + 8], s[at + 9]], chosen: [s[at + 10], s[at + 11]],
      violation: c['decision.violation'][k], status: this.head.statuses[c['decision.status'][k]],
      hasExactMultipliers: c['decision.exact_multipliers'][k] !== 0, isOfUser: c['decision.own_stage'][k] !== 0, halfPlanes: [], parts: [],
      // s: beside movers, after what time it can stand; 0: it stands. Else null.
      standsAfter: this.hasMovers ? c['decision.stopping_steps'][k] * this.about.time_step : null,
    };
    for (let i = this.starts[k]; i < this.starts[k + 1]; ++i) decision.halfPlanes.push(this.halfPlane(i, row, robot));
    for (let i = this.partStarts[k]; i < this.partStarts[k + 1]; ++i)
      decision.parts.push({kind: PART_KINDS[c['part.kind'][i]], multiplier: c['part.multiplier'][i]});
    return decision;
  }

  // The robot that holds this one most, in a row with decisions (formation/waiting.h); -1 where it waits for none.
  waitsFor(row, robot) {
    return this.columns['decision.waits'][row * this.n + robot] - 1;
  }

  halfPlane(i, row, robot) {
    const c = this.columns, line = c['half_plane.line'], flags = c['half_plane.flags'][i];
    const number = c['half_plane.body'][i], body = this.bodies[number];
    const h = {
      body: number, kind: body.kind, index: c['half_plane.index'][i], piece: c['half_plane.piece'][i],
      nx: line[3 * i], ny: line[3 * i + 1], c: line[3 * i + 2],
      timeHorizon: c['half_plane.time_horizon'][i], clearance: c['half_plane.clearance'][i], multiplier: c['half_plane.multiplier'][i],
      certified: (flags & 1) !== 0, hard: (flags & 2) !== 0, active: (flags & 4) !== 0, fellBack: (flags & 8) !== 0,
      radius: body.kind === 'robot' ? this.robots[robot].radius : this.robots[robot].obstacle_radius,
    };
    h.isOwnLimit = h.kind === 'robot' && h.hard;  // of what follows
    h.limited = this.robots[robot].on_wheels ? 'wheels' : 'acceleration';
    Object.assign(h, this.placed(h, row));
    if (h.kind === 'moving' && this.hasMovers) this.keepOff(h, row, robot);
    return h;
  }

  // The shape of a half-plane's body as it stood in that row, and its velocity.
  placed(h, row) {
    if (h.kind === 'robot') {
      const s = this.columns['decision.state'], at = 12 * (row * this.n + h.index);
      return {shape: {disc: [s[at], s[at + 1], this.robots[h.index].radius]}, ux: s[at + 2], uy: s[at + 3]};
    }
    if (h.kind !== 'moving') return {shape: this.bodies[h.body].shape, ux: 0, uy: 0};
    const m = this.columns['decision.moving'], at = 4 * (row * this.moving.length + h.index);
    const points = [];
    for (const ring of this.moving[h.index].rings)
      for (let k = 0; k < ring.length; k += 2) points.push(ring[k] + m[at], ring[k + 1] + m[at + 1]);
    return {shape: {polygon: points}, ux: m[at + 2], uy: m[at + 3]};
  }

  // A mover may go anywhere: how far until the robot stands, h.reach, m, as explain has it.
  keepOff(h, row, robot) {
    const mover = this.moving[h.index], m = this.columns['decision.moving'], at = 4 * (row * this.moving.length + h.index);
    h.steps = this.columns['decision.stopping_steps'][row * this.n + robot];
    h.mostSpeed = mover.max_speed;
    h.reach = mover.max_speed * h.steps * this.about.time_step;
    h.shape = {disc: [mover.disc[0] + m[at], mover.disc[1] + m[at + 1], mover.disc[2]]};
    h.ux = h.uy = 0;
    h.radius += h.reach;
  }

  // In words, as the program has them.
  nameOf(h) {
    const owners = this.bodies[h.body].owners;
    if (h.kind === 'robot') return `${h.isOwnLimit ? `${h.limited} of ` : ''}robot ${this.robots[h.index].id}`;
    if (h.kind === 'moving') return `moving obstacle ${this.moving[h.index].id}`;
    const ids = owners.map((o) => this.obstacles[o].id);
    const some = ids.length > 3 ? [...ids.slice(0, 3), `${ids.length - 3} more`] : ids;
    const names = some.length > 1 ? `${some.slice(0, -1).join(', ')} and ${some[some.length - 1]}` : some.join('');
    const of = `of obstacle${ids.length > 1 ? 's' : ''} ${names}`;
    if (h.kind === 'edge') return `an edge ${of}`;
    return `enclosure ${h.index}${h.piece > 0 ? `, piece ${h.piece},` : ''} ${of}`;
  }
}

const COLUMNS = ['time', 'x', 'y', 'vx', 'vy', 'mode', 'status', 'side', 'leader', 'moving', 'decision.time', 'decision.state',
  'decision.violation', 'decision.status', 'decision.exact_multipliers', 'decision.own_stage', 'decision.half_planes', 'decision.parts', 'decision.moving', 'decision.waits',
  'part.kind', 'part.multiplier', 'half_plane.body', 'half_plane.index', 'half_plane.piece', 'half_plane.flags', 'half_plane.line',
  'half_plane.time_horizon', 'half_plane.clearance', 'half_plane.multiplier'];
const PART_KINDS = ['line', 'disc', 'right', 'left', 'top', 'bottom'];

function startsOf(counts) {
  const starts = new Uint32Array(counts.length + 1);
  for (let k = 0; k < counts.length; ++k) starts[k + 1] = starts[k] + counts[k];
  return starts;
}

function lastAtOrBefore(times, t) {
  let low = 0, high = times.length;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t + 1e-9) low = middle;
    else high = middle;
  }
  return low;
}

export {DataProblem, Run, bytesOfBase64, unpackRun, unpackBytes, lastAtOrBefore};
