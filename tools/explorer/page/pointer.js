// SPDX-License-Identifier: GPL-3.0-or-later
// What the pointer does: moving views, dragging, hovering, choosing.
import {clearanceOf, hasChain} from './shapes.js';
import {shortName} from './draw.js';
import {contactWords, effectWords, lineWords, modeWords, number} from './words.js';
import {pickInWorld} from './world.js';
import {pickInSpace} from './space.js';
import {pickEvent, pxToTime} from './charts.js';
import {$, page, shownPositions, shownRun, ui} from './state.js';
import {setFollow} from './views.js';
import {chooseHalfPlane} from './facts.js';
import {chooseRobot, seek, writeAddress} from './moment.js';
import {grabbed} from './changing.js';
import {setPlaying, showEvent} from './playing.js';

function onView(canvas, view, {where, onClick, onHover}) {
  const pointers = new Map();
  let moved = 0, spread = 0, grab = null;
  const at = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spreadNow = () => {
    const [a, b] = [...pointers.values()];
    return Math.hypot(a[0] - b[0], a[1] - b[1]);
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, at(event));
    if (pointers.size === 2) spread = spreadNow();
    moved = 0;
    grab = pointers.size === 1 ? grabbed(where, view, ...at(event)) : null;
  });
  canvas.addEventListener('pointermove', (event) => {
    const [x, y] = at(event), before = pointers.get(event.pointerId);
    if (!before) {
      onHover(x, y, event);
      return;
    }
    moved += Math.abs(x - before[0]) + Math.abs(y - before[1]);
    pointers.set(event.pointerId, [x, y]);
    if (grab) {
      if (moved > 4) grab.put(view.x(x), view.y(y));
    } else if (pointers.size === 2) {
      const now = spreadNow(), [a, b] = [...pointers.values()];
      view.zoomAt((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, now / Math.max(1, spread));
      spread = now;
    } else if (moved > 4) {
      if (view === page.world) setFollow(false);
      view.cx -= (x - before[0]) / view.scale;
      view.cy += (y - before[1]) / view.scale;
    }
    page.dirty = true;
  });
  const up = (event) => {
    if (pointers.delete(event.pointerId) && moved <= 4 && event.type === 'pointerup') onClick(...at(event), event);
  };
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('pointerleave', () => {
    showTip(null);
    onHover(-1e6, -1e6, null);
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    view.zoomAt(...at(event), Math.exp(-0.0015 * event.deltaY * (event.deltaMode === 1 ? 20 : 1)));
    page.dirty = true;
  }, {passive: false});
}

function showTip(text, event) {
  $('tip').hidden = !text || !event;
  if (!text || !event) return;
  $('tip').textContent = text;
  $('tip').style.left = `${Math.min(event.clientX + 14, innerWidth - 330)}px`;
  $('tip').style.top = `${Math.min(event.clientY + 14, innerHeight - 90)}px`;
}

function worldTip(found) {
  const run = shownRun(), positions = shownPositions();
  if (!found) return '';
  if (found.goal !== undefined) {
    const [robot, k] = found.goal, goals = run.robots[robot].goals, away = run.unreachable.find((u) => u.robot === robot && u.goal === k);
    return `goal${goals.length > 2 ? ` ${k + 1}` : ''} of ${shortName(run.robots[robot].id, 120)}\n(${number(goals[2 * k])}, ${number(goals[2 * k + 1])}) m` +
      (away ? `\nout of reach: ${shortName(away.why, 400)}` : '');
  }
  if (found.obstacle !== undefined) {
    const robot = run.robots[ui.robot], at = [positions.x[ui.robot], positions.y[ui.robot], positions.heading[ui.robot]];
    return `obstacle ${shortName(run.obstacles[found.obstacle].id, 120)}\n` +
      `${number(clearanceOf(robot, ...at, run.obstacles[found.obstacle], 0, 0))} m from ` +
      `${hasChain(robot) ? 'the discs of the footprint' : 'the rim'} of ${shortName(robot.id, 40)}`;
  }
  if (found.moving !== undefined) return `moving obstacle ${shortName(run.moving[found.moving].id, 120)}`;
  const i = found.robot, row = positions.row, vx = run.vx(row, i), vy = run.vy(row, i);
  return `robot ${shortName(run.robots[i].id, 120)}\nat (${number(positions.x[i])}, ${number(positions.y[i])}) m, ` +
    `${run.robots[i].outline ? 'within' : 'radius'} ${run.robots[i].radius} m${hasChain(run.robots[i]) ? ` beside robots, discs of ${number(run.robots[i].obstacle_radius, 3)} m beside obstacles` : ''}${run.robots[i].body_radius ? `, of which the body ${run.robots[i].body_radius} m` : ''}\nspeed ${number(Math.hypot(vx, vy))} of ${run.robots[i].max_speed} m/s${run.about.method === 'check' ? '' : `\n${modeWords(run, row, i)}`}`;
}

function connectPointer() {
  onView($('world'), page.world, {
    where: 'world',
    onClick: (x, y) => {
      const found = pickInWorld(page.world, shownRun(), shownPositions(), x, y);
      if (found && found.robot !== undefined) chooseRobot(found.robot);
    },
    onHover: (x, y, event) => showTip(event && worldTip(pickInWorld(page.world, shownRun(), shownPositions(), x, y)), event),
  });
  onView($('space'), page.plane, {
    where: 'space',
    onClick: (x, y) => chooseHalfPlane(pickInSpace(page.plane, page.space, x, y), true),
    onHover: (x, y, event) => {
      const k = event ? pickInSpace(page.plane, page.space, x, y) : null;
      if (ui.halfPlane !== (k === null ? ui.pinned : k)) chooseHalfPlane(k, false);
      const d = page.space && page.space.decision;
      if (k === null || !event) {
        showTip(event && d ? `(${number(page.plane.x(x))}, ${number(page.plane.y(y))}) m/s` : '', event);
      } else {
        const h = d.halfPlanes[k];
        showTip(`[${k + 1}] ${shortName(shownRun().nameOf(h), 120)}, ${effectWords(d, h)}\n${contactWords(d, h)}\n${lineWords(h)}` +
          (h.multiplier > 0 ? `\nmultiplier ${number(h.multiplier, 4)} m/s` : ''), event);
      }
    },
  });
  const charts = $('charts');
  const seekTo = (event) => {
    const box = charts.getBoundingClientRect(), x = event.clientX - box.left;
    const found = event.clientY - box.top < 18 ? pickEvent(page.run, page.events, box.width, x) : null;
    seek(found ? found.time : pxToTime(page.run, box.width, x));
    showEvent(found);
    writeAddress();
  };
  charts.addEventListener('pointerdown', (event) => {
    setPlaying(false);
    charts.setPointerCapture(event.pointerId);
    seekTo(event);
  });
  charts.addEventListener('pointermove', (event) => {
    if (event.buttons) {
      seekTo(event);
      return;
    }
    const box = charts.getBoundingClientRect();
    const found = event.clientY - box.top < 18 ? pickEvent(page.run, page.events, box.width, event.clientX - box.left) : null;
    showTip(found ? `${number(found.time)} s, ${shortName(page.run.robots[found.robot]?.id ?? '', 40)}\n${shortName(found.text, 300)}` : '', event);
  });
  charts.addEventListener('pointerleave', () => showTip(null));
  const card = (event) => event.target.closest('li[data-half-plane]');
  $('half-planes').addEventListener('click', (event) => {
    const li = card(event);
    if (li) chooseHalfPlane(Number(li.dataset.halfPlane) === ui.pinned ? null : Number(li.dataset.halfPlane), true);
  });
  $('half-planes').addEventListener('pointerover', (event) => {
    const li = card(event);
    if (li) chooseHalfPlane(Number(li.dataset.halfPlane), false);
  });
  $('half-planes').addEventListener('pointerleave', () => chooseHalfPlane(null, false));
}

export {connectPointer};
