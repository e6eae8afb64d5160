// SPDX-License-Identifier: GPL-3.0-or-later
// What the signs of the two pictures mean: each drawn as it is there, with a word.
import {arrow, line, triangle} from './draw.js';

function entry(text, colours, draw) {
  const span = document.createElement('span'), canvas = document.createElement('canvas');
  canvas.width = 52;
  canvas.height = 28;
  const ctx = canvas.getContext('2d');
  ctx.scale(2, 2);
  draw(ctx, colours);
  span.append(canvas, text);
  return span;
}

function stroked(colour, width, dash) {
  return (ctx, colours) => {
    ctx.strokeStyle = colours[colour];
    ctx.lineWidth = width;
    ctx.setLineDash(dash);
    line(ctx, 1, 7, 25, 7);
    ctx.setLineDash([]);
  };
}

function filled(colour, alpha = 1) {
  return (ctx, colours) => {
    ctx.fillStyle = colours[colour];
    ctx.globalAlpha = alpha;
    ctx.fillRect(2, 1, 22, 12);
    ctx.globalAlpha = 1;
  };
}

function arrowed(colour, width, dash) {
  return (ctx, colours) => {
    ctx.strokeStyle = ctx.fillStyle = colours[colour];
    ctx.lineWidth = width;
    ctx.setLineDash(dash);
    arrow(ctx, 1, 7, 25, 7, 8);
  };
}

// A cone with its cut-off, in the colour of its kind.
function coned(colour) {
  return (ctx, colours) => {
    filled(colour, 0.25)(ctx, colours);
    ctx.strokeStyle = colours[colour];
    ctx.lineWidth = 2.6;
    line(ctx, 3, 1, 3, 13);
  };
}

function hatched(colour, dash = []) {
  return (ctx, colours) => {
    ctx.strokeStyle = colours[colour];
    ctx.lineWidth = 2;
    ctx.setLineDash(dash);
    line(ctx, 1, 4, 25, 4);
    ctx.setLineDash([]);
    ctx.lineWidth = 1;
    for (let x = 3; x < 24; x += 5) line(ctx, x, 4, x + 4, 10);
  };
}

function crossed(isOutOfReach) {
  return (ctx, colours) => {
    ctx.strokeStyle = colours.series[0];
    ctx.lineWidth = 1.5;
    line(ctx, 9, 3, 17, 11);
    line(ctx, 9, 11, 17, 3);
    if (!isOutOfReach) return;
    ctx.strokeStyle = colours.bad;
    ctx.beginPath();
    ctx.arc(13, 7, 6, 0, 2 * Math.PI);
    ctx.stroke();
  };
}

function squared(ctx, colours) {
  ctx.strokeStyle = colours.preferred;
  ctx.strokeRect(10, 4, 6, 6);
}

function plussed(ctx, colours) {
  ctx.strokeStyle = colours.bad;
  ctx.lineWidth = 2.5;
  line(ctx, 7, 7, 19, 7);
  line(ctx, 13, 1, 13, 13);
}

function triangled(ctx, colours) {
  ctx.strokeStyle = colours.active;
  ctx.lineWidth = 1.8;
  triangle(ctx, 13, 8, 6);
}

// `isCheck`: of trajectories that were checked, which have neither goals nor decisions.
function worldLegend(element, colours, isServed, isCheck, hasMovers) {
  const entries = isCheck ? [['collision', plussed]] : [['goal', crossed(false)], ['goal out of reach', crossed(true)], ['route', stroked('text', 1.4, [8, 3, 2, 3])], ['path of a joint plan', stroked('text', 2.4, [2, 3])],
    ['enclosure that the robot sees', stroked('enclosure', 1.4, [5, 4])], ['facade, piece', stroked('enclosure', 1.4, [])],
    ['obstacle that presses on the robot', stroked('active', 4, [])], ['from a robot to one that presses on it', arrowed('active', 1.4, [3, 3])], ['from a robot to one that it waits for', arrowed('bad', 3, [])],
    ['collision', plussed]];
  if (hasMovers) entries.push(['it stood and was hit', triangled]);
  if (isServed) entries.push(['drag it', squared]);
  element.replaceChildren(...entries.map(([text, draw]) => entry(text, colours, draw)));
}

function spaceLegend(element, colours) {
  const entries = [['velocity obstacle, its cut-off thick', coned('cone')], ['of a robot or what moves', coned('coneRobot')],
    ['half-plane, hatched where forbidden', hatched('slack')], ['binding', hatched('active')], ['violated', hatched('bad', [6, 3])],
    ['allowed', filled('allowed')],
    ['free, given away', filled('givenAway')], ['speed bound', stroked('text', 1.3, [7, 5])]];
  element.replaceChildren(...entries.map(([text, draw]) => entry(text, colours, draw)));
}

export {worldLegend, spaceLegend};
