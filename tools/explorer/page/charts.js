// SPDX-License-Identifier: GPL-3.0-or-later
// Charts over time of the chosen robot: clearances, speed, jitter. They share the cursor of the time line.
import {label, shortNumber, tickStep} from './draw.js';
import {obstacleClearance, robotClearance} from './shapes.js';

const MOST_SAMPLES = 4000;
const MOST_WORK = 4e6;  // distances a series may cost

// Series of one robot: {rows, time, values: {obstacle, robot, speed, jitter}}, thinned where a run is long.
function seriesOf(run, robot) {
  let edges = 0;
  for (const o of [...run.obstacles, ...run.moving]) for (const ring of o.rings) edges += ring.length / 2;
  const most = Math.max(2, Math.min(MOST_SAMPLES, Math.floor(MOST_WORK / Math.max(1, edges + run.n))));
  const stride = Math.max(1, Math.ceil(run.rows / most)), count = Math.ceil(run.rows / stride);
  const series = {robot, time: new Float64Array(count), obstacle: new Float32Array(count), others: new Float32Array(count),
    speed: new Float32Array(count), jitter: new Float32Array(count), least: {obstacle: Infinity, others: Infinity}};
  for (let k = 0; k < count; ++k) {
    const row = Math.min(run.rows - 1, k * stride);
    series.time[k] = run.time[row];
    series.obstacle[k] = obstacleClearance(run, row, robot);
    series.others[k] = robotClearance(run, row, robot);
    series.speed[k] = Math.hypot(run.vx(row, robot), run.vy(row, robot));
    // Rows of a check are no steps: of one just behind a bend, the jitter says only how near it stands.
    series.jitter[k] = run.about.method === 'check' ? NaN : jitterAt(run, row, robot);
    series.least.obstacle = Math.min(series.least.obstacle, series.obstacle[k]);
    series.least.others = Math.min(series.least.others, series.others[k]);
  }
  return series;
}

// |a_{k+1} - a_k|, m/s^2: what the metrics add up.
function jitterAt(run, row, robot) {
  if (row < 1 || row + 1 >= run.rows) return 0;
  const before = run.time[row] - run.time[row - 1], after = run.time[row + 1] - run.time[row];
  const ax = (run.vx(row + 1, robot) - run.vx(row, robot)) / after - (run.vx(row, robot) - run.vx(row - 1, robot)) / before;
  const ay = (run.vy(row + 1, robot) - run.vy(row, robot)) / after - (run.vy(row, robot) - run.vy(row - 1, robot)) / before;
  return Math.hypot(ax, ay);
}

// The length of the way between rows, m.
function pathLength(run, robot) {
  let length = 0;
  for (let row = 1; row < run.rows; ++row)
    if (run.isThere(robot, run.time[row]) && run.isThere(robot, run.time[row - 1]))
      length += Math.hypot(run.x(row, robot) - run.x(row - 1, robot), run.y(row, robot) - run.y(row - 1, robot));
  return length;
}

const STRIPS = [
  {title: 'clearance [m]', lines: [['obstacle', 0, 'obstacles'], ['others', 3, 'robots']], cap: 5, unit: 'm'},
  {title: 'speed [m/s]', lines: [['speed', 2, '']], cap: Infinity},
  {title: 'jitter [m/s\u00b2]', lines: [['jitter', 1, '']], cap: Infinity},
];

const LEFT = 44, RIGHT = 10, GAP = 10;

function timeToPx(run, width, t) {
  return LEFT + (width - LEFT - RIGHT) * (run.end > run.time[0] ? (t - run.time[0]) / (run.end - run.time[0]) : 0);
}
function pxToTime(run, width, px) {
  const share = (px - LEFT) / Math.max(1, width - LEFT - RIGHT);
  return run.time[0] + Math.max(0, Math.min(1, share)) * (run.end - run.time[0]);
}

function rangeOf(series, strip) {
  let low = 0, high = 0;
  for (const [name] of strip.lines)
    for (const value of series[name]) {
      if (!Number.isFinite(value)) continue;
      low = Math.min(low, value);
      high = Math.max(high, Math.min(strip.cap, value));
    }
  return [low, high > low ? high : low + 1];
}

function drawStrip(ctx, run, series, strip, colours, width, top, height) {
  const [low, high] = rangeOf(series, strip), pad = 4;
  const y = (value) => top + height - pad - (Math.min(value, high) - low) / (high - low) * (height - 2 * pad - 12);
  const step = tickStep((height - 20) / (high - low), 15);
  ctx.font = '10px system-ui, sans-serif';
  ctx.textAlign = 'right';
  ctx.lineWidth = 1;
  for (let value = Math.ceil(low / step) * step; value <= high + 1e-12; value += step) {
    ctx.strokeStyle = Math.abs(value) < step / 2 ? colours.axis : colours.grid;
    ctx.beginPath();
    ctx.moveTo(LEFT, y(value));
    ctx.lineTo(width - RIGHT, y(value));
    ctx.stroke();
    ctx.fillStyle = colours.faint;
    ctx.fillText(shortNumber(value, step), LEFT - 5, y(value) + 3);
  }
  for (const [name, colour] of strip.lines) {
    ctx.strokeStyle = colours.series[colour];
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    let open = false;
    for (let k = 0; k < series.time.length; ++k) {
      const value = series[name][k];
      if (!Number.isFinite(value)) {
        open = false;
        continue;
      }
      const x = timeToPx(run, width, series.time[k]);
      if (open) ctx.lineTo(x, y(value));
      else ctx.moveTo(x, y(value));
      open = true;
    }
    ctx.stroke();
  }
  ctx.textAlign = 'left';
  ctx.font = '11px system-ui, sans-serif';
  const isCut = strip.lines.some(([name]) => series[name].some((value) => Number.isFinite(value) && value > high));
  const title = isCut ? `${strip.title}, cut at ${strip.cap} ${strip.unit}` : strip.title;
  label(ctx, title, LEFT + 4, top + 10, colours.text, colours.label);
  let x = LEFT + 12 + ctx.measureText(title).width;
  for (const [name, colour, words] of strip.lines) {
    if (!words || !series[name].some(Number.isFinite)) continue;
    ctx.fillStyle = colours.series[colour];
    ctx.fillRect(x, top + 3, 10, 6);
    label(ctx, words, x + 14, top + 10, colours.faint, colours.label);
    x += 26 + ctx.measureText(words).width;
  }
}

const MARKS = {note: 0, relaxed: 1, arrived: 2, plan: 3, unreachable: 4, collision: 5, hit: 6};

function collisionWords(c) {
  const depth = c.depth === null ? '' : `, ${c.depth.toPrecision(2)} m deep`;
  const isNumbered = /^(polygon|wall) [-\d]/.test(c.with);
  const other = c.kind === 'robot' ? c.with : isNumbered ? `the ${c.with} of the map` : `${c.kind} ${c.with}`;
  return `${c.standing ? 'stood and was hit by' : 'collision with'} ${other}${depth} at ${c.at.toFixed(2)} s`;
}

// Events of the run as {time, robot, kind, text}; collisions among them, and hits of robots that stood.
function eventsOf(run) {
  const ids = new Map(run.robots.map((r, i) => [r.id, i]));
  const events = run.head.events.map((e) => ({...e}));
  for (const c of run.about.collisions)
    events.push({time: c.from, robot: ids.get(c.robot), kind: c.standing ? 'hit' : 'collision', text: collisionWords(c)});
  events.sort((a, b) => a.time - b.time);
  return events;
}

function drawMarks(ctx, run, events, robot, colours, width, top, height) {
  const paints = [colours.series[0], colours.bad, colours.chosen, colours.coneRobot, colours.active, colours.bad,
    colours.active];
  for (const mine of [false, true])
    for (const e of events) {
      if ((e.robot === robot) !== mine) continue;
      const x = timeToPx(run, width, e.time);
      ctx.globalAlpha = mine ? 1 : 0.3;
      ctx.fillStyle = paints[MARKS[e.kind] || 0];
      ctx.beginPath();
      if (e.kind === 'collision' || e.kind === 'hit' || e.kind === 'relaxed') {
        ctx.moveTo(x - 4, top);
        ctx.lineTo(x + 4, top);
        ctx.lineTo(x, top + height);
      } else if (e.kind === 'plan') {
        ctx.rect(x - 3, top + height / 2 - 3, 6, 6);
      } else {
        ctx.arc(x, top + height / 2, e.kind === 'arrived' ? 4 : 3, 0, 2 * Math.PI);
      }
      ctx.fill();
    }
  ctx.globalAlpha = 1;
}

// Everything but the cursor.
function drawCharts(ctx, run, series, events, colours, width, height) {
  ctx.fillStyle = colours.ground;
  ctx.fillRect(0, 0, width, height);
  drawMarks(ctx, run, events, series.robot, colours, width, 3, 10);
  // Clearances of outlines and the jitter of a check are not measured: no axes without a line.
  const strips = STRIPS.filter((strip) => strip.lines.some(([name]) => series[name].some(Number.isFinite)));
  const top = 18, bottom = 16, each = (height - top - bottom - GAP * (strips.length - 1)) / strips.length;
  strips.forEach((strip, k) => drawStrip(ctx, run, series, strip, colours, width, top + k * (each + GAP), each));
  const span = Math.max(1e-9, run.end - run.time[0]), step = tickStep((width - LEFT - RIGHT) / span, 60);
  ctx.font = '10px system-ui, sans-serif';
  ctx.textAlign = 'center';
  ctx.fillStyle = colours.faint;
  for (let t = Math.ceil(run.time[0] / step) * step; t <= run.end + 1e-9; t += step)
    ctx.fillText(`${shortNumber(t, step)} s`, timeToPx(run, width, t), height - 3);
  ctx.textAlign = 'start';
}

function drawCursor(ctx, run, t, colours, width, height) {
  const x = timeToPx(run, width, t);
  ctx.strokeStyle = colours.active;
  ctx.lineWidth = 1.5;
  ctx.beginPath();
  ctx.moveTo(x, 0);
  ctx.lineTo(x, height - 14);
  ctx.stroke();
}

// The event whose mark is under a point; null where none is.
function pickEvent(run, events, width, px) {
  let best = null, nearest = 6;
  for (const e of events) {
    const d = Math.abs(timeToPx(run, width, e.time) - px);
    if (d < nearest) {
      nearest = d;
      best = e;
    }
  }
  return best;
}

export {seriesOf, pathLength, collisionWords, eventsOf, drawCharts, drawCursor, pickEvent, timeToPx, pxToTime};
