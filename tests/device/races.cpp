// Missing barriers, planted: ThreadSanitizer must find them (tests/device/CMakeLists.txt runs these under it, and asks that it
// does). Hidden from all other runs.

#include "support/host_machines.hpp"

#include <catch2/catch.hpp>

using namespace weave::sim;

namespace {

struct FillOwn {
    View<double> numbers;
    WEAVE_HD void operator()(std::size_t i) const { numbers[i] = static_cast<double>(i); }
};

/// Reads what other threads have written without having waited for them.
struct WithoutBarrier {
    View<double> numbers;
    template <class Crew>
    void operator()(Crew& crew) const {
        crew.each(numbers_count, FillOwn{numbers});
        numbers[0] = numbers[0] + 1;  // every thread, at once
        crew.each(numbers_count, FillOwn{numbers});
    }
    static constexpr std::size_t numbers_count = 12;
};

}  // namespace

TEST_CASE("races: a missing barrier", "[.planted]") {
    HostMemory memory;
    Array<double> numbers(memory, WithoutBarrier::numbers_count);
    // Threads that come late may see that the others are far ahead, which counts as having waited for them: about every second time,
    // where there are more threads than cores.
    for (int time = 0; time < 100; ++time) emulate(2, 3, WithoutBarrier{numbers.view()});
    CHECK(numbers.get().back() == 11);
}

TEST_CASE("races: an access beyond the end", "[.planted-bounds]") {
    HostMemory memory;
    Array<double> numbers(memory, 4);
    run_alone([&](auto& crew) { crew.each(5, FillOwn{numbers.view()}); });
    CHECK(numbers.size() == 4);
}
