// SPDX-License-Identifier: GPL-3.0-or-later
// Claims, one JSON object a line on standard input (tests/browser/certificate_cases.cpp), judged by the checker of the
// page: node page_claims.mjs FOLDER_OF_PROOF_JS prints 0 or 1 a line.
import {createInterface} from 'node:readline';
import {pathToFileURL} from 'node:url';

const {checkDecision, checkHalfPlane} = await import(pathToFileURL(`${process.argv[2]}/proof.js`));
for await (const line of createInterface({input: process.stdin})) {
  const c = JSON.parse(line);
  const {ok} = c.claim ? checkHalfPlane(c.claim) : checkDecision(c.problem, c.answer);
  process.stdout.write(ok ? '1\n' : '0\n');
}
