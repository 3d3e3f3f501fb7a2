#pragma once

#include <weave/core/json_reader.hpp>
#include <weave/design/design.hpp>

namespace weave {

/// One entry of the section `blocks` of a document as JSON and back; FORMAT.md specifies it.
Json to_json(const Node& node);
/// Errors carry their place inside the node, such as `stacks[3][4]`.
Result<NodePtr> node_from_json(const Json& value);

Json to_json(const Flip& flip);
Flip flip_from_json(JsonReader& reader);

}  // namespace weave
