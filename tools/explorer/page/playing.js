// SPDX-License-Identifier: GPL-3.0-or-later
// Playing, steps and events.
import {shortName} from './draw.js';
import {number} from './words.js';
import {$, page, report, ui} from './state.js';
import {paint} from './views.js';
import {fillWords} from './facts.js';
import {seek, writeAddress} from './moment.js';

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
  const mine = page.events.filter((e) => e.robot === ui.robot || e.kind === 'collision' || e.kind === 'hit');
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

function changeSpeed(direction) {
  const options = $('speed').options, k = Math.max(0, Math.min(options.length - 1, $('speed').selectedIndex + direction));
  $('speed').selectedIndex = k;
  page.speed = Number(options[k].value);
}

export {onFrame, setPlaying, stepBy, toEvent, showEvent, changeSpeed};
