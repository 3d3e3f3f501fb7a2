#include <weave/design/merge.hpp>

#include <weave/design/tree.hpp>

namespace weave {

namespace {

/// The name under which `node` goes into the design: that of an equal block, or a free one.
std::string place_for(const Design& design, const std::string& wish, const Node& node) {
    std::string name = wish;
    for (std::size_t k = 2; design.blocks.contains(name); ++k) {
        if (*design.blocks.at(name) == node) return name;
        name = wish + "-" + std::to_string(k);
    }
    return name;
}

}  // namespace

std::string free_name(const Design& design, const std::string& wish) {
    std::string name = wish;
    for (std::size_t k = 2; design.blocks.contains(name); ++k) name = wish + "-" + std::to_string(k);
    return name;
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

bool same_yarns(const Design& a, const Design& b) { return a.warp == b.warp && a.weft == b.weft; }

}  // namespace weave
