#include <studio/document/cloth.hpp>

#include <unordered_map>

namespace weave::studio {

std::optional<std::vector<std::size_t>> changed_cells(const Block& before, const Block& after) {
    if (before.t() != after.t() || before.p() != after.p()) return std::nullopt;
    // Stacks are compared once a pair of table entries, of which there are few.
    std::unordered_map<std::uint64_t, bool> differs;
    const auto old_cells = before.cells(), new_cells = after.cells();
    std::vector<std::size_t> changed;
    std::uint64_t last_pair = ~std::uint64_t{0};
    bool last_differs = false;
    for (std::size_t cell = 0; cell < old_cells.size(); ++cell) {
        const std::uint64_t pair = std::uint64_t{old_cells[cell]} << 32 | new_cells[cell];
        if (pair != last_pair) {
            const auto [found, is_new] = differs.try_emplace(pair, false);
            if (is_new) found->second = !(before.stacks()[old_cells[cell]] == after.stacks()[new_cells[cell]]);
            last_pair = pair;
            last_differs = found->second;
        }
        if (last_differs) changed.push_back(cell);
    }
    return changed;
}

}  // namespace weave::studio
