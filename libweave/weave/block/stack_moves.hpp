#pragma once

#include <weave/block/stack.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace weave {

/// `upper` on top of `lower`, which is filled up to `lower_height` with empty slots; upper's yarns count on
/// from lower's.
Stack piled(const Stack& lower, std::size_t lower_height, const Stack& upper);

/// `times` copies on top of each other, each filled up to `height`.
Stack piled_times(const Stack& stack, std::size_t height, std::size_t times);

/// What becomes of each of `count` yarns where the k-th is to be the one that was number order[k]; nothing
/// where `order` does not name each of them once.
std::optional<std::vector<std::size_t>> new_numbers(std::span<const std::size_t> order, std::size_t count);

/// The stack with its wefts (or warps) under these numbers.
Stack renumbered(const Stack& stack, System system, std::span<const std::size_t> numbers);

}  // namespace weave
