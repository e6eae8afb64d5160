// SPDX-License-Identifier: GPL-3.0-or-later
// The two pictures and the charts: their sizes, what they show, and how they are painted.
import {drawHandles, drawWorld, extentOf} from './world.js';
import {drawSpace, reachOf, spaceOf} from './space.js';
import {drawCharts, drawCursor, seriesOf} from './charts.js';
import {$, page, shownPositions, shownRun, shownTime, shownUi, ui} from './state.js';
import {fillRobotMetrics} from './runs.js';
import {canEdit} from './changing.js';

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

function setFollow(on) {
  page.follow = on;
  $('follow').setAttribute('aria-pressed', String(on));
  page.dirty = true;
}

function fitAll() {
  setFollow(false);
  fitWorld();
  fitSpace();
}

export {resize, fitWorld, fitSpace, fitAll, currentDecision, paint, setFollow};
