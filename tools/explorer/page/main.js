// SPDX-License-Identifier: GPL-3.0-or-later
// The page from its beginning.
import {checkConstraint, checkDecision, checkHalfOfPair, checkHalfPlane} from './proof.js';
import {DataProblem} from './columns.js';
import {obstacleClearance} from './shapes.js';
import {page, report, ui} from './state.js';
import {fillList, openRun, readList} from './runs.js';
import {checkAll} from './checking.js';
import {addressWords, chooseRobot, readAddress, seek} from './moment.js';
import {changed, connectLive, editOfMoment, live} from './changing.js';
import {onFrame} from './playing.js';
import {connectPointer} from './pointer.js';
import {svgOfMoment, svgOfRun} from './saving.js';
import {connectControls, fillLegends, setTheme, showLegend} from './controls.js';

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
  fillLegends();
  await readAddress();
  requestAnimationFrame(onFrame);
}

// For the console and for tests.
window.exactvo = {page, ui, live, changed, editOfMoment, obstacleClearance, seek, chooseRobot, openRun, checkAll, checkDecision, checkConstraint, checkHalfPlane, checkHalfOfPair, svgOfMoment, svgOfRun};

window.exactvo.ready = start().catch(report);
