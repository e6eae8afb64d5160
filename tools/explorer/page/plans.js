// SPDX-License-Identifier: GPL-3.0-or-later
// Joint plans: of robots that waited for each other, the moves that each makes (docs/guide/liveness.md).

// The plan that a robot goes by at a time; null where it goes by none.
function planAt(run, robot, t) {
  const mode = run.head.modes[run.columns['mode'][run.rowAt(t) * run.n + robot]];
  if (mode !== 'by-plan' && mode !== 'going-back') return null;
  let found = null;
  for (const plan of run.head.plans || []) if (plan.time <= t + 1e-9 && plan.robots.includes(robot)) found = plan;
  return found;
}

// The places of each robot of a plan in order, from where it was when the plan begins: [{robot, places: [x, y, x, y, ...]}].
function pathsOf(plan) {
  if (plan.paths) return plan.paths;
  const of = new Map(plan.robots.map((robot, k) => [robot, [plan.starts[2 * k], plan.starts[2 * k + 1]]]));
  for (let k = 0; k < plan.movers.length; ++k) of.get(plan.movers[k]).push(plan.places[2 * k], plan.places[2 * k + 1]);
  plan.paths = [...of].map(([robot, places]) => ({robot, places}));
  return plan.paths;
}

// Draws the plan that the chosen robot goes by: its own path strongly, those of the others faintly, a dot at each place.
function drawPlan(ctx, view, colours, run, ui) {
  const plan = planAt(run, ui.robot, ui.t);
  if (!plan) return;
  ctx.setLineDash([2, 3]);
  for (const {robot, places} of pathsOf(plan)) {
    ctx.strokeStyle = ctx.fillStyle = colours.series[robot % colours.series.length];
    ctx.globalAlpha = robot === ui.robot ? 1 : 0.35;
    ctx.lineWidth = robot === ui.robot ? 2.4 : 1.2;
    ctx.beginPath();
    for (let k = 0; k < places.length; k += 2) {
      if (k === 0) ctx.moveTo(view.px(places[0]), view.py(places[1]));
      else ctx.lineTo(view.px(places[k]), view.py(places[k + 1]));
    }
    ctx.stroke();
    for (let k = 2; k < places.length; k += 2) {
      ctx.beginPath();
      ctx.arc(view.px(places[k]), view.py(places[k + 1]), robot === ui.robot ? 3 : 1.6, 0, 2 * Math.PI);
      ctx.fill();
    }
  }
  ctx.globalAlpha = 1;
  ctx.setLineDash([]);
}

// "made at 12.5 s for 14 robots: 307 moves, 21 of its own"; empty where it goes by none.
function planWords(run, robot, t) {
  const plan = planAt(run, robot, t);
  if (!plan) return '';
  const own = plan.movers.filter((mover) => mover === robot).length;
  return `made at ${Number(plan.time.toFixed(3))} s for ${plan.robots.length} robot${plan.robots.length === 1 ? '' : 's'}: ` +
    `${plan.movers.length} moves, ${own} of its own` + (plan.from < plan.time ? `; begins where they were at ${Number(plan.from.toFixed(3))} s` : '');
}

export {planAt, pathsOf, drawPlan, planWords};
