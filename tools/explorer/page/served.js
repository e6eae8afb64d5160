// SPDX-License-Identifier: GPL-3.0-or-later
// Only in pages that exactvo serve gives out: questions to the server that the page came from.
'use strict';

// "robot 'R1', position" of /robots/0/position: a user who drags knows names, not places in a file.
function exactvoPlace(place, scenario) {
  const parts = place.split('/').slice(1).filter((part, k) => k > 0 || part !== 'scenario');
  const kinds = {robots: 'robot', obstacles: 'obstacle', moving_obstacles: 'moving obstacle'};
  const one = kinds[parts[0]] && (scenario[parts[0]] || [])[Number(parts[1])];
  const words = one ? [`${kinds[parts[0]]} '${String(one.id ?? Number(parts[1]) + 1).slice(0, 60)}'`, ...parts.slice(2)] : parts;
  return words.map((word) => (/^[a-z_]+$/.test(word) ? word.replace(/_/g, ' ') : word)).join(', ');
}

// The keys that an expectation names, such as /horizons/least.
function exactvoKeysInWords(text) {
  return text.replace(/(^|\s)\/([a-z_]+(?:\/[a-z_]+)*)/g, (all, before, keys) => before + keys.split('/').reverse().join(' of ').replace(/_/g, ' '));
}

window.exactvoServer = {
  // `what`: decide, free or run. {bytes, took: {compute, processor}} (ms), or throws an Error with the server's words.
  async ask(what, question) {
    let response;
    try {
      response = await fetch(what, {method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(question)});
    } catch (error) {
      throw new Error('exactvo serve does not answer any more: start it again, and open its new address.');
    }
    const took = {};
    for (const part of (response.headers.get('Server-Timing') || '').split(',')) {
      const [name, duration] = part.trim().split(';dur=');
      if (duration !== undefined) took[name] = Number(duration);
    }
    if (response.ok) return {bytes: await response.arrayBuffer(), took};
    const why = await response.json().catch(() => ({}));
    if (!why.expected) throw new Error(why.error || `the server answered ${response.status}`);
    const place = exactvoPlace(why.place || '', question.scenario || {});
    throw new Error(`${place ? `${place}: ` : ''}found ${why.found}, expected ${exactvoKeysInWords(why.expected)}`);
  },
};
