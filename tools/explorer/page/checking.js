// SPDX-License-Identifier: GPL-3.0-or-later
// Every proof of a run, checked.
import {checkChoice, checkConstraint} from './proof.js';
import {$, page, ui} from './state.js';
import {seek} from './moment.js';

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

export {checkAll};
