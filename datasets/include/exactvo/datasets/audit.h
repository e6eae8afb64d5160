// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Verifies a recording in exact rational arithmetic (GMP), sharing no code with the run but plain types, two checkers
/// of certificates (vo/certificate.h, lp/certificate.h), and for what is plainly apart the distances of
/// geometry/distance.h with their bound. Ten points:
///
///  (1) scenario      the header agrees with its scenario, its scenario with the file given, the lines with the seal;
///                    radii take in the tracking error that the scenario has;
///  (2) bodies        for every robot and goal each obstacle edge lies inside a body that stands for its obstacle; what
///                    is no enclosure is made of its obstacle's vertices or edges;
///  (3) completeness  whatever a robot could meet within the step, at its greatest speed, is excluded by half-planes of
///                    its row, for the step at least: obstacles edge by edge, moving obstacles at their present
///                    velocity, robots by both halves of the pair;
///  (4) half-planes   every certified half-plane excludes the interior of its body's velocity obstacle, for the robot's
///                    radius, where the row has both, and looks a time step ahead; a robot's half takes its share,
///                    or the halves of the pair add up;
///  (5) choices       the velocity chosen satisfies the recorded half-planes and the speed bound, and the recorded
///                    multipliers prove that none is better (or, relaxed, that none violates less);
///  (6) sequence      the first row is the scenario's start; the next follows from the choice by the law of motion (bit
///                    for bit of kinematic robots, else up to named roundings); leader and moving obstacles are where
///                    their paths have them;
///  (7) motions       every motion from row to row, as it was driven, keeps clear of obstacles, of moving obstacles
///                    where they are meanwhile, and of the other robots;
///  (8) plans         every joint plan begins where its robots were, and no move of it comes nearer to an obstacle or
///                    to another robot of the plan than radii allow, up to a share of 1e-8 (plans are rounded);
///  (9) braking       where robots have an acceleration, or are on wheels: no velocity changes by more than A dt (on
///                    wheels (10) asks that), the braking time is long enough to stop, nothing is relaxed, and in every
///                    row every robot could have braked from its choice on without touching anything: its way
///                    [x, x + tau v] keeps clear of obstacles, and the ways of any two robots that brake alike keep
///                    clear of each other; each disc of the chain of a footprint keeps clear of obstacles on this way,
///                    at every heading between that of the row and the choice, as (7) requires for the step;
///  (10) kinematics   for robots on wheels, heading and wheel speeds of each row follow from the constant twist that
///                    moves the reference point as chosen; wheel speeds, their changes, turning and reversing are
///                    within their limits; the disc about the reference point holds the body at every moment,
///                    and the chain of discs its footprint. In a recording of a crowd heading and wheels follow from
///                    the first headings and from places, and discs of robots without wheels hold bodies and
///                    tracking error.
///
/// The motion of (7) is straight, the exponential curve, or the cubic through both rows (`formation::MotionLaw`).
/// Curves are cut into chords with a proven bound of how far they stray, finer and finer until each is proven clear or
/// a collision is. Straight motions and those of obstacles whose legs have rational lengths are decided exactly;
/// elsewhere what touches to within some 1e-7 of its bulge stays open.
///
/// What stays open is neither proven nor refuted: in (7) it is a failure. In (3) to (5) it is none by itself (a robot
/// whose anchor overlaps an obstacle has no promise), nor in (8) (a plan may begin too near to something), since (7)
/// proves what was driven. `not_audited` lists what is not asked. The seal has no key: it shows damage, and the points
/// show forgery.

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "exactvo/datasets/recording_file.h"

namespace exactvo::datasets {

/// The ten points, numbered in the head of this file.
enum class AuditPoint {
  scenario,      ///< (1)
  bodies,        ///< (2)
  completeness,  ///< (3)
  half_planes,   ///< (4)
  choices,       ///< (5)
  sequence,      ///< (6)
  motions,       ///< (7)
  plans,         ///< (8)
  braking,       ///< (9)
  kinematics     ///< (10)
};
/// How many points there are.
inline constexpr std::size_t kAuditPoints = 10;

/// "scenario", "bodies" and so on, as in JSON.
const char* name(AuditPoint point);

/// asked = proven + refuted + open.
struct PointCount {
  std::size_t proven = 0;    ///< hold, by exact arithmetic
  std::size_t refuted = 0;   ///< do not hold
  std::size_t open = 0;      ///< neither: exact arithmetic did not decide them
  std::size_t unlisted = 0;  ///< refuted and open ones without a line in AuditReport::findings
  /// The number of questions.
  std::size_t asked() const { return proven + refuted + open; }
};

/// The result of an audit.
struct AuditReport {
  std::array<PointCount, kAuditPoints> points{};  ///< in the order of AuditPoint
  /// The count of one point.
  PointCount& operator[](AuditPoint point) { return points[static_cast<std::size_t>(point)]; }
  /// The count of one point.
  const PointCount& operator[](AuditPoint point) const { return points[static_cast<std::size_t>(point)]; }

  std::size_t rows = 0;  ///< audited rows
  /// For each recording that ends early: where, and the findings in the rows that are there. They are no whole run.
  std::vector<std::string> cut_off;

  std::size_t half_planes = 0;  ///< of (4): certified ones of obstacles
  std::size_t unsafe = 0;       ///< of (4): refuted
  /// Motions of point (7): one robot from one row to the next; in a recording of a crowd also its place in the first
  /// row.
  std::size_t steps = 0;
  std::size_t collisions = 0;  ///< of these, nearer to an obstacle or another robot than the radii allow
  std::size_t hits_standing =
      0;                     ///< of these, a robot that stands and a moving obstacle with a max_speed that meets it
  std::size_t unproven = 0;  ///< of these, neither a collision nor proven to be none
  std::size_t inconsistencies = 0;    ///< refuted of (1) and (6)
  std::vector<std::string> findings;  ///< in words: the first refuted and the first open ones of each point

  std::size_t curved_steps = 0;  ///< of the steps, those that were not driven in a straight line
  std::size_t ends_only = 0;     ///< of the steps, motions between rows several time steps apart: only ends judged
  std::size_t left_out = 0;      ///< motions that `sample` left out; they are none of the steps
  std::size_t obstacle_questions = 0;  ///< pairs of a step and an obstacle, a moving obstacle, another robot
  std::size_t moving_questions = 0;    ///< of them, a step and a moving obstacle
  std::size_t robot_questions = 0;     ///< of them, a step and another robot
  double largest_bulge = 0.0;          ///< m: no curve strays farther from the straight way between its rows
  double largest_violation = 0.0;      ///< m/s: by which a choice violates a half-plane that must hold; 0 if all hold

  /// Pairs of robots that overlapped in the first row of a scenario with `separate`: "R1 and R2, apart from 1.5 s on",
  /// "still in overlap at the end", or "came nearer after row 7", which refutes (7).
  std::vector<std::string> started_overlapping;

  bool scenario_was_given = false;  ///< the recorded scenario was compared with a file
  bool without_pairs = false;       ///< the method promises nothing between robots (rvo, hrvo)
  bool has_staying = false;  ///< a run ended early, since robots that did not arrive stay: their goals are not checked
  bool has_places = false;   ///< a crowd's recording, which has no decisions
  bool has_measurements = false;  ///< robots measure each other, within bounds that rows keep
  bool has_tube = false;          ///< radii have a tracking error, up to which bodies are where rows have them
  bool has_movers = false;        ///< moving obstacles are assumed to be no faster than their max_speed
  bool has_sums = false;          ///< a run tracks a sum in which the choice is one term: (6) asks less

  /// Something is refuted, or a motion open.
  bool fails() const;
  /// It does not fail, and no recording ends early.
  bool clean() const;
};
/// Findings of one point and one recording: this many refuted and this many open ones; PointCount counts the others.
inline constexpr std::size_t kMostAuditFindings = 20;

/// REQUIRES: a recording that read_recording gave, or one like it. `scenario`: what it must be a recording of.
AuditReport audit(const RecordingFile& file, const formation::Scenario* scenario = nullptr);

/// The same for a file, with its seal: the digest of all lines in the last one (recording_file.h), so that a row that
/// was altered in a way that is still safe, an ulp inward, is found too. Reads it once, row by row, so that it may be a
/// pipe into which a run writes; "-" is standard input. Memory does not grow with the rows, except for the places of
/// robots: 16 bytes per robot and row, for the last 2^23 of these. If the file ends early (`cut_off`), the rows that
/// are there are audited. Throws DataError where it can't be read, or ends before the first row (E_CUT_OFF).
///
/// A recording of a crowd, FILE.evr (crowd_recording.h), has places alone: (6) is that no robot moves farther
/// than its speed allows; (7) applies to motions between rows of consecutive steps, elsewhere to the rows alone, as to
/// the first row. Where a robot touches an obstacle at a row, to within 40 u of the numbers involved (u = 2^-24),
/// it may come as much nearer in each step up to the next row, to 99 % of its radius; nearer is open. One that moves
/// must be apart at the next row. `sample`: about this many motions, spread evenly over robots and rows; 0: all. Throws
/// DataError where there is no row, or the first is not that of step 0. REQUIRES: no `scenario`, which it can't be
/// compared with.
AuditReport audit_recording(const std::filesystem::path& path, const formation::Scenario* scenario = nullptr,
                            std::size_t sample = 0);

/// Counts added up, findings joined.
void add(AuditReport& sum, const AuditReport& other);

/// What this audit did not ask, a sentence each.
std::vector<std::string> not_audited(const AuditReport& report);

/// One JSON object: `rows`, `cut_off` (whether there is one), `half_planes`, `unsafe`, `steps`, `collisions`,
/// `unproven`, `inconsistencies`, `points` (of each point `asked`, `proven`, `refuted`, `open`, `unlisted`),
/// `largest_violation`, `proved` (how much of what was proven), `not_audited`, `findings`.
std::string to_json(const AuditReport& report);

}  // namespace exactvo::datasets
