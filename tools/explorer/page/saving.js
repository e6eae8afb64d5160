// SPDX-License-Identifier: GPL-3.0-or-later
// What is shown, saved: SVG, an animation, a film.
import {DataProblem} from './columns.js';
import {number} from './words.js';
import {drawStill, drawWorld} from './world.js';
import {drawSpace} from './space.js';
import {animatedSvg, download, fileName, momentSvg, recordFilm} from './export.js';
import {$, page, report, shownPositions, shownRun, shownTime, shownUi, ui} from './state.js';
import {currentDecision} from './views.js';
import {seek} from './moment.js';
import {live} from './changing.js';
import {setPlaying} from './playing.js';

function title() {
  const run = shownRun();
  return `${run.about.name}, ${run.about.method}: ${run.robots[ui.robot].id} at ${number(live.edit ? live.edit.time : ui.t)} s${page.live ? ', changed' : ''}`;
}

function paintInto(ctx, which) {
  if (which === 'world') drawWorld(ctx, page.world, shownRun(), shownPositions(), shownUi(), currentDecision());
  else drawSpace(ctx, page.plane, page.space, ui);
}

function svgOfMoment() {
  shownPositions().at(shownTime());
  return momentSvg(title(), {world: page.world, space: page.plane}, paintInto, ui.colours);
}

function saveMoment() {
  download(fileName(page.run, `-${number(ui.t)}s.svg`), new Blob([svgOfMoment()], {type: 'image/svg+xml'}));
}

function svgOfRun() {
  return animatedSvg(page.run, page.world, ui.colours, (ctx) => drawStill(ctx, page.world, page.run, ui));
}

function saveAnimation() {
  download(fileName(page.run, '.svg'), new Blob([svgOfRun()], {type: 'image/svg+xml'}));
}

function film() {
  if (page.stopFilm) {
    page.stopFilm();
    return;
  }
  setPlaying(false);
  const canvas = document.createElement('canvas'), gap = 10;
  canvas.width = 2 * Math.round((page.world.width + gap + page.plane.width) / 2);
  canvas.height = 2 * Math.round(Math.max(page.world.height, page.plane.height) / 2);
  const ctx = canvas.getContext('2d');
  const frame = (t) => {
    seek(t);
    page.positions.at(t);
    ctx.setTransform(1, 0, 0, 1, 0, 0);
    ctx.fillStyle = ui.colours.ground;
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    paintInto(ctx, 'world');
    ctx.setTransform(1, 0, 0, 1, page.world.width + gap, 0);
    paintInto(ctx, 'space');
  };
  $('film').textContent = 'Stop';
  const from = ui.t >= page.run.end ? page.run.time[0] : ui.t;
  page.stopFilm = recordFilm(canvas, from, page.run.end, page.speed, frame, (blob, why) => {
    page.stopFilm = null;
    $('film').textContent = 'Film';
    page.film = blob;
    if (blob) download(fileName(page.run, '.webm'), blob);
    else report(new DataProblem(why));
  });
}

export {svgOfMoment, saveMoment, svgOfRun, saveAnimation, film};
