// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo vo: velocity obstacles, their answers and certificates; the free velocities.
#include "figures/figure.h"
#include "support/terminal.h"
#include "verb.h"
#include "verbs/vo/answer.h"

namespace exactvo::tools {

namespace {

ExitCode show(const VoFlags& flags) {
  const VoQuestion question = question_of(flags);
  const VoAnswer answer = answer_of(question);
  if (!flags.figure.empty()) write_figure(vo_figure(answer), flags.figure);
  const std::string text = flags.json ? to_json(answer) : in_words(answer);
  print(text);
  return ExitCode::success;
}

}  // namespace

Verb vo_verb() {
  return {"vo", "One velocity obstacle or several: legs, certified half-planes, free velocities",
          "  exactvo vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))' --enclose ellipse --position 0,0 \\\n"
          "      --velocity 1,0.2 --radius 0.5 --time-horizon 2 --json --figure out/cone.svg\n"
          "  exactvo vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))' --obstacle-velocity=-0.6,0.1 \\\n"
          "      --position 0,0 --velocity 1,0.2 --radius 0.5 --time-horizon 2 --responsibility 0.5\n"
          "  exactvo vo --obstacle 'POLYGON((2 -1, 3 -1, 3 1, 2 1, 2 -1))' --free \\\n"
          "      --obstacle 'LINESTRING(-1 2, 0 2)' --max-speed 1.5 --position 0,0 \\\n"
          "      --velocity 1,0.2 --radius 0.5 --time-horizon 2 --figure out/free.svg\n",
          with_flags(declare_options, show)};
}

}  // namespace exactvo::tools
