#pragma once

#include <weave/block/block.hpp>
#include <weave/block/preset.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace weave::presets {

/// The options of one family with their defaults filled in, each within its range.
class Values {
  public:
    explicit Values(std::map<std::string, std::int64_t> values) : m_values(std::move(values)) {}
    /// An option that the family has.
    [[nodiscard]] std::int64_t number(const std::string& name) const { return m_values.at(name); }
    /// The same for options whose range holds nothing below 0.
    [[nodiscard]] std::size_t count(const std::string& name) const {
        return static_cast<std::size_t>(number(name));
    }

  private:
    std::map<std::string, std::int64_t> m_values;
};

/// A family and the rule that makes its weaves.
struct Rule {
    PresetFamily family;
    Result<Block> (*make)(const Values&);
};

/// A weave of one layer, one pick and one end a stack: where `lifted(pick, end)` the end lies over the pick.
template <class Lifted>
Result<Block> single_layer(std::size_t picks, std::size_t ends, Lifted lifted) {
    const Stack warp_over({Slot::weft(0), Slot::warp(0)}), weft_over({Slot::warp(0), Slot::weft(0)});
    return make_block(
        std::vector<std::uint32_t>(picks, 1), std::vector<std::uint32_t>(ends, 1),
        [&](std::size_t pick, std::size_t end) { return lifted(pick, end) ? warp_over : weft_over; });
}

/// `value` modulo `size`, never negative.
constexpr std::int64_t wrapped(std::int64_t value, std::int64_t size) {
    return (value % size + size) % size;
}

/// The moves with which a satin of this size binds every end once: from 2 to size - 2, sharing no factor with
/// it.
std::vector<std::int64_t> satin_moves(std::int64_t size);

/// The satin move that lays the binding points farthest apart (the smallest of equals). `moves` must not be
/// empty.
std::int64_t most_even_move(std::int64_t size, const std::vector<std::int64_t>& moves);

/// `2, 3 and 5`.
std::string listed(const std::vector<std::int64_t>& numbers);

/// plain, twill, satin and their kin.
std::vector<Rule> flat_rules();

/// Weaves with several layers of wefts.
std::vector<Rule> layered_rules();

}  // namespace weave::presets
