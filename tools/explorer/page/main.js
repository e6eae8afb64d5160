// SPDX-License-Identifier: GPL-3.0-or-later
// The page: state, controls, address, keys. Text from files reaches the page as text only (textContent).
import {DataProblem, bytesOfBase64, unpackRun} from './columns.js';
import {PALETTES, View, shortName} from './draw.js';
import {distanceToObstacle, obstacleClearance} from './shapes.js';
import {Positions, extentOf, drawWorld, pickInWorld, drawStill} from './world.js';
import {spaceOf, reachOf, drawSpace, pickInSpace} from './space.js';
import {seriesOf, pathLength, eventsOf, drawCharts, drawCursor, pickEvent, pxToTime} from './charts.js';
import {number, pair, speedWords, effectOf, effectWords, statusWords, contactWords, lineWords, modeWords, waitWords, whyWords} from './words.js';
import {checkDecision, checkHalfPlane, checkHalfOfPair, checkChoice, checkConstraint} from './proof.js';
import {download, fileName, momentSvg, animatedSvg, recordFilm} from './export.js';

const $ = (id) => document.getElementById(id);
const page = {
  list: [], elements: [], loaded: new Map(), key: '', run: null, positions: null, events: [], series: null, space: null,
  world: new View(), plane: new View(), isPlaying: false, speed: 1, follow: false, stopFilm: null, dirty: true,
  chartsDirty: true, shownDecision: '', frames: [],
};
const ui = {t: 0, robot: 0, halfPlane: null, pinned: null, colours: PALETTES.light};

function element(tag, text, className) {
  const e = document.createElement(tag);
  if (text !== undefined) e.textContent = text;
  if (className) e.className = className;
  return e;
}

function isolated(text) {
  const e = element('bdi', shortName(text, 400));
  return e;
}

// --- What went wrong ---

function report(error) {
  const known = error instanceof DataProblem;
  $('problem').textContent = known ? error.message : `The page failed: ${error && error.message}. This is a defect of the page.`;
  $('problem').hidden = false;
  if (!known) console.error(error);
}

// --- Runs of the page ---

function readList() {
  const list = document.querySelector('script.runs');
  if (!list) throw new DataProblem('This page has no runs: make one with exactvo view.');
  try {
    return JSON.parse(new TextDecoder().decode(bytesOfBase64(list.textContent)));
  } catch (error) {
    if (error instanceof DataProblem) throw error;
    throw new DataProblem('The list of runs of this page is damaged or cut short.');
  }
}

async function openRun(key) {
  const k = page.list.findIndex((r) => r.key === key);
  if (k < 0) throw new DataProblem(`This page has no run '${shortName(key, 80)}'.`);
  if (!page.elements[k]) throw new DataProblem('The data of this page is cut short: a run is missing.');
  if (!page.loaded.has(key)) page.loaded.set(key, await unpackRun(page.elements[k].textContent));
  $('problem').hidden = true;
  page.key = key;
  page.run = page.loaded.get(key);
  page.positions = new Positions(page.run);
  page.events = eventsOf(page.run);
  page.series = page.space = null;
  page.shownDecision = '';
  Object.assign(ui, {t: page.run.time[0], robot: 0, halfPlane: null, pinned: null});
  $('main').hidden = false;
  fillRun();
  resize();
  fitWorld();
  fitSpace();
}

function fillRun() {
  const run = page.run, about = run.about;
  $('name').textContent = shortName(about.name, 200);
  document.title = `${shortName(about.name, 80)} \u2013 ExactVO explorer`;
  const words = [about.method, about.controller, about.guidance && `guidance ${about.guidance}`,
    about.liveness && `liveness ${about.liveness}`, `${run.n} robot${run.n > 1 ? 's' : ''}`, `${number(run.end)} s`,
    about.description].filter(Boolean);
  $('about').textContent = shortName(words.join(' \u00b7 '), 300);
  $('run').value = page.key;
  for (const button of $('guide').querySelectorAll('button')) button.setAttribute('aria-pressed', String(button.dataset.key === page.key));
  $('guide').querySelector('p').textContent = page.list.find((r) => r.key === page.key).description;
  $('robot').replaceChildren(...run.robots.map((r, i) => {
    const option = element('option', shortName(r.id, 40));
    option.value = String(i);
    return option;
  }));
  $('scrub').min = String(run.time[0]);
  $('scrub').max = String(run.end);
  $('outcome').textContent = about.outcome;
  $('warnings').replaceChildren(...[...about.warnings, ...about.stuck.map((s) => s.text)].map((w) => element('li', shortName(w, 1000))));
  const partial = [];
  if (!about.all_half_planes)
    partial.push('The recording has only the half-planes that bind and those against what could be met within a time step: simulate --record-all keeps the others too.');
  if (run.head.decisions.every > 1) partial.push(`One row in ${run.head.decisions.every} has its decisions in this page.`);
  if (run.head.rows.every > 1) partial.push(`One row in ${run.head.rows.every} is in this page.`);
  $('partial').textContent = partial.join(' ');
  $('origin').textContent = `ExactVO ${about.version}, ${about.commit}`;
  $('checked').textContent = '';
  fillMetrics();
}

const METRICS = [
  ['last_arrival_time', 'last arrival', 's'], ['min_obstacle_clearance', 'least clearance to obstacles', 'm'],
  ['min_robot_clearance', 'least clearance between robots', 'm'], ['formation_position_error', 'formation position error', 'm'],
  ['formation_velocity_error', 'formation velocity error', 'm/s'], ['jitter', 'jitter', 'm/s\u00b2'],
  ['velocity_variation', 'velocity variation', 'm/s'], ['peak_acceleration', 'peak acceleration', 'm/s\u00b2'],
  ['heading_reversals', 'heading reversals', ''], ['relaxed_steps', 'relaxed decisions', ''],
  ['uncertified_half_planes', 'half-planes not certified', ''], ['steps', 'steps', ''],
];

function metricRow(name, text, key) {
  const row = element('tr'), value = element('td', text);
  if (key) value.dataset.metric = key;
  row.append(element('td', name), value);
  return row;
}

function fillMetrics() {
  const metrics = page.run.head.metrics, rows = [];
  for (const [key, name, unit] of metrics ? METRICS : []) {
    const value = metrics[key];
    if (value === null || value === undefined) continue;
    rows.push(metricRow(name, `${Number(value.toPrecision(5))}${unit ? ` ${unit}` : ''}`, key));
  }
  $('metrics').replaceChildren(...rows);
}

// Of the chosen robot: counted by the page from what it holds.
function fillRobotMetrics() {
  for (const old of [...$('metrics').querySelectorAll('tr.robot')]) old.remove();
  const run = page.run, i = ui.robot, metrics = run.head.metrics;
  const add = (name, text, key) => {
    const row = metricRow(name, text, key);
    row.className = 'robot';
    $('metrics').append(row);
  };
  const id = shortName(run.robots[i].id, 24), least = page.series.least;
  add(`${id}: path length`, `${number(pathLength(run, i), 3)} m`, 'page.path_length');
  if (Number.isFinite(least.obstacle)) add(`${id}: least clearance to obstacles, at rows`, `${number(least.obstacle, 3)} m`, 'page.obstacle_clearance');
  if (Number.isFinite(least.others)) add(`${id}: least clearance to robots, at rows`, `${number(least.others, 3)} m`, 'page.robot_clearance');
  const robot = metrics && metrics.robots ? metrics.robots[i] : null;
  if (robot && robot.arrival_time !== null && robot.arrival_time !== undefined) add(`${id}: arrived at`, `${number(robot.arrival_time)} s`, 'robot.arrival_time');
}

// --- Views ---

function sizeOf(canvas, view) {
  const box = canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
  const width = Math.max(50, Math.round(box.width)), height = Math.max(50, Math.round(box.height));
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  if (view) {
    view.scale *= Math.min(width / view.width, height / view.height);
    view.width = width;
    view.height = height;
  }
  return {width, height, ratio};
}

function resize() {
  if (!page.run) return;
  sizeOf($('world'), page.world);
  sizeOf($('space'), page.plane);
  sizeOf($('charts'), null);
  page.chartsDirty = page.dirty = true;
}

function fitWorld() {
  const {low, high} = extentOf(page.run);
  page.world.fit(low, high, 34);
  page.dirty = true;
}

function fitSpace() {
  const d = currentDecision();
  const reach = d ? reachOf(page.run, d) : page.run.robots[ui.robot].max_speed * 1.3;
  page.plane.fit([-reach, -reach], [reach, reach], 8);
  page.dirty = true;
}

function currentDecision() {
  const row = page.run.decisionRowAt(ui.t);
  if (row < 0) return null;
  const space = page.space;
  if (space && space.decision.row === row && space.decision.robot === ui.robot) return space.decision;
  page.space = spaceOf(page.run, page.run.decision(row, ui.robot));
  return page.space.decision;
}

function contextOf(canvas) {
  const ratio = window.devicePixelRatio || 1, ctx = canvas.getContext('2d');
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  return ctx;
}

function paint() {
  const run = page.run, decision = currentDecision();
  page.positions.at(ui.t);
  if (page.follow) {
    page.world.cx = page.positions.x[ui.robot];
    page.world.cy = page.positions.y[ui.robot];
  }
  drawWorld(contextOf($('world')), page.world, run, page.positions, ui, decision);
  drawSpace(contextOf($('space')), page.plane, page.space, ui);
  paintCharts();
}

// What does not change with time is kept as a picture of its own.
const chartPicture = document.createElement('canvas');
function paintCharts() {
  const canvas = $('charts'), width = canvas.width, height = canvas.height, ratio = window.devicePixelRatio || 1;
  if (!page.series || page.series.robot !== ui.robot) {
    page.series = seriesOf(page.run, ui.robot);
    fillRobotMetrics();
    page.chartsDirty = true;
  }
  if (page.chartsDirty) {
    chartPicture.width = width;
    chartPicture.height = height;
    const ctx = chartPicture.getContext('2d');
    ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
    drawCharts(ctx, page.run, page.series, page.events, ui.colours, width / ratio, height / ratio);
    page.chartsDirty = false;
  }
  const ctx = canvas.getContext('2d');
  ctx.setTransform(1, 0, 0, 1, 0, 0);
  ctx.drawImage(chartPicture, 0, 0);
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawCursor(ctx, page.run, ui.t, ui.colours, width / ratio, height / ratio);
}

// --- Words beside the picture ---

function fact(list, name, value, key) {
  const dd = element('dd', value);
  if (key) dd.dataset.fact = key;
  list.push(element('dt', name), dd);
}

function verdictOf(result) {
  if (result.ok === null) return ['not claimed', 'open'];
  return result.ok ? ['\u2713 proven', 'good'] : ['\u2717 refuted', 'bad'];
}

function showVerdict(target, result) {
  const [text, className] = verdictOf(result);
  target.textContent = text;
  target.title = result.ok ? 'Checked in this page in exact arithmetic' : result.why;
  target.classList.remove('good', 'bad', 'open');
  target.classList.add(className);
}

function fillWords() {
  const run = page.run, d = currentDecision();
  $('time').textContent = `${number(ui.t)} s`;
  if (document.activeElement !== $('scrub') || page.isPlaying) $('scrub').value = String(ui.t);
  const key = d ? `${d.row} ${d.robot}` : `none ${ui.robot}`;
  if (page.shownDecision === key) return;
  // While a run plays, words follow ten times a second.
  const now = performance.now();
  if (page.isPlaying && now - (page.wordsAt || 0) < 100) return;
  page.wordsAt = now;
  page.shownDecision = key;
  $('robot').value = String(ui.robot);
  $('space-robot').textContent = shortName(run.robots[ui.robot].id, 40);
  $('space-time').textContent = d ? `at ${number(d.time)} s` : 'not in this page';
  if (!d) {
    for (const id of ['facts', 'half-planes', 'why', 'verdict', 'count']) $(id).replaceChildren();
    return;
  }
  const row = run.rowAt(d.time), facts = [], mode = run.mode(row, ui.robot);
  const shift = Math.hypot(d.chosen[0] - d.preferred[0], d.chosen[1] - d.preferred[1]);
  fact(facts, 'robot', shortName(run.robots[ui.robot].id, 400));
  fact(facts, 'time', `${number(d.time)} s`, 'time');
  fact(facts, 'position', `${pair(d.position)} m`, 'position');
  fact(facts, 'moving at', speedWords(d.velocity), 'velocity');
  fact(facts, 'mode', modeWords(run, row, ui.robot), 'mode');
  fact(facts, 'preferred', speedWords(d.preferred), 'preferred');
  fact(facts, 'chosen', speedWords(d.chosen), 'chosen');
  fact(facts, 'difference', shift < 0.005 ? 'the preferred one itself' : `${number(shift)} m/s from the preferred one`);
  fact(facts, 'status', statusWords(d), 'status');
  const waits = waitWords(run, d.row, ui.robot);
  if (waits) fact(facts, 'waiting', waits, 'waiting');
  $('facts').replaceChildren(...facts);
  $('why').textContent = whyWords(run, d, mode).join('\n');
  const result = checkChoice(run, d);
  showVerdict($('verdict'), result);
  if (result.ok === false) $('why').textContent += `\nRefuted: ${result.why}.`;
  fillHalfPlanes(d);
}

const MOST_CARDS = 60;

function fillHalfPlanes(d) {
  const run = page.run, counts = {slack: 0, binding: 0, violated: 0};
  for (const h of d.halfPlanes) ++counts[effectOf(d, h)];
  $('count').textContent = `${d.halfPlanes.length}: ${counts.binding} binding${counts.violated ? `, ${counts.violated} violated` : ''}`;
  const order = d.halfPlanes.map((h, k) => k).sort((a, b) => d.halfPlanes[b].active - d.halfPlanes[a].active || a - b);
  const cards = order.slice(0, MOST_CARDS).map((k) => {
    const h = d.halfPlanes[k], card = element('li', undefined, effectOf(d, h)), head = element('div', undefined, 'head');
    const mark = element('span', '', 'mark');
    const result = checkConstraint(run, d, h);
    showVerdict(mark, result);
    const name = element('span');
    name.append(`[${k + 1}] `, isolated(run.nameOf(h)));
    head.append(name, mark);
    card.append(head, element('div', `${effectWords(d, h)}: ${contactWords(d, h)}`),
      element('div', `${lineWords(h)}${h.multiplier > 0 ? `; multiplier ${number(h.multiplier, 4)} m/s` : ''}`, 'more'));
    if (result.ok === false) card.append(element('div', `Refuted: ${result.why}.`, 'bad'));
    card.dataset.halfPlane = String(k);
    card.tabIndex = 0;
    return card;
  });
  if (order.length > MOST_CARDS) cards.push(element('li', `and ${order.length - MOST_CARDS} more`));
  $('half-planes').replaceChildren(...cards);
  if (ui.pinned !== null && ui.pinned >= d.halfPlanes.length) ui.pinned = null;
  ui.halfPlane = ui.pinned;
  markCards();
}

function markCards() {
  for (const card of $('half-planes').children) card.classList.toggle('chosen', card.dataset.halfPlane === String(ui.halfPlane));
}

function chooseHalfPlane(k, isPinned) {
  if (isPinned) ui.pinned = k;
  ui.halfPlane = k === null ? ui.pinned : k;
  markCards();
  page.dirty = true;
}

// --- Every proof of the run ---

async function checkAll() {
  const run = page.run, counts = {choices: [0, 0, 0], halfPlanes: [0, 0, 0]};
  let first = null, since = performance.now();
  const count = (tally, result, d, k) => {
    ++tally[result.ok === null ? 2 : result.ok ? 0 : 1];
    if (result.ok === false && !first) first = {time: d.time, robot: d.robot, halfPlane: k};
  };
  $('check').disabled = true;
  for (let row = 0; row < run.decisionTime.length; ++row) {
    for (let robot = 0; robot < run.n; ++robot) {
      const d = run.decision(row, robot);
      count(counts.choices, checkChoice(run, d), d, null);
      d.halfPlanes.forEach((h, k) => count(counts.halfPlanes, checkConstraint(run, d, h), d, k));
    }
    if (performance.now() - since > 60) {
      $('checked').textContent = `${Math.round(100 * row / run.decisionTime.length)} %`;
      await new Promise((resume) => setTimeout(resume));
      since = performance.now();
      if (page.run !== run) break;
    }
  }
  $('check').disabled = false;
  if (page.run !== run) return counts;
  const words = ([proven, refuted, open], what) => `${proven} ${what} proven, ${refuted} refuted${open ? `, ${open} not claimed` : ''}`;
  $('checked').textContent = `${words(counts.choices, 'choices')}; ${words(counts.halfPlanes, 'half-planes')}.`;
  $('checked').className = first ? 'bad' : 'good';
  if (first) {
    ui.robot = first.robot;
    seek(first.time);
  }
  return counts;
}

// --- State and address ---

function seek(t) {
  ui.t = Math.max(page.run.time[0], Math.min(page.run.end, t));
  page.dirty = true;
}

function chooseRobot(i) {
  ui.robot = (i + page.run.n) % page.run.n;
  ui.pinned = ui.halfPlane = null;
  page.shownDecision = '';
  page.chartsDirty = page.dirty = true;
  fitSpace();
  writeAddress();
}

// A robot by its id, or by its number where that is long.
function robotWord() {
  const id = page.run.robots[ui.robot].id;
  return id.length <= 60 && id.isWellFormed?.() !== false ? id : String(ui.robot);
}

let addressTimer = 0;
function writeAddress() {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => {
    const words = [];
    if (page.list.length > 1) words.push(`run=${encodeURIComponent(page.key)}`);
    words.push(`t=${Number(ui.t.toFixed(4))}`, `robot=${encodeURIComponent(robotWord())}`);
    try {
      history.replaceState(null, '', `#${words.join('&')}`);
    } catch (error) {
      // Some browsers refuse this for files; the page works without.
    }
  }, 150);
}

function addressWords() {
  const words = new Map();
  for (const part of location.hash.slice(1).split('&')) {
    const at = part.indexOf('=');
    if (at < 0) continue;
    try {
      words.set(part.slice(0, at), decodeURIComponent(part.slice(at + 1)));
    } catch (error) {
      // A part that is no text says nothing.
    }
  }
  return words;
}

async function readAddress() {
  const words = addressWords(), key = words.get('run');
  if (key !== undefined && key !== page.key && page.list.some((r) => r.key === key)) await openRun(key);
  const robot = words.get('robot');
  if (robot !== undefined) {
    const i = page.run.robots.findIndex((r) => r.id === robot);
    const k = i >= 0 ? i : Number(robot);
    if (Number.isInteger(k) && k >= 0 && k < page.run.n) chooseRobot(k);
  }
  const t = Number(words.get('t'));
  if (words.has('t') && Number.isFinite(t)) seek(t);
  page.dirty = true;
}

// --- Playing ---

let lastFrame = 0;
function onFrame(now) {
  if (page.isPlaying && !page.stopFilm) {
    seek(ui.t + Math.min(0.25, (now - lastFrame) / 1000) * page.speed);
    if (ui.t >= page.run.end) setPlaying(false);
  }
  lastFrame = now;
  if (page.dirty && page.run) {
    page.dirty = false;
    const begin = performance.now();
    try {
      paint();
      fillWords();
    } catch (error) {
      report(error);
    }
    page.frames.push(performance.now() - begin);
    if (page.frames.length > 600) page.frames.shift();
  }
  requestAnimationFrame(onFrame);
}

function setPlaying(on) {
  if (on && ui.t >= page.run.end) seek(page.run.time[0]);
  page.isPlaying = on;
  page.shownDecision = '';
  page.dirty = true;
  $('play').textContent = on ? 'Pause' : 'Play';
  if (!on) writeAddress();
}

function stepBy(direction) {
  setPlaying(false);
  const run = page.run, row = run.decisionRowAt(ui.t);
  if (row < 0) {
    seek(run.time[Math.max(0, Math.min(run.rows - 1, run.rowAt(ui.t) + direction))]);
  } else {
    const isBetween = direction < 0 && ui.t > run.decisionTime[row] + 1e-9;
    seek(run.decisionTime[Math.max(0, Math.min(run.decisionTime.length - 1, row + (isBetween ? 0 : direction)))]);
  }
  writeAddress();
}

function toEvent(direction) {
  const mine = page.events.filter((e) => e.robot === ui.robot || e.kind === 'collision');
  const next = direction > 0 ? mine.find((e) => e.time > ui.t + 1e-9) : mine.filter((e) => e.time < ui.t - 1e-9).pop();
  if (!next) return;
  setPlaying(false);
  seek(next.time);
  showEvent(next);
  writeAddress();
}

function showEvent(e) {
  $('event').textContent = e ? `${number(e.time)} s, ${shortName(page.run.robots[e.robot]?.id ?? '', 40)}: ${shortName(e.text, 300)}` : '';
}

// --- Pointer ---

function onView(canvas, view, {onClick, onHover, isPannable}) {
  const pointers = new Map();
  let moved = 0, spread = 0;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spreadNow = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at(event));
    if (pointers.size === 2) spread = spreadNow();
    moved = 0;
  });
  canvas.addEventListener('pointermove', (event) => {
    const [x, y] = at(event), before = pointers.get(event.pointerId);
    if (!before) {
      onHover(x, y, event);
      return;
    }
    moved += Math.abs(x - before[0]) + Math.abs(y - before[1]);
    pointers.set(event.pointerId, [x, y]);
    if (!isPannable) return;
    if (pointers.size === 2) {
      const now = spreadNow(), [a, b] = [...pointers.values()];
      view.zoomAt((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, now / Math.max(1, spread));
      spread = now;
    } else if (moved > 4) {
      if (view === page.world) setFollow(false);
      view.cx -= (x - before[0]) / view.scale;
      view.cy += (y - before[1]) / view.scale;
    }
    page.dirty = true;
  });
  const up = (event) => {
    if (pointers.delete(event.pointerId) && moved <= 4 && event.type === 'pointerup') onClick(...at(event), event);
  };
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('pointerleave', () => {
    showTip(null);
    onHover(-1e6, -1e6, null);
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    view.zoomAt(...at(event), Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 20 : 1)));
    page.dirty = true;
  }, {passive: false});
}

function showTip(text, event) {
  $('tip').hidden = !text || !event;
  if (!text || !event) return;
  $('tip').textContent = text;
  $('tip').style.left = `${Math.min(event.clientX + 14, innerWidth - 330)}px`;
  $('tip').style.top = `${Math.min(event.clientY + 14, innerHeight - 90)}px`;
}

function worldTip(found) {
  const run = page.run;
  if (!found) return '';
  if (found.obstacle !== undefined) {
    const x = page.positions.x[ui.robot], y = page.positions.y[ui.robot];
    return `obstacle ${shortName(run.obstacles[found.obstacle].id, 120)}\n` +
      `${number(distanceToObstacle(run.obstacles[found.obstacle], x, y, 0, 0) - run.robots[ui.robot].radius)} m from the rim of ` +
      shortName(run.robots[ui.robot].id, 40);
  }
  if (found.moving !== undefined) return `moving obstacle ${shortName(run.moving[found.moving].id, 120)}`;
  const i = found.robot, row = page.positions.row, vx = run.vx(row, i), vy = run.vy(row, i);
  return `robot ${shortName(run.robots[i].id, 120)}\nat (${number(page.positions.x[i])}, ${number(page.positions.y[i])}) m, ` +
    `radius ${run.robots[i].radius} m\nspeed ${number(Math.hypot(vx, vy))} of ${run.robots[i].max_speed} m/s\n${modeWords(run, row, i)}`;
}

function connectPointer() {
  onView($('world'), page.world, {
    isPannable: true,
    onClick: (x, y) => {
      const found = pickInWorld(page.world, page.run, page.positions, x, y);
      if (found && found.robot !== undefined) chooseRobot(found.robot);
    },
    onHover: (x, y, event) => showTip(event && worldTip(pickInWorld(page.world, page.run, page.positions, x, y)), event),
  });
  onView($('space'), page.plane, {
    isPannable: true,
    onClick: (x, y) => chooseHalfPlane(pickInSpace(page.plane, page.space, x, y), true),
    onHover: (x, y, event) => {
      const k = event ? pickInSpace(page.plane, page.space, x, y) : null;
      if (ui.halfPlane !== (k === null ? ui.pinned : k)) chooseHalfPlane(k, false);
      const d = page.space && page.space.decision;
      if (k === null || !event) {
        showTip(event && d ? `(${number(page.plane.x(x))}, ${number(page.plane.y(y))}) m/s` : '', event);
      } else {
        const h = d.halfPlanes[k];
        showTip(`[${k + 1}] ${shortName(page.run.nameOf(h), 120)}, ${effectWords(d, h)}\n${contactWords(d, h)}\n${lineWords(h)}` +
          (h.multiplier > 0 ? `\nmultiplier ${number(h.multiplier, 4)} m/s` : ''), event);
      }
    },
  });
  const charts = $('charts');
  const seekTo = (event) => {
    const box = charts.getBoundingClientRect(), x = event.clientX - box.left;
    const found = event.clientY - box.top < 18 ? pickEvent(page.run, page.events, box.width, x) : null;
    seek(found ? found.time : pxToTime(page.run, box.width, x));
    showEvent(found);
    writeAddress();
  };
  charts.addEventListener('pointerdown', (event) => {
    setPlaying(false);
    charts.setPointerCapture(event.pointerId);
    seekTo(event);
  });
  charts.addEventListener('pointermove', (event) => {
    if (event.buttons) {
      seekTo(event);
      return;
    }
    const box = charts.getBoundingClientRect();
    const found = event.clientY - box.top < 18 ? pickEvent(page.run, page.events, box.width, event.clientX - box.left) : null;
    showTip(found ? `${number(found.time)} s, ${shortName(page.run.robots[found.robot]?.id ?? '', 40)}\n${shortName(found.text, 300)}` : '', event);
  });
  charts.addEventListener('pointerleave', () => showTip(null));
  const card = (event) => event.target.closest('li[data-half-plane]');
  $('half-planes').addEventListener('click', (event) => {
    const li = card(event);
    if (li) chooseHalfPlane(Number(li.dataset.halfPlane) === ui.pinned ? null : Number(li.dataset.halfPlane), true);
  });
  $('half-planes').addEventListener('pointerover', (event) => {
    const li = card(event);
    if (li) chooseHalfPlane(Number(li.dataset.halfPlane), false);
  });
  $('half-planes').addEventListener('pointerleave', () => chooseHalfPlane(null, false));
}

// --- Buttons and keys ---

function setFollow(on) {
  page.follow = on;
  $('follow').setAttribute('aria-pressed', String(on));
  page.dirty = true;
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  ui.colours = PALETTES[theme];
  page.chartsDirty = page.dirty = true;
}

function title() {
  const run = page.run;
  return `${run.about.name}, ${run.about.method}: ${run.robots[ui.robot].id} at ${number(ui.t)} s`;
}

function paintInto(ctx, which) {
  if (which === 'world') drawWorld(ctx, page.world, page.run, page.positions, ui, currentDecision());
  else drawSpace(ctx, page.plane, page.space, ui);
}

function svgOfMoment() {
  page.positions.at(ui.t);
  return momentSvg(title(), {world: page.world, space: page.plane}, paintInto, ui.colours);
}

function saveMoment() {
  download(fileName(page.run, `-${number(ui.t)}s.svg`), new Blob([svgOfMoment()], {type: 'image/svg+xml'}));
}

function svgOfRun() {
  return animatedSvg(page.run, page.world, ui.colours, (ctx) => drawStill(ctx, page.world, page.run, ui));
}

function saveAnimation() {
  download(fileName(page.run, '.svg'), new Blob([svgOfRun()], {type: 'image/svg+xml'}));
}

function film() {
  if (page.stopFilm) {
    page.stopFilm();
    return;
  }
  setPlaying(false);
  const canvas = document.createElement('canvas'), gap = 10;
  canvas.width = 2 * Math.round((page.world.width + gap + page.plane.width) / 2);
  canvas.height = 2 * Math.round(Math.max(page.world.height, page.plane.height) / 2);
  const ctx = canvas.getContext('2d');
  const frame = (t) => {
    seek(t);
    page.positions.at(t);
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.fillStyle = ui.colours.ground;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    paintInto(ctx, 'world');
    ctx.setTransform(1, 0, 0, 1, page.world.width + gap, 0);
    paintInto(ctx, 'space');
  };
  $('film').textContent = 'Stop';
  const from = ui.t >= page.run.end ? page.run.time[0] : ui.t;
  page.stopFilm = recordFilm(canvas, from, page.run.end, page.speed, frame, (blob, why) => {
    page.stopFilm = null;
    $('film').textContent = 'Film';
    page.film = blob;
    if (blob) download(fileName(page.run, '.webm'), blob);
    else report(new DataProblem(why));
  });
}

function changeSpeed(direction) {
  const options = $('speed').options, k = Math.max(0, Math.min(options.length - 1, $('speed').selectedIndex + direction));
  $('speed').selectedIndex = k;
  page.speed = Number(options[k].value);
}

function nextHalfPlane(direction) {
  const d = page.space && page.space.decision;
  if (!d || !d.halfPlanes.length) return;
  const n = d.halfPlanes.length, k = ui.pinned === null ? (direction > 0 ? 0 : n - 1) : (ui.pinned + direction + n) % n;
  chooseHalfPlane(k, true);
}

const KEYS = {
  ' ': () => setPlaying(!page.isPlaying), k: () => setPlaying(!page.isPlaying),
  Home: () => seek(page.run.time[0]), End: () => seek(page.run.end),
  n: () => toEvent(1), p: () => toEvent(-1), '[': () => chooseRobot(ui.robot - 1), ']': () => chooseRobot(ui.robot + 1),
  ArrowUp: () => nextHalfPlane(-1), ArrowDown: () => nextHalfPlane(1), Escape: () => chooseHalfPlane(null, true),
  f: () => setFollow(!page.follow), 0: () => fitAll(), '-': () => changeSpeed(-1), '+': () => changeSpeed(1), '=': () => changeSpeed(1),
  s: saveMoment, a: saveAnimation, r: film, v: checkAll,
  t: () => setTheme(ui.colours === PALETTES.light ? 'dark' : 'light'), '?': () => $('keys').showModal(),
};

function fitAll() {
  setFollow(false);
  fitWorld();
  fitSpace();
}

function onKey(event) {
  if (!page.run || event.ctrlKey || event.metaKey || event.altKey || $('keys').open) return;
  const tag = event.target.tagName;
  if (tag === 'SELECT' || (tag === 'INPUT' && event.key.startsWith('Arrow'))) return;
  if ((tag === 'BUTTON' || tag === 'LI') && (event.key === ' ' || event.key === 'Enter')) {
    if (tag === 'LI') event.target.click();
    return;
  }
  if (event.key === 'ArrowLeft' || event.key === 'ArrowRight') {
    const direction = event.key === 'ArrowLeft' ? -1 : 1;
    if (event.shiftKey) seek(ui.t + direction);
    else stepBy(direction);
    event.preventDefault();
    return;
  }
  const action = KEYS[event.key] || KEYS[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action();
}

function connectControls() {
  const on = (id, action) => $(id).addEventListener('click', action);
  on('play', () => setPlaying(!page.isPlaying));
  on('back', () => stepBy(-1));
  on('step', () => stepBy(1));
  on('previous-event', () => toEvent(-1));
  on('next-event', () => toEvent(1));
  on('follow', () => setFollow(!page.follow));
  on('fit', () => {
    setFollow(false);
    fitWorld();
  });
  on('space-fit', fitSpace);
  on('save', saveMoment);
  on('animate', saveAnimation);
  on('film', film);
  on('theme', KEYS.t);
  on('help', KEYS['?']);
  on('check', () => checkAll().catch(report));
  $('speed').addEventListener('change', () => changeSpeed(0));
  $('scrub').addEventListener('input', () => {
    setPlaying(false);
    seek(Number($('scrub').value));
  });
  $('scrub').addEventListener('change', writeAddress);
  $('robot').addEventListener('change', () => chooseRobot(Number($('robot').value)));
  $('run').addEventListener('change', () => openRun($('run').value).then(writeAddress).catch(report));
  addEventListener('keydown', onKey);
  addEventListener('resize', resize);
  addEventListener('hashchange', () => readAddress().catch(report));
}

function fillList(isGuide) {
  $('run').hidden = isGuide || page.list.length < 2;
  $('run').replaceChildren(...page.list.map((r) => {
    const option = element('option', shortName(r.title, 80));
    option.value = r.key;
    return option;
  }));
  $('guide').hidden = !isGuide;
  for (const r of isGuide ? page.list : []) {
    const button = element('button');
    button.dataset.key = r.key;
    button.textContent = r.title;
    button.addEventListener('click', () => openRun(r.key).then(writeAddress).catch(report));
    $('guide').append(button);
  }
  $('guide').append(element('p'));
}

async function start() {
  const prefersDark = typeof matchMedia === 'function' && matchMedia('(prefers-color-scheme: dark)').matches;
  setTheme(addressWords().get('theme') === 'dark' || (prefersDark && addressWords().get('theme') !== 'light') ? 'dark' : 'light');
  const about = readList();
  page.list = about.runs;
  page.elements = [...document.querySelectorAll('script.run')];
  if (!page.list.length) throw new DataProblem('This page has no runs: make one with exactvo view.');
  fillList(about.guide);
  connectControls();
  connectPointer();
  await openRun(page.list.some((r) => r.key === addressWords().get('run')) ? addressWords().get('run') : page.list[0].key);
  await readAddress();
  requestAnimationFrame(onFrame);
}

// For the console and for tests.
window.exactvo = {page, ui, obstacleClearance, seek, chooseRobot, openRun, checkAll, checkDecision, checkHalfPlane, checkHalfOfPair, svgOfMoment, svgOfRun};
window.exactvo.ready = start().catch(report);
