#include <weave/picture/layer_map.hpp>

#include <algorithm>

namespace weave {

namespace {

using Heights = std::vector<std::size_t>;

/// Sums of height differences over the best pairings that begin at the lowest yarns and end with a given
/// pair.
class PairingCosts {
  public:
    PairingCosts(const Heights& many, const Heights& few)
        : m_width(few.size()), m_sums(many.size() * few.size(), impossible) {
        for (std::size_t a = 0; a < many.size(); ++a) {
            for (std::size_t b = 0; b <= std::min(a, few.size() - 1); ++b) {
                std::size_t before = a == 0 ? 0 : at(a - 1, b);
                if (a > 0 && b > 0) before = std::min(before, at(a - 1, b - 1));
                if (before != impossible) m_sums[a * m_width + b] = before + difference(many[a], few[b]);
            }
        }
    }
    static constexpr std::size_t impossible = SIZE_MAX;
    static std::size_t difference(std::size_t a, std::size_t b) { return a > b ? a - b : b - a; }
    [[nodiscard]] std::size_t at(std::size_t many, std::size_t few) const {
        return m_sums[many * m_width + few];
    }

  private:
    std::size_t m_width;
    std::vector<std::size_t> m_sums;
};

/// The same heights seen from the top.
Heights upside_down(const Heights& heights, std::size_t height) {
    Heights turned;
    for (const std::size_t level : heights) turned.insert(turned.begin(), height - level);
    return turned;
}

/// Calls pair(a, b) for yarn a of `many` and b of `few` wherever some best pairing joins them.
template <class Pair>
void pair_up(const Heights& many, const Heights& few, std::size_t height, Pair pair) {
    const PairingCosts from_below(many, few), from_above(upside_down(many, height), upside_down(few, height));
    const std::size_t last_a = many.size() - 1, last_b = few.size() - 1, best = from_below.at(last_a, last_b);
    for (std::size_t a = 0; a <= last_a; ++a) {
        for (std::size_t b = 0; b <= last_b; ++b) {
            const std::size_t low = from_below.at(a, b), high = from_above.at(last_a - a, last_b - b);
            if (low == PairingCosts::impossible || high == PairingCosts::impossible) continue;
            if (low + high - PairingCosts::difference(many[a], few[b]) == best) pair(a, b);
        }
    }
}

}  // namespace

std::size_t layer_count(const Block& block) {
    std::size_t layers = 1;
    for (const Stack& stack : block.stacks()) layers = std::max(layers, stack.wefts());
    return layers;
}

std::vector<LayerPixel> layer_pixels(const Stack& stack) {
    std::vector<LayerPixel> layers(stack.wefts(), LayerPixel::none);
    Heights wefts, warps, layer_of_weft;
    std::size_t above = stack.wefts();  // wefts from this height on
    for (std::size_t level = 0; level < stack.height(); ++level) {
        const Slot slot = stack.slots()[level];
        if (slot.is_weft()) --above;
        if (slot.is_loose()) continue;
        if (slot.is_warp()) warps.push_back(level);
        if (!slot.is_weft()) continue;
        wefts.push_back(level);
        layer_of_weft.push_back(above);
    }
    if (wefts.empty() || warps.empty() || std::max(wefts.size(), warps.size()) > most_paired) return layers;
    const auto join = [&](std::size_t weft, std::size_t warp) {
        const LayerPixel pixel = wefts[weft] > warps[warp] ? LayerPixel::weft_over : LayerPixel::lifted;
        LayerPixel& so_far = layers[layer_of_weft[weft]];
        so_far = so_far == LayerPixel::none || so_far == pixel ? pixel : LayerPixel::between;
    };
    if (wefts.size() >= warps.size()) {
        pair_up(wefts, warps, stack.height(), join);
    } else {
        pair_up(warps, wefts, stack.height(), [&](std::size_t warp, std::size_t weft) { join(weft, warp); });
    }
    return layers;
}

}  // namespace weave
