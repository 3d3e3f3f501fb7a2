#include <weave/block/stack_moves.hpp>

namespace weave {

Stack piled(const Stack& lower, std::size_t lower_height, const Stack& upper) {
    std::vector<Slot> slots(lower.slots().begin(), lower.slots().end());
    slots.resize(lower_height);
    for (const Slot slot : upper.slots()) {
        const std::size_t below = slot.is_weft() ? lower.wefts() : lower.warps();
        slots.push_back(slot.is_empty() ? slot : slot.renumbered(slot.index() + below));
    }
    return Stack(std::move(slots));
}

Stack piled_times(const Stack& stack, std::size_t height, std::size_t times) {
    std::vector<Slot> slots;
    slots.reserve(height * times);
    for (std::size_t k = 0; k < times; ++k) {
        slots.resize(k * height);
        for (const Slot slot : stack.slots()) {
            const std::size_t below = k * (slot.is_weft() ? stack.wefts() : stack.warps());
            slots.push_back(slot.is_empty() ? slot : slot.renumbered(slot.index() + below));
        }
    }
    return Stack(std::move(slots));
}

std::optional<std::vector<std::size_t>> new_numbers(std::span<const std::size_t> order, std::size_t count) {
    if (order.size() != count) return {};
    std::vector<std::size_t> numbers(count, count);
    for (std::size_t k = 0; k < count; ++k) {
        if (order[k] >= count || numbers[order[k]] != count) return {};
        numbers[order[k]] = k;
    }
    return numbers;
}

Stack renumbered(const Stack& stack, System system, std::span<const std::size_t> numbers) {
    std::vector<Slot> slots(stack.slots().begin(), stack.slots().end());
    for (Slot& slot : slots) {
        const bool moves = system == System::weft ? slot.is_weft() : slot.is_warp();
        if (moves) slot = slot.renumbered(numbers[slot.index()]);
    }
    return Stack(std::move(slots));
}

}  // namespace weave
