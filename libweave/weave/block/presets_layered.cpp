#include <weave/block/preset_rules.hpp>

#include <algorithm>
#include <numeric>

namespace weave::presets {

namespace {

constexpr std::int64_t most_layers = 64;

/// The stack of straight wefts 0 … layers-1 from the bottom, with warp w in gap gaps[w]: gap g has g wefts
/// below it. Gaps must rise. A gap without a warp stays an empty slot, so that wefts and straight ends keep
/// their level from stack to stack.
Stack with_warps_in_gaps(std::size_t layers, const std::vector<std::size_t>& gaps) {
    std::vector<Slot> slots(2 * layers + 1);
    for (std::size_t weft = 0; weft < layers; ++weft) slots[2 * weft + 1] = Slot::weft(weft);
    for (std::size_t warp = 0; warp < gaps.size(); ++warp) slots[2 * gaps[warp]] = Slot::warp(warp);
    return Stack(std::move(slots));
}

/// Columns of binders that follow one path, each column a row later than the one before, and between them
/// columns of straight stuffers, one in each gap between two wefts.
struct Interlock {
    std::size_t layers = 0;
    std::vector<std::size_t> path;    ///< per row of the repeat: how many wefts lie below the lowest binder
    std::size_t depth = 0;            ///< wefts that one binder spans
    std::size_t binder_columns = 0;   ///< in the repeat
    std::size_t shift = 1;            ///< rows from one binder column's path to the next one's
    std::size_t stuffer_columns = 0;  ///< after each binder column
};

Result<Block> make_interlock(const Interlock& plan) {
    const std::size_t binders = plan.layers - plan.depth + 1, stuffers = plan.layers - 1;
    const std::size_t group = 1 + plan.stuffer_columns, columns = group * plan.binder_columns;
    std::vector<std::uint32_t> p;
    for (std::size_t column = 0; column < columns; ++column) {
        p.push_back(static_cast<std::uint32_t>(column % group == 0 ? binders : stuffers));
    }
    const std::vector<std::uint32_t> t(plan.path.size(), static_cast<std::uint32_t>(plan.layers));
    return make_block(t, p, [&](std::size_t row, std::size_t column) {
        const std::size_t rows = plan.path.size(), behind = column / group * plan.shift % rows;
        std::vector<std::size_t> gaps(p[column]);
        std::iota(gaps.begin(), gaps.end(),
                  column % group == 0 ? plan.path[(row + rows - behind) % rows] : 1);
        return with_warps_in_gaps(plan.layers, gaps);
    });
}

Result<std::size_t> depth_of(const Values& values) {
    const std::size_t layers = values.count("layers"), depth = values.count("depth");
    if (depth == 0) return layers;
    if (depth <= layers) return depth;
    return invalid("an end cannot span " + std::to_string(depth) + " of " + std::to_string(layers) +
                   " weft layers; depth must be at most " + std::to_string(layers));
}

Result<Block> make_layer_to_layer(const Values& values) {
    Interlock plan;
    plan.layers = values.count("layers");
    WEAVE_TRY(plan.depth, depth_of(values));
    const std::size_t floats = values.count("float");
    plan.path.assign(floats, 0);
    plan.path.resize(2 * floats, plan.depth);
    plan.binder_columns = plan.path.size();
    plan.stuffer_columns = values.count("stuffers");
    return make_interlock(plan);
}

Result<Block> make_angle_interlock(const Values& values) {
    Interlock plan;
    plan.layers = values.count("layers");
    WEAVE_TRY(plan.depth, depth_of(values));
    const std::size_t step = values.count("step");
    if (step > plan.depth) {
        return invalid("an end cannot climb " + std::to_string(step) +
                       " weft layers a row when it spans only " + std::to_string(plan.depth) +
                       "; step must be at most that");
    }
    for (std::size_t level = 0; level < plan.depth; level += step) plan.path.push_back(level);
    for (std::size_t level = plan.depth, row = plan.path.size(); row > 0; --row) {
        plan.path.push_back(level);
        level -= std::min(level, step);
    }
    plan.binder_columns = plan.path.size();
    plan.stuffer_columns = values.count("stuffers");
    return make_interlock(plan);
}

Result<Block> make_orthogonal(const Values& values) {
    Interlock plan;
    plan.layers = plan.depth = values.count("layers");
    plan.shift = values.count("float");
    plan.path.assign(plan.shift, plan.layers);
    plan.path.resize(2 * plan.shift, 0);
    plan.binder_columns = 2;
    plan.stuffer_columns = values.count("stuffers");
    return make_interlock(plan);
}

/// The weave of each layer of a multi-layer cloth, as a square repeat.
struct Ground {
    std::int64_t size = 2, up = 1, move = 1;
    [[nodiscard]] bool lifted(std::size_t row, std::size_t column) const {
        const auto i = static_cast<std::int64_t>(row), j = static_cast<std::int64_t>(column);
        return wrapped(j - move * i, size) < up;
    }
};

Result<Ground> ground_of(const Values& values) {
    const std::int64_t weave = values.number("weave"), asked = values.number("size");
    constexpr std::int64_t usual_sizes[] = {2, 4, 5};
    const std::int64_t size = asked == 0 ? usual_sizes[weave] : asked;
    if (weave == 0 && size != 2) return invalid("plain weave has size 2, not " + std::to_string(size));
    if (weave == 0) return Ground{2, 1, 1};
    if (weave == 1 && size < 3) return invalid("a twill has at least 3 ends, not " + std::to_string(size));
    if (weave == 1) return Ground{size, size / 2, 1};
    const std::vector<std::int64_t> moves = satin_moves(size);
    if (moves.empty())
        return invalid("there is no regular satin on " + std::to_string(size) + " ends; 5, 7 and 8 have one");
    return Ground{size, size - 1, most_even_move(size, moves)};
}

/// Whether a layer is tied to the one above in this cell: once in `interval` repeats of the ground along each
/// pick and each end, on a spot where both layers lift their ends, so that the upper end hides the tie. The
/// spots of different layers lie in different rows of the ground as far as there are enough.
bool stitched(const Ground& ground, std::size_t interval, std::size_t layer, std::size_t row,
              std::size_t column) {
    const auto size = static_cast<std::size_t>(ground.size);
    if (interval == 0 || row / size % interval != column / size % interval) return false;
    if (row % size != layer % size) return false;
    std::size_t spot = 0;
    while (!ground.lifted(row, spot)) ++spot;
    return column % size == spot;
}

/// Layer by layer from the bottom; a stitch lifts the end over the next layer's pick, with which it changes
/// places.
Stack layers_at(const Ground& ground, std::size_t layers, std::size_t interval, std::size_t row,
                std::size_t column) {
    std::vector<Slot> slots;
    for (std::size_t layer = 0; layer < layers; ++layer) {
        const Slot weft = Slot::weft(layer), warp = Slot::warp(layer);
        const bool tied = layer > 0 && stitched(ground, interval, layer - 1, row, column);
        if (tied) {
            slots.insert(slots.end() - 1, weft);
            slots.push_back(warp);
        } else if (ground.lifted(row, column)) {
            slots.insert(slots.end(), {weft, warp});
        } else {
            slots.insert(slots.end(), {warp, weft});
        }
    }
    return Stack(std::move(slots));
}

Result<Block> make_multi_layer(const Values& values) {
    const std::size_t layers = values.count("layers"), interval = values.count("stitch");
    WEAVE_TRY(const Ground ground, ground_of(values));
    const std::size_t size = static_cast<std::size_t>(ground.size) * std::max<std::size_t>(interval, 1);
    const std::vector<std::uint32_t> counts(size, static_cast<std::uint32_t>(layers));
    return make_block(counts, counts, [&](std::size_t row, std::size_t column) {
        return layers_at(ground, layers, interval, row, column);
    });
}

PresetOption layers_option(std::int64_t fallback) {
    return {"layers", fallback, 2, most_layers, "wefts on top of each other in a row"};
}
PresetOption stuffers_option(std::int64_t fallback) {
    return {"stuffers", fallback, 0, 8, "columns of straight ends after each column of binding ends"};
}

}  // namespace

std::vector<Rule> layered_rules() {
    return {
        {{"layer-to-layer",
          "ends go up and down between neighbouring weft layers and tie each to the next",
          {layers_option(4),
           {"depth", 2, 0, most_layers, "weft layers that an end spans; 1: layers stay apart; 0: all"},
           {"float", 1, 1, 32, "rows that an end stays up, and down"},
           stuffers_option(0)}},
         make_layer_to_layer},
        {{"angle-interlock",
          "ends climb slantwise through the weft layers and back",
          {layers_option(4),
           {"depth", 0, 0, most_layers, "weft layers that an end spans; 0: the whole thickness"},
           {"step", 1, 1, most_layers, "weft layers that an end climbs from one row to the next"},
           stuffers_option(0)}},
         make_angle_interlock},
        {{"orthogonal",
          "straight ends and wefts in layers, held by ends that go straight through from face to back",
          {layers_option(3),
           {"float", 1, 1, 32, "rows that a binding end stays on one face"},
           stuffers_option(1)}},
         make_orthogonal},
        {{"multi-layer",
          "cloths on top of each other, free or stitched together",
          {{"layers", 2, 2, most_layers, "cloths on top of each other"},
           {"weave", 0, 0, 2, "of each cloth. 0: plain, 1: twill, 2: satin"},
           {"size", 0, 0, 32, "ends in the repeat of the weave; 0: 2 for plain, 4 for twill, 5 for satin"},
           {"stitch", 0, 0, 32, "tie each cloth to the next once in so many repeats; 0: free"}}},
         make_multi_layer},
    };
}

}  // namespace weave::presets
