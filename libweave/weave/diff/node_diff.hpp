#pragma once

#include <weave/design/design.hpp>
#include <weave/diff/change.hpp>

#include <string>

namespace weave {

/// `tile`, `card` and so on, as documents call the kind.
const std::string& kind_of(const Node& node);

/// What a block is made from and what is done to it, in a few words: `'twill' repeated 7 times along the
/// warp`.
std::string in_words(const Node& node);

/// A flip: `pick 3, end 4: weft over`.
std::string in_words(const Flip& flip);

/// What differs between a block and the block that it was; nothing where they are equal. `where` is the
/// block's place, `blocks.toe`. Names of the blocks that it is made from are to be those of the design after.
Changes diff_nodes(const Node& before, const Node& after, const std::string& where);

}  // namespace weave
