// What only a device has: its memory, its faults, kernels that run next to one another.

#include <weave/sim/device/devices.hpp>
#include <weave/sim/device/launches.cuh>

#include <catch2/catch.hpp>

#include <cstdint>
#include <vector>

using namespace weave::sim;

namespace {

struct OwnSum {
    View<const double> numbers;
    View<double> sums;
    std::size_t each;
    struct Number {
        View<const double> numbers;
        std::size_t first;
        WEAVE_HD double operator()(std::size_t i) const { return numbers[first + i]; }
    };
    struct Set {
        View<double> sums;
        std::size_t at;
        double sum;
        WEAVE_HD void operator()() const { sums[at] = sum; }
    };
    template <class Crew>
    WEAVE_HD void operator()(Crew& crew, std::size_t k) const {
        const double sum = crew.sum(each, Number{numbers, k * each});
        crew.alone(Set{sums, k, sum});
    }
};

}  // namespace

TEST_CASE("queue: more memory than a device has is refused in numbers, and the next request is met", "[device]") {
    DeviceQueue queue;
    CudaMemory memory(queue);
    constexpr std::size_t much = std::size_t{1} << 45;
    CHECK_THROWS_AS(Array<unsigned char>(memory, much), std::bad_alloc);
    try {
        Array<unsigned char> all(memory, much);
    } catch (const DeviceMemoryShort& error) {
        CHECK(std::string(error.what()).find(std::to_string(much)) != std::string::npos);
    }
    Array<double> few(memory, 10);
    CHECK((few.get() == std::vector<double>(10)));
}

TEST_CASE("queue: a device that is not there is told as a fault", "[device]") {
    CHECK_THROWS_AS(DeviceQueue(1000), DeviceError);
    const DeviceQueue queue;  // and the next call answers for itself
}

TEST_CASE("gangs: many small ones run next to one another, each with sums of its own", "[device]") {
    constexpr std::size_t gangs = 500, each = 300;
    DeviceQueue queue;
    CudaMemory memory(queue);
    std::vector<double> numbers(gangs * each), right(gangs);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i % 13), right[i / each] += numbers[i];
    const Array<double> at(memory, numbers);
    Array<double> sums(memory, gangs);
    GangRunner(queue).run_each(OwnSum{at.view(), sums.view(), each}, gangs);
    CHECK((sums.get() == right));
}
