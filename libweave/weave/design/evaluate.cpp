#include <weave/design/evaluate.hpp>

#include <weave/block/from_card.hpp>
#include <weave/design/extent_to_be.hpp>
#include <weave/design/tree.hpp>

#include <algorithm>
#include <span>

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
    const std::string names[] = {operation.of, operation.other};
    return attach(*children[0], *children[1], operation.face, names);
}
Result<Block> make(const StencilOperation& operation, const std::vector<BlockPtr>& children) {
    return stencil(children, *operation.map, operation.of);
}
Result<Block> make(const RenumberOperation& operation, const std::vector<BlockPtr>& children) {
    return operation.system == System::weft ? renumber_row(*children[0], operation.line, operation.order)
                                            : renumber_column(*children[0], operation.line, operation.order);
}

BlockPtr with_flips(Block block, std::span<const Flip> flips, std::vector<RefusedFlip>& refused) {
    if (flips.empty()) return std::make_shared<const Block>(std::move(block));
    FlippedBlock flipped = apply_flips(std::move(block), flips);
    refused = std::move(flipped.refused);
    return std::make_shared<const Block>(std::move(flipped.block));
}

/// What a node is made into. A leaf of stacks without flips is its block already: no copy.
Result<BlockPtr> block_of(const Node& node, const std::vector<BlockPtr>& children,
                          std::vector<RefusedFlip>& refused) {
    const auto* leaf = std::get_if<StacksLeaf>(&node.source);
    if (leaf != nullptr && node.flips.empty()) return leaf->block;
    WEAVE_TRY(Block block,
              std::visit([&](const auto& source) { return make(source, children); }, node.source));
    return with_flips(std::move(block), node.flips, refused);
}

bool begins_with(const std::vector<Flip>& flips, const std::vector<Flip>& first) {
    return flips.size() >= first.size() && std::equal(first.begin(), first.end(), flips.begin());
}

bool same_source(const Node& a, const Node& b) {
    return Node{a.source, {}} == Node{b.source, {}};
}

/// Of remembered versions, the latest first, the one with most of the flips that the latest begins with, none of them lost, and
/// otherwise the same. Flips are made one after the other, so the rest of them made on its block come to the latest: for a person
/// who flips one crossing after the other that is a copy of the block instead of making it from its parts.
template <class Version>
const Version* with_fewer_flips(const std::vector<Version>& versions) {
    const Version &latest = versions.front(), *found = nullptr;
    for (const Version& version : versions) {
        const bool serves = version.block && version.lost_flips.empty() && version.children == latest.children &&
                            begins_with(latest.node->flips, version.node->flips) && same_source(*version.node, *latest.node);
        if (serves && (found == nullptr || found->node->flips.size() < version.node->flips.size())) found = &version;
    }
    return found;
}

constexpr std::size_t most_versions = 8;

/// What a block holds: its cells, and the slots of its stacks.
std::size_t weight(const Block& block) {
    return block.cells().size() + extent_of(block).slots;
}

Error too_much(const std::string& name, std::size_t limit) {
    return bad_input("this block and those that are needed at the same time hold more than the limit of " +
                         std::to_string(limit) +
                         " cells of memory; make the cloth from fewer or smaller blocks",
                     "blocks." + name);
}

}  // namespace

Result<Evaluation> Evaluator::evaluate(const Design& design) {
    return evaluate(design, design.root);
}

Result<Evaluation> Evaluator::evaluate(const Design& design, const std::string& block) {
    WEAVE_CHECK_OK(check(design));
    if (!design.blocks.contains(block))
        return bad_input("'" + block.substr(0, 80) + "' is not a block of this design");
    const std::vector<std::string> order = bottom_up(design, block);
    for (const std::string& name : order) recognise(name, design.blocks.at(name));
    Evaluation evaluation;
    WEAVE_TRY(evaluation.block, cloth(order));
    for (const std::string& name : order) {
        const std::vector<LostFlip>& lost = latest(name).lost_flips;
        evaluation.lost_flips.insert(evaluation.lost_flips.end(), lost.begin(), lost.end());
    }
    for (auto known = m_known.begin(); known != m_known.end();) {
        if (design.blocks.contains(known->first)) {
            ++known;
            continue;
        }
        for (Version& version : known->second) forget(version);
        known = m_known.erase(known);
    }
    return evaluation;
}

/// Makes the version of `name` that this node is now the latest; the names that it is made from are
/// recognised.
void Evaluator::recognise(const std::string& name, const NodePtr& node) {
    std::vector<std::size_t> children;
    for (const std::string& child : children_of(*node)) children.push_back(latest(child).id);
    std::vector<Version>& versions = m_known[name];
    const auto found = std::find_if(versions.begin(), versions.end(), [&](const Version& version) {
        return version.children == children && (version.node == node || *version.node == *node);
    });
    if (found != versions.end()) {
        std::rotate(versions.begin(), found, found + 1);
        return;
    }
    versions.insert(versions.begin(), Version{++m_last_id, node, std::move(children), nullptr, 0, {}});
    if (versions.size() <= most_versions) return;
    forget(versions.back());
    versions.pop_back();
}

/// The block of the last name. Only what it needs and is not remembered is made; each block is at hand as
/// long as something is still to be made from it, whatever the budget; but all of them within the limit.
Result<BlockPtr> Evaluator::cloth(const std::vector<std::string>& order) {
    std::map<std::string, std::size_t> uses{{order.back(), 1}};
    std::map<std::string, BlockPtr> at_hand;
    std::size_t held = 0;  // by the blocks at hand
    for (auto name = order.rbegin(); name != order.rend(); ++name) {
        if (!uses.contains(*name)) continue;
        if (const BlockPtr& block = latest(*name).block) {
            at_hand[*name] = block;
            held += extent_of(*block).units();
            touch(latest(*name));
            continue;
        }
        for (const std::string& child : children_of(*latest(*name).node)) ++uses[child];
    }
    for (const std::string& name : order) {
        if (!uses.contains(name) || at_hand.contains(name)) continue;
        std::vector<BlockPtr> children;
        const std::vector<std::string> child_names = children_of(*latest(name).node);
        for (const std::string& child : child_names) children.push_back(at_hand.at(child));
        std::vector<Extent> extents;
        std::vector<SizedPart> sizes;
        for (const BlockPtr& child : children) {
            extents.push_back(extent_of(*child));
            sizes.push_back({&child->grid(), child->height()});
        }
        if (Status fits = check_counts_fit(latest(name).node->source, sizes); !fits)
            return std::move(fits).error().under("blocks." + name);
        if (held + needed_for(*latest(name).node, extents) > m_limit) return too_much(name, m_limit);
        WEAVE_CHECK_OK(make(name, children));
        at_hand[name] = latest(name).block;
        held += extent_of(*at_hand[name]).units();
        for (const std::string& child : child_names) {
            if (--uses[child] > 0) continue;
            held -= extent_of(*at_hand.at(child)).units();
            at_hand.erase(child);
        }
        keep_within_budget();
    }
    return at_hand.at(order.back());
}

Status Evaluator::make(const std::string& name, const std::vector<BlockPtr>& children) {
    Version& version = latest(name);
    std::vector<RefusedFlip> refused;
    Result<BlockPtr> block = [&]() -> Result<BlockPtr> {
        const Version* before = with_fewer_flips(m_known.at(name));
        if (before == nullptr) return block_of(*version.node, children, refused);
        return with_flips(*before->block, std::span(version.node->flips).subspan(before->node->flips.size()), refused);
    }();
    if (!block) return std::move(block).error().under("blocks." + name);
    ++m_computed;
    version.lost_flips.clear();
    for (RefusedFlip& flip : refused) version.lost_flips.push_back({name, flip.flip, std::move(flip.reason)});
    version.block = std::move(block).value();
    m_held += weight(*version.block);
    touch(version);
    return {};
}

void Evaluator::forget(Version& version) {
    if (version.block) m_held -= weight(*version.block);
    version.block = nullptr;
}

void Evaluator::keep_within_budget() {
    while (m_held > m_budget) {
        Version* oldest = nullptr;
        for (auto& [name, versions] : m_known) {
            for (Version& version : versions) {
                if (!version.block || version.used == m_clock) continue;
                if (oldest == nullptr || version.used < oldest->used) oldest = &version;
            }
        }
        if (oldest == nullptr) return;
        forget(*oldest);
    }
}

Result<Evaluation> evaluate(const Design& design) {
    return Evaluator(0).evaluate(design);
}

}  // namespace weave
