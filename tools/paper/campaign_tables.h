// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The two campaigns over random fields as people read them: a table, JSON, CSV, and a figure of the remedies.

#include <filesystem>
#include <string>
#include <vector>

#include "figures/figure.h"
#include "paper/campaign.h"

namespace exactvo::tools {

struct CampaignFiles {
  std::string table;  ///< for people
  std::string json;
  std::string csv;
  std::vector<Figure> figures;
};

/// Every kind of field by every method.
CampaignFiles random_fields(const CampaignOptions& options);

/// Every set of remedies over random formations, and over B0-B3 in `scenarios`.
CampaignFiles ablations(const CampaignOptions& options, const std::filesystem::path& scenarios);

/// `stem`.json, `stem`.csv and `stem`.txt in `folder`, each whole or not at all.
void write_campaign(const CampaignFiles& files, const std::filesystem::path& folder, const std::string& stem);

/// The figures' data, scripts and pictures.
void draw_campaign(const CampaignFiles& files, const std::filesystem::path& folder);

}  // namespace exactvo::tools
