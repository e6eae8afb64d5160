// SPDX-License-Identifier: GPL-3.0-or-later
// Files out of the page: the moment as SVG, the run as an animated SVG or as a WebM film.
import {SvgRecorder, escapeXml, shortName} from './draw.js';
import {colourOf} from './world.js';

function download(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

function fileName(run, ending) {
  return `${run.about.name.replace(/[^A-Za-z0-9._-]+/g, '-').slice(0, 60) || 'run'}${ending}`;
}

// Both pictures side by side with a title. `paint(ctx, which)` draws 'world' or 'space' at (0, 0).
function momentSvg(title, sizes, paint, colours) {
  const gap = 12, top = 34, height = Math.max(sizes.world.height, sizes.space.height) + top;
  const svg = new SvgRecorder(sizes.world.width + gap + sizes.space.width, height);
  svg.fillStyle = colours.ground;
  svg.fillRect(0, 0, svg.width, height);
  svg.fillStyle = colours.text;
  svg.font = '14px system-ui, sans-serif';
  svg.fillText(shortName(title, 160), 10, 22);
  let left = 0;
  for (const which of ['world', 'space']) {
    svg.save();
    svg.translate(left, top);
    svg.beginPath();
    svg.rect(0, 0, sizes[which].width, sizes[which].height);
    svg.clip();
    paint(svg, which);
    svg.restore();
    left += sizes[which].width + gap;
  }
  return svg.toString();
}

const MOST_FRAMES = 300;

// The world as an SVG that plays by itself (SMIL), also inside an img element. `still(svg)` draws what does not move.
function animatedSvg(run, view, colours, still) {
  const svg = new SvgRecorder(view.width, view.height);
  still(svg);
  const stride = Math.max(1, Math.ceil(run.rows / MOST_FRAMES));
  const rows = [];
  for (let row = 0; row < run.rows; row += stride) rows.push(row);
  if (rows[rows.length - 1] !== run.rows - 1) rows.push(run.rows - 1);
  const span = run.end - run.time[0], pause = 0.04 * span;
  const times = [...rows.map((row) => ((run.time[row] - run.time[0]) / (span + pause)).toFixed(4)), '1'].join(';');
  const list = (f) => [...rows, run.rows - 1].map((row) => f(row).toFixed(1)).join(';');
  const duration = `${(span + pause).toFixed(2)}s`;
  const animate = (attribute, values) =>
    `<animate attributeName="${attribute}" dur="${duration}" repeatCount="indefinite" keyTimes="${times}" values="${values}"/>`;
  // On wheels, within the disc: the body about the axle, and a line from there to the reference point.
  const addBody = (i, {reference, body_radius: radius, footprint}) => {
    const x = (row) => view.px(run.x(row, i)), y = (row) => view.py(run.y(row, i));
    const axleX = (row) => view.px(run.x(row, i) - reference * Math.cos(run.heading(row, i)));
    const axleY = (row) => view.py(run.y(row, i) - reference * Math.sin(run.heading(row, i)));
    const corners = (row) => {
      const c = Math.cos(run.heading(row, i)) * view.scale, s = Math.sin(run.heading(row, i)) * view.scale, points = [];
      for (let k = 0; k < footprint.length; k += 2)
        points.push(`${(axleX(row) + c * footprint[k] - s * footprint[k + 1]).toFixed(1)},${(axleY(row) - s * footprint[k] - c * footprint[k + 1]).toFixed(1)}`);
      return points.join(' ');
    };
    svg.parts.push(footprint.length ? `<polygon fill="${colourOf(colours, i)}">${animate('points', [...rows, run.rows - 1].map(corners).join(';'))}</polygon>` :
      `<circle r="${(radius * view.scale).toFixed(1)}" fill="${colourOf(colours, i)}">${animate('cx', list(axleX))}${animate('cy', list(axleY))}</circle>`,
      `<line stroke="${colours.text}" stroke-width="2">${animate('x1', list(axleX))}${animate('y1', list(axleY))}${animate('x2', list(x))}${animate('y2', list(y))}</line>`);
  };
  for (let i = 0; i < run.n; ++i) {
    const r = Math.max(2.5, run.robots[i].radius * view.scale).toFixed(1);
    svg.parts.push(`<circle r="${r}" cx="${view.px(run.x(0, i)).toFixed(1)}" cy="${view.py(run.y(0, i)).toFixed(1)}" ` +
      `fill="${colourOf(colours, i)}" fill-opacity="${run.robots[i].on_wheels ? 0.3 : 0.9}"><title>${escapeXml(shortName(run.robots[i].id, 40))}</title>` +
      animate('cx', list((row) => view.px(run.x(row, i)))) + animate('cy', list((row) => view.py(run.y(row, i)))) + '</circle>');
    if (run.robots[i].on_wheels) addBody(i, run.robots[i].on_wheels);
  }
  for (let k = 0; k < run.moving.length; ++k) {
    const moved = run.columns['moving'], at = (row) => 2 * (row * run.moving.length + k);
    const d = run.moving[k].rings.map((ring) => {
      let path = '';
      for (let j = 0; j < ring.length; j += 2)
        path += `${j ? 'L' : 'M'}${view.px(ring[j]).toFixed(1)} ${view.py(ring[j + 1]).toFixed(1)}`;
      return path + (run.moving[k].solid ? 'Z' : '');
    }).join('');
    const offsets = [...rows, run.rows - 1].map((row) =>
      `${(moved[at(row)] * view.scale).toFixed(1)} ${(-moved[at(row) + 1] * view.scale).toFixed(1)}`).join(';');
    svg.parts.push(`<path d="${d}" fill="${colours.obstacle}" stroke="${colours.obstacleLine}"><animateTransform ` +
      `attributeName="transform" type="translate" dur="${duration}" repeatCount="indefinite" keyTimes="${times}" values="${offsets}"/></path>`);
  }
  return svg.toString();
}

// Films what `frame(t)` paints on a canvas from `from` to `until` seconds, `speed` times as fast as the run. Calls
// `done(blob)`, or `done(null, why)`. Returns a function that stops.
function recordFilm(canvas, from, until, speed, frame, done) {
  const type = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4']
    .find((t) => typeof MediaRecorder !== 'undefined' && MediaRecorder.isTypeSupported(t));
  if (!type || !canvas.captureStream) {
    done(null, 'This browser cannot record films (MediaRecorder).');
    return () => {};
  }
  const recorder = new MediaRecorder(canvas.captureStream(30), {mimeType: type, videoBitsPerSecond: 6e6}), chunks = [];
  // A busy computer encodes its first picture late: until it has, the last one stays.
  const headSize = 1000, longestWait = 5000;  // bytes of a film without a picture, at most; ms
  let size = 0;
  recorder.ondataavailable = (event) => {
    chunks.push(event.data);
    size += event.data.size;
  };
  recorder.onstop = () => done(new Blob(chunks, {type}));
  recorder.start(100);
  const begin = performance.now();
  let over = false;
  const tick = () => {
    const t = Math.min(until, from + speed * (performance.now() - begin) / 1000);
    frame(t);
    const isLate = size < headSize && performance.now() < begin + 1000 * (until - from) / speed + longestWait;
    if (over || (t >= until && !isLate)) setTimeout(() => recorder.stop(), 200);
    else requestAnimationFrame(tick);
  };
  tick();
  return () => {
    over = true;
  };
}

export {download, fileName, momentSvg, animatedSvg, recordFilm};
