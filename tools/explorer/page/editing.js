// SPDX-License-Identifier: GPL-3.0-or-later
// A moment of a run as a scenario that can be changed, and the places in it that can be dragged. What follows from a
// change is computed by the server (served.js); nothing here decides anything.
import {shortName} from './draw.js';

const MOST_HANDLES = 4000;

// The time of the decision that is shown at t, or of the row where there are no decisions.
function momentOf(run, t) {
  const row = run.decisionRowAt(t);
  return row >= 0 ? run.decisionTime[row] : run.time[run.rowAt(t)];
}

// Which of its goals a robot heads for.
function goalAt(run, robot, time) {
  let goal = 0;
  for (const o of run.head.goal_bodies) if (o.robot === robot && o.time <= time + 1e-9) goal = o.goal;
  return goal;
}

class Edit {
  // `key`: of the run that the server knows, whose method is used.
  constructor(run, key, t) {
    this.key = key;
    this.from = run;
    this.time = momentOf(run, t);
    this.scenario = structuredClone(run.head.scenario);
    this.method = null;
    this.preferred = null;  // {robot, value}
    const row = run.decisionRowAt(t), at = run.rowAt(t);
    this.scenario.robots.forEach((robot, i) => {
      const d = row >= 0 ? run.decision(row, i) : {position: [run.x(at, i), run.y(at, i)], velocity: [run.vx(at, i), run.vy(at, i)]};
      robot.position = [...d.position];
      robot.velocity = [...d.velocity];
      robot.goals = (robot.goals || []).slice(goalAt(run, i, this.time));
    });
  }

  question(robot) {
    const preferred = this.preferred || {robot, value: null};
    return {run: this.key, scenario: this.scenario, time: this.time, robot, preferred: preferred.value, preferred_robot: preferred.robot,
      method: this.method};
  }

  // The horizon of the velocity obstacles, one number in place of the scenario's several.
  get horizon() {
    const h = this.scenario.horizons;
    return this.methodName() === 'orca' ? h.orca : h.most;
  }
  set horizon(seconds) {
    const h = this.scenario.horizons;
    Object.assign(h, {orca: seconds, robots: seconds, most: seconds, least: Math.min(h.least, seconds)});
  }
  methodName() {
    return this.method || this.from.about.method;
  }
}

function vertexHandle(obstacle, ring, k, what) {
  return {label: `${what} ${shortName(obstacle.id, 30)}, corner ${k + 1}`, where: 'world', at: () => ring[k],
    put: (x, y) => {
      ring[k] = [x, y];
    }};
}

function ringsOf(obstacle) {
  return obstacle.polyline ? [obstacle.polyline] : [obstacle.polygon, ...(obstacle.holes || [])];
}

// Everything of an edit that can be dragged, for the robot that is shown and its decision.
function handlesOf(edit, robot, decision) {
  const handles = [], s = edit.scenario;
  s.robots.forEach((r, i) => handles.push({label: `robot ${shortName(r.id, 30)}`, where: 'world', kind: 'robot', robot: i, at: () => r.position,
    put: (x, y) => {
      r.position = [x, y];
    }}));
  s.robots.forEach((r, i) => r.goals.forEach((goal, k) => handles.push({
    label: `goal${r.goals.length > 1 ? ` ${k + 1}` : ''} of ${shortName(r.id, 30)}`, where: 'world', kind: 'goal', robot: i, at: () => r.goals[k],
    put: (x, y) => {
      r.goals[k] = [x, y];
    }})));
  for (const o of s.obstacles || [])
    for (const ring of ringsOf(o)) for (let k = 0; k < ring.length && handles.length < MOST_HANDLES; ++k) handles.push(vertexHandle(o, ring, k, 'obstacle'));
  const one = s.robots[robot];
  handles.push({label: `velocity of ${shortName(one.id, 30)}`, where: 'space', kind: 'velocity', at: () => one.velocity,
    put: (x, y) => {
      one.velocity = [x, y];
    }});
  const preferred = () => (edit.preferred && edit.preferred.robot === robot ? edit.preferred.value : decision ? decision.preferred : [0, 0]);
  handles.push({label: `preferred velocity of ${shortName(one.id, 30)}`, where: 'space', kind: 'preferred', at: preferred,
    put: (x, y) => {
      edit.preferred = {robot, value: [x, y]};
    }});
  return handles;
}

// A whole obstacle, by a place on it.
function obstacleHandle(edit, k, x0, y0) {
  const o = edit.scenario.obstacles[k], before = ringsOf(o).map((ring) => ring.map((p) => [...p]));
  return {label: `obstacle ${shortName(o.id, 30)}`, where: 'world', at: () => [x0, y0],
    put: (x, y) => ringsOf(o).forEach((ring, r) => ring.forEach((p, i) => {
      ring[i] = [before[r][i][0] + x - x0, before[r][i][1] + y - y0];
    }))};
}

// The nearest handle to a point of the screen that is less than `reach` pixels away, robots aside; null where there is none.
function pickHandle(view, handles, where, px, py, reach) {
  let best = null, nearest = reach;
  for (const h of handles) {
    if (h.where !== where || h.kind === 'robot') continue;
    const [x, y] = h.at(), d = Math.hypot(view.px(x) - px, view.py(y) - py);
    if (d < nearest) {
      nearest = d;
      best = h;
    }
  }
  return best;
}

export {Edit, handlesOf, obstacleHandle, pickHandle};
