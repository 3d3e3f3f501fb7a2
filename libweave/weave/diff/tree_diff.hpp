#pragma once

#include <weave/design/design.hpp>
#include <weave/diff/change.hpp>

#include <string>
#include <vector>

namespace weave {

/// One block of the design tree that differs.
struct BlockChange {
    ChangeKind kind = ChangeKind::changed;
    std::string before, after;            ///< its names; empty where it is not there
    std::string kind_before, kind_after;  ///< `tile` and so on; empty where it is not there
    std::string text;                     ///< one line for a weaver
    Changes details;                      ///< of a changed block, or one that was renamed and changed
};

/// The trees of two designs compared.
struct TreeDiff {
    std::string root_before, root_after;  ///< the blocks that are the cloths
    bool same_root = true;                ///< they are one block, under whatever name
    std::vector<BlockChange> blocks;      ///< by name: added, removed, changed, renamed, moved

    [[nodiscard]] bool is_same() const { return same_root && blocks.empty(); }
};

/// Compares the blocks of two designs. A block is known again by its name, else by its content: the same
/// source and flips, made from the same blocks. One that is made the same way but is used in other places,
/// and in none where it was used, has moved. Both must pass check().
TreeDiff diff_trees(const Design& before, const Design& after);

}  // namespace weave
