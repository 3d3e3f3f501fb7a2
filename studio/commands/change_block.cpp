#include <studio/commands/change_block.hpp>

#include <memory>
#include <utility>

namespace weave::studio {

EditStep change_block(const Design& design, const std::string& name, NodeSource source, const QString& text) {
    const Node& before = *design.blocks.at(name);
    return {text, {PutBlock{name, std::make_shared<const Node>(Node{std::move(source), before.flips})}}};
}

}  // namespace weave::studio
