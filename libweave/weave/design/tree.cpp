#include <weave/design/tree.hpp>

#include <utility>

namespace weave {

std::vector<std::string> bottom_up(const Design& design, const std::string& root) {
    std::vector<std::string> order;
    std::map<std::string, bool> seen;
    std::vector<std::pair<std::string, bool>> path{{root, false}};
    while (!path.empty()) {
        auto [name, left] = std::move(path.back());
        path.pop_back();
        if (left) {
            order.push_back(std::move(name));
        } else if (!std::exchange(seen[name], true)) {
            path.emplace_back(name, true);
            for (std::string& child : children_of(*design.blocks.at(name))) {
                if (!seen[child]) path.emplace_back(std::move(child), false);
            }
        }
    }
    return order;
}

NodePtr with_renamed_children(const NodePtr& node, const std::map<std::string, std::string>& names) {
    bool changed = false;
    Node copy = *node;
    const auto rename = [&](std::string& name) {
        const auto found = names.find(name);
        if (found == names.end() || found->second == name) return;
        name = found->second;
        changed = true;
    };
    if (auto* tile = std::get_if<TileOperation>(&copy.source)) rename(tile->of);
    if (auto* renumber = std::get_if<RenumberOperation>(&copy.source)) rename(renumber->of);
    if (auto* attach = std::get_if<AttachOperation>(&copy.source)) rename(attach->of), rename(attach->other);
    if (auto* stencil = std::get_if<StencilOperation>(&copy.source)) {
        for (std::string& name : stencil->of) rename(name);
    }
    return changed ? std::make_shared<const Node>(std::move(copy)) : node;
}

}  // namespace weave
