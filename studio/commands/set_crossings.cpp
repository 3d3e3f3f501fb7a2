#include <studio/commands/set_crossings.hpp>

#include <memory>

namespace weave::studio {

EditStep set_crossings(const Design& design, const std::string& block, std::span<const Flip> flips, const QString& text) {
    if (flips.empty()) return {text, {}};
    Node node = *design.blocks.at(block);
    node.flips.insert(node.flips.end(), flips.begin(), flips.end());
    return {text, {PutBlock{block, std::make_shared<const Node>(std::move(node))}}};
}

}  // namespace weave::studio
