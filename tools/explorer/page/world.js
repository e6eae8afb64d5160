// SPDX-License-Identifier: GPL-3.0-or-later
// The world: obstacles, enclosures, robots with heading and trail, goals, what presses on each robot.
import {drawGrid, label, line, arrow, triangle, shortName, tracePoints} from './draw.js';
import {distanceToSegment} from './shapes.js';
import {drawPlan} from './plans.js';

const CROWD = 60;          // robots: more than this are drawn in bulk, without names and trails
const MOST_TRAIL = 4000;   // points of a trail
const MOST_ENDS = 400;     // facades: of more, the ends are not marked

// Positions of all robots at a time, between two rows where it lies there. No allocation per frame.
class Positions {
  constructor(run) {
    this.run = run;
    this.x = new Float64Array(run.n);
    this.y = new Float64Array(run.n);
    this.heading = new Float64Array(run.n);  // radians, of robots on wheels
    this.row = 0;
  }
  at(t) {
    const run = this.run, row = run.rowAt(t), next = Math.min(row + 1, run.rows - 1);
    const span = run.time[next] - run.time[row];
    const f = span > 0 ? Math.max(0, Math.min(1, (t - run.time[row]) / span)) : 0;
    const xs = run.columns['x'], ys = run.columns['y'], a = row * run.n, b = next * run.n;
    for (let i = 0; i < run.n; ++i) {
      this.x[i] = ((1 - f) * xs[a + i] + f * xs[b + i]) * run.scale;
      this.y[i] = ((1 - f) * ys[a + i] + f * ys[b + i]) * run.scale;
    }
    for (let i = 0; i < run.n && run.columns['heading']; ++i) {
      const turn = run.heading(next, i) - run.heading(row, i);
      this.heading[i] = run.heading(row, i) + f * (turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)));
    }
    this.row = row;
    return this;
  }
}

// All that a run touches, for the first view.
function extentOf(run) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  const add = (x, y, r) => {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    low[0] = Math.min(low[0], x - r);
    low[1] = Math.min(low[1], y - r);
    high[0] = Math.max(high[0], x + r);
    high[1] = Math.max(high[1], y + r);
  };
  const stride = Math.max(1, Math.floor(run.rows / 400));
  for (let row = 0; row < run.rows; row += stride)
    for (let i = 0; i < run.n; ++i) add(run.x(row, i), run.y(row, i), run.robots[i].radius);
  for (const o of [...run.obstacles, ...run.moving])
    for (const ring of o.rings) for (let k = 0; k < ring.length; k += 2) add(ring[k], ring[k + 1], 0);
  for (const r of run.robots) for (let k = 0; k < r.goals.length; k += 2) add(r.goals[k], r.goals[k + 1], 0.3);
  return {low, high};
}

function colourOf(colours, i) {
  return colours.series[i % colours.series.length];
}

function traceRings(ctx, view, obstacle, ox, oy) {
  ctx.beginPath();
  for (const ring of obstacle.rings) {
    for (let k = 0; k < ring.length; k += 2) {
      const x = view.px(ring[k] + ox), y = view.py(ring[k + 1] + oy);
      if (k === 0) ctx.moveTo(x, y);
      else ctx.lineTo(x, y);
    }
    if (obstacle.solid) ctx.closePath();
  }
}

function drawObstacle(ctx, view, colours, obstacle, ox, oy, isMarked) {
  traceRings(ctx, view, obstacle, ox, oy);
  if (obstacle.solid) {
    ctx.fillStyle = colours.obstacle;
    ctx.fill('evenodd');
  }
  ctx.strokeStyle = isMarked ? colours.active : colours.obstacleLine;
  ctx.lineWidth = (obstacle.solid ? 1.5 : 3.5) + (isMarked ? 1.5 : 0);
  ctx.lineJoin = 'round';
  ctx.stroke();
}

function outlineOf(shape) {
  if (shape.segment || shape.polygon) {
    const numbers = shape.segment || shape.polygon, points = [];
    for (let k = 0; k < numbers.length; k += 2) points.push([numbers[k], numbers[k + 1]]);
    return points;
  }
  const [cx, cy, a, b, c] = shape.ellipse || [shape.disc[0], shape.disc[1], shape.disc[2], 0, shape.disc[2]];
  const points = [];
  for (let i = 0; i < 96; ++i) {
    const u = Math.cos(i * Math.PI / 48), w = Math.sin(i * Math.PI / 48);
    points.push([cx + a * u, cy + b * u + c * w]);
  }
  return points;
}

// The shapes that the chosen robot sees at a time: enclosures, or facades and convex pieces.
function goalBodiesAt(run, robot, t) {
  let found = null;
  for (const o of run.head.goal_bodies) if (o.robot === robot && o.time <= t + 1e-9) found = o;
  return found;
}

function drawEnclosures(ctx, view, colours, run, ui) {
  const ofGoal = goalBodiesAt(run, ui.robot, ui.t);
  if (!ofGoal) return;
  ctx.strokeStyle = ctx.fillStyle = colours.enclosure;
  ctx.lineWidth = 1.2;
  for (const number of ofGoal.bodies) {
    const shape = run.bodies[number].shape;
    if (!shape) continue;
    ctx.setLineDash(shape.ellipse ? [5, 4] : []);
    tracePoints(ctx, view, outlineOf(shape), !shape.segment);
    ctx.stroke();
    if (!shape.segment || ofGoal.bodies.length > MOST_ENDS) continue;
    for (const [x, y] of outlineOf(shape)) {
      ctx.beginPath();
      ctx.arc(view.px(x), view.py(y), 2.2, 0, 2 * Math.PI);
      ctx.fill();
    }
  }
  ctx.setLineDash([]);
}

function drawTrail(ctx, view, run, robot, from, until) {
  const stride = Math.max(1, Math.ceil((until - from) / MOST_TRAIL));
  ctx.beginPath();
  let lastX = NaN, lastY = NaN;
  for (let row = from; row <= until; row += stride) {
    if (!run.isThere(robot, run.time[row])) {
      lastX = NaN;
      continue;
    }
    const x = view.px(run.x(row, robot)), y = view.py(run.y(row, robot));
    if (Math.abs(x - lastX) + Math.abs(y - lastY) < 1.5) continue;
    if (Number.isNaN(lastX)) ctx.moveTo(x, y);
    else ctx.lineTo(x, y);
    lastX = x;
    lastY = y;
  }
  ctx.stroke();
}

function drawTrails(ctx, view, colours, run, ui, row) {
  ctx.lineJoin = 'round';
  const recent = run.rowAt(Math.max(0, run.time[row] - 4));
  for (let i = 0; i < run.n; ++i) {
    if (run.n > CROWD && i !== ui.robot) continue;
    ctx.strokeStyle = colourOf(colours, i);
    ctx.globalAlpha = 0.3;
    ctx.lineWidth = 1.2;
    drawTrail(ctx, view, run, i, 0, run.rows - 1);
    ctx.globalAlpha = 1;
    ctx.lineWidth = 2.2;
    drawTrail(ctx, view, run, i, recent, row);
  }
  ctx.globalAlpha = 1;
}

function drawGoals(ctx, view, colours, run, ui) {
  ctx.lineWidth = 1.5;
  for (let i = 0; i < run.n; ++i) {
    if (run.n > CROWD && i !== ui.robot) continue;
    const goals = run.robots[i].goals;
    ctx.strokeStyle = colourOf(colours, i);
    for (let k = 0; k < goals.length; k += 2) {
      const x = view.px(goals[k]), y = view.py(goals[k + 1]), s = k + 2 === goals.length ? 5 : 3;
      line(ctx, x - s, y - s, x + s, y + s);
      line(ctx, x - s, y + s, x + s, y - s);
    }
  }
}

// The routes that robots set out on: of every robot of a few, else of the chosen one.
function drawRoutes(ctx, view, colours, run, ui) {
  ctx.setLineDash([8, 3, 2, 3]);
  for (const route of run.head.routes || []) {
    if (!route.points.length || (run.n > CROWD && route.robot !== ui.robot)) continue;
    ctx.strokeStyle = colourOf(colours, route.robot);
    ctx.globalAlpha = route.robot === ui.robot ? 0.9 : 0.4;
    ctx.lineWidth = route.robot === ui.robot ? 1.6 : 1;
    ctx.beginPath();
    for (let k = 0; k < route.points.length; k += 2) {
      if (k === 0) ctx.moveTo(view.px(route.points[0]), view.py(route.points[1]));
      else ctx.lineTo(view.px(route.points[k]), view.py(route.points[k + 1]));
    }
    ctx.stroke();
  }
  ctx.globalAlpha = 1;
  ctx.setLineDash([]);
}

// The goals of each robot that are proven out of its reach, with why: [{robot, goal, why}].
function unreachableOf(run) {
  const found = (run.head.routes || []).filter((route) => route.why_not).map((route) => ({robot: route.robot, goal: route.goal, why: route.why_not}));
  for (const e of run.head.events) {
    if (e.kind !== 'unreachable' || found.some((u) => u.robot === e.robot)) continue;
    const number = /its goal (\d+)/.exec(e.text);
    found.push({robot: e.robot, goal: number ? Number(number[1]) - 1 : 0, why: e.text});
  }
  return found.filter((u) => run.robots[u.robot].goals.length > 2 * u.goal);
}

function drawUnreachable(ctx, view, colours, run, ui) {
  ctx.strokeStyle = colours.bad;
  ctx.lineWidth = 2.5;
  for (const {robot, goal} of run.unreachable) {
    if (run.n > CROWD && robot !== ui.robot) continue;
    const goals = run.robots[robot].goals, x = view.px(goals[2 * goal]), y = view.py(goals[2 * goal + 1]);
    ctx.beginPath();
    ctx.arc(x, y, 10, 0, 2 * Math.PI);
    ctx.stroke();
    line(ctx, x - 7, y + 7, x + 7, y - 7);
  }
}

// Corners and goals that can be dragged.
function drawHandles(ctx, view, colours, run) {
  ctx.strokeStyle = colours.preferred;
  ctx.fillStyle = colours.ground;
  ctx.lineWidth = 1.4;
  const square = (x, y, r) => {
    ctx.beginPath();
    ctx.rect(x - r, y - r, 2 * r, 2 * r);
    ctx.fill();
    ctx.stroke();
  };
  for (const o of run.obstacles)
    for (const ring of o.rings) for (let k = 0; k < ring.length && ring.length <= 2 * MOST_ENDS; k += 2) square(view.px(ring[k]), view.py(ring[k + 1]), 3);
  if (run.n > CROWD) return;
  for (const r of run.robots)
    for (let k = 0; k < r.goals.length; k += 2) {
      ctx.beginPath();
      ctx.arc(view.px(r.goals[k]), view.py(r.goals[k + 1]), 8, 0, 2 * Math.PI);
      ctx.stroke();
    }
}

function drawLeader(ctx, view, colours, run, row) {
  if (!run.about.formation) return;
  const path = run.about.formation.path;
  ctx.strokeStyle = colours.axis;
  ctx.lineWidth = 1;
  ctx.setLineDash([2, 4]);
  ctx.beginPath();
  for (let k = 0; k < path.length; k += 2) {
    if (k === 0) ctx.moveTo(view.px(path[k]), view.py(path[k + 1]));
    else ctx.lineTo(view.px(path[k]), view.py(path[k + 1]));
  }
  ctx.stroke();
  ctx.setLineDash([]);
  const leader = run.columns['leader'], x = leader[2 * row], y = leader[2 * row + 1], offsets = run.about.formation.offsets;
  ctx.strokeStyle = colours.faint;
  for (let i = 0; i < run.n; ++i) {
    ctx.beginPath();
    ctx.arc(view.px(x + offsets[2 * i]), view.py(y + offsets[2 * i + 1]), 4, 0, 2 * Math.PI);
    ctx.stroke();
  }
  ctx.fillStyle = colours.faint;
  ctx.beginPath();
  ctx.arc(view.px(x), view.py(y), 3, 0, 2 * Math.PI);
  ctx.fill();
}

// In bulk: one path a colour.
function drawCrowd(ctx, view, colours, run, positions, t) {
  const modes = run.columns['mode'], statuses = run.columns['status'], at = positions.row * run.n;
  const arrived = run.head.modes.indexOf('arrived');
  for (let group = 0; group < 3; ++group) {
    ctx.fillStyle = group === 0 ? colours.series[0] : group === 1 ? colours.axis : colours.bad;
    ctx.beginPath();
    for (let i = 0; i < run.n; ++i) {
      const kind = statuses[at + i] !== 0 ? 2 : modes[at + i] === arrived ? 1 : 0;
      if (kind !== group || !run.isThere(i, t)) continue;
      const x = view.px(positions.x[i]), y = view.py(positions.y[i]), r = Math.max(1.3, run.robots[i].radius * view.scale);
      if (x < -r || y < -r || x > view.width + r || y > view.height + r) continue;
      if (r < 2.5) {
        ctx.rect(x - r, y - r, 2 * r, 2 * r);
      } else {
        ctx.moveTo(x + r, y);
        ctx.arc(x, y, r, 0, 2 * Math.PI);
      }
    }
    ctx.fill();
  }
  if (run.columns['heading']) drawHeadings(ctx, view, colours, run, positions, t);
}

// Of robots that are large enough to show it: a line to the rim of the disc.
function drawHeadings(ctx, view, colours, run, positions, t) {
  ctx.strokeStyle = colours.text;
  ctx.lineWidth = 1.2;
  ctx.beginPath();
  for (let i = 0; i < run.n; ++i) {
    const r = run.robots[i].radius, x = positions.x[i], y = positions.y[i];
    if (!run.robots[i].on_wheels || r * view.scale < 3 || !run.isThere(i, t)) continue;
    ctx.moveTo(view.px(x), view.py(y));
    ctx.lineTo(view.px(x + r * Math.cos(positions.heading[i])), view.py(y + r * Math.sin(positions.heading[i])));
  }
  ctx.stroke();
}

// Within its disc: the body about the axle, both wheels, and a line from the axle to the reference point.
function drawOnWheels(ctx, view, colours, wheels, positions, i) {
  const c = Math.cos(positions.heading[i]), s = Math.sin(positions.heading[i]);
  const axle = [positions.x[i] - wheels.reference * c, positions.y[i] - wheels.reference * s];
  const at = (ahead, left) => [view.px(axle[0] + ahead * c - left * s), view.py(axle[1] + ahead * s + left * c)];
  const r = wheels.body_radius, half = wheels.wheel_separation / 2;
  ctx.beginPath();
  for (let k = 0; k < wheels.footprint.length; k += 2) ctx.lineTo(...at(wheels.footprint[k], wheels.footprint[k + 1]));
  if (!wheels.footprint.length) ctx.arc(...at(0, 0), r * view.scale, 0, 2 * Math.PI);
  ctx.fill();
  ctx.strokeStyle = colours.text;
  ctx.lineWidth = Math.max(2, 0.2 * r * view.scale);
  for (const left of [half, -half]) line(ctx, ...at(-r / 3, left), ...at(r / 3, left));
  ctx.lineWidth = 1.6;
  line(ctx, ...at(0, 0), ...at(wheels.reference, 0));
}

// A body that is no disc: its convex parts, turned.
function traceOutline(ctx, view, rings, x, y, heading) {
  const c = Math.cos(heading), s = Math.sin(heading);
  for (const ring of rings) {
    for (let k = 0; k < ring.length; k += 2) {
      const px = view.px(x + c * ring[k] - s * ring[k + 1]), py = view.py(y + s * ring[k] + c * ring[k + 1]);
      if (k === 0) ctx.moveTo(px, py);
      else ctx.lineTo(px, py);
    }
    ctx.closePath();
  }
}

function drawRobot(ctx, view, colours, run, ui, positions, i) {
  const x = view.px(positions.x[i]), y = view.py(positions.y[i]), r = Math.max(2.5, run.robots[i].radius * view.scale);
  const wheels = run.robots[i].on_wheels;
  ctx.fillStyle = colourOf(colours, i);
  const body = run.robots[i].body_radius;  // smaller than the disc where it may be off
  ctx.globalAlpha = wheels || body ? 0.3 : 0.85;
  ctx.beginPath();
  if (run.robots[i].outline) traceOutline(ctx, view, run.robots[i].outline, positions.x[i], positions.y[i], positions.heading[i]);
  else ctx.arc(x, y, r, 0, 2 * Math.PI);
  ctx.fill();
  ctx.globalAlpha = 1;
  if (wheels) drawOnWheels(ctx, view, colours, wheels, positions, i);
  if (body) {
    ctx.beginPath();
    ctx.arc(x, y, body * view.scale, 0, 2 * Math.PI);
    ctx.fill();
  }
  if (i === ui.robot) {
    ctx.strokeStyle = colours.selected;
    ctx.lineWidth = 2.5;
    ctx.beginPath();
    ctx.arc(x, y, r + 3, 0, 2 * Math.PI);
    ctx.stroke();
  }
  const vx = run.vx(positions.row, i), vy = run.vy(positions.row, i), speed = Math.hypot(vx, vy);
  if (speed > 1e-3) {
    ctx.strokeStyle = ctx.fillStyle = colours.text;
    ctx.lineWidth = 1.6;
    arrow(ctx, x, y, x + vx * view.scale * 0.6, y - vy * view.scale * 0.6, 8);
  }
}

// Thin arrows from each robot to the robots whose half-planes press on it (multiplier above 0).
function drawPressure(ctx, view, colours, run, ui, positions) {
  const row = run.decisionRowAt(ui.t);
  if (row < 0 || run.n > 200) return;
  const index = run.columns['half_plane.index'], lambda = run.columns['half_plane.multiplier'];
  const body = run.columns['half_plane.body'];
  ctx.strokeStyle = ctx.fillStyle = colours.active;
  ctx.setLineDash([3, 3]);
  for (let i = 0; i < run.n; ++i) {
    ctx.lineWidth = i === ui.robot ? 1.8 : 0.9;
    ctx.globalAlpha = i === ui.robot ? 1 : 0.55;
    for (let k = run.starts[row * run.n + i]; k < run.starts[row * run.n + i + 1]; ++k) {
      if (!(lambda[k] > 1e-6) || run.bodies[body[k]].kind !== 'robot') continue;
      const j = index[k];
      arrow(ctx, view.px(positions.x[i]), view.py(positions.y[i]), view.px(positions.x[j]), view.py(positions.y[j]), 7);
    }
  }
  ctx.globalAlpha = 1;
  ctx.setLineDash([]);
}

// From a robot to the one that it waits for: thick arrows from rim to rim.
function drawWaits(ctx, view, colours, run, ui, positions) {
  const row = run.decisionRowAt(ui.t);
  if (row < 0 || run.n > 1000) return;
  ctx.strokeStyle = ctx.fillStyle = colours.bad;
  ctx.lineWidth = 3;
  for (let i = 0; i < run.n; ++i) {
    const j = run.waitsFor(row, i);
    if (j < 0) continue;
    const x1 = view.px(positions.x[i]), y1 = view.py(positions.y[i]), x2 = view.px(positions.x[j]), y2 = view.py(positions.y[j]);
    const length = Math.hypot(x2 - x1, y2 - y1), rim = run.robots[j].radius * view.scale;
    if (length > rim) arrow(ctx, x1, y1, x2 - (x2 - x1) * rim / length, y2 - (y2 - y1) * rim / length, 11);
  }
}

// Obstacles that press on the chosen robot, by index.
function pressingObstacles(run, decision) {
  const marked = new Set();
  if (!decision) return marked;
  for (const h of decision.halfPlanes)
    if (h.multiplier > 1e-6 && (h.kind === 'edge' || h.kind === 'enclosure')) for (const o of run.bodies[h.body].owners) marked.add(o);
  return marked;
}

function drawPinnedBody(ctx, view, colours, ui, decision) {
  const h = decision && ui.halfPlane !== null ? decision.halfPlanes[ui.halfPlane] : null;
  if (!h) return;
  ctx.strokeStyle = colours.active;
  ctx.lineWidth = 3;
  tracePoints(ctx, view, outlineOf(h.shape), !h.shape.segment);
  ctx.stroke();
}

function drawCollisions(ctx, view, colours, run, t) {
  for (const c of run.about.collisions) {
    if (c.from > t + 1e-9) continue;
    const x = view.px(c.place[0]), y = view.py(c.place[1]);
    ctx.strokeStyle = c.standing ? colours.active : colours.bad;
    ctx.lineWidth = c.standing ? 1.8 : 2.5;
    if (c.standing) {  // nothing is promised to it
      triangle(ctx, x, y, 7);
      continue;
    }
    line(ctx, x - 7, y, x + 7, y);
    line(ctx, x, y - 7, x, y + 7);
  }
}

// Beside each robot where its name covers neither another name nor a robot; where there is no such place it is left
// out, but for the chosen robot's. Pointing at a robot names it.
function drawNames(ctx, view, colours, run, ui, positions) {
  ctx.font = 'bold 12px system-ui, sans-serif';
  ctx.textAlign = 'left';
  const taken = [], shown = [];
  for (let i = 0; i < run.n; ++i) {
    if ((run.n > CROWD && i !== ui.robot) || !run.isThere(i, ui.t)) continue;
    const x = view.px(positions.x[i]), y = view.py(positions.y[i]), r = Math.max(2.5, run.robots[i].radius * view.scale) + 3;
    if (x < -r || y < -r || x > view.width + r || y > view.height + r) continue;
    taken.push([x - r, y - r, x + r, y + r]);
    shown.push({i, x, y, r});
  }
  shown.sort((a, b) => (b.i === ui.robot) - (a.i === ui.robot) || a.i - b.i);
  for (const {i, x, y, r} of shown) {
    const text = shortName(run.robots[i].id, 18), width = ctx.measureText(text).width;
    const place = namePlace(x, y, r, width, taken) || (i === ui.robot ? [x + r + 2, y - r] : null);
    if (!place) continue;
    taken.push([place[0], place[1] - 11, place[0] + width, place[1] + 2]);
    label(ctx, text, place[0], place[1], colours.text, colours.label);
  }
}

function namePlace(x, y, r, width, taken) {
  const places = [[x + r + 2, y - r], [x + r + 2, y + r + 8], [x - r - 2 - width, y - r], [x - r - 2 - width, y + r + 8],
    [x - width / 2, y - r - 4], [x - width / 2, y + r + 12], [x + r + 3, y + 4], [x - r - 3 - width, y + 4]];
  const isFree = ([left, base]) => taken.every(([x1, y1, x2, y2]) => left > x2 || left + width < x1 || base - 11 > y2 || base + 2 < y1);
  return places.find(isFree) || null;
}

// ui: {t, robot, halfPlane, colours}; decision: of the chosen robot, or null.
function drawWorld(ctx, view, run, positions, ui, decision) {
  const colours = ui.colours;
  ctx.fillStyle = colours.ground;
  ctx.fillRect(0, 0, view.width, view.height);
  const numbers = drawGrid(ctx, view, colours, 'm');
  const marked = pressingObstacles(run, decision);
  for (let k = 0; k < run.obstacles.length; ++k) drawObstacle(ctx, view, colours, run.obstacles[k], 0, 0, marked.has(k));
  const moved = run.columns['moving'];
  for (let k = 0; k < run.moving.length; ++k) {
    const at = 2 * (positions.row * run.moving.length + k);
    drawObstacle(ctx, view, colours, run.moving[k], moved[at], moved[at + 1], false);
  }
  drawEnclosures(ctx, view, colours, run, ui);
  drawRoutes(ctx, view, colours, run, ui);
  drawPlan(ctx, view, colours, run, ui);
  drawGoals(ctx, view, colours, run, ui);
  drawUnreachable(ctx, view, colours, run, ui);
  drawTrails(ctx, view, colours, run, ui, positions.row);
  drawLeader(ctx, view, colours, run, positions.row);
  if (run.n > CROWD) drawCrowd(ctx, view, colours, run, positions, ui.t);
  for (let i = 0; i < run.n; ++i) if ((run.n <= CROWD || i === ui.robot) && run.isThere(i, ui.t)) drawRobot(ctx, view, colours, run, ui, positions, i);
  drawPressure(ctx, view, colours, run, ui, positions);
  drawWaits(ctx, view, colours, run, ui, positions);
  drawPinnedBody(ctx, view, colours, ui, decision);
  drawCollisions(ctx, view, colours, run, ui.t);
  drawNames(ctx, view, colours, run, ui, positions);
  numbers();
}

// What does not move: for an animation.
function drawStill(ctx, view, run, ui) {
  const colours = ui.colours;
  ctx.fillStyle = colours.ground;
  ctx.fillRect(0, 0, view.width, view.height);
  const numbers = drawGrid(ctx, view, colours, 'm');
  for (const o of run.obstacles) drawObstacle(ctx, view, colours, o, 0, 0, false);
  drawGoals(ctx, view, colours, run, ui);
  drawTrails(ctx, view, colours, run, ui, 0);
  numbers();
}

// What lies under a point of the screen: {robot}, {goal: [robot, which]}, {obstacle} or {moving}; null where nothing does.
function pickInWorld(view, run, positions, px, py) {
  let best = null, nearest = 14;
  for (let i = 0; i < run.n; ++i) {
    if (!run.isThere(i, run.time[positions.row])) continue;
    const d = Math.hypot(view.px(positions.x[i]) - px, view.py(positions.y[i]) - py) - run.robots[i].radius * view.scale;
    if (d < Math.min(nearest, 6)) {
      nearest = d;
      best = {robot: i};
    }
  }
  if (best) return best;
  for (let i = 0; i < run.n && run.n <= CROWD; ++i)
    for (let k = 0; k < run.robots[i].goals.length; k += 2)
      if (Math.hypot(view.px(run.robots[i].goals[k]) - px, view.py(run.robots[i].goals[k + 1]) - py) < 9) return {goal: [i, k / 2]};
  const x = view.x(px), y = view.y(py);
  const near = (o, ox, oy) => {
    for (const ring of o.rings)
      for (let k = 0; k + (o.solid ? 0 : 2) < ring.length; k += 2) {
        const j = (k + 2) % ring.length;
        if (distanceToSegment(x, y, ring[k] + ox, ring[k + 1] + oy, ring[j] + ox, ring[j + 1] + oy) * view.scale < 7) return true;
      }
    return false;
  };
  for (let k = 0; k < run.obstacles.length; ++k) if (near(run.obstacles[k], 0, 0)) return {obstacle: k};
  const moved = run.columns['moving'];
  for (let k = 0; k < run.moving.length; ++k) {
    const at = 2 * (positions.row * run.moving.length + k);
    if (near(run.moving[k], moved[at], moved[at + 1])) return {moving: k};
  }
  return null;
}

export {Positions, extentOf, unreachableOf, drawWorld, drawHandles, drawStill, pickInWorld, colourOf, CROWD};
