#pragma once

#include <weave/block/extent.hpp>
#include <weave/design/design.hpp>

#include <cstddef>
#include <vector>

namespace weave {

/// At most what the block of a node, before its flips, will be and hold. Presets and slices count nothing:
/// they are small, or as small as the document that holds them; nor do the few stacks of a card, nor a block
/// that its own operation refuses, with better words. `children` are those of the blocks that it is made
/// from, or more than those.
Extent extent_to_be(const NodeSource& source, const std::vector<Extent>& children);

/// A block as far as its own counts tell.
struct SizedPart {
    const BlockGrid* grid = nullptr;
    std::size_t height = 0;
};

/// What the operation of a node refuses for the counts of its children alone, so that it can be said before
/// anything is laid out, and before it is asked what fits into memory.
Status check_counts_fit(const NodeSource& source, const std::vector<SizedPart>& children);

/// At most what is held, beside its children, while the block of this node is made, in units of 4 bytes.
std::size_t needed_for(const Node& node, const std::vector<Extent>& children);

}  // namespace weave
