// SPDX-License-Identifier: GPL-3.0-or-later
// The page: state, controls, address, keys. Text from files reaches the page as text only (textContent).
import {DataProblem, bytesOfBase64, unpackRun, unpackBytes} from './columns.js';
import {PALETTES, View, shortName} from './draw.js';
import {distanceToObstacle, obstacleClearance} from './shapes.js';
import {Positions, extentOf, unreachableOf, drawWorld, drawHandles, pickInWorld, drawStill} from './world.js';
import {worldLegend, spaceLegend} from './legend.js';
import {Edit, handlesOf, obstacleHandle, pickHandle} from './editing.js';
import {spaceOf, reachOf, drawSpace, pickInSpace} from './space.js';
import {seriesOf, pathLength, eventsOf, drawCharts, drawCursor, pickEvent, pxToTime} from './charts.js';
import {number, pair, speedWords, effectOf, effectWords, statusWords, contactWords, lineWords, modeWords, waitWords, whyWords} from './words.js';
import {planWords} from './plans.js';
import {checkDecision, checkHalfPlane, checkHalfOfPair, checkChoice, checkConstraint} from './proof.js';
import {download, fileName, momentSvg, animatedSvg, recordFilm} from './export.js';

const $ = (id) => document.getElementById(id);
const page = {
  list: [], elements: [], loaded: new Map(), key: '', run: null, positions: null, events: [], series: null, space: null,
  world: new View(), plane: new View(), isPlaying: false, speed: 1, follow: false, stopFilm: null, dirty: true,
  chartsDirty: true, shownDecision: '', frames: [],
  live: null,  // in place of the run's moment: {run, positions}, the answer to a change
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

// What the reader should know, and the page goes on.
function notice(text) {
  $('notice').hidden = !text;
  $('notice').firstElementChild.textContent = text;
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
  if (!page.loaded.has(key)) {
    if (!page.elements[k]) throw new DataProblem('The data of this page is cut short: a run is missing.');
    page.loaded.set(key, await unpackRun(page.elements[k].textContent));
  }
  $('problem').hidden = true;
  endEdit();
  page.key = key;
  page.run = page.loaded.get(key);
  page.run.unreachable = unreachableOf(page.run);
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
  showLive();
}

// The run, positions and time that are shown: the run's own, or those of a change.
function shownRun() {
  return page.live ? page.live.run : page.run;
}
function shownTime() {
  return page.live ? page.live.run.time[0] : ui.t;
}
function shownPositions() {
  return page.live ? page.live.positions : page.positions;
}
function shownUi() {
  return page.live ? {...ui, t: shownTime()} : ui;
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
  const hasDecisions = run.decisionTime.length > 0;
  for (const e of document.querySelectorAll('.of-decisions')) e.hidden = !hasDecisions;
  if (hasDecisions && !about.all_half_planes)
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
  const reach = d ? reachOf(shownRun(), d) : page.run.robots[ui.robot].max_speed * 1.3;
  page.plane.fit([-reach, -reach], [reach, reach], 8);
  page.dirty = true;
}

function currentDecision() {
  const run = shownRun(), row = run.decisionRowAt(shownTime());
  if (row < 0) {
    page.space = null;
    return null;
  }
  const space = page.space;
  if (space && space.run === run && space.decision.row === row && space.decision.robot === ui.robot) return space.decision;
  page.space = spaceOf(run, run.decision(row, ui.robot));
  return page.space.decision;
}

function contextOf(canvas) {
  const ratio = window.devicePixelRatio || 1, ctx = canvas.getContext('2d');
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  return ctx;
}

function paint() {
  const decision = currentDecision(), positions = shownPositions().at(shownTime());
  if (page.follow) {
    page.world.cx = positions.x[ui.robot];
    page.world.cy = positions.y[ui.robot];
  }
  const ctx = contextOf($('world'));
  drawWorld(ctx, page.world, shownRun(), positions, shownUi(), decision);
  if (canEdit()) drawHandles(ctx, page.world, ui.colours, shownRun());
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
  const run = shownRun(), d = currentDecision();
  $('time').textContent = `${number(ui.t)} s`;
  if (document.activeElement !== $('scrub') || page.isPlaying) $('scrub').value = String(ui.t);
  const key = d ? `${d.row} ${d.robot}` : `none ${ui.robot} ${shownPositions().row}`;
  if (page.shownDecision === key) return;
  // While a run plays, words follow ten times a second.
  const now = performance.now();
  if (page.isPlaying && now - (page.wordsAt || 0) < 100) return;
  page.wordsAt = now;
  page.shownDecision = key;
  $('robot').value = String(ui.robot);
  $('space-robot').textContent = shortName(run.robots[ui.robot].id, 40);
  $('space-time').textContent = !d ? 'no decision here' : page.live ? `at ${number(live.edit ? live.edit.time : d.time)} s, changed` : `at ${number(d.time)} s`;
  if (!d) {
    fillStateOnly(run);
    return;
  }
  const row = run.rowAt(d.time), facts = [], mode = run.mode(row, ui.robot);
  const shift = Math.hypot(d.chosen[0] - d.preferred[0], d.chosen[1] - d.preferred[1]);
  fact(facts, 'robot', shortName(run.robots[ui.robot].id, 400));
  fact(facts, 'time', `${number(live.edit && page.live ? live.edit.time : d.time)} s`, 'time');
  fact(facts, 'position', `${pair(d.position)} m`, 'position');
  fact(facts, 'moving at', speedWords(d.velocity), 'velocity');
  fact(facts, 'mode', modeWords(run, row, ui.robot), 'mode');
  fact(facts, 'preferred', speedWords(d.preferred), 'preferred');
  fact(facts, 'chosen', speedWords(d.chosen), 'chosen');
  fact(facts, 'difference', shift < 0.005 ? 'the preferred one itself' : `${number(shift)} m/s from the preferred one`);
  fact(facts, 'status', statusWords(d), 'status');
  const waits = waitWords(run, d.row, ui.robot);
  if (waits) fact(facts, 'waiting', waits, 'waiting');
  const plan = planWords(run, ui.robot, d.time);
  if (plan) fact(facts, 'plan', plan, 'plan');
  $('facts').replaceChildren(...facts);
  $('why').textContent = whyWords(run, d, mode).join('\n');
  const result = checkChoice(run, d);
  showVerdict($('verdict'), result);
  if (result.ok === false) $('why').textContent += `\nRefuted: ${result.why}.`;
  fillHalfPlanes(d);
  if (canEdit() && !page.isPlaying) fillLiveNumbers();
}

// A recording of positions alone, or a robot whose decisions were left out.
function fillStateOnly(run) {
  for (const id of ['half-planes', 'why', 'verdict', 'count']) $(id).replaceChildren();
  const facts = [], i = ui.robot, row = shownPositions().row;
  fact(facts, 'robot', shortName(run.robots[i].id, 400));
  fact(facts, 'time', `${number(run.time[row])} s`, 'time');
  fact(facts, 'position', `${pair([run.x(row, i), run.y(row, i)])} m`, 'position');
  fact(facts, 'moving at', speedWords([run.vx(row, i), run.vy(row, i)]), 'velocity');
  $('facts').replaceChildren(...facts);
  $('why').textContent = run.decisionTime.length ? '' : 'This recording has positions only: no decisions, no half-planes, no goals. ' +
    'Robots in red had a half-plane relaxed since the row before.';
}

const MOST_CARDS = 60;

function fillHalfPlanes(d) {
  const run = shownRun(), counts = {slack: 0, binding: 0, violated: 0};
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
  endEdit();
  ui.t = Math.max(page.run.time[0], Math.min(page.run.end, t));
  page.dirty = true;
}

function chooseRobot(i) {
  ui.robot = (i + page.run.n) % page.run.n;
  ui.pinned = ui.halfPlane = null;
  page.shownDecision = '';
  page.chartsDirty = page.dirty = true;
  fitSpace();
  fillLive();
  if (live.edit) askForDecision();  // an answer has every half-plane of the robot that was asked about
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
  const words = addressWords(), key = words.get('run'), wrong = [];
  notice('');
  if (key !== undefined && !page.list.some((r) => r.key === key)) wrong.push(`This page has no run '${shortName(key, 80)}'.`);
  else if (key !== undefined && key !== page.key) await openRun(key);
  const robot = words.get('robot');
  if (robot !== undefined) {
    const i = page.run.robots.findIndex((r) => r.id === robot);
    const k = i >= 0 ? i : Number(robot);
    if (robot !== '' && Number.isInteger(k) && k >= 0 && k < page.run.n) chooseRobot(k);
    else wrong.push(`This run has no robot '${shortName(robot, 80)}'.`);
  }
  const time = words.get('t'), t = Number(time);
  if (time !== undefined && time !== '' && Number.isFinite(t)) {
    seek(t);
    if (Math.abs(ui.t - t) > 5e-5) wrong.push(`This run lasts from ${number(page.run.time[0])} to ${number(page.run.end)} s: there is no ${shortName(time, 20)} s.`);
  } else if (time !== undefined) {
    wrong.push(`'${shortName(time, 80)}' is no time in seconds.`);
  }
  if (wrong.length) notice(`The address asks for what is not here. ${wrong.join(' ')} Shown instead: ${shortName(page.run.about.name, 60)}, ` +
    `${shortName(page.run.robots[ui.robot].id, 40)} at ${number(ui.t)} s.`);
  page.dirty = true;
}

// --- Changes: computed by the server that gave the page out (served.js) ---

const live = {edit: null, isAsking: false, isAgain: false, freeTimer: 0, made: 0, server: window.exactvoServer || null, keys: new Map()};

// Recordings of crowds have positions alone: neither goals nor decisions.
function canEdit() {
  return live.server !== null && page.run !== null && Boolean(page.run.head.scenario) && page.run.decisionTime.length > 0;
}

function liveMessage(text, isBad) {
  $('live-message').textContent = text;
  $('live-message').className = isBad ? 'bad' : '';
}

// The change that goes on, or a new one of the moment that is shown.
function editOfMoment() {
  return live.edit || new Edit(page.run, live.keys.get(page.key) || page.key, ui.t);
}

function endEdit() {
  if (!live.edit && !page.live) return;
  live.edit = page.live = null;
  page.shownDecision = '';
  page.space = null;
  page.dirty = true;
  clearTimeout(live.freeTimer);
  $('live-free').textContent = '';
  liveMessage('', false);
  fillLive();
}

// A change goes on with `edit`: it is computed and shown.
function changed(edit) {
  if (live.edit !== edit) {
    setPlaying(false);
    live.edit = edit;
  }
  fillLiveNumbers();
  askForDecision();
}

// One question at a time; what changed in between is asked next.
async function askForDecision() {
  live.isAgain = true;
  if (live.isAsking) return;
  live.isAsking = true;
  while (live.isAgain && live.edit) {
    live.isAgain = false;
    const edit = live.edit;
    try {
      const {bytes, took} = await live.server.ask('decide', edit.question(ui.robot));
      const run = await unpackBytes(new Uint8Array(bytes));
      if (live.edit !== edit) continue;
      run.unreachable = unreachableOf(run);
      page.live = {run, positions: new Positions(run)};
      page.shownDecision = '';
      page.dirty = true;
      liveMessage(`Computed in ${number(took.compute, 1)} ms (processor: ${number(took.processor, 1)} ms).`, false);
      askForFree(edit);
    } catch (error) {
      if (live.edit === edit) liveMessage(`Not computed: ${error.message}`, true);
    }
  }
  live.isAsking = false;
  fillLive();
}

// When a change rests: what of the free velocities the half-planes give away.
function askForFree(edit) {
  clearTimeout(live.freeTimer);
  $('live-free').textContent = '';
  live.freeTimer = setTimeout(async () => {
    try {
      const {bytes} = await live.server.ask('free', {...edit.question(ui.robot), robot: ui.robot, preferred: null});
      if (live.edit !== edit) return;
      const answer = JSON.parse(new TextDecoder().decode(bytes)), middle = ([low, high]) => number((low + high) / 2);
      $('live-free').textContent = answer.why_not ? `Free velocities: ${answer.why_not}.`
        : `Free velocities: ${middle(answer.free)} (m/s)\u00b2, of which the half-planes give away ${middle(answer.given_away)} and ` +
          `keep ${middle(answer.allowed)}${answer.inside === 'no' ? ' (some of it not free: shared with others)' : ''}.`;
    } catch (error) {
      $('live-free').textContent = '';  // the decision stands without it
    }
  }, 350);
}

async function runFromHere() {
  if (!canEdit()) return;
  const edit = editOfMoment(), base = page.key, robot = ui.robot;
  liveMessage('Simulates on from this moment ...', false);
  $('live-run').disabled = true;
  try {
    const {bytes} = await live.server.ask('run', edit.question(robot));
    const run = await unpackBytes(new Uint8Array(bytes)), key = `changed-${++live.made}`;
    live.keys.set(key, live.keys.get(base) || base);
    page.loaded.set(key, run);
    page.list.push({key, title: `${page.run.about.name}, on from ${number(edit.time)} s (${live.made})`, description: ''});
    fillList(page.isGuide);
    await openRun(key);
    chooseRobot(robot);
    setPlaying(true);
  } catch (error) {
    liveMessage(`Not simulated: ${error.message}`, true);
  }
  $('live-run').disabled = false;
}

// The panel of changes, where there is a server.
function showLive() {
  $('live').hidden = live.server === null;
  for (const e of document.querySelectorAll('.of-server')) e.hidden = live.server === null;
  for (const e of $('live').querySelectorAll('input, select, button')) e.disabled = !canEdit();
  if (live.server && !canEdit()) liveMessage('This recording has neither goals nor decisions: nothing can be computed from it.', true);
  fillLive();
}

function fillLive() {
  if (!canEdit()) return;
  $('live-back').disabled = live.edit === null;
  $('live-state').textContent = live.edit ? `the moment at ${number(live.edit.time)} s, changed` : 'drag robots, goals, corners, arrows';
  const handles = liveHandles(), chosen = $('live-handle').value;
  $('live-handle').replaceChildren(...handles.map((h, k) => {
    const option = element('option', h.label);
    option.value = String(k);
    return option;
  }));
  if (chosen !== '' && Number(chosen) < handles.length) $('live-handle').value = chosen;
  fillLiveNumbers();
}

function liveHandles(edit = editOfMoment()) {
  return handlesOf(edit, ui.robot, currentDecision());
}

function fillLiveNumbers() {
  const edit = editOfMoment(), robot = edit.scenario.robots[ui.robot], set = (id, value) => {
    if (document.activeElement !== $(id)) $(id).value = String(Number(value.toFixed(4)));
  };
  $('live-method').value = edit.methodName();
  for (const id of ['live-radius', 'live-radius-number']) set(id, robot.radius);
  for (const id of ['live-horizon', 'live-horizon-number']) set(id, edit.horizon);
  const handle = liveHandles(edit)[Number($('live-handle').value) || 0];
  if (!handle) return;
  const [x, y] = handle.at();
  set('live-x', x);
  set('live-y', y);
}

// Where a drag begins: on a handle, a robot or an obstacle; null where the view is to be moved.
function grabbed(where, view, px, py) {
  if (!canEdit()) return null;
  const edit = editOfMoment(), handles = liveHandles(edit);
  let handle = pickHandle(view, handles, where, px, py);
  if (!handle && where === 'world') {
    const found = pickInWorld(view, shownRun(), shownPositions(), px, py) || {};
    if (found.robot !== undefined) handle = handles.find((h) => h.kind === 'robot' && h.robot === found.robot);
    else if (found.obstacle !== undefined) handle = obstacleHandle(edit, found.obstacle, view.x(px), view.y(py));
  }
  return handle && {edit, put: (x, y) => {
    handle.put(x, y);
    const k = liveHandles(edit).findIndex((h) => h.label === handle.label);
    if (k >= 0) $('live-handle').value = String(k);
    changed(edit);
  }};
}

function connectLive() {
  const change = (id, apply) => $(id).addEventListener('input', () => {
    const value = Number($(id).value);
    if ($(id).value === '' || !Number.isFinite(value)) return;
    const edit = editOfMoment();
    apply(edit, value);
    changed(edit);
  });
  for (const id of ['live-radius', 'live-radius-number'])
    change(id, (edit, value) => {
      edit.scenario.robots[ui.robot].radius = value;
    });
  for (const id of ['live-horizon', 'live-horizon-number'])
    change(id, (edit, value) => {
      edit.horizon = value;
    });
  const move = (edit, x, y) => liveHandles(edit)[Number($('live-handle').value) || 0].put(x, y);
  change('live-x', (edit, x) => move(edit, x, Number($('live-y').value)));
  change('live-y', (edit, y) => move(edit, Number($('live-x').value), y));
  $('live-handle').addEventListener('change', fillLiveNumbers);
  $('live-method').addEventListener('change', () => {
    const edit = editOfMoment();
    edit.method = $('live-method').value;
    changed(edit);
  });
  $('live-run').addEventListener('click', runFromHere);
  $('live-back').addEventListener('click', endEdit);
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

function onView(canvas, view, {where, onClick, onHover}) {
  const pointers = new Map();
  let moved = 0, spread = 0, grab = null;
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
    grab = pointers.size === 1 ? grabbed(where, view, ...at(event)) : null;
  });
  canvas.addEventListener('pointermove', (event) => {
    const [x, y] = at(event), before = pointers.get(event.pointerId);
    if (!before) {
      onHover(x, y, event);
      return;
    }
    moved += Math.abs(x - before[0]) + Math.abs(y - before[1]);
    pointers.set(event.pointerId, [x, y]);
    if (grab) {
      if (moved > 4) grab.put(view.x(x), view.y(y));
    } else if (pointers.size === 2) {
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
  const run = shownRun(), positions = shownPositions();
  if (!found) return '';
  if (found.goal !== undefined) {
    const [robot, k] = found.goal, goals = run.robots[robot].goals, away = run.unreachable.find((u) => u.robot === robot && u.goal === k);
    return `goal${goals.length > 2 ? ` ${k + 1}` : ''} of ${shortName(run.robots[robot].id, 120)}\n(${number(goals[2 * k])}, ${number(goals[2 * k + 1])}) m` +
      (away ? `\nout of reach: ${shortName(away.why, 400)}` : '');
  }
  if (found.obstacle !== undefined) {
    const x = positions.x[ui.robot], y = positions.y[ui.robot];
    return `obstacle ${shortName(run.obstacles[found.obstacle].id, 120)}\n` +
      `${number(distanceToObstacle(run.obstacles[found.obstacle], x, y, 0, 0) - run.robots[ui.robot].radius)} m from the rim of ` +
      shortName(run.robots[ui.robot].id, 40);
  }
  if (found.moving !== undefined) return `moving obstacle ${shortName(run.moving[found.moving].id, 120)}`;
  const i = found.robot, row = positions.row, vx = run.vx(row, i), vy = run.vy(row, i);
  return `robot ${shortName(run.robots[i].id, 120)}\nat (${number(positions.x[i])}, ${number(positions.y[i])}) m, ` +
    `radius ${run.robots[i].radius} m\nspeed ${number(Math.hypot(vx, vy))} of ${run.robots[i].max_speed} m/s\n${modeWords(run, row, i)}`;
}

function connectPointer() {
  onView($('world'), page.world, {
    where: 'world',
    onClick: (x, y) => {
      const found = pickInWorld(page.world, shownRun(), shownPositions(), x, y);
      if (found && found.robot !== undefined) chooseRobot(found.robot);
    },
    onHover: (x, y, event) => showTip(event && worldTip(pickInWorld(page.world, shownRun(), shownPositions(), x, y)), event),
  });
  onView($('space'), page.plane, {
    where: 'space',
    onClick: (x, y) => chooseHalfPlane(pickInSpace(page.plane, page.space, x, y), true),
    onHover: (x, y, event) => {
      const k = event ? pickInSpace(page.plane, page.space, x, y) : null;
      if (ui.halfPlane !== (k === null ? ui.pinned : k)) chooseHalfPlane(k, false);
      const d = page.space && page.space.decision;
      if (k === null || !event) {
        showTip(event && d ? `(${number(page.plane.x(x))}, ${number(page.plane.y(y))}) m/s` : '', event);
      } else {
        const h = d.halfPlanes[k];
        showTip(`[${k + 1}] ${shortName(shownRun().nameOf(h), 120)}, ${effectWords(d, h)}\n${contactWords(d, h)}\n${lineWords(h)}` +
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
  worldLegend($('world-legend'), ui.colours, live.server !== null);
  spaceLegend($('space-legend'), ui.colours);
  page.chartsDirty = page.dirty = true;
}

function title() {
  const run = shownRun();
  return `${run.about.name}, ${run.about.method}: ${run.robots[ui.robot].id} at ${number(live.edit ? live.edit.time : ui.t)} s${page.live ? ', changed' : ''}`;
}

function paintInto(ctx, which) {
  if (which === 'world') drawWorld(ctx, page.world, shownRun(), shownPositions(), shownUi(), currentDecision());
  else drawSpace(ctx, page.plane, page.space, ui);
}

function svgOfMoment() {
  shownPositions().at(shownTime());
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
  l: () => showLegend($('world-legend').hidden), x: () => runFromHere(), b: () => endEdit(),
  t: () => setTheme(ui.colours === PALETTES.light ? 'dark' : 'light'), '?': () => $('keys').showModal(),
};

function showLegend(on) {
  for (const id of ['world-legend', 'space-legend']) $(id).hidden = !on;
  $('legend').setAttribute('aria-pressed', String(on));
  resize();
}

function fitAll() {
  setFollow(false);
  fitWorld();
  fitSpace();
}

function onKey(event) {
  if (!page.run || event.ctrlKey || event.metaKey || event.altKey || $('keys').open) return;
  const tag = event.target.tagName;
  if (tag === 'SELECT' || (tag === 'INPUT' && (event.target.type === 'number' || event.key.startsWith('Arrow')))) return;
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
  on('legend', KEYS.l);
  on('notice-close', () => notice(''));
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
  $('run').hidden = page.list.length < 2 || (isGuide && live.made === 0);
  $('run').replaceChildren(...page.list.map((r) => {
    const option = element('option', shortName(r.title, 80));
    option.value = r.key;
    return option;
  }));
  $('guide').hidden = !isGuide;
  $('guide').replaceChildren();
  for (const r of isGuide ? page.list.slice(0, page.elements.length) : []) {
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
  showLegend(innerHeight >= 900 && innerWidth > 1100);
  const about = readList();
  page.list = about.runs;
  page.elements = [...document.querySelectorAll('script.run')];
  if (!page.list.length) throw new DataProblem('This page has no runs: make one with exactvo view.');
  page.isGuide = about.guide;
  fillList(about.guide);
  connectControls();
  connectPointer();
  connectLive();
  await openRun(page.list.some((r) => r.key === addressWords().get('run')) ? addressWords().get('run') : page.list[0].key);
  await readAddress();
  requestAnimationFrame(onFrame);
}

// For the console and for tests.
window.exactvo = {page, ui, live, changed, editOfMoment, obstacleClearance, seek, chooseRobot, openRun, checkAll, checkDecision, checkHalfPlane, checkHalfOfPair, svgOfMoment, svgOfRun};
window.exactvo.ready = start().catch(report);
