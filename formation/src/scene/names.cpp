// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/geometry/names.h"
#include "exactvo/formation/simulation.h"

namespace exactvo::formation {
namespace {

using geometry::name_in;
using geometry::Names;
using geometry::parse_in;
using geometry::words_in;

constexpr Names<Method, 4> kMethods{{{Method::orca, "orca"},
                                     {Method::ivo_edge, "ivo-edge"},
                                     {Method::ivo_cluster, "ivo-cluster"},
                                     {Method::ivo, "ivo"}}};
constexpr Names<Controller, 4> kControllers{{{Controller::paper_literal, "paper-literal"},
                                             {Controller::paper_signs, "paper-signs"},
                                             {Controller::corrected, "corrected"},
                                             {Controller::standard, "default"}}};
constexpr Names<Integrator, 5> kIntegrators{{{Integrator::exact, "exact"},
                                             {Integrator::euler, "euler"},
                                             {Integrator::rk4, "rk4"},
                                             {Integrator::dopri5, "dopri5"},
                                             {Integrator::rosenbrock4, "rosenbrock4"}}};
constexpr Names<Guidance, 2> kGuidances{{{Guidance::none, "none"}, {Guidance::route, "route"}}};
constexpr Names<Unreachable, 2> kUnreachables{{{Unreachable::stay, "stay"}, {Unreachable::nearest, "nearest"}}};
constexpr Names<Liveness, 3> kLivenesses{{{Liveness::off, "off"}, {Liveness::bias, "bias"}, {Liveness::plan, "plan"}}};
constexpr Names<Mode, 9> kModes{{{Mode::direct, "direct"},
                                 {Mode::guided, "guided"},
                                 {Mode::by_plan, "by-plan"},
                                 {Mode::going_back, "going-back"},
                                 {Mode::staying, "staying"},
                                 {Mode::boost, "boost"},
                                 {Mode::following, "following"},
                                 {Mode::pushing_out, "pushing-out"},
                                 {Mode::arrived, "arrived"}}};

}  // namespace

const char* name(Method m) {
  return name_in(kMethods, m);
}
const char* name(Controller c) {
  return name_in(kControllers, c);
}
const char* name(Integrator i) {
  return name_in(kIntegrators, i);
}
const char* name(Liveness l) {
  return name_in(kLivenesses, l);
}

const char* name(Guidance g) {
  return name_in(kGuidances, g);
}
const char* name(Unreachable u) {
  return name_in(kUnreachables, u);
}
const char* name(Mode m) {
  return name_in(kModes, m);
}
std::vector<std::string> method_names() {
  return words_in(kMethods);
}
std::vector<std::string> controller_names() {
  return words_in(kControllers);
}
std::vector<std::string> integrator_names() {
  return words_in(kIntegrators);
}
std::vector<std::string> liveness_names() {
  return words_in(kLivenesses);
}

std::vector<std::string> guidance_names() {
  return words_in(kGuidances);
}
bool parse(const std::string& text, Method& out) {
  return parse_in(kMethods, text, out);
}
bool parse(const std::string& text, Controller& out) {
  return parse_in(kControllers, text, out);
}
bool parse(const std::string& text, Integrator& out) {
  return parse_in(kIntegrators, text, out);
}
bool parse(const std::string& text, Liveness& out) {
  return parse_in(kLivenesses, text, out);
}

bool parse(const std::string& text, Guidance& out) {
  return parse_in(kGuidances, text, out);
}
bool parse(const std::string& text, Unreachable& out) {
  return parse_in(kUnreachables, text, out);
}

}  // namespace exactvo::formation
