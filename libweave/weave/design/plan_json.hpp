#pragma once

#include <weave/core/json_reader.hpp>
#include <weave/design/scene.hpp>
#include <weave/design/yarns.hpp>

namespace weave {

/// The sections `warp`, `weft` and `scene` of a document as JSON and back; FORMAT.md specifies them. Members
/// that are missing take their defaults; errors are recorded in the reader.
Json to_json(const WarpPlan& warp);
Json to_json(const WeftPlan& weft);
Json to_json(const Scene& scene);
WarpPlan warp_from_json(JsonReader reader);
WeftPlan weft_from_json(JsonReader reader);
Scene scene_from_json(JsonReader reader);

/// `shuttle` and so on, by value of Insertion, as documents and loom profiles write them.
const std::vector<std::string>& insertion_kinds();

/// Reads a sequence member, recording what is wrong with it.
Sequence sequence_member(JsonReader& reader, const std::string& key, std::size_t below,
                         const Sequence& fallback);

}  // namespace weave
