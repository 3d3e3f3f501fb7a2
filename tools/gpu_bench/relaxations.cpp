#include "cases.hpp"
#include "cloths.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <span>
#include <utility>

namespace weave::gpu_bench {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point began) {
    return std::chrono::duration<double, std::milli>(Clock::now() - began).count();
}

/// What relaxing took, with the memory that it asks for and the way there and back.
struct Taken {
    sim::RelaxResult result;
    double ms = 0;
};

sim::RelaxOptions to_standard(double most_seconds) {
    sim::RelaxOptions options;
    options.residual = 1e-3;
    options.most_iterations = 20'000;
    options.most_seconds = most_seconds;
    return options;
}

Taken there(sim::DeviceRelaxer& relaxer, Cloth& cloth, const sim::RelaxOptions& options) {
    std::vector<double> state = cloth.state;
    const Clock::time_point began = Clock::now();
    Taken taken;
    taken.result = relaxer.relax(cloth.energy, state, options);
    taken.ms = ms_since(began);
    return taken;
}

Taken here(Cloth& cloth, const sim::RelaxOptions& options) {
    std::vector<double> state = cloth.state;
    const Clock::time_point began = Clock::now();
    Taken taken;
    taken.result = sim::relax(cloth.energy, state, options);
    taken.ms = ms_since(began);
    return taken;
}

std::string how(const Taken& taken) {
    char residual[40];
    std::snprintf(residual, sizeof residual, "%.1e", taken.result.residual);
    return std::string(sim::name_of(taken.result.ending)) + " at " + residual + " after " + std::to_string(taken.result.iterations) + " steps";
}

/// Whoever was cut short has no time to be compared with.
bool are_at_rest(const std::vector<sim::RelaxResult>& results) {
    return std::ranges::all_of(results, [](const sim::RelaxResult& result) { return result.ending == sim::Ending::converged; });
}

std::string with_points(const std::string& name, const Cloth& cloth) {
    return name + ", " + std::to_string(cloth.fabric.points()) + " points";
}

}  // namespace

Figures measure_table1(sim::DeviceRelaxer& relaxer) {
    Figures figures;
    for (const char* name : {"satin-e", "twill-g", "layer-to-layer", "angle-interlock-a", "angle-interlock-b", "hexagon-tubes", "tl013-corrected", "pocket"}) {
        Cloth cloth(sample_scene(name, sim::Fidelity::standard));
        const sim::RelaxOptions options = to_standard(4);
        Taken best = there(relaxer, cloth, options);
        for (int k = 0; k < 2 && best.ms < 2000; ++k) {
            const Taken again = there(relaxer, cloth, options);
            if (again.ms < best.ms) best = again;
        }
        const Taken processor = here(cloth, options);
        figures.push_back({with_points(name, cloth), best.ms, "ms", how(best) + "; the least of up to 3"});
        figures.push_back({std::string("  the processor, ") + std::to_string(cloth.executor.threads()) + " threads", processor.ms, "ms", how(processor)});
        if (are_at_rest({best.result, processor.result}))
            figures.push_back({"  the processor's time by the device's", processor.ms / best.ms, "", "of the two above"});
    }
    return figures;
}

Figures measure_batch(sim::DeviceRelaxer& relaxer) {
    constexpr std::size_t cells = 64;
    std::vector<std::unique_ptr<Cloth>> cloths;
    std::vector<std::vector<double>> states;
    std::vector<sim::ClothToRelax> all;
    for (std::uint32_t k = 0; k < cells; ++k) {
        cloths.push_back(std::make_unique<Cloth>(sample_scene("satin-e", sim::Fidelity::standard, 1, k + 1), 1));
        states.push_back(cloths.back()->state);
    }
    for (std::size_t k = 0; k < cells; ++k) all.push_back({&cloths[k]->energy, &states[k], to_standard(10)});
    const Clock::time_point began = Clock::now();
    const std::vector<sim::RelaxResult> results = relaxer.relax_each(std::span<const sim::ClothToRelax>(all));
    const double at_once = ms_since(began);
    const auto at_rest = std::ranges::count_if(results, [](const sim::RelaxResult& result) { return result.ending == sim::Ending::converged; });
    const Taken one = there(relaxer, *cloths.front(), to_standard(10));
    const double a_cell = at_once / cells;
    const std::string name = std::to_string(cells) + " cells, " + with_points("Satin E", *cloths.front());
    Figures figures{{name + ", at once", a_cell, "ms", "a cell; " + std::to_string(at_rest) + " of them came to rest"}, {name + ", one alone", one.ms, "ms", how(one)}};
    if (are_at_rest(results) && are_at_rest({one.result})) figures.push_back({"  one alone by one of many", one.ms / a_cell, "", "of the two above"});
    return figures;
}

Figures measure_live(sim::DeviceRelaxer& relaxer) {
    Cloth cloth(sample_scene("satin-e", sim::Fidelity::standard, 3));  // 7,200 points; 4 tiles have 12,800
    Cloth larger(sample_scene("satin-e", sim::Fidelity::standard, 4));
    Figures figures;
    for (Cloth* one : {&cloth, &larger}) {
        sim::RelaxOptions options = to_standard(4);
        options.residual = 1e-9;  // it is watched, not waited for
        std::size_t pictures = 0;
        double longest = 0;
        Clock::time_point last = Clock::now();
        options.watch = [&](const sim::Progress&) {
            const double since = ms_since(last);
            last = Clock::now();
            if (pictures++ > 10) longest = std::max(longest, since);  // the first ones find out how many steps a picture has room for
            return true;
        };
        const Taken taken = there(relaxer, *one, options);
        figures.push_back({with_points("pictures a second", *one), 1e3 * static_cast<double>(pictures) / taken.ms, "1/s",
                           "each with the state in the processor's memory; " + std::to_string(taken.result.iterations) + " steps in " +
                               std::to_string(static_cast<int>(taken.ms)) + " ms"});
        figures.push_back({"  the longest wait for one", longest, "ms", "after the first ten"});
    }
    return figures;
}

Figures measure_large(sim::DeviceRelaxer& relaxer) {
    Cloth cloth(sample_scene("satin-e", sim::Fidelity::standard, 36));
    const std::size_t points = cloth.fabric.points();
    const Taken taken = there(relaxer, cloth, to_standard(60));
    const double steps = static_cast<double>(std::max<std::size_t>(1, taken.result.iterations)) * static_cast<double>(points);
    return {{with_points("Satin E tiled", cloth), taken.ms / 1000, "s", how(taken)},
            {"  a step of a point", 1e6 * taken.ms / steps, "ns", "of the above"},
            {"  memory foreseen", static_cast<double>(sim::device_bytes(cloth.fabric)) / 1e6, "MB", ""}};
}

}  // namespace weave::gpu_bench
