#include <weave/picture/look.hpp>

#include <algorithm>
#include <map>

namespace weave {

namespace {

constexpr std::size_t shades = 5;

/// The colour itself, darker, lighter, darkest, lightest.
Colour shade(Colour colour, std::size_t index) {
    constexpr Colour black{0, 0, 0}, white{0xff, 0xff, 0xff};
    switch (index) {
        case 1:
            return mix(colour, black, 0.35);
        case 2:
            return mix(colour, white, 0.4);
        case 3:
            return mix(colour, black, 0.6);
        case 4:
            return mix(colour, white, 0.68);
        default:
            return colour;
    }
}

/// For each yarn of a group how many of its colour come before it, over and over.
template <class ColourOf>
void add_shades(std::vector<std::uint8_t>& list, std::size_t first, std::size_t after, ColourOf colour_of) {
    std::map<std::uint32_t, std::size_t> met;
    for (std::size_t yarn = first; yarn < after; ++yarn)
        list.push_back(static_cast<std::uint8_t>(met[pixel_of(colour_of(yarn))]++ % shades));
}

bool same_colours(const std::vector<YarnType>& a, const std::vector<YarnType>& b) {
    return std::ranges::equal(a, b, {}, &YarnType::colour, &YarnType::colour);
}

}  // namespace

YarnColours::YarnColours(const Subject& subject) : m_table(pick_table(subject.design, subject.block)) {
    const Design& design = subject.design;
    m_ends.reserve(subject.block.ends());
    for (std::size_t end = 0; end < subject.block.ends(); ++end) m_ends.push_back(colour_of_end(design, end));
    for (const Pick& pick : m_table) {
        const YarnType* yarn = yarn_of_pick(design, pick);
        m_woven.push_back(yarn != nullptr);
        m_picks.push_back(yarn != nullptr ? yarn->colour : Colour{0xff, 0xff, 0xff});
    }
    m_own_warp = !same_colours(design.warp.yarns, default_warp().yarns) || !design.warp.colours.empty();
    m_own_weft = !same_colours(design.weft.yarns, default_weft().yarns);
    const Block& block = subject.block;
    for (std::size_t column = 0; column < block.columns(); ++column) {
        add_shades(m_end_shades, block.first_end(column), block.first_end(column + 1),
                   [&](std::size_t end) { return drawn_end(end); });
    }
    for (std::size_t row = 0; row < block.rows(); ++row) {
        add_shades(m_pick_shades, block.first_pick(row), block.first_pick(row + 1),
                   [&](std::size_t pick) { return drawn_pick(pick); });
    }
}

Colour YarnColours::shaded_end(std::size_t end) const {
    return shade(drawn_end(end), m_end_shades[end]);
}

Colour YarnColours::shaded_pick(std::size_t pick) const {
    return shade(drawn_pick(pick), m_pick_shades[pick]);
}

Surface::Surface(const Block& block, const YarnColours& colours, bool back, bool trim)
    : m_block(block), m_colours(colours), m_back(back), m_trim(trim) {
    for (const Stack& stack : block.stacks()) m_of_stack.push_back(seen(stack, 0, true));
    for (std::size_t row = 0; row < block.rows(); ++row) {
        bool woven = true;
        for (std::size_t pick = block.first_pick(row); pick < block.first_pick(row + 1); ++pick) {
            woven = woven && colours.has_weft(pick);
        }
        m_row_is_woven.push_back(woven);
    }
}

Slot Surface::seen(const Stack& stack, std::size_t row, bool all_woven) const {
    const auto slots = stack.slots();
    for (std::size_t k = 0; k < slots.size(); ++k) {
        const Slot slot = slots[m_back ? k : slots.size() - 1 - k];
        if (slot.is_empty() || (m_trim && slot.is_loose())) continue;
        if (slot.is_weft() && !all_woven && !m_colours.has_weft(m_block.first_pick(row) + slot.index()))
            continue;
        return slot;
    }
    return {};
}

Slot Surface::at(std::size_t row, std::size_t column) const {
    if (m_row_is_woven[row]) return m_of_stack[m_block.cells()[row * m_block.columns() + column]];
    return seen(m_block.stack(row, column), row, false);
}

std::optional<Colour> Surface::colour(std::size_t row, std::size_t column) const {
    const Slot slot = at(row, column);
    if (slot.is_empty()) return std::nullopt;
    return slot.is_weft() ? m_colours.of_pick(m_block.first_pick(row) + slot.index())
                          : m_colours.of_end(m_block.first_end(column) + slot.index());
}

}  // namespace weave
