// SPDX-License-Identifier: GPL-3.0-or-later
// The velocity space of one robot at one moment: velocity obstacles with legs and cut-off, half-planes hatched on the
// forbidden side, the allowed velocities, speed bound, preferred and chosen velocity.
import {drawGrid, label, line, arrow, tracePoints} from './draw.js';
import {effectOf} from './words.js';
import {velocityObstacle, ringOf, clipped, speedRing} from './shapes.js';

// Everything of a decision that does not depend on the view.
function spaceOf(run, decision) {
  const obstacles = decision.halfPlanes.map((h) => velocityObstacle(h, decision.anchor));
  let allowed = speedRing(run, decision.robot);
  for (const h of decision.halfPlanes) if (allowed.length) allowed = clipped(allowed, h.nx, h.ny, h.c);
  allowed = withinChange(run, decision, allowed);
  return {run, decision, obstacles, allowed, bound: speedRing(run, decision.robot), isWhole: run.about.all_half_planes,
    effects: decision.halfPlanes.map((h) => effectOf(decision, h))};
}

// What the acceleration leaves: a polygon of 24 sides within the disc about the present velocity, with a corner towards
// rest.
function withinChange(run, decision, ring) {
  const [x, y] = decision.velocity, side = Math.PI / 12, reach = run.about.change * Math.cos(side / 2);
  if (run.robots[decision.robot].on_wheels) return withinWheels(run, decision, ring);
  if (!(run.about.change > 0)) return ring;
  for (let k = 0; k < 24 && ring.length; ++k) {
    const angle = Math.atan2(-y, -x) + (k + 0.5) * side, nx = -Math.cos(angle), ny = -Math.sin(angle);
    ring = clipped(ring, nx, ny, nx * x + ny * y - reach);
  }
  return ring;
}

// What wheels allow for ever, at their present heading: the hull of a disc about 0 and a point ahead (docs/guide/wheels.md,
// theorem 1), by 72 of its tangents.
function withinWheels(run, decision, ring) {
  const wheels = run.robots[decision.robot].on_wheels, most = wheels.max_wheel_speed;
  const disc = most / Math.hypot(1, wheels.wheel_separation / (2 * wheels.reference)), heading = run.heading(decision.row, decision.robot);
  for (let k = 0; k < 72 && ring.length; ++k) {
    const angle = k * Math.PI / 36;
    ring = clipped(ring, -Math.cos(heading + angle), -Math.sin(heading + angle), -Math.max(disc, most * Math.cos(angle)));
  }
  return ring;
}

// The half-width of the square that shows all of it.
function reachOf(run, decision) {
  const v = run.robots[decision.robot].max_speed * (run.about.speed_bound === 'box' ? 1.42 : 1);
  let reach = 1.3 * v;
  for (const u of [decision.preferred, decision.chosen, decision.velocity])
    if (Number.isFinite(u[0] + u[1])) reach = Math.max(reach, 1.1 * Math.hypot(u[0], u[1]));
  return reach;
}

// The piece of a half-plane's line within the view, as two points; null where it is outside.
function lineInView(view, h) {
  const length2 = h.nx * h.nx + h.ny * h.ny, reach = Math.hypot(view.width, view.height) / view.scale;
  // The foot of the view's centre on the line.
  const off = (h.c - h.nx * view.cx - h.ny * view.cy) / length2, n = Math.sqrt(length2);
  const fx = view.cx + off * h.nx, fy = view.cy + off * h.ny;
  if (Math.abs(off) * n > reach) return null;
  return [[fx - reach * h.ny / n, fy + reach * h.nx / n], [fx + reach * h.ny / n, fy - reach * h.nx / n]];
}

function drawCone(ctx, view, colours, h, obstacle, isMarked, strength) {
  const colour = h.kind === 'robot' || h.kind === 'moving' ? colours.coneRobot : colours.cone;
  const reach = Math.hypot(view.width, view.height) / view.scale + Math.hypot(view.cx, view.cy);
  tracePoints(ctx, view, ringOf(obstacle, reach), true);
  ctx.fillStyle = colour;
  ctx.globalAlpha = (isMarked ? 0.38 : 0.2) * strength;
  ctx.fill();
  ctx.globalAlpha = isMarked ? 1 : 0.5 + 0.5 * strength;
  ctx.strokeStyle = colour;
  ctx.lineWidth = isMarked ? 2.4 : 1.3;
  for (const leg of obstacle.legs) {
    const length = 4 * (reach + Math.hypot(leg.foot[0], leg.foot[1]));
    line(ctx, view.px(leg.foot[0]), view.py(leg.foot[1]), view.px(leg.foot[0] + length * leg.direction[0]),
      view.py(leg.foot[1] + length * leg.direction[1]));
  }
  tracePoints(ctx, view, obstacle.cutOff, false);
  ctx.lineWidth = isMarked ? 4 : 2.6;
  ctx.stroke();
  if (isMarked || strength === 1) {
    ctx.setLineDash([2, 3]);
    ctx.lineWidth = 1;
    tracePoints(ctx, view, obstacle.outline, true);
    ctx.stroke();
    ctx.setLineDash([]);
  }
  ctx.globalAlpha = 1;
}

// The colour of a half-plane that is slack, binding or violated.
function paintOf(colours, effect) {
  return effect === 'slack' ? colours.slack : effect === 'binding' ? colours.active : colours.bad;
}

function drawHalfPlane(ctx, view, colours, h, effect, isMarked) {
  const ends = lineInView(view, h);
  if (!ends) return null;
  const [x1, y1, x2, y2] = [view.px(ends[0][0]), view.py(ends[0][1]), view.px(ends[1][0]), view.py(ends[1][1])];
  ctx.strokeStyle = paintOf(colours, effect);
  ctx.lineWidth = (effect === 'slack' ? 1.3 : 2.6) + (isMarked ? 1.6 : 0);
  ctx.setLineDash(effect === 'violated' ? [9, 4] : []);
  line(ctx, x1, y1, x2, y2);
  ctx.setLineDash([]);
  // Hatching: strokes into the forbidden side, at 45 degrees to the line.
  const length = Math.hypot(x2 - x1, y2 - y1), ux = (x2 - x1) / length, uy = (y2 - y1) / length;
  const n = Math.hypot(h.nx, h.ny), ox = -h.nx / n, oy = h.ny / n, size = 9, gap = 11;
  ctx.lineWidth = isMarked ? 1.6 : 1;
  ctx.globalAlpha = effect !== 'slack' || isMarked ? 0.9 : 0.6;
  ctx.beginPath();
  for (let s = gap / 2; s < length; s += gap) {
    const x = x1 + s * ux, y = y1 + s * uy;
    if (x < -size || y < -size || x > view.width + size || y > view.height + size) continue;
    ctx.moveTo(x, y);
    ctx.lineTo(x + size * (ox + ux) * 0.7, y + size * (oy + uy) * 0.7);
  }
  ctx.stroke();
  ctx.globalAlpha = 1;
  return [x1, y1, x2, y2];
}

// A place for the number of a half-plane on its line, inside the view and away from those that are taken.
function numberPlace(view, ends, taken) {
  const [x1, y1, x2, y2] = ends;
  let best = null, room = -1;
  for (let k = 1; k < 40; ++k) {
    const x = x1 + (x2 - x1) * k / 40, y = y1 + (y2 - y1) * k / 40;
    const isInLegend = (x > view.width - 100 && y < 68) || (x < 200 && y < 48);
    if (isInLegend || x < 16 || y < 30 || x > view.width - 16 || y > view.height - 26) continue;
    let here = 60;
    for (const [tx, ty] of taken) here = Math.min(here, Math.hypot(tx - x, ty - y));
    if (here > room) {
      room = here;
      best = [x, y];
    }
  }
  return best;
}

function drawNumber(ctx, colours, text, x, y, effect) {
  ctx.beginPath();
  ctx.arc(x, y, 9, 0, 2 * Math.PI);
  ctx.fillStyle = colours.ground;
  ctx.fill();
  ctx.strokeStyle = paintOf(colours, effect);
  ctx.lineWidth = effect === 'slack' ? 1 : 2;
  ctx.stroke();
  ctx.fillStyle = effect === 'slack' ? colours.faint : paintOf(colours, effect);
  ctx.textAlign = 'center';
  ctx.textBaseline = 'middle';
  ctx.font = 'bold 10px system-ui, sans-serif';
  ctx.fillText(text, x, y);
  ctx.textAlign = 'start';
  ctx.textBaseline = 'alphabetic';
}

function drawVelocity(ctx, view, colour, v, width, dash, dot) {
  if (!Number.isFinite(v[0] + v[1])) return;
  ctx.strokeStyle = ctx.fillStyle = colour;
  ctx.lineWidth = width;
  ctx.setLineDash(dash);
  if (dash.length) line(ctx, view.px(0), view.py(0), view.px(v[0]), view.py(v[1]));
  else arrow(ctx, view.px(0), view.py(0), view.px(v[0]), view.py(v[1]), 5 + 2.6 * width);
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.arc(view.px(v[0]), view.py(v[1]), dot, 0, 2 * Math.PI);
  ctx.fill();
}

function drawLegend(ctx, view, colours) {
  const entries = [['preferred', colours.preferred], ['chosen', colours.chosen], ['present', colours.velocity]];
  ctx.font = '12px system-ui, sans-serif';
  ctx.textAlign = 'right';
  entries.forEach(([text, colour], k) => {
    const y = 18 + 17 * k;
    label(ctx, text, view.width - 24, y, colours.text, colours.label);
    ctx.beginPath();
    ctx.arc(view.width - 14, y - 4, 4.5, 0, 2 * Math.PI);
    ctx.fillStyle = colour;
    ctx.fill();
  });
  ctx.textAlign = 'start';
}

// The free velocities: within the speed bound and in no velocity obstacle. What the allowed ones leave of them, painted
// over this, is given away. Only where every half-plane is there.
function drawFree(ctx, view, colours, {obstacles, bound, isWhole}) {
  if (!isWhole || obstacles.includes(null)) return;
  tracePoints(ctx, view, bound, true);
  ctx.fillStyle = colours.givenAway;
  ctx.fill();
  const reach = Math.hypot(view.width, view.height) / view.scale + Math.hypot(view.cx, view.cy);
  ctx.fillStyle = colours.ground;
  for (const o of obstacles) {
    tracePoints(ctx, view, ringOf(o, reach), true);
    ctx.fill();
  }
}

// ui: {halfPlane, colours}; space: spaceOf(...) or null.
function drawSpace(ctx, view, space, ui) {
  const colours = ui.colours;
  ctx.fillStyle = colours.ground;
  ctx.fillRect(0, 0, view.width, view.height);
  if (!space) {
    drawGrid(ctx, view, colours, 'm/s')();
    return;
  }
  const {decision, obstacles, allowed, bound, effects} = space;
  drawFree(ctx, view, colours, space);
  if (allowed.length > 2) {
    tracePoints(ctx, view, allowed, true);
    ctx.fillStyle = colours.allowed;
    ctx.fill();
  }
  const numbers = drawGrid(ctx, view, colours, 'm/s');
  const strength = Math.min(1, 5 / Math.max(1, obstacles.length));
  obstacles.forEach((o, k) => {
    if (o) drawCone(ctx, view, colours, decision.halfPlanes[k], o, ui.halfPlane === k, strength);
  });
  tracePoints(ctx, view, bound, true);
  ctx.strokeStyle = colours.text;
  ctx.lineWidth = 1.3;
  ctx.setLineDash([7, 5]);
  ctx.stroke();
  ctx.setLineDash([]);
  const draw = (h, k) => drawHalfPlane(ctx, view, colours, h, effects[k], ui.halfPlane === k);
  const isAbove = (k) => effects[k] !== 'slack' || ui.halfPlane === k;
  const ends = decision.halfPlanes.map((h, k) => (isAbove(k) ? null : draw(h, k)));
  decision.halfPlanes.forEach((h, k) => {
    if (isAbove(k)) ends[k] = draw(h, k);
  });
  drawVelocity(ctx, view, colours.velocity, decision.velocity, 1.5, [], 2);
  drawVelocity(ctx, view, colours.chosen, decision.chosen, 4, [], 4.5);
  drawVelocity(ctx, view, colours.preferred, decision.preferred, 2, [6, 5], 4.5);
  const taken = [];
  const count = decision.halfPlanes.length;
  decision.halfPlanes.forEach((h, k) => {
    if (!ends[k] || (count > 24 && !isAbove(k))) return;
    const place = numberPlace(view, ends[k], taken);
    if (!place) return;
    taken.push(place);
    drawNumber(ctx, colours, String(k + 1), place[0], place[1], effects[k]);
  });
  numbers();
  drawLegend(ctx, view, colours);
  if (!space.isWhole)
    ['half-planes not recorded', 'may forbid more'].forEach((text, k) => label(ctx, text, 38, 18 + 15 * k, colours.text, colours.label));
}

// The half-plane whose line passes a point of the screen; null where none is near.
function pickInSpace(view, space, px, py) {
  if (!space) return null;
  let best = null, nearest = 9;
  space.decision.halfPlanes.forEach((h, k) => {
    const d = Math.abs(h.nx * view.x(px) + h.ny * view.y(py) - h.c) / Math.hypot(h.nx, h.ny) * view.scale;
    if (d < nearest) {
      nearest = d;
      best = k;
    }
  });
  return best;
}

export {spaceOf, reachOf, drawSpace, pickInSpace};
