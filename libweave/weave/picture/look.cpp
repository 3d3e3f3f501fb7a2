#include <weave/picture/look.hpp>

#include <algorithm>

namespace weave {

namespace {

/// Shades that tell apart the yarns of one stack: the colour itself, darker, lighter, darkest, lightest.
Colour shade(Colour colour, std::size_t index) {
    switch (index % 5) {
        case 1:
            return mix(colour, {0x40, 0x18, 0x00}, 0.42);
        case 2:
            return mix(colour, {0xff, 0xff, 0xff}, 0.38);
        case 3:
            return mix(colour, {0x20, 0x08, 0x00}, 0.68);
        case 4:
            return mix(colour, {0xff, 0xf0, 0x60}, 0.5);
        default:
            return colour;
    }
}

Colour grey_shade(std::size_t index) {
    constexpr Colour greys[]{
        paper_weft, {0x5f, 0x64, 0x6b}, {0xae, 0xb3, 0xb9}, {0x45, 0x49, 0x50}, {0xc2, 0xc6, 0xcb}};
    return greys[index % 5];
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
}

Colour YarnColours::drawn_end(std::size_t end, std::size_t index) const {
    return m_own_warp ? m_ends[end] : shade(paper_warp, index);
}

Colour YarnColours::drawn_pick(std::size_t pick, std::size_t index) const {
    return m_own_weft ? m_picks[pick] : grey_shade(index);
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
