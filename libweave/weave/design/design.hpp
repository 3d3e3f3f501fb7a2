#pragma once

#include <weave/block/block.hpp>
#include <weave/block/flip.hpp>
#include <weave/block/operations.hpp>
#include <weave/block/preset.hpp>
#include <weave/block/slice.hpp>
#include <weave/core/json.hpp>
#include <weave/design/scene.hpp>
#include <weave/design/yarns.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace weave {

/// A leaf written as stacks.
struct StacksLeaf {
    BlockPtr block;
};

/// A leaf that is a card image read with these t and p, which repeat over it.
struct CardLeaf {
    std::shared_ptr<const CardImage> card;
    std::vector<std::uint32_t> t{1}, p{1};
};

struct PresetLeaf {
    Preset preset;
};

struct SliceLeaf {
    Slice slice;
};

/// `of` repeated x, y and z times.
struct TileOperation {
    std::string of;
    std::size_t x = 1, y = 1, z = 1;
};

/// `other` on a face of `of`.
struct AttachOperation {
    std::string of, other;
    Face face = Face::plus_x;
};

struct StencilOperation {
    std::vector<std::string> of;  ///< the blocks that the map numbers
    std::shared_ptr<const StencilMap> map;
};

/// New order of the picks of one row (or the ends of one column), see renumber_row.
struct RenumberOperation {
    std::string of;
    System system = System::weft;
    std::size_t line = 0;
    std::vector<std::size_t> order;
};

using NodeSource = std::variant<StacksLeaf, CardLeaf, PresetLeaf, SliceLeaf, TileOperation, AttachOperation,
                                StencilOperation, RenumberOperation>;

/// One named block of a design: what it is made from, and the flips on top. Nodes never change, edits replace
/// them.
struct Node {
    NodeSource source;
    std::vector<Flip> flips;  ///< applied again whenever what the node is made from changes
};
using NodePtr = std::shared_ptr<const Node>;

/// The names of the blocks that a node is made from, in order, repetitions included.
std::vector<std::string> children_of(const Node& node);

/// Equal in meaning: the same source and flips.
bool operator==(const Node& a, const Node& b);

/// A whole design: named blocks that form a directed graph without cycles, one of them the cloth, and how it
/// is woven.
struct Design {
    std::string title;
    std::string notes;
    std::string root;  ///< the block that is the cloth
    std::map<std::string, NodePtr> blocks;
    WarpPlan warp = default_warp();
    WeftPlan weft = default_weft();
    Scene scene;
    Json view = Json::object();  ///< whatever a program with windows wants to find again; never hashed

    friend bool operator==(const Design& a, const Design& b);
};

/// Limits of what a document holds, so that whatever is written can be read again.
inline constexpr std::size_t most_blocks = 4096;
inline constexpr std::size_t longest_title = 1000, longest_notes = 65536, longest_yarn_name = 200,
                             longest_family = 100;                  ///< bytes
inline constexpr std::size_t most_stencilled = 65535;               ///< blocks that one stencil numbers
inline constexpr std::size_t most_times = most_yarns;                ///< of a tile in each direction
inline constexpr std::int64_t most_option = std::int64_t{1} << 40;  ///< of a preset, either side of 0

/// Block names: 1 to 64 letters, digits, '-', '_' or '.', the first a letter or digit.
Status check_block_name(const std::string& name);

/// Title and notes as a document may hold them: UTF-8, and not too long.
Status check_texts(const std::string& title, const std::string& notes);

/// What can be said of one block without the others: numbers in their ranges, and nothing missing. Errors
/// carry their place inside the node, such as `flips[3]`.
Status check(const Node& node);

/// Everything that can be said without evaluating: nodes that pass check(), a root that exists, children that
/// exist, no cycle (named as a chain of blocks), indices of yarns, feeders and beams in range, numbers finite
/// and in their ranges, texts and lists no longer than a document may hold, texts in UTF-8.
Status check(const Design& design);

}  // namespace weave
