#include "cases.hpp"
#include "stopwatch.cuh"

#include <weave/sim/device/launches.cuh>

#include <cstddef>
#include <cstdint>

namespace weave::gpu_bench {

namespace {

struct alignas(16) Sixteen {
    std::uint32_t bytes[4];
};
struct CopySixteen {
    sim::View<const Sixteen> from;
    sim::View<Sixteen> to;
    WEAVE_HD void operator()(std::size_t i) const { to[i] = from[i]; }
};
struct FillSixteen {
    sim::View<Sixteen> to;
    WEAVE_HD void operator()(std::size_t i) const {
        for (std::uint32_t k = 0; k < 4; ++k) to[i].bytes[k] = static_cast<std::uint32_t>(i) * 2654435761U + k;
    }
};
struct FillOne {
    sim::View<double> to;
    WEAVE_HD void operator()(std::size_t i) const { to[i] = static_cast<double>(i); }
};
struct OneNumber {
    sim::View<const double> numbers;
    WEAVE_HD double operator()(std::size_t i) const { return numbers[i]; }
};
/// Blocks that wait for one another so many times, or sum so many times.
struct WaitTurns {
    sim::View<double> out;
    std::size_t turns;
    bool sums;
    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        double sum = 0;
        for (std::size_t turn = 0; turn < turns; ++turn) {
            if (sums) sum += crew.sum(1, OneNumber{out});
            else crew.each(0, FillOne{out});
        }
        if (sum > 0) crew.each(1, FillOne{out});  // so that nobody leaves the sums out
    }
};
struct WaitTurnsAlone {
    WaitTurns turns;
    template <class Crew>
    WEAVE_HD void operator()(Crew& crew, std::size_t) const {
        turns(crew);
    }
};

double gb_per_s(std::size_t bytes, double ms) {
    return static_cast<double>(bytes) / ms / 1e6;
}

}  // namespace

std::vector<Figure> measure_copy() {
    constexpr std::size_t bytes = std::size_t{1} << 29, count = bytes / sizeof(Sixteen);
    sim::DeviceQueue queue;
    sim::CudaMemory memory(queue);
    sim::Launches launches(queue);
    sim::Array<Sixteen> from(memory, count), to(memory, count);
    launches.each(count, FillSixteen{from.view()});
    const Stopwatch watch(queue);
    const double by_body = watch.median_ms(20, [&] { launches.each(count, CopySixteen{from.view(), to.view()}); });
    const double by_driver = watch.median_ms(20, [&] {
        WEAVE_CUDA_CHECK(cudaMemcpyAsync(to.view().at(0, count), from.view().at(0, count), bytes, cudaMemcpyDeviceToDevice, queue.stream()));
    });
    const std::string how = "512 MiB read and as much written, both counted; median of 20";
    return {{"copy by a body, 16 bytes a thread", gb_per_s(2 * bytes, by_body), "GB/s", how},
            {"copy by the driver", gb_per_s(2 * bytes, by_driver), "GB/s", how}};
}

std::vector<Figure> measure_launches() {
    constexpr int launched = 1000;
    sim::DeviceQueue queue;
    sim::CudaMemory memory(queue);
    sim::Launches launches(queue);
    sim::Array<double> numbers(memory, 1);
    const Stopwatch watch(queue);
    const double each = watch.median_ms(9, [&] {
        for (int k = 0; k < launched; ++k) launches.each(1, FillOne{numbers.view()});
    });
    const double sum = watch.median_ms(9, [&] {
        for (int k = 0; k < launched; ++k) static_cast<void>(launches.sum(1, OneNumber{numbers.view()}));
    });
    const double read = watch.median_ms(9, [&] {
        for (int k = 0; k < launched; ++k) static_cast<void>(launches.read(sim::View<const double>(numbers.view()), 0));
    });
    const std::string how = "one after the other, a thousand in a row; median of 9 rows";
    return {{"a launch", 1000 * each / launched, "µs", how},
            {"a sum that the processor waits for", 1000 * sum / launched, "µs", how},
            {"a number that the processor reads", 1000 * read / launched, "µs", how}};
}

std::vector<Figure> measure_barriers() {
    constexpr std::size_t turns = 2000;
    sim::DeviceQueue queue;
    sim::CudaMemory memory(queue);
    sim::GangRunner runner(queue);
    sim::Array<double> out(memory, 1);
    const Stopwatch watch(queue);
    std::vector<Figure> figures;
    for (const bool sums : {false, true}) {
        const WaitTurns kernel{out.view(), turns, sums};
        const std::string what = sums ? "a sum of one number within a gang, " : "a barrier, ";
        const double alone = watch.median_ms(9, [&] { runner.run_each(WaitTurnsAlone{kernel}, 1); });
        figures.push_back({what + "one block", 1000 * alone / turns, "µs", "256 threads, 2000 in a row; median of 9 rows"});
        for (const std::size_t blocks : {std::size_t{2}, std::size_t{16}, queue.multiprocessors(), runner.most_blocks(kernel)}) {
            const double all = watch.median_ms(9, [&] { runner.start(kernel, blocks); });
            const std::string name = what + std::to_string(blocks) + " blocks";
            figures.push_back({name, 1000 * all / turns, "µs", "256 threads each, 2000 in a row; median of 9 rows"});
        }
    }
    return figures;
}

}  // namespace weave::gpu_bench
