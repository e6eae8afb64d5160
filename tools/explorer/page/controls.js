// SPDX-License-Identifier: GPL-3.0-or-later
// Buttons, keys, light and dark.
import {PALETTES} from './draw.js';
import {spaceLegend, worldLegend} from './legend.js';
import {$, notice, page, report, ui} from './state.js';
import {openRun} from './runs.js';
import {fitAll, fitSpace, fitWorld, resize, setFollow} from './views.js';
import {chooseHalfPlane, nextHalfPlane} from './facts.js';
import {checkAll} from './checking.js';
import {chooseRobot, readAddress, seek, writeAddress} from './moment.js';
import {endEdit, live, runFromHere} from './changing.js';
import {changeSpeed, setPlaying, stepBy, toEvent} from './playing.js';
import {film, saveAnimation, saveMoment} from './saving.js';

function fillLegends() {
  worldLegend($('world-legend'), ui.colours, live.server !== null, page.run?.about.method === 'check', page.run?.hasMovers);
  spaceLegend($('space-legend'), ui.colours);
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  ui.colours = PALETTES[theme];
  fillLegends();
  page.chartsDirty = page.dirty = true;
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

// To the moment at which a collision is deepest.
function showCollision(event) {
  const button = event.target.closest('button');
  if (!button) return;
  const c = page.run.about.collisions[Number(button.dataset.collision)];
  setPlaying(false);
  chooseRobot(Math.max(0, page.run.robots.findIndex((r) => r.id === c.robot)));
  seek(c.at);
  writeAddress();
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
  on('collisions', showCollision);
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

export {fillLegends, setTheme, showLegend, connectControls};
