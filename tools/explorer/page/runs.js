// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of the page: their list, the one that is shown, its words and measurements.
import {bytesOfBase64, DataProblem, unpackRun} from './columns.js';
import {shortName} from './draw.js';
import {coveredWords, number} from './words.js';
import {Positions, unreachableOf} from './world.js';
import {collisionWords, eventsOf, pathLength} from './charts.js';
import {$, element, page, report, ui} from './state.js';
import {fitSpace, fitWorld, resize} from './views.js';
import {writeAddress} from './moment.js';
import {endEdit, live, showLive} from './changing.js';

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
  $('collisions').replaceChildren(...about.collisions.map((c, k) => {
    const item = element('li'), button = element('button', shortName(`${c.robot}: ${collisionWords(c)}`, 200));
    button.dataset.collision = String(k);
    item.append(button);
    return item;
  }));
  $('warnings').replaceChildren(...[...about.warnings, ...about.stuck.map((s) => s.text)].map((w) => element('li', shortName(w, 1000))));
  $('moment').textContent = about.method === 'check' ? 'Moment' : 'Decision';
  const partial = [];
  const hasDecisions = run.decisionTime.length > 0;
  $('main').classList.toggle('positions-only', !hasDecisions);
  for (const e of document.querySelectorAll('.of-decisions')) e.hidden = !hasDecisions;
  if (hasDecisions && !about.all_half_planes)
    partial.push('The recording has only the half-planes that bind or are violated and those against what could be met within a time step: simulate --decisions all keeps the others too.');
  if (run.head.decisions.every > 1) partial.push(`One row in ${run.head.decisions.every} has its decisions in this page.`);
  if (run.head.rows.every > 1) partial.push(`One row in ${run.head.rows.every} is in this page.`);
  $('partial').textContent = partial.join(' ');
  $('origin').textContent = `ExactVO ${about.version}, ${about.commit}`;
  $('checked').textContent = '';
  $('covered').textContent = coveredWords(run);
  fillMetrics();
}

const METRICS = [
  ['last_arrival_time', 'last arrival', 's'], ['min_obstacle_clearance', 'least clearance to obstacles', 'm'],
  ['min_robot_clearance', 'least clearance between robots', 'm'], ['formation_position_error', 'formation position error', 'm'],
  ['formation_velocity_error', 'formation velocity error', 'm/s'], ['jitter', 'jitter', 'm/s\u00b2'],
  ['velocity_variation', 'velocity variation', 'm/s'], ['peak_acceleration', 'peak acceleration', 'm/s\u00b2'],
  ['heading_reversals', 'heading reversals', ''], ['decisions.relaxed', 'relaxed decisions', ''],
  ['decisions.uncertified_half_planes', 'half-planes not certified', ''], ['steps', 'steps', ''],
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
    const value = key.split('.').reduce((part, name) => (part ? part[name] : undefined), metrics);
    if (value === null || value === undefined) continue;
    rows.push(metricRow(name, `${Number(value.toPrecision(5))}${unit ? ` ${unit}` : ''}`, key));
  }
  $('metrics').replaceChildren(...rows);
}

// Metrics of the chosen robot, which the page counts from what it holds.
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

export {readList, openRun, fillRobotMetrics, fillList};
