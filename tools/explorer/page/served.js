// SPDX-License-Identifier: GPL-3.0-or-later
// Only in pages that exactvo serve gives out: questions to the server that the page came from.
'use strict';
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
    throw new Error(why.expected ? `${why.place ? `${why.place}: ` : ''}found ${why.found}, expected ${why.expected}` : why.error || `the server answered ${response.status}`);
  },
};
