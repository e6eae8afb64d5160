// SPDX-License-Identifier: GPL-3.0-or-later
// What pictures share: colours, a view of the plane, and a recorder of canvas calls that writes SVG, so that the same
// function draws on the screen and into a file.

// Colours that colour-blind readers tell apart (Okabe and Ito, 2008), for a light and a dark ground.
const PALETTES = {
  light: {
    ground: '#ffffff', text: '#1b1e23', faint: '#5d6570', grid: '#e6e8ec', axis: '#aab0b9', obstacle: '#c9ccd2',
    obstacleLine: '#3f444d', enclosure: '#8a6d00', allowed: '#d4efdf', givenAway: '#fbe7bd', cone: '#6f7785', coneRobot: '#b0578a',
    active: '#c24e00', slack: '#848b95', preferred: '#0057b8', chosen: '#007a54', velocity: '#3a3f47', bad: '#d00000',
    selected: '#1b1e23', label: '#ffffffd8',
    series: ['#0072B2', '#D55E00', '#009E73', '#CC79A7', '#B87A00', '#3a8fc0', '#555555'],
  },
  dark: {
    ground: '#14171c', text: '#e8eaee', faint: '#a0a8b4', grid: '#262b33', axis: '#565e6a', obstacle: '#3a404a',
    obstacleLine: '#9aa3b0', enclosure: '#e0b93b', allowed: '#173d2e', givenAway: '#453715', cone: '#98a1ae', coneRobot: '#e39cc4',
    active: '#ff8c3a', slack: '#7f8793', preferred: '#6cb6ff', chosen: '#2fd39a', velocity: '#c8cdd5', bad: '#ff6060',
    selected: '#ffffff', label: '#14171cd8',
    series: ['#56B4E9', '#FF8C3A', '#2fd39a', '#E39CC4', '#F0B429', '#7fc4ee', '#b0b0b0'],
  },
};

// The plane on a rectangle of the screen: metres (or m/s) to pixels, y upwards.
class View {
  constructor() {
    this.cx = 0;
    this.cy = 0;
    this.scale = 40;  // pixels a unit
    this.width = 100;
    this.height = 100;
  }
  px(x) {
    return this.width / 2 + (x - this.cx) * this.scale;
  }
  py(y) {
    return this.height / 2 - (y - this.cy) * this.scale;
  }
  x(px) {
    return this.cx + (px - this.width / 2) / this.scale;
  }
  y(py) {
    return this.cy - (py - this.height / 2) / this.scale;
  }
  fit(low, high, margin) {
    this.cx = (low[0] + high[0]) / 2;
    this.cy = (low[1] + high[1]) / 2;
    const width = Math.max(high[0] - low[0], 1e-6), height = Math.max(high[1] - low[1], 1e-6);
    this.scale = Math.max(1e-6, Math.min((this.width - 2 * margin) / width, (this.height - 2 * margin) / height));
  }
  zoomAt(px, py, factor) {
    const x = this.x(px), y = this.y(py);
    this.scale = Math.max(1e-3, Math.min(1e5, this.scale * factor));
    this.cx += x - this.x(px);
    this.cy += y - this.y(py);
  }
}

// 1, 2 or 5 times a power of ten, so that steps are at least `pixels` apart.
function tickStep(scale, pixels) {
  const least = pixels / scale, power = 10 ** Math.floor(Math.log10(least));
  for (const factor of [1, 2, 5, 10]) if (factor * power >= least) return factor * power;
  return 10 * power;
}

function shortNumber(x, step) {
  const digits = Math.max(0, Math.min(9, -Math.floor(Math.log10(step) + 1e-9)));
  return (Math.abs(x) < step / 2 ? 0 : x).toFixed(digits);
}

// Grid lines with numbers at the lower and left rim.
function drawGrid(ctx, view, colours, unit) {
  const step = tickStep(view.scale, 56);
  ctx.lineWidth = 1;
  ctx.font = '11px system-ui, sans-serif';
  ctx.textBaseline = 'alphabetic';
  const first = (low) => Math.ceil(low / step) * step;
  for (let x = first(view.x(0)); x <= view.x(view.width); x += step) {
    ctx.strokeStyle = Math.abs(x) < step / 2 ? colours.axis : colours.grid;
    line(ctx, view.px(x), 0, view.px(x), view.height);
  }
  for (let y = first(view.y(view.height)); y <= view.y(0); y += step) {
    ctx.strokeStyle = Math.abs(y) < step / 2 ? colours.axis : colours.grid;
    line(ctx, 0, view.py(y), view.width, view.py(y));
  }
  return () => {  // numbers go on top of what is drawn in between
    ctx.font = '11px system-ui, sans-serif';
    ctx.textBaseline = 'alphabetic';
    ctx.textAlign = 'center';
    for (let x = first(view.x(40)); x <= view.x(view.width - 30); x += step)
      label(ctx, shortNumber(x, step), view.px(x), view.height - 6, colours.faint, colours.label);
    ctx.textAlign = 'left';
    for (let y = first(view.y(view.height - 24)); y <= view.y(24); y += step)
      label(ctx, shortNumber(y, step), 6, view.py(y) + 4, colours.faint, colours.label);
    label(ctx, unit, 6, 15, colours.faint, colours.label);
    ctx.textAlign = 'start';
  };
}

function line(ctx, x1, y1, x2, y2) {
  ctx.beginPath();
  ctx.moveTo(x1, y1);
  ctx.lineTo(x2, y2);
  ctx.stroke();
}

// Text with a rim in the colour of the ground.
function label(ctx, text, x, y, colour, rim) {
  ctx.lineWidth = 3;
  ctx.lineJoin = 'round';
  ctx.strokeStyle = rim;
  ctx.strokeText(text, x, y);
  ctx.fillStyle = colour;
  ctx.fillText(text, x, y);
}

function tracePoints(ctx, view, points, closed) {
  ctx.beginPath();
  for (let i = 0; i < points.length; ++i) {
    const x = view.px(points[i][0]), y = view.py(points[i][1]);
    if (i === 0) ctx.moveTo(x, y);
    else ctx.lineTo(x, y);
  }
  if (closed) ctx.closePath();
}

// With its tip up.
function triangle(ctx, x, y, reach) {
  ctx.beginPath();
  ctx.moveTo(x - reach, y + 0.7 * reach);
  ctx.lineTo(x + reach, y + 0.7 * reach);
  ctx.lineTo(x, y - reach);
  ctx.closePath();
  ctx.stroke();
}

function arrow(ctx, x1, y1, x2, y2, head) {
  const length = Math.hypot(x2 - x1, y2 - y1);
  line(ctx, x1, y1, x2, y2);
  if (length < 2) return;
  const size = Math.min(head, length), ux = (x2 - x1) / length, uy = (y2 - y1) / length;
  ctx.beginPath();
  ctx.moveTo(x2, y2);
  ctx.lineTo(x2 - size * ux + 0.4 * size * uy, y2 - size * uy - 0.4 * size * ux);
  ctx.lineTo(x2 - size * ux - 0.4 * size * uy, y2 - size * uy + 0.4 * size * ux);
  ctx.closePath();
  ctx.fill();
}

// The part of the canvas interface that the pictures use, written down as SVG.
class SvgRecorder {
  constructor(width, height) {
    this.width = width;
    this.height = height;
    this.parts = [];
    this.d = '';
    this.dash = [];
    this.stack = [];
    Object.assign(this, {fillStyle: '#000', strokeStyle: '#000', lineWidth: 1, globalAlpha: 1, font: '12px sans-serif',
      textAlign: 'start', textBaseline: 'alphabetic', lineJoin: 'miter', lineCap: 'butt', dx: 0, dy: 0});
  }
  number(x) {
    return String(Math.round(x * 100) / 100);
  }
  at(x, y) {
    return `${this.number(x + this.dx)} ${this.number(y + this.dy)}`;
  }
  save() {
    this.stack.push([this.fillStyle, this.strokeStyle, this.lineWidth, this.globalAlpha, this.font, this.textAlign,
      this.textBaseline, this.dash, this.dx, this.dy, this.parts.length]);
    this.parts.push('');
  }
  restore() {
    const state = this.stack.pop(), begin = state.pop();
    [this.fillStyle, this.strokeStyle, this.lineWidth, this.globalAlpha, this.font, this.textAlign, this.textBaseline,
      this.dash, this.dx, this.dy] = state;
    if (this.parts[begin] !== '') this.parts.push('</g>');
  }
  translate(x, y) {
    this.dx += x;
    this.dy += y;
  }
  // Clips to a rectangle, until restore().
  clip() {
    const id = `clip${this.parts.length}`;
    const begin = this.stack[this.stack.length - 1][10];
    this.parts[begin] = `<clipPath id="${id}"><path d="${this.d}"/></clipPath><g clip-path="url(#${id})">`;
  }
  setLineDash(dash) {
    this.dash = dash;
  }
  beginPath() {
    this.d = '';
  }
  moveTo(x, y) {
    this.d += `M${this.at(x, y)}`;
  }
  lineTo(x, y) {
    this.d += `L${this.at(x, y)}`;
  }
  closePath() {
    this.d += 'Z';
  }
  rect(x, y, w, h) {
    this.moveTo(x, y);
    this.lineTo(x + w, y);
    this.lineTo(x + w, y + h);
    this.lineTo(x, y + h);
    this.closePath();
  }
  // Whole circles only.
  arc(x, y, r) {
    const radius = this.number(r);
    this.d += `M${this.at(x + r, y)}A${radius} ${radius} 0 1 0 ${this.at(x - r, y)}A${radius} ${radius} 0 1 0 ${this.at(x + r, y)}Z`;
  }
  fill(rule) {
    const evenOdd = rule === 'evenodd' ? ' fill-rule="evenodd"' : '';
    this.parts.push(`<path d="${this.d}" fill="${this.fillStyle}"${evenOdd}${this.opacity()}/>`);
  }
  stroke() {
    const dash = this.dash.length ? ` stroke-dasharray="${this.dash.join(' ')}"` : '';
    this.parts.push(`<path d="${this.d}" fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}"` +
      ` stroke-linejoin="${this.lineJoin}" stroke-linecap="${this.lineCap}"${dash}${this.opacity()}/>`);
  }
  fillRect(x, y, w, h) {
    this.beginPath();
    this.rect(x, y, w, h);
    this.fill();
  }
  fillText(text, x, y) {
    this.text(text, x, y, `fill="${this.fillStyle}"`);
  }
  strokeText(text, x, y) {
    this.text(text, x, y, `fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}" stroke-linejoin="round"`);
  }
  text(text, x, y, paint) {
    const anchor = {center: 'middle', right: 'end', end: 'end'}[this.textAlign] || 'start';
    const [size, ...family] = this.font.replace('bold ', '').split(' ');
    const weight = this.font.startsWith('bold') ? ' font-weight="bold"' : '';
    const shift = this.textBaseline === 'middle' ? 4 : 0;
    this.parts.push(`<text x="${this.number(x + this.dx)}" y="${this.number(y + this.dy + shift)}" text-anchor="${anchor}"` +
      ` font-size="${size}" font-family="${escapeXml(family.join(' '))}"${weight} ${paint}${this.opacity()}>${escapeXml(text)}</text>`);
  }
  measureText(text) {
    return {width: 6.2 * text.length};
  }
  opacity() {
    return this.globalAlpha < 1 ? ` opacity="${this.globalAlpha}"` : '';
  }
  toString() {
    return `<svg xmlns="http://www.w3.org/2000/svg" width="${this.width}" height="${this.height}" ` +
      `viewBox="0 0 ${this.width} ${this.height}">\n${this.parts.filter(Boolean).join('\n')}\n</svg>\n`;
  }
}

// Characters that XML has no place for go too.
function escapeXml(text) {
  return String(text).replace(/[^\t\n\r\u{20}-\u{d7ff}\u{e000}-\u{fffd}\u{10000}-\u{10ffff}]/gu, '\ufffd')
    .replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/>/g, '&gt;').replace(/"/g, '&quot;');
}

// A name in a picture: on one line, short.
function shortName(text, most) {
  const plain = String(text).replace(/[\u0000-\u001f\u007f-\u009f\u2028\u2029\u202a-\u202e\u2066-\u2069]/g, ' ');
  return plain.length > most ? plain.slice(0, most - 1) + '\u2026' : plain;
}

export {PALETTES, View, SvgRecorder, tickStep, shortNumber, drawGrid, line, label, tracePoints, arrow, triangle, escapeXml, shortName};
