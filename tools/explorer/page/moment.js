// SPDX-License-Identifier: GPL-3.0-or-later
// The moment that is shown, the robot that is chosen, and both in the address.
import {shortName} from './draw.js';
import {number} from './words.js';
import {notice, page, ui} from './state.js';
import {openRun} from './runs.js';
import {fitSpace} from './views.js';
import {askForDecision, endEdit, fillLive, live} from './changing.js';

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

export {seek, chooseRobot, writeAddress, addressWords, readAddress};
