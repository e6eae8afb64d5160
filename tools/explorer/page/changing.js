// SPDX-License-Identifier: GPL-3.0-or-later
// Changes: computed by the server that gave the page out (served.js).
import {unpackBytes} from './columns.js';
import {number} from './words.js';
import {pickInWorld, Positions, unreachableOf} from './world.js';
import {Edit, handlesOf, obstacleHandle, pickHandle} from './editing.js';
import {$, element, page, shownPositions, shownRun, ui} from './state.js';
import {fillList, openRun} from './runs.js';
import {currentDecision} from './views.js';
import {chooseRobot} from './moment.js';
import {setPlaying} from './playing.js';

const HANDLE_REACH = 10;  // px
const HANDLE_LEAD = 3;  // px; a handle is taken before a robot's centre that is nearer by less, such as the goal that it stands on

const live = {edit: null, isAsking: false, isAgain: false, freeTimer: 0, made: 0, server: window.exactvoServer || null, keys: new Map()};

// Recordings of crowds have positions alone: neither goals nor decisions.
function hasWheels() {
  return page.run !== null && page.run.robots.some((r) => r.on_wheels);
}

function canEdit() {
  return live.server !== null && page.run !== null && Boolean(page.run.head.scenario) && page.run.decisionTime.length > 0 && !hasWheels();
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
      const {bytes} = await live.server.ask('free', {...edit.question(ui.robot), preferred: null});
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
    liveMessage('', false);  // also where nothing had been changed
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
  if (live.server && !canEdit())
    liveMessage(hasWheels() ? 'A run of robots on wheels begins at rest: nothing can be computed from a moment of it.'
      : 'This recording has neither goals nor decisions: nothing can be computed from it.', true);
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
  const edit = editOfMoment(), handles = liveHandles(edit), positions = shownPositions();
  const found = (where === 'world' && pickInWorld(view, shownRun(), positions, px, py)) || {};
  let reach = HANDLE_REACH;
  if (found.robot !== undefined)
    reach = Math.min(reach, Math.hypot(view.px(positions.x[found.robot]) - px, view.py(positions.y[found.robot]) - py) + HANDLE_LEAD);
  let handle = pickHandle(view, handles, where, px, py, reach);
  if (!handle) {
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
  const move = (edit, place) => {  // the other coordinate is kept, to the last digit, whatever its field shows
    const handle = liveHandles(edit)[Number($('live-handle').value) || 0];
    handle.put(...place(handle.at()));
  };
  change('live-x', (edit, x) => move(edit, ([, y]) => [x, y]));
  change('live-y', (edit, y) => move(edit, ([x]) => [x, y]));
  $('live-handle').addEventListener('change', fillLiveNumbers);
  $('live-method').addEventListener('change', () => {
    const edit = editOfMoment();
    edit.method = $('live-method').value;
    changed(edit);
  });
  $('live-run').addEventListener('click', runFromHere);
  $('live-back').addEventListener('click', endEdit);
}

export {live, canEdit, editOfMoment, endEdit, changed, askForDecision, runFromHere, showLive, fillLive, fillLiveNumbers, grabbed, connectLive};
