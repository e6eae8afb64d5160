// SPDX-License-Identifier: GPL-3.0-or-later
// The geometry of pictures, rounded: support functions, legs and cut-offs of velocity obstacles, clipping, distances.
// Proofs are in proof.js.

// h(n) and the point of the shape, seen from (x, y) and grown by `radius`, that is farthest along the unit vector n.
// Writes the point into out.x, out.y.
function support(seen, nx, ny, out) {
  const {shape, x, y, radius} = seen;
  let px, py;
  if (shape.disc) {
    px = shape.disc[0] + shape.disc[2] * nx;
    py = shape.disc[1] + shape.disc[2] * ny;
  } else if (shape.ellipse) {
    const [cx, cy, l11, l21, l22] = shape.ellipse;
    const a = l11 * nx + l21 * ny, b = l22 * ny, length = Math.hypot(a, b) || 1;
    px = cx + l11 * a / length;
    py = cy + (l21 * a + l22 * b) / length;
  } else {
    const points = shape.segment || shape.polygon;
    let best = -Infinity;
    for (let i = 0; i < points.length; i += 2) {
      const along = points[i] * nx + points[i + 1] * ny;
      if (along > best) {
        best = along;
        px = points[i];
        py = points[i + 1];
      }
    }
  }
  out.x = px - x + radius * nx;
  out.y = py - y + radius * ny;
  return out.x * nx + out.y * ny;
}

const scratch = {x: 0, y: 0};

function heightAt(seen, angle) {
  return support(seen, Math.cos(angle), Math.sin(angle), scratch);
}

// The angle of the direction in which the shape reaches least far: away from it, where the origin is outside.
function separatingAngle(seen) {
  const coarse = 48, step = 2 * Math.PI / coarse;
  let best = 0, least = Infinity;
  for (let i = 0; i < coarse; ++i) {
    const h = heightAt(seen, i * step);
    if (h < least) {
      least = h;
      best = i * step;
    }
  }
  let low = best - step, high = best + step;
  for (let i = 0; i < 60; ++i) {
    const a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
    if (heightAt(seen, a) < heightAt(seen, b)) high = b;
    else low = a;
  }
  return (low + high) / 2;
}

// Where h passes 0 between an angle where it is below and one where it is above.
function rootOfHeight(seen, below, above) {
  for (let i = 0; i < 52; ++i) {
    const middle = (below + above) / 2;
    if (heightAt(seen, middle) < 0) below = middle;
    else above = middle;
  }
  return below;
}

// The velocity obstacle { w + u : t w in S, 0 < t <= tau }: its legs (where each starts, and where to), its cut-off and
// S / tau + u as points, the direction into it. Null where the robot overlaps the shape: there is no cone.
function velocityObstacle(h, anchor) {
  const seen = {shape: h.shape, x: anchor[0], y: anchor[1], radius: h.radius};
  const away = separatingAngle(seen);
  if (!(heightAt(seen, away) < 0)) return null;
  const left = rootOfHeight(seen, away, away - Math.PI), right = rootOfHeight(seen, away, away + Math.PI);
  const at = (angle) => {
    support(seen, Math.cos(angle), Math.sin(angle), scratch);
    return [scratch.x / h.timeHorizon + h.ux, scratch.y / h.timeHorizon + h.uy];
  };
  const steps = 96, cutOff = [], outline = [];
  for (let i = 0; i <= steps; ++i) cutOff.push(at(left + (right - left) * i / steps));
  for (let i = 0; i < 160; ++i) outline.push(at(2 * Math.PI * i / 160));
  // Along each leg away from the apex u, at right angles to its normal.
  const legs = [[Math.sin(left), -Math.cos(left)], [-Math.sin(right), Math.cos(right)]].map((d, i) => {
    const foot = i === 0 ? cutOff[0] : cutOff[steps];
    const outwards = (foot[0] - h.ux) * d[0] + (foot[1] - h.uy) * d[1] >= 0 ? 1 : -1;
    return {foot, direction: [d[0] * outwards, d[1] * outwards]};
  });
  return {legs, cutOff, outline, inwards: [-Math.cos(away), -Math.sin(away)]};
}

// The velocity obstacle as a ring that reaches beyond a disc of radius `reach` round the origin.
function ringOf(obstacle, reach) {
  const far = (leg) => {
    const length = 4 * (reach + Math.hypot(leg.foot[0], leg.foot[1]));
    return [leg.foot[0] + length * leg.direction[0], leg.foot[1] + length * leg.direction[1]];
  };
  const a = far(obstacle.legs[0]), b = far(obstacle.legs[1]);
  // A cone that opens by nearly 180 degrees reaches far beyond the line between its legs' ends.
  const length = Math.hypot(a[0] - b[0], a[1] - b[1]) + 4 * reach;
  const beyond = (p) => [p[0] + length * obstacle.inwards[0], p[1] + length * obstacle.inwards[1]];
  return [beyond(a), a, ...obstacle.cutOff, b, beyond(b)];
}

// The part of a convex ring where n.v >= c.
function clipped(ring, nx, ny, c) {
  const result = [];
  for (let i = 0; i < ring.length; ++i) {
    const a = ring[i], b = ring[(i + 1) % ring.length];
    const da = nx * a[0] + ny * a[1] - c, db = nx * b[0] + ny * b[1] - c;
    if (da >= 0) result.push(a);
    if (da * db < 0) result.push([a[0] + (b[0] - a[0]) * da / (da - db), a[1] + (b[1] - a[1]) * da / (da - db)]);
  }
  return result;
}

function speedRing(run, robot) {
  const v = run.robots[robot].max_speed;
  if (run.about.speed_bound === 'box') return [[-v, -v], [v, -v], [v, v], [-v, v]];
  const ring = [];
  for (let i = 0; i < 180; ++i) ring.push([v * Math.cos(i * Math.PI / 90), v * Math.sin(i * Math.PI / 90)]);
  return ring;
}

function distanceToSegment(x, y, ax, ay, bx, by) {
  const dx = bx - ax, dy = by - ay, squared = dx * dx + dy * dy;
  const t = squared > 0 ? Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / squared)) : 0;
  return Math.hypot(x - ax - t * dx, y - ay - t * dy);
}

// From a point to an obstacle moved by (ox, oy), negative inside; even-odd over its rings.
function distanceToObstacle(obstacle, x, y, ox, oy) {
  let least = Infinity, inside = false;
  for (const ring of obstacle.rings) {
    const last = obstacle.solid ? ring.length : ring.length - 2;
    for (let i = 0; i < last; i += 2) {
      const j = (i + 2) % ring.length;
      const ax = ring[i] + ox, ay = ring[i + 1] + oy, bx = ring[j] + ox, by = ring[j + 1] + oy;
      const d = distanceToSegment(x, y, ax, ay, bx, by);
      if (d < least) least = d;
      if (obstacle.solid && (ay > y) !== (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax) inside = !inside;
    }
  }
  return inside ? -least : least;
}

// Whether clearances are counted at a row: of a disc that is there.
function isCounted(run, row, robot) {
  return !run.robots[robot].outline && run.isThere(robot, run.time[row]);
}

// The discs of a robot that keep clear of obstacles: how far ahead of its place each is, and its radius. One disc, or
// the chain of its footprint; [ahead, radius, ahead, radius, ...].
function obstacleDiscs(robot) {
  return hasChain(robot) ? robot.on_wheels.chain : [0, robot.obstacle_radius];
}

function hasChain(robot) {
  return Boolean(robot.on_wheels && robot.on_wheels.chain.length);
}

// From the discs of a robot at (x, y), turned by its heading (radians), to an obstacle moved by (ox, oy). Negative where
// they overlap.
function clearanceOf(robot, x, y, heading, obstacle, ox, oy) {
  const chain = obstacleDiscs(robot);
  let least = Infinity;
  for (let k = 0; k < chain.length; k += 2) {
    const ahead = chain[k], discX = x + ahead * Math.cos(heading), discY = y + ahead * Math.sin(heading);
    least = Math.min(least, distanceToObstacle(obstacle, discX, discY, ox, oy) - chain[k + 1]);
  }
  return least;
}

// Sampled at a row: from the robot's rim to the nearest obstacle, and to the nearest other robot's rim. Infinite where
// there is none.
function obstacleClearance(run, row, robot) {
  if (!isCounted(run, row, robot)) return Infinity;
  const x = run.x(row, robot), y = run.y(row, robot), body = run.robots[robot];
  const heading = hasChain(body) ? run.heading(row, robot) : 0;
  let least = Infinity;
  for (const o of run.obstacles) least = Math.min(least, clearanceOf(body, x, y, heading, o, 0, 0));
  const moved = run.columns['moving'];
  for (let k = 0; k < run.moving.length; ++k) {
    const at = 2 * (row * run.moving.length + k);
    least = Math.min(least, clearanceOf(body, x, y, heading, run.moving[k], moved[at], moved[at + 1]));
  }
  return least;
}

function robotClearance(run, row, robot) {
  const x = run.x(row, robot), y = run.y(row, robot), radius = run.robots[robot].radius;
  let least = Infinity;
  for (let j = 0; j < run.n && isCounted(run, row, robot); ++j)
    if (j !== robot && isCounted(run, row, j)) least = Math.min(least, Math.hypot(run.x(row, j) - x, run.y(row, j) - y) - radius - run.robots[j].radius);
  return least;
}

// From the rim of the robot to the shape of a half-plane; negative inside.
function distanceOf(h, anchor) {
  const seen = {shape: h.shape, x: anchor[0], y: anchor[1], radius: h.radius};
  return -heightAt(seen, separatingAngle(seen));
}

// When a robot that keeps the velocity v (relative to the shape) first touches it, s; null where it never does.
function timeToContact(h, anchor, vx, vy) {
  const seen = {shape: h.shape, x: anchor[0], y: anchor[1], radius: h.radius};
  let first = 0, last = Infinity;
  for (let i = 0; i < 720; ++i) {
    const nx = Math.cos(i * Math.PI / 360), ny = Math.sin(i * Math.PI / 360);
    const height = support(seen, nx, ny, scratch), speed = nx * vx + ny * vy;
    if (speed > 0) last = Math.min(last, height / speed);
    else if (speed < 0) first = Math.max(first, height / speed);
    else if (height < 0) return null;
  }
  return first > last ? null : first;
}

export {velocityObstacle, ringOf, clipped, speedRing, distanceToSegment, hasChain, clearanceOf, obstacleClearance,
  robotClearance, distanceOf, timeToContact};
