#include <weave/block/from_card.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/design/tree.hpp>

#include <algorithm>

namespace weave {

namespace {

Result<Block> make(const StacksLeaf& leaf, const std::vector<BlockPtr>&) {
    return *leaf.block;
}
Result<Block> make(const CardLeaf& leaf, const std::vector<BlockPtr>&) {
    return block_from_card(*leaf.card, leaf.t, leaf.p);
}
Result<Block> make(const PresetLeaf& leaf, const std::vector<BlockPtr>&) {
    return make_preset(leaf.preset);
}
Result<Block> make(const SliceLeaf& leaf, const std::vector<BlockPtr>&) {
    return to_block(leaf.slice);
}
Result<Block> make(const TileOperation& operation, const std::vector<BlockPtr>& children) {
    return tile(*children[0], operation.x, operation.y, operation.z);
}
Result<Block> make(const AttachOperation& operation, const std::vector<BlockPtr>& children) {
    return attach(*children[0], *children[1], operation.face);
}
Result<Block> make(const StencilOperation& operation, const std::vector<BlockPtr>& children) {
    return stencil(children, *operation.map);
}
Result<Block> make(const RenumberOperation& operation, const std::vector<BlockPtr>& children) {
    return operation.system == System::weft ? renumber_row(*children[0], operation.line, operation.order)
                                            : renumber_column(*children[0], operation.line, operation.order);
}

/// What a node is made into. A leaf of stacks without flips is its block already: no copy.
Result<BlockPtr> block_of(const Node& node, const std::vector<BlockPtr>& children,
                          std::vector<RefusedFlip>& refused) {
    const auto* leaf = std::get_if<StacksLeaf>(&node.source);
    if (leaf != nullptr && node.flips.empty()) return leaf->block;
    WEAVE_TRY(Block block,
              std::visit([&](const auto& source) { return make(source, children); }, node.source));
    if (node.flips.empty()) return std::make_shared<const Block>(std::move(block));
    FlippedBlock flipped = apply_flips(block, node.flips);
    refused = std::move(flipped.refused);
    return std::make_shared<const Block>(std::move(flipped.block));
}

/// So many that a name's versions stay within some 16 MB, unless the latest alone is larger.
std::size_t versions_to_keep(const Block& block) {
    constexpr std::size_t most = 8, most_cells = std::size_t{1} << 22;
    return std::clamp<std::size_t>(most_cells / block.cells().size(), 1, most);
}

}  // namespace

Result<Evaluation> Evaluator::evaluate(const Design& design) {
    return evaluate(design, design.root);
}

Result<Evaluation> Evaluator::evaluate(const Design& design, const std::string& block) {
    WEAVE_CHECK_OK(check(design));
    if (!design.blocks.contains(block))
        return bad_input("'" + block.substr(0, 80) + "' is not a block of this design");
    Evaluation evaluation;
    for (const std::string& name : bottom_up(design, block)) {
        WEAVE_CHECK_OK(make_known(name, design.blocks.at(name)));
        const Known& made = known(name);
        evaluation.lost_flips.insert(evaluation.lost_flips.end(), made.lost_flips.begin(),
                                     made.lost_flips.end());
        evaluation.block = made.block;
    }
    std::erase_if(m_known, [&](const auto& versions) { return !design.blocks.contains(versions.first); });
    return evaluation;
}

Status Evaluator::make_known(const std::string& name, const NodePtr& node) {
    std::vector<BlockPtr> children;
    for (const std::string& child : children_of(*node)) children.push_back(known(child).block);
    std::vector<Known>& versions = m_known[name];
    const auto found = std::find_if(versions.begin(), versions.end(), [&](const Known& version) {
        return version.node == node && version.children == children;
    });
    if (found != versions.end()) {
        std::rotate(versions.begin(), found, found + 1);
        return {};
    }
    std::vector<RefusedFlip> refused;
    Result<BlockPtr> block = block_of(*node, children, refused);
    if (!block) {
        if (versions.empty()) m_known.erase(name);
        return std::move(block).error().under("blocks." + name);
    }
    ++m_computed;
    std::vector<LostFlip> lost;
    for (RefusedFlip& flip : refused) lost.push_back({name, flip.flip, std::move(flip.reason)});
    const std::size_t keep = versions_to_keep(**block);
    versions.insert(versions.begin(), {node, std::move(children), std::move(block).value(), std::move(lost)});
    versions.resize(std::min(versions.size(), keep));
    return {};
}

Result<Evaluation> evaluate(const Design& design) {
    return Evaluator().evaluate(design);
}

}  // namespace weave
