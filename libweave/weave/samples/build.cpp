#include <weave/samples/build.hpp>

#include <algorithm>
#include <cassert>
#include <numeric>

namespace weave::sample {

Stack cell(std::size_t wefts, std::span<const End> ends, Below loose_wefts) {
    const auto ends_below = [&](std::size_t weft) {
        return std::count_if(ends.begin(), ends.end(),
                             [&](const End& end) { return (end.below >> weft & 1) == 0; });
    };
    std::vector<std::size_t> from_below(wefts);
    std::iota(from_below.begin(), from_below.end(), std::size_t{0});
    std::stable_sort(from_below.begin(), from_below.end(),
                     [&](std::size_t a, std::size_t b) { return ends_below(a) < ends_below(b); });

    std::vector<Slot> slots;
    std::vector<bool> placed(ends.size(), false);
    const auto place = [&](auto may_lie_here) {
        for (std::size_t e = 0; e < ends.size(); ++e) {
            if (placed[e] || !may_lie_here(ends[e])) continue;
            slots.push_back(Slot::warp(e, ends[e].loose));
            placed[e] = true;
        }
    };
    for (const std::size_t weft : from_below) {
        place([&](const End& end) { return (end.below >> weft & 1) == 0; });
        slots.push_back(Slot::weft(weft, (loose_wefts >> weft & 1) != 0));
        for (std::size_t e = 0; e < ends.size(); ++e) assert(placed[e] == ((ends[e].below >> weft & 1) == 0));
    }
    place([](const End&) { return true; });
    return Stack(std::move(slots));
}

namespace {

NodePtr node(NodeSource source) {
    return std::make_shared<const Node>(Node{std::move(source), {}});
}

}  // namespace

NodePtr warp_slice_of(const std::vector<Stack>& rows) {
    Slice slice;
    slice.dots = System::weft;
    for (const Stack& row : rows) {
        std::vector<SliceYarn> position;
        for (const Slot slot : row.slots()) position.push_back({slot, false});
        slice.positions.push_back(std::move(position));
    }
    return node(SliceLeaf{std::move(slice)});
}

NodePtr preset(std::string family, std::map<std::string, std::int64_t> options) {
    return node(PresetLeaf{{std::move(family), std::move(options)}});
}

NodePtr tiled(std::string of, std::size_t x, std::size_t y) {
    return node(TileOperation{std::move(of), x, y, 1});
}

NodePtr attached(std::string of, std::string other, Face face) {
    return node(AttachOperation{std::move(of), std::move(other), face});
}

NodePtr stencilled(std::vector<std::string> of, StencilMap map) {
    return node(StencilOperation{std::move(of), std::make_shared<const StencilMap>(std::move(map))});
}

NodePtr renumbered(std::string of, std::size_t row, std::vector<std::size_t> order) {
    return node(RenumberOperation{std::move(of), System::weft, row, std::move(order)});
}

Colour colour(std::string_view text) {
    return parse_colour(text).value();
}

YarnType yarn(std::string name, std::string_view shade, double radius_mm, double tex, double stretch_N,
              double bend_N_mm2) {
    YarnType type;
    type.name = std::move(name);
    type.colour = colour(shade);
    type.radius_mm = radius_mm;
    type.linear_density_tex = tex;
    type.stretch_stiffness_N = stretch_N;
    type.bending_stiffness_N_mm2 = bend_N_mm2;
    return type;
}

YarnType roving(std::string name, std::string_view shade, double radius_mm, double tex) {
    // Glass or carbon, untwisted. Its filaments lie wavy in it: at weaving tension the first percent of strain only
    // straightens them, so it is far softer than its material, and it slides on itself when it bends. It is packed
    // hard, so that it gives way to other yarns less than cotton does.
    YarnType type = yarn(std::move(name), shade, radius_mm, tex, 2 * tex, 5e-4 * tex);
    type.contact_stiffness_N_mm2 = 20;
    return type;
}

YarnType cotton(std::string name, std::string_view shade, double radius_mm, double tex) {
    // A spun cotton yarn stretches about 6 % at 0.15 N/tex; its fibres slide, so it bends far softer than a
    // rod.
    return yarn(std::move(name), shade, radius_mm, tex, 2.5 * tex, 1e-4 * tex);
}

Design cloth(std::string title, std::string notes, YarnType warp, YarnType weft) {
    Design design;
    design.title = std::move(title);
    design.notes = std::move(notes);
    design.warp.yarns = {std::move(warp)};
    design.weft.yarns = {std::move(weft)};
    return design;
}

void add(Design& design, const std::string& name, NodePtr made) {
    design.blocks[name] = std::move(made);
    design.root = name;
}

}  // namespace weave::sample
