// SPDX-License-Identifier: GPL-3.0-or-later
#include "verb.h"

namespace exactvo::tools {

// One line a verb, in the order of --help.
Verb simulate_verb();
Verb explain_verb();
Verb draw_verb();
Verb view_verb();
Verb serve_verb();
Verb paper_verb();
Verb lp_verb();
Verb vo_verb();
Verb audit_verb();
Verb check_verb();
Verb monitor_verb();
Verb trap_verb();
Verb route_verb();
Verb validate_verb();
Verb repair_verb();
Verb convert_verb();
Verb batch_verb();
Verb generate_verb();
Verb segment_verb();

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = {
      simulate_verb(), explain_verb(), draw_verb(),  view_verb(),     serve_verb(),  paper_verb(), lp_verb(),
      vo_verb(),       audit_verb(),   check_verb(), monitor_verb(),  trap_verb(),   route_verb(), validate_verb(),
      repair_verb(),   convert_verb(), batch_verb(), generate_verb(), segment_verb()};
  return all;
}

}  // namespace exactvo::tools
