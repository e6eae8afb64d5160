// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Counts over random fields (datasets/random_fields.h): how many are reached and safe, by method or by set of
/// controller options. Resumable, and the same bytes for any number of threads. As people read them: a table,
/// JSON, CSV, and a figure of the controller options.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "exactvo/datasets/random_fields.h"
#include "exactvo/formation/metrics.h"
#include "exactvo/formation/simulation.h"
#include "figures/figure.h"

namespace exactvo::tools {

/// One way of running one kind of field.
struct Variant {
  datasets::FieldKind kind = datasets::FieldKind::convex;
  std::string name;  ///< of the method, controller or set of controller options
  formation::SimulationOptions options;
};

/// The kinds against the methods: convex and open by all four, formations by the default controller over three (of
/// formations ivo and ivo-cluster are the same).
std::vector<Variant> random_field_variants();

/// Formations by every set of controller options.
std::vector<Variant> option_variants();

struct FieldResult {
  std::uint64_t field = 0;
  bool reached = false;
  bool safe = false;                                       ///< formation::is_safe
  double last_arrival = 0.0;                               ///< s; nan where not reached
  double obstacle_clearance = 0.0, robot_clearance = 0.0;  ///< m, swept; nan where there is nothing to be clear of
  std::size_t uncertified = 0;
  double formation_error = 0.0;  ///< m, at the end; nan without a formation
  double jitter = 0.0;           ///< m/s^2; nan where a robot left every bound
  bool good() const { return reached && safe; }
};

struct VariantResult {
  std::string kind;
  std::string name;
  std::vector<FieldResult> fields;

  std::size_t good() const;
  std::size_t reached() const;
  std::size_t safe() const;
  double latest_arrival() const;  ///< s, of the good ones; nan where there are none
  double median_jitter() const;   ///< m/s^2, over all that have one
  std::size_t without_jitter() const;
};

// --- Long work in parts: each part is a file that appears whole or not at all, so that what was killed goes on where
// it stopped. Which part is done by which thread, and when, leaves no trace in the results ---

struct PartTask {
  std::string name;                   ///< of its file; unique
  std::function<std::string()> work;  ///< gives the part's text; called from any thread
};

/// Does every part that is not in the folder yet, which is created where missing, on this many threads. `key`: what a
/// part depends on beside its name; one made under another key is done again. Returns the texts of all, in the tasks'
/// order. Throws Interrupted after a request to stop, with the parts kept that are done; what a task throws goes
/// through.
std::vector<std::string> run_parts(const std::vector<PartTask>& tasks, const std::filesystem::path& folder,
                                   const std::string& key, unsigned jobs);

/// The key of everything that this very program computes: the digest of its own file where the system shows it, else
/// its version, commit and compiler.
std::string program_key();

struct CampaignOptions {
  std::filesystem::path folder;  ///< for the parts
  std::uint64_t fields = 0;      ///< 0 .. fields - 1 of each variant
  std::uint64_t seed = datasets::kFieldSeed;
  unsigned jobs = 1;
};

std::vector<VariantResult> run_campaign(const std::vector<Variant>& variants, const CampaignOptions& options);

/// A row a field: kind, variant, field, what FieldResult has.
std::string campaign_csv(const std::vector<VariantResult>& results);

/// `what` names the file; counts a variant, the numbers of the fields that were not good, the seed and the program.
/// Nothing in it depends on when or by how many threads it was made.
std::string campaign_json(const std::string& what, const std::vector<VariantResult>& results,
                          const CampaignOptions& options);

struct CampaignFiles {
  std::string table;  ///< for people
  std::string json;
  std::string csv;
  std::vector<Figure> figures;
};

/// Every kind of field by every method.
CampaignFiles random_fields(const CampaignOptions& options);

/// Every set of controller options over random formations, and over B0-B3 in `scenarios`.
CampaignFiles ablations(const CampaignOptions& options, const std::filesystem::path& scenarios);

/// `stem`.json, `stem`.csv and `stem`.txt in `folder`, each whole or not at all.
void write_campaign(const CampaignFiles& files, const std::filesystem::path& folder, const std::string& stem);

}  // namespace exactvo::tools
