#pragma once

#include <weave/design/design.hpp>

#include <string>
#include <variant>

namespace weave {

/// Edits are data: they can be kept, sent and undone. Each names the least that it changes.
struct PutBlock {
    std::string name;
    NodePtr node;
};
/// Refused while another block is made from it, or it is the root.
struct RemoveBlock {
    std::string name;
};
/// Every reference follows.
struct RenameBlock {
    std::string from, to;
};
struct SetRoot {
    std::string name;
};
/// Adds a flip after those of a block; where the last of them is of the same crossing it takes its place. What
/// the flips before it came to stays as it was, so that no pixel but its own changes.
struct PutFlip {
    std::string block;
    Flip flip;
};
/// Takes out every flip of this crossing. Those after it may come to something else.
struct RemoveFlip {
    std::string block;
    std::size_t pick = 0, end = 0;
};
struct SetTitle {
    std::string title, notes;
};
struct SetWarp {
    WarpPlan warp;
};
struct SetWeft {
    WeftPlan weft;
};
struct SetScene {
    Scene scene;
};

using Edit = std::variant<PutBlock, RemoveBlock, RenameBlock, SetRoot, PutFlip, RemoveFlip, SetTitle, SetWarp,
                          SetWeft, SetScene>;

/// Makes an edit and gives the edit that undoes it exactly. On an error (unknown block, a cycle that would
/// arise, a block still in use) the design is unchanged.
Result<Edit> apply_edit(Design& design, const Edit& edit);

/// An edit as one JSON object and back, for journals and messages.
Json to_json(const Edit& edit);
Result<Edit> edit_from_json(const Json& value);

}  // namespace weave
