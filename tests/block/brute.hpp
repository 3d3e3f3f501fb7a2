#pragma once

#include <weave/block/block.hpp>

#include <vector>

namespace weave::testing {

/// A block as the paper writes it: absolute yarn numbers, one flat array of heights. Made independently of
/// the library's operations, to compare them with.
struct Plain {
    static constexpr int empty = -1;
    struct Yarn {
        bool weft = false;
        int number = empty;  ///< through the whole block
        friend bool operator==(const Yarn&, const Yarn&) = default;
    };
    std::size_t r = 0, c = 0, h = 0;
    std::vector<std::size_t> t, p;
    std::vector<std::vector<std::vector<Yarn>>> a;  ///< r x c x h
    friend bool operator==(const Plain&, const Plain&) = default;
};

inline std::size_t sum(const std::vector<std::size_t>& counts, std::size_t first) {
    std::size_t total = 0;
    for (std::size_t i = 0; i < first; ++i) total += counts[i];
    return total;
}

inline Plain plain(const Block& block) {
    Plain out{block.rows(),
              block.columns(),
              block.height(),
              {block.t().begin(), block.t().end()},
              {block.p().begin(), block.p().end()},
              {}};
    out.a.assign(out.r, std::vector<std::vector<Plain::Yarn>>(out.c, std::vector<Plain::Yarn>(out.h)));
    for (std::size_t i = 0; i < out.r; ++i) {
        for (std::size_t j = 0; j < out.c; ++j) {
            const auto slots = block.stack(i, j).slots();
            for (std::size_t k = 0; k < slots.size(); ++k) {
                if (slots[k].is_empty()) continue;
                const bool weft = slots[k].is_weft();
                const std::size_t first = weft ? sum(out.t, i) : sum(out.p, j);
                out.a[i][j][k] = {weft, static_cast<int>(first + slots[k].index())};
            }
        }
    }
    return out;
}

/// Constraint 1 of the weave model: every stack holds exactly its picks and its ends, once each.
inline bool obeys(const Plain& block) {
    for (std::size_t i = 0; i < block.r; ++i) {
        for (std::size_t j = 0; j < block.c; ++j) {
            std::vector<int> wefts(sum(block.t, block.r)), warps(sum(block.p, block.c));
            for (const Plain::Yarn yarn : block.a[i][j]) {
                if (yarn.number == Plain::empty) continue;
                auto& seen = yarn.weft ? wefts : warps;
                if (yarn.number < 0 || static_cast<std::size_t>(yarn.number) >= seen.size()) return false;
                ++seen[static_cast<std::size_t>(yarn.number)];
            }
            for (std::size_t k = 0; k < wefts.size(); ++k) {
                if (wefts[k] != (k >= sum(block.t, i) && k < sum(block.t, i + 1) ? 1 : 0)) return false;
            }
            for (std::size_t k = 0; k < warps.size(); ++k) {
                if (warps[k] != (k >= sum(block.p, j) && k < sum(block.p, j + 1) ? 1 : 0)) return false;
            }
        }
    }
    return true;
}

/// Constraint 2: pixel by pixel, by looking for both yarns in every stack.
inline std::vector<std::vector<bool>> pixels(const Plain& block) {
    std::vector<std::vector<bool>> image(sum(block.t, block.r), std::vector<bool>(sum(block.p, block.c)));
    for (const auto& row : block.a) {
        for (const auto& stack : row) {
            for (std::size_t low = 0; low < stack.size(); ++low) {
                for (std::size_t high = low + 1; high < stack.size(); ++high) {
                    if (stack[low].number == Plain::empty || stack[high].number == Plain::empty) continue;
                    if (!stack[low].weft && stack[high].weft) {
                        image[static_cast<std::size_t>(stack[high].number)]
                             [static_cast<std::size_t>(stack[low].number)] = true;
                    }
                }
            }
        }
    }
    return image;
}

inline std::vector<std::vector<bool>> pixels(const CardImage& card) {
    std::vector<std::vector<bool>> image(card.picks(), std::vector<bool>(card.ends()));
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        for (std::size_t end = 0; end < card.ends(); ++end) image[pick][end] = card.weft_over(pick, end);
    }
    return image;
}

/// The paper's tiling with absolute numbers; `misprinted` leaves the factor jj in the offsets.
inline Plain tiled(const Plain& block, std::size_t x, std::size_t y, std::size_t z, bool misprinted) {
    Plain out{x * block.r, y * block.c, z * block.h, {}, {}, {}};
    for (std::size_t i = 0; i < x; ++i) {
        for (const auto count : block.t) out.t.push_back(z * count);
    }
    for (std::size_t j = 0; j < y; ++j) {
        for (const auto count : block.p) out.p.push_back(z * count);
    }
    out.a.assign(out.r, std::vector<std::vector<Plain::Yarn>>(out.c, std::vector<Plain::Yarn>(out.h)));
    for (std::size_t i = 0; i < out.r; ++i) {
        for (std::size_t j = 0; j < out.c; ++j) {
            const std::size_t ii = i % block.r, jj = j % block.c, factor = misprinted ? jj : 1;
            for (std::size_t k = 0; k < z; ++k) {
                const std::size_t t_offset = i / block.r * z * sum(block.t, block.r) +
                                             factor * (z - 1) * sum(block.t, ii) + k * block.t[ii];
                const std::size_t p_offset = j / block.c * z * sum(block.p, block.c) +
                                             factor * (z - 1) * sum(block.p, jj) + k * block.p[jj];
                for (std::size_t level = 0; level < block.h; ++level) {
                    Plain::Yarn yarn = block.a[ii][jj][level];
                    if (yarn.number != Plain::empty) {
                        yarn.number += static_cast<int>(yarn.weft ? t_offset : p_offset);
                    }
                    out.a[i][j][k * block.h + level] = yarn;
                }
            }
        }
    }
    return out;
}

}  // namespace weave::testing
