#pragma once

#include <weave/core/json.hpp>

#include <loomlink/export/package.hpp>

/// What the manifest of a release says, part by part; no interface of the folder.
namespace weave::loomlink {

inline constexpr const char* layout_label =
    "layout-compatible with observed files, not certified by the maker";

/// One entry of `files`: path, size, sha256, format, certified, label.
Json file_entry(const PackageFile& file);

/// `reading` of a controller's file: polarity, order of records, bits and hooks, the places of pick 1 and end
/// 1, face.
Json controller_reading(const HookPlan& plan, const LoomProfile& profile, std::size_t ends);

/// `hooks`: what each hook is for, as ranges from 0 with both ends included.
Json hooks_entry(const HookPlan& plan, const LoomProfile& profile, std::size_t ends);

/// `feeders`: how the file selects them, and which feeder of the loom each of the design's is.
Json feeders_entry(const weave::Design& design, const LoomProfile& profile, const FeederMap& feeders);

/// `take_up`: on how many picks the cloth stands still, and whether the file stops it.
Json take_up_entry(const std::vector<Pick>& picks, const LoomProfile& profile);

}  // namespace weave::loomlink
