// SPDX-License-Identifier: GPL-3.0-or-later
// The words beside the pictures: facts of a decision, and its half-planes as cards.
import {checkChoice, checkConstraint} from './proof.js';
import {shortName} from './draw.js';
import {contactWords, effectOf, effectWords, lineWords, modeWords, number, pair, speedWords, standsWords, statusWords, waitWords, whyWords} from './words.js';
import {planWords} from './plans.js';
import {$, element, isolated, page, shownPositions, shownRun, ui} from './state.js';
import {currentDecision} from './views.js';
import {canEdit, fillLiveNumbers, live} from './changing.js';

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
  if (run.robots[ui.robot].on_wheels) fact(facts, 'heading', `${number(run.heading(row, ui.robot) * 180 / Math.PI)} degrees`, 'heading');
  fact(facts, 'mode', modeWords(run, row, ui.robot), 'mode');
  fact(facts, 'preferred', speedWords(d.preferred), 'preferred');
  fact(facts, 'chosen', speedWords(d.chosen), 'chosen');
  fact(facts, 'difference', shift < 0.005 ? 'the preferred one itself' : `${number(shift)} m/s from the preferred one`);
  const stands = standsWords(d);
  if (stands) fact(facts, 'stands', stands, 'stands');
  fact(facts, 'status', statusWords(d), 'status');
  const waits = waitWords(run, d.row, ui.robot);
  if (waits) fact(facts, 'waiting', waits, 'waiting');
  if (run.about.assumed) fact(facts, 'assumed', run.about.assumed.replace('assumed: ', ''), 'assumed');
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
  const isThere = run.isThere(i, ui.t);
  fact(facts, 'position', isThere ? `${pair([run.x(row, i), run.y(row, i)])} m` : 'not there', 'position');
  if (isThere) fact(facts, 'moving at', speedWords([run.vx(row, i), run.vy(row, i)]), 'velocity');
  if (run.about.assumed) fact(facts, 'assumed', run.about.assumed.replace('assumed: ', ''), 'assumed');
  $('facts').replaceChildren(...facts);
  const checked = 'Trajectories that exactvo check decided on, in continuous time: bounds of moments and depths are in its answer. The page draws straight lines between the bends of a way.';
  $('why').textContent = run.about.method === 'check' ? checked : run.decisionTime.length ? '' : 'This recording has positions only: no decisions, no half-planes, no goals (exactvo explain computes a decision again; simulate --decisions binding records all). ' +
    'Robots in red had a half-plane relaxed since the row before.';
}

const MOST_CARDS = 60;

function fillHalfPlanes(d) {
  const run = shownRun(), counts = {slack: 0, binding: 0, violated: 0};
  for (const h of d.halfPlanes) ++counts[effectOf(d, h)];
  $('count').textContent = `${d.halfPlanes.length}: ${counts.binding} binding${counts.violated ? `, ${counts.violated} violated` : ''}`;
  const isSlack = (k) => effectOf(d, d.halfPlanes[k]) === 'slack';
  const order = d.halfPlanes.map((h, k) => k).sort((a, b) => isSlack(a) - isSlack(b) || a - b);
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

function nextHalfPlane(direction) {
  const d = page.space && page.space.decision;
  if (!d || !d.halfPlanes.length) return;
  const n = d.halfPlanes.length, k = ui.pinned === null ? (direction > 0 ? 0 : n - 1) : (ui.pinned + direction + n) % n;
  chooseHalfPlane(k, true);
}

export {fillWords, chooseHalfPlane, nextHalfPlane};
