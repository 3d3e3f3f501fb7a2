#include "bench_measure.hpp"

#include "interrupt.hpp"

#include <weave/block/operations.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/deviation.hpp>
#include <weave/sim/order.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <limits>
#include <malloc.h>
#include <thread>

namespace weave::program {

namespace {

/// What stands after a name in a file of the system such as `VmHWM:  123 kB`.
std::string line_after(const char* file, const std::string& name) {
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind(name, 0) != 0) continue;
        const std::size_t at = line.find_first_not_of(" \t:", name.size());
        return at == std::string::npos ? "" : line.substr(at);
    }
    return "";
}

/// Keeps the states of a run at the residuals that are told, and ends it after its time.
class Looker {
  public:
    Looker(sim::Energy<double>& energy, const std::vector<double>& state, const RunLimits& limits,
           Measured& measured)
        : m_energy(energy), m_state(state), m_limits(limits), m_measured(measured) {}

    bool operator()(const sim::Progress& progress) {
        // Of the last residual there is no later step to find it by.
        if (progress.iteration >= m_next || progress.residual <= told_residuals.back()) look(progress);
        return !interrupted() && seconds() < m_limits.seconds;
    }

    /// So long without looking.
    [[nodiscard]] double seconds() const { return seconds_now(m_limits.threads) - m_began - m_away; }

  private:
    /// A residual by an older reference force is taken as a hint; what counts is that of this very state.
    void look(const sim::Progress& progress) {
        std::vector<Snapshot>& snapshots = m_measured.snapshots;
        if (snapshots.size() == told_residuals.size() || progress.residual > told_residuals[snapshots.size()])
            return;
        const double at = seconds();
        m_energy.evaluate(m_state, m_gradient);
        const double force = sim::greatest_force(m_energy.executor(), m_gradient);
        const double reference = sim::reference_force(m_energy, m_state),
                     residual = reference > 0 ? force / reference : 0;
        while (snapshots.size() < told_residuals.size() && residual <= told_residuals[snapshots.size()])
            snapshots.push_back({told_residuals[snapshots.size()], residual, at, progress.energy,
                                 progress.iteration, m_energy.fabric().control(m_state)});
        m_next = progress.iteration + 1 + progress.iteration / 50;
        m_away += seconds() - at;
    }

    sim::Energy<double>& m_energy;
    const std::vector<double>& m_state;
    RunLimits m_limits;
    Measured& m_measured;
    std::vector<double> m_gradient;
    std::size_t m_next = 0;
    double m_began = seconds_now(m_limits.threads), m_away = 0;
};

constexpr const char* pinned_plain = "plain-pinned";

/// Plain weave of 8×8 yarns held at their ends, the outermost all along, 7.5 radii apart, laid 7.5 % too
/// shallow: the scene on which other simulators were measured.
Structure make_pinned_plain() {
    Structure structure;
    structure.name = pinned_plain;
    structure.design = find_sample("plain")->make();
    const double warp = structure.design.warp.yarns[0].radius_mm,
                 weft = structure.design.weft.yarns[0].radius_mm;
    Scene& scene = structure.design.scene;
    scene.boundary_x = scene.boundary_y = Boundary::frozen;
    scene.dx_mm = scene.dy_mm = 7.5 * (warp + weft) / 2;
    scene.dz_mm = 0.925 * (warp + weft);
    // The others end on the outermost, which must not slip off them.
    for (const bool is_pick : {true, false}) {
        scene.pins.push_back({is_pick, 0});
        scene.pins.push_back({is_pick, 7});
    }
    structure.tiles = {4, 4};
    return structure;
}

}  // namespace

Json machine_json(std::size_t threads) {
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    const std::string memory = line_after("/proc/meminfo", "MemTotal");
    const double gib = memory.empty() ? 0 : std::stod(memory) / (1 << 20);
    return {{"processor", line_after("/proc/cpuinfo", "model name")},
            {"cores", cores},
            {"threads", threads == 0 ? cores : threads},
            {"memory_GiB", std::round(gib)}};
}

std::string machine_line(const Json& machine) {
    return "Machine: " + machine.at("processor").get<std::string>() + ", " +
           std::to_string(machine.at("cores").get<std::size_t>()) + " cores, " +
           std::to_string(machine.at("threads").get<std::size_t>()) + " threads, " +
           in_words("%.0f", machine.at("memory_GiB")) + " GiB";
}

double seconds_now(std::size_t threads) {
    timespec now{};
    ::clock_gettime(threads == 1 ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::uint64_t peak_memory() {
    const std::string peak = line_after("/proc/self/status", "VmHWM");
    return peak.empty() ? 0 : std::stoull(peak) * 1024;
}

void reset_peak_memory() {
    ::malloc_trim(0);
    std::ofstream("/proc/self/clear_refs")
        << "5\n";  // where that is not allowed, the peak is that of the process
}

double length_of(const Spline& spline) {
    constexpr double places[]{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
    constexpr double weights[]{0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                               0.1739274225687269};
    double length = 0;
    for (std::size_t s = 0; s < spline.segments(); ++s) {
        for (std::size_t g = 0; g < 4; ++g)
            length += weights[g] * spline.tangent(static_cast<double>(s) + places[g]).norm();
    }
    return length;
}

std::size_t points_of(const sim::SimScene& scene) {
    std::size_t points = 0;
    for (const sim::SimYarn& yarn : scene.yarns) points += yarn.control.size();
    return points;
}

Shape shape_of(const sim::Plan& plan, const Control& control) {
    Shape shape;
    std::vector<Spline> of_curves(plan.curves.yarns.size());
    std::array<double, 2> sums{}, counts{};
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t y = 0; y < control.size(); ++y) {
        const sim::SimYarn& yarn = plan.scene.yarns[y];
        const Spline spline{control[y], yarn.is_periodic, yarn.shift};
        const std::size_t system = plan.curves.yarns[plan.curve_of[y]].system == System::warp ? 0 : 1;
        const double planned = yarn.is_periodic ? yarn.shift.norm() : yarn.rest_mm;
        sums[system] += 100 * (length_of(spline) / planned - 1);
        counts[system] += 1;
        for (std::size_t k = 0; k < 8 * spline.segments(); ++k) {
            const double z = spline.place(static_cast<double>(k) / 8).z();
            low = std::min(low, z - yarn.radius_mm);
            high = std::max(high, z + yarn.radius_mm);
        }
        of_curves[plan.curve_of[y]] = spline;
        shape.splines.push_back(spline);
    }
    for (const std::size_t system : {0, 1})
        shape.crimp_pc[system] = counts[system] > 0 ? sums[system] / counts[system] : 0;
    shape.thickness_mm = control.empty() ? 0 : high - low;
    shape.lost = sim::lost_crossings(plan.curves, of_curves).size();
    return shape;
}

Json error_json(const sim::Plan& plan, const Shape& shape, const Shape& right) {
    double radius = std::numeric_limits<double>::infinity();
    for (const sim::SimYarn& yarn : plan.scene.yarns) radius = std::min(radius, yarn.radius_mm);
    const bool drifts =
        plan.scene.is_periodic[0] && plan.scene.is_periodic[1] && plan.scene.fields.empty() &&
        std::ranges::all_of(plan.scene.yarns, [](const sim::SimYarn& yarn) { return yarn.frozen.empty(); });
    const sim::Deviation places = sim::deviation_of(shape.splines, right.splines, drifts);
    return {{"crimp_warp_pp", shape.crimp_pc[0] - right.crimp_pc[0]},
            {"crimp_weft_pp", shape.crimp_pc[1] - right.crimp_pc[1]},
            {"thickness_mm", shape.thickness_mm - right.thickness_mm},
            {"thickness_pc", 100 * (shape.thickness_mm / right.thickness_mm - 1)},
            {"place_rms_radii", places.rms_mm / radius},
            {"place_max_radii", places.max_mm / radius}};
}

std::optional<double> Measured::seconds_to(double residual) const {
    for (const Snapshot& snapshot : snapshots) {
        if (snapshot.wanted == residual) return snapshot.seconds;
    }
    return {};
}

Json Measured::json() const {
    Json seconds = Json::object(), steps = Json::object();
    for (const double residual : told_residuals) {
        char name[16];
        std::snprintf(name, sizeof name, "%.0e", residual);
        seconds[name] = steps[name] = nullptr;
        for (const Snapshot& snapshot : snapshots) {
            if (snapshot.wanted != residual) continue;
            seconds[name] = snapshot.seconds;
            steps[name] = snapshot.iterations;
        }
    }
    return {{"points", points},
            {"samples", samples},
            {"ending", std::string(sim::name_of(result.ending))},
            {"residual", result.residual},
            {"energy_N_mm", result.energy},
            {"steps", result.iterations},
            {"evaluations", result.evaluations},
            {"cg_steps", result.cg_iterations},
            {"seconds", result.seconds},
            {"cap_s", cap_seconds},
            {"seconds_to", seconds},
            {"steps_to", steps},
            {"peak_bytes", peak_bytes}};
}

Measured measure(const sim::Plan& plan, sim::Solver solver, const sim::PaperOptions& paper,
                 const RunLimits& limits, const Control* start) {
    reset_peak_memory();
    Measured measured;
    sim::SimScene scene = plan.scene;
    for (std::size_t y = 0; start != nullptr && y < scene.yarns.size(); ++y)
        scene.yarns[y].control = (*start)[y];
    const sim::Executor executor(limits.threads);
    const sim::Fabric<double> fabric(scene);
    sim::Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state();
    Looker looker(energy, state, limits, measured);
    sim::RelaxOptions options;
    options.residual = limits.residual;
    options.most_iterations = std::numeric_limits<std::size_t>::max();
    options.watch = [&](const sim::Progress& progress) { return looker(progress); };
    measured.result = solver == sim::Solver::paper ? sim::relax_in_time(energy, state, options, paper)
                                                   : sim::relax(energy, state, options);
    measured.result.seconds = looker.seconds();
    if (measured.result.ending == sim::Ending::stopped) measured.result.ending = sim::Ending::time;
    measured.control = fabric.control(state);
    measured.points = fabric.points();
    measured.samples = fabric.samples();
    measured.peak_bytes = peak_memory();
    measured.cap_seconds = limits.seconds;
    return measured;
}

Control refined(const sim::SimScene& scene, const Control& control, std::size_t times) {
    Control finer;
    for (std::size_t y = 0; y < control.size(); ++y) {
        const Spline spline{control[y], scene.yarns[y].is_periodic, scene.yarns[y].shift};
        finer.push_back(resample(spline, times * spline.segments() + (spline.is_periodic ? 0 : 1)).control);
    }
    return finer;
}

Control resampled_to(const sim::SimScene& scene, const sim::SimScene& from, const Control& control) {
    Control other;
    for (std::size_t y = 0; y < control.size(); ++y) {
        const Spline spline{control[y], from.yarns[y].is_periodic, from.yarns[y].shift};
        other.push_back(resample(spline, scene.yarns[y].control.size()).control);
        for (std::size_t i = 0; i < scene.yarns[y].frozen.size(); ++i) {
            if (scene.yarns[y].frozen[i] != 0) other.back()[i] = scene.yarns[y].control[i];
        }
    }
    return other;
}

std::vector<std::string> structure_names() {
    std::vector<std::string> names;
    for (const Sample& sample : samples()) names.push_back(sample.name);
    names.emplace_back(pinned_plain);
    return names;
}

bool is_whole_product(const std::string& name) {
    return name.rfind("shoe-", 0) == 0;
}

Result<Structure> make_structure(const std::string& name) {
    Structure structure;
    if (name == pinned_plain) {
        structure = make_pinned_plain();
    } else if (const Sample* sample = find_sample(name); sample != nullptr) {
        structure.name = name;
        structure.design = sample->make();
    } else {
        std::string names;
        for (const std::string& one : structure_names()) names += (names.empty() ? "" : ", ") + one;
        return Error{ErrorCode::usage, "there is no structure '" + name + "'; there are " + names, "--only"};
    }
    WEAVE_TRY(const Evaluation evaluation, evaluate(structure.design));
    structure.block = evaluation.block;
    if (structure.tiles[0] * structure.tiles[1] > 1) {
        WEAVE_TRY(Block tiled, tile(*structure.block, structure.tiles[0], structure.tiles[1], 1));
        structure.block = std::make_shared<const Block>(std::move(tiled));
    }
    return structure;
}

void tell(const std::string& line) {
    std::fprintf(stderr, "%s\n", line.c_str());
}

std::string in_words(const char* format, double number) {
    char text[64];
    std::snprintf(text, sizeof text, format, number);
    return text;
}

}  // namespace weave::program
