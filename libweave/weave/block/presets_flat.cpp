#include <weave/block/preset_rules.hpp>

#include <algorithm>
#include <numeric>

namespace weave::presets {

namespace {

constexpr std::int64_t most_yarns_a_float = 200;

Result<Block> make_plain(const Values&) {
    return single_layer(2, 2, [](std::size_t pick, std::size_t end) { return (pick + end) % 2 == 0; });
}

/// Steps with which every end of a twill goes up and down: the ends fall into gcd(step, size) classes, and an
/// end meets only the places of its class, so a class must fit both above and below.
bool binds_every_end(std::int64_t up, std::int64_t down, std::int64_t step) {
    return std::gcd(step, up + down) <= std::min(up, down);
}

Status check_twill_step(std::int64_t up, std::int64_t down, std::int64_t step) {
    if (binds_every_end(up, down, step)) return {};
    std::vector<std::int64_t> possible;
    for (std::int64_t other = 1; other < up + down && possible.size() < 12; ++other) {
        if (binds_every_end(up, down, other)) possible.push_back(other);
    }
    return invalid("with step " + std::to_string(step) + " a " + std::to_string(up) + "/" +
                   std::to_string(down) + " twill would leave ends that never bind; possible steps are " +
                   listed(possible) + ", or their negatives");
}

Result<Block> make_twill(const Values& values) {
    const std::int64_t up = values.number("up"), down = values.number("down"), step = values.number("step");
    WEAVE_CHECK_OK(check_twill_step(up, down, step));
    const std::int64_t size = up + down, picks = size / std::gcd(step, size);
    return single_layer(static_cast<std::size_t>(picks), static_cast<std::size_t>(size),
                        [&](std::size_t pick, std::size_t end) {
                            const auto i = static_cast<std::int64_t>(pick),
                                       j = static_cast<std::int64_t>(end);
                            return wrapped(j - step * i, size) < up;
                        });
}

/// How many ends before a reversing twill turns: 0 asks for one repeat, and less would leave a pick unbound.
Result<std::int64_t> ends_to_turn(const Values& values, std::int64_t size) {
    const std::int64_t width = values.number("width");
    if (width == 0) return size;
    if (width >= size) return width;
    return invalid("the twill repeats on " + std::to_string(size) + " ends, so it must not turn after " +
                   std::to_string(width) + ": picks would not bind; width must be at least " +
                   std::to_string(size));
}

Result<Block> make_pointed(const Values& values) {
    const std::int64_t up = values.number("up"), size = up + values.number("down");
    WEAVE_TRY(const std::int64_t width, ends_to_turn(values, size));
    const std::int64_t ends = 2 * (width - 1);  // the two ends at the points are not doubled
    return single_layer(static_cast<std::size_t>(size), static_cast<std::size_t>(ends),
                        [&](std::size_t pick, std::size_t end) {
                            const auto i = static_cast<std::int64_t>(pick),
                                       j = static_cast<std::int64_t>(end);
                            return wrapped((j < width ? j : ends - j) - i, size) < up;
                        });
}

/// At each turn the next end starts `up` places on, so that in an even twill it is the exact opposite of the
/// end beside it.
Result<Block> make_herringbone(const Values& values) {
    const std::int64_t up = values.number("up"), size = up + values.number("down");
    WEAVE_TRY(const std::int64_t width, ends_to_turn(values, size));
    return single_layer(static_cast<std::size_t>(size), static_cast<std::size_t>(2 * width),
                        [&](std::size_t pick, std::size_t end) {
                            const auto i = static_cast<std::int64_t>(pick),
                                       j = static_cast<std::int64_t>(end);
                            const std::int64_t place = j < width ? j : 2 * width - 1 + up - j;
                            return wrapped(place - i, size) < up;
                        });
}

Result<std::int64_t> satin_move(std::int64_t size, std::int64_t move) {
    const std::vector<std::int64_t> moves = satin_moves(size);
    if (moves.empty()) {
        return invalid("there is no regular satin on " + std::to_string(size) +
                       " ends: every move from 2 to " + std::to_string(size - 2) +
                       " shares a factor with it; 5, 7 and 8 ends have one");
    }
    if (move == 0) return most_even_move(size, moves);
    if (std::find(moves.begin(), moves.end(), move) != moves.end()) return move;
    return invalid("a satin on " + std::to_string(size) + " ends cannot have move " + std::to_string(move) +
                   ": some ends would not bind; possible moves are " + listed(moves));
}

Result<Block> satin_of(const Values& values, bool weft_faced) {
    const std::int64_t size = values.number("size");
    WEAVE_TRY(const std::int64_t move, satin_move(size, values.number("move")));
    return single_layer(static_cast<std::size_t>(size), static_cast<std::size_t>(size),
                        [&](std::size_t pick, std::size_t end) {
                            const bool binds = move * static_cast<std::int64_t>(pick) % size ==
                                               static_cast<std::int64_t>(end);
                            return binds == weft_faced;
                        });
}

Result<Block> make_satin(const Values& values) {
    return satin_of(values, values.number("weft-faced") == 1);
}
Result<Block> make_sateen(const Values& values) {
    return satin_of(values, true);
}

Result<Block> make_rib(const Values& values) {
    const std::size_t first = values.count("first"), both = first + values.count("second");
    if (values.number("weft-rib") == 1) {
        return single_layer(2, both,
                            [&](std::size_t pick, std::size_t end) { return (end < first) == (pick == 0); });
    }
    return single_layer(both, 2,
                        [&](std::size_t pick, std::size_t end) { return (pick < first) == (end == 0); });
}

Result<Block> make_basket(const Values& values) {
    const std::size_t picks = values.count("picks"), ends = values.count("ends");
    return single_layer(2 * picks, 2 * ends, [&](std::size_t pick, std::size_t end) {
        return (pick / picks + end / ends) % 2 == 0;
    });
}

PresetOption up_option() {
    return {"up", 2, 1, most_yarns_a_float, "picks in a row that an end lies over"};
}
PresetOption down_option() {
    return {"down", 2, 1, most_yarns_a_float, "picks in a row that an end lies under"};
}
PresetOption width_option() {
    return {"width", 0, 0, 2000, "ends before the twill turns; 0: one repeat"};
}
PresetOption size_option() {
    return {"size", 5, 5, most_yarns_a_float, "ends and picks in the repeat"};
}
PresetOption move_option() {
    return {"move", 0, 0, most_yarns_a_float,
            "ends from one binding point to the next pick's; 0: the most even one"};
}

}  // namespace

std::string listed(const std::vector<std::int64_t>& numbers) {
    std::string text;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        if (k > 0) text += k + 1 == numbers.size() ? " and " : ", ";
        text += std::to_string(numbers[k]);
    }
    return text;
}

std::vector<std::int64_t> satin_moves(std::int64_t size) {
    std::vector<std::int64_t> moves;
    for (std::int64_t move = 2; move <= size - 2; ++move) {
        if (std::gcd(move, size) == 1) moves.push_back(move);
    }
    return moves;
}

std::int64_t most_even_move(std::int64_t size, const std::vector<std::int64_t>& moves) {
    const auto nearest = [&](std::int64_t move) {  // square of the least distance of two binding points
        std::int64_t least = size * size;
        for (std::int64_t pick = 1; pick < size; ++pick) {
            const std::int64_t along = pick * move % size, across = std::min(along, size - along);
            const std::int64_t rows = std::min(pick, size - pick);
            least = std::min(least, rows * rows + across * across);
        }
        return least;
    };
    std::int64_t best = moves.front(), distance = 0;
    for (const std::int64_t move : moves) {
        const std::int64_t reached = nearest(move);
        if (reached > distance) best = move, distance = reached;
    }
    return best;
}

std::vector<Rule> flat_rules() {
    return {
        {{"plain", "each end over one pick and under the next", {}}, make_plain},
        {{"twill",
          "diagonal lines: each pick repeats the one before, moved sideways",
          {up_option(),
           down_option(),
           {"step", 1, -most_yarns_a_float, most_yarns_a_float,
            "ends to move each pick; negative: lines to the left"}}},
         make_twill},
        {{"pointed-twill",
          "a twill that turns back at single ends, in zigzag lines",
          {up_option(), down_option(), width_option()}},
         make_pointed},
        {{"herringbone",
          "a twill that turns back with a clean cut between two ends",
          {up_option(), down_option(), width_option()}},
         make_herringbone},
        {{"satin",
          "scattered binding points: each end lies under one pick of the repeat and over the rest",
          {size_option(), move_option(), {"weft-faced", 0, 0, 1, "1: the wefts form the face"}}},
         make_satin},
        {{"sateen",
          "weft-faced satin: each end lies over one pick of the repeat only",
          {size_option(), move_option()}},
         make_sateen},
        {{"rib",
          "plain weave with several picks in one shed (warp rib) or several ends as one (weft rib)",
          {{"first", 2, 1, most_yarns_a_float, "yarns in the first rib"},
           {"second", 2, 1, most_yarns_a_float, "yarns in the second rib"},
           {"weft-rib", 0, 0, 1, "1: ends work together; 0: picks share a shed"}}},
         make_rib},
        {{"basket",
          "plain weave of groups of ends and picks, also called hopsack or mat",
          {{"ends", 2, 1, most_yarns_a_float, "ends that work together"},
           {"picks", 2, 1, most_yarns_a_float, "picks in one shed"}}},
         make_basket},
    };
}

}  // namespace weave::presets
