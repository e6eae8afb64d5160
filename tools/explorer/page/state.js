// SPDX-License-Identifier: GPL-3.0-or-later
// What the page shows, and what its modules share. Text from files reaches the page as text only (textContent).
import {DataProblem} from './columns.js';
import {PALETTES, shortName, View} from './draw.js';

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

export {$, page, ui, element, isolated, report, notice, shownRun, shownTime, shownPositions, shownUi};
