#include <weave/design/merge.hpp>

#include <weave/design/tree.hpp>

namespace weave {

namespace {

/// The k-th name to try, from 1: `wish`, `wish-2`, `wish-3` …, never longer than a block name may be.
std::string name_tried(const std::string& wish, std::size_t k) {
    return k < 2 ? wish.substr(0, 64) : wish.substr(0, 48) + "-" + std::to_string(k);
}

/// The name under which `node` goes into the design: that of an equal block, or a free one.
std::string place_for(const Design& design, const std::string& wish, const Node& node) {
    for (std::size_t k = 1;; ++k) {
        const auto there = design.blocks.find(name_tried(wish, k));
        if (there == design.blocks.end() || *there->second == node) return name_tried(wish, k);
    }
}

}  // namespace

std::string free_name(const Design& design, const std::string& wish) {
    std::size_t k = 1;
    while (design.blocks.contains(name_tried(wish, k))) ++k;
    return name_tried(wish, k);
}

std::string bring_in(Design& into, const Design& from) {
    std::map<std::string, std::string> names;
    for (const std::string& name : bottom_up(from, from.root)) {
        const NodePtr node = with_renamed_children(from.blocks.at(name), names);
        const std::string place = place_for(into, name, *node);
        into.blocks.try_emplace(place, node);
        names[name] = place;
    }
    return names.at(from.root);
}

bool same_yarns(const Design& a, const Design& b) {
    return a.warp == b.warp && a.weft == b.weft;
}

}  // namespace weave
