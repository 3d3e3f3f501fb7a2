#pragma once

#include <weave/sim/device/memory.hpp>
#include <weave/sim/device/view.hpp>

#include <cstddef>
#include <type_traits>
#include <vector>

namespace device_tests {

/// Writes what one thread found out, for the test to read.
template <class T>
struct TellIt {
    weave::sim::View<T> to;  ///< one
    T told;
    WEAVE_HD void operator()() const { to[0] = told; }
};

/// The first numbers of a view in some machine's memory.
template <class T>
std::vector<std::remove_const_t<T>> fetched(weave::sim::Memory& memory, const weave::sim::View<T>& view, std::size_t count) {
    std::vector<std::remove_const_t<T>> numbers(count);
    if (count > 0) memory.get(numbers.data(), view.at(0, count), count * sizeof(T));
    return numbers;
}

}  // namespace device_tests
