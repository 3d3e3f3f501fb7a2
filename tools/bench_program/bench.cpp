// Benchmarks of libweave, loomlink and simd: each case prints what it measured.

#include "loomlink.hpp"
#include "settling.hpp"
#include "simd.hpp"

#include <weave/block/operations.hpp>
#include <weave/block/preset.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>
#include <weave/sim/simulate.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using namespace weave;

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double peak_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1024;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

/// The full-size shoe: from its file to the card image.
Json shoe() {
    const auto file = std::filesystem::temp_directory_path() / ("shoe-" + std::to_string(getpid()) + ".weave");
    if (!save_design(find_sample("shoe-adult")->make(), file)) return nullptr;
    std::vector<double> seconds;
    std::size_t picks = 0, ends = 0;
    const std::size_t bytes = std::filesystem::file_size(file);
    for (int k = 0; k < 5; ++k) {
        const double start = now_s();
        const Design design = load_design(file).value();
        const CardImage card = evaluate(design)->block->card_image();
        seconds.push_back(now_s() - start);
        picks = card.picks(), ends = card.ends();
    }
    std::filesystem::remove(file);
    return {{"picks", picks}, {"ends", ends}, {"file_bytes", bytes}, {"file_to_card_s", median(seconds)}, {"peak_MB", peak_mb()}};
}

/// A flip of one crossing of the whole shoe, and a flip inside one of its blocks: evaluated again, and the card made again.
Json shoe_edit() {
    Design design = find_sample("shoe-adult")->make();
    Evaluator evaluator;
    BlockPtr cloth = evaluator.evaluate(design)->block;
    std::vector<double> evaluations, cards;
    std::size_t pick = 0, end = 0;
    for (int k = 0; k < 21; ++k) {
        while (!flip(cloth->stack(cloth->row_of_pick(pick), cloth->column_of_end(end)), pick - cloth->first_pick(cloth->row_of_pick(pick)),
                     end - cloth->first_end(cloth->column_of_end(end)))
                    .valid) {
            end = (end + 7) % cloth->ends(), pick = (pick + 13) % cloth->picks();
        }
        const Flip wish{pick, end, !cloth->weft_over(pick, end)};
        const double start = now_s();
        if (!apply_edit(design, PutFlip{design.root, wish})) return nullptr;
        cloth = evaluator.evaluate(design)->block;
        evaluations.push_back(now_s() - start);
        const CardImage card = cloth->card_image();
        cards.push_back(now_s() - start);
        end = (end + 101) % cloth->ends(), pick = (pick + 997) % cloth->picks();
    }
    return {{"edit_to_block_ms", median(evaluations) * 1e3}, {"edit_to_card_ms", median(cards) * 1e3}, {"peak_MB", peak_mb()}};
}

/// A stencil of 20,000 × 20,000 stacks of one pick and one end each: 400 million crossings.
Json stencil_20000() {
    const std::size_t size = 20000;
    std::vector<BlockPtr> blocks;
    for (const char* family : {"plain", "twill", "satin"}) blocks.push_back(std::make_shared<const Block>(make_preset({family, {}}).value()));
    const double start = now_s();
    StencilMap map{size, size, std::vector<std::uint16_t>(size * size)};
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t j = 0; j < size; ++j) map.blocks[i * size + j] = static_cast<std::uint16_t>((i / 640 + j / 900) % 3);
    }
    const double mapped = now_s();
    const Block block = stencil(blocks, map).value();
    const double stencilled = now_s();
    const std::string hash = block.card_image().sha256();
    return {{"crossings", size * size},          {"map_s", mapped - start}, {"stencil_s", stencilled - mapped},
            {"card_and_hash_s", now_s() - stencilled}, {"card_sha256", hash}, {"peak_MB", peak_mb()}};
}

/// A satin, its wefts `ratio` times as thick as its ends and laid that much farther apart.
Design satin_design(double ratio) {
    Design design;
    design.root = "satin";
    design.blocks["satin"] = std::make_shared<const Node>(Node{PresetLeaf{{"satin", {}}}, {}});
    const double warp_mm = design.warp.yarns[0].radius_mm, weft_mm = design.weft.yarns[0].radius_mm * ratio;
    design.scene.weft.radius_scale = ratio;
    design.scene.dx_mm = 2.8 * weft_mm;
    design.scene.dy_mm = 2.8 * warp_mm;
    return design;
}

struct PairCost {
    double seconds = 0;
    std::size_t pairs = 0, samples = 0;
    [[nodiscard]] double nanoseconds() const { return 1e9 * seconds / static_cast<double>(pairs); }
};

/// Energy and gradient of relaxed satin, one thread: time of one evaluation (median of 100), and how many pairs of contact
/// samples touch in it.
PairCost evaluation_cost(double ratio) {
    const Design design = satin_design(ratio);
    const Block cloth = tile(*evaluate(design)->block, 6, 6, 1).value();
    sim::SimulationRequest request;
    request.reduce = false;
    const sim::Plan plan = sim::make_plan(design, cloth, request).value();
    const sim::Executor executor(1);
    const sim::Fabric<double> fabric(plan.scene);
    sim::Energy<double> energy(fabric, executor);
    std::vector<double> state = fabric.state(), gradient;
    sim::RelaxOptions options;
    options.residual = 1e-2;
    sim::relax(energy, state, options);
    std::vector<double> seconds;
    for (int k = 0; k < 100; ++k) {
        const double start = now_s();
        energy.evaluate(state, gradient);
        seconds.push_back(now_s() - start);
    }
    PairCost cost{median(seconds), 0, fabric.samples()};
    const sim::FabricView<double> view = energy.view(state);
    for (std::uint32_t a = 0; a < fabric.samples(); ++a) {
        for (std::uint32_t e = view.first_neighbour[a]; e < view.first_neighbour[a + 1]; ++e) {
            const std::uint32_t b = view.neighbours[e];
            const double reach = view.samples.radius[a] + view.samples.radius[b];
            const Vec3 apart(view.samples.x[a] - view.samples.x[b], view.samples.y[a] - view.samples.y[b],
                             view.samples.z[a] - view.samples.z[b]);
            cost.pairs += apart.squaredNorm() < reach * reach ? 1 : 0;
        }
    }
    return cost;
}

/// What mixed radii cost: wefts as thick as ends, and three times as thick.
Json mixed_radii() {
    const PairCost equal = evaluation_cost(1), mixed = evaluation_cost(3);
    return {{"equal_ns_a_pair", equal.nanoseconds()}, {"mixed_ns_a_pair", mixed.nanoseconds()},
            {"ratio", mixed.nanoseconds() / equal.nanoseconds()},
            {"equal_pairs", equal.pairs}, {"mixed_pairs", mixed.pairs}, {"equal_samples", equal.samples}, {"mixed_samples", mixed.samples}};
}

/// Plans and simulates a cloth on one thread; seconds, median of 7, null where it does not come to rest.
Json simulation_s(const Design& design, const Block& cloth) {
    std::vector<double> seconds;
    for (int k = 0; k < 7; ++k) {
        const double start = now_s();
        sim::SimulationOptions options;
        options.threads = 1;
        const sim::Plan plan = sim::make_plan(design, cloth, {}).value();
        if (!sim::simulate(design, plan, options).report.at("converged").get<bool>()) return nullptr;
        seconds.push_back(now_s() - start);
    }
    return median(seconds);
}

/// A sample tiled 4 × 4 against its single repeat: planning, relaxing and copying back.
Json tiled() {
    Json answer;
    for (const char* name : {"satin-e", "twill-g"}) {
        const Design design = find_sample(name)->make();
        const Block cell = *evaluate(design)->block, cloth = tile(cell, 4, 4, 1).value();
        const Json one = simulation_s(design, cell), all = simulation_s(design, cloth);
        answer[name] = {{"cell_s", one}, {"tiled_s", all}};
        if (!one.is_null() && !all.is_null()) answer[name]["ratio"] = all.get<double>() / one.get<double>();
    }
    return answer;
}

/// A crossing that may flip, near the middle of a cloth.
Flip some_flip(const Block& cloth) {
    Flip wish{cloth.picks() / 2, cloth.ends() / 2, false};
    while (!flip(stack_at(cloth, wish.pick, wish.end), wish.pick, wish.end)) ++wish.pick;
    wish.weft_over = !cloth.weft_over(wish.pick, wish.end);
    return wish;
}

/// One flip in relaxed cloth, one thread: leading the two yarns past one another and coming to rest again, against relaxing
/// the flipped cloth from its planned curves.
Json flip_settles() {
    Json answer = Json::array();
    for (const std::uint32_t repeats : {1, 3}) {
        Design design = find_sample("satin-e")->make();
        design.blocks["cloth"] = std::make_shared<const Node>(Node{TileOperation{design.root, repeats, repeats, 1}, {}});
        design.root = "cloth";
        const Flip wish = some_flip(*evaluate(design)->block);
        sim::SimulationRequest request;
        request.reduce = false;
        sim::SimulationOptions options;
        options.threads = 1;
        options.flips = {wish};
        const Json flipped = sim::simulate(design, sim::make_plan(design, *evaluate(design)->block, request).value(), options).report;
        if (!apply_edit(design, PutFlip{design.root, wish})) return nullptr;
        options.flips.clear();
        const Json over = sim::simulate(design, sim::make_plan(design, *evaluate(design)->block, request).value(), options).report;
        const Json& flip = flipped.at("flips").at(0);
        const double settled = flip.at("flip_seconds").get<double>() + flip.at("settle_seconds").get<double>(),
                     started_over = over.at("seconds").get<double>();
        answer.push_back({{"points", over.at("points")}, {"done", flip.at("done")}, {"flip_s", flip.at("flip_seconds")},
                          {"settle_s", flip.at("settle_seconds")}, {"start_over_s", started_over}, {"ratio", started_over / settled}});
    }
    return answer;
}

struct Case {
    const char* name;
    const char* about;
    Json (*run)();
};
constexpr Case cases[] = {{"shoe", "The full-size shoe from its file to the card image", shoe},
                          {"shoe-edit", "One crossing of it flipped, and evaluated again", shoe_edit},
                          {"stencil-20000", "A stencil of 20,000 x 20,000 stacks", stencil_20000},
                          {"mixed-radii", "One evaluation of satin with wefts three times as thick", mixed_radii},
                          {"tiled", "Tiled cloth, reduced, against its repeat", tiled},
                          {"flip", "One flip in relaxed cloth against starting over", flip_settles},
                          {"settling", "Points that need no step any more", bench::settling},
                          {"loomlink-load", "Pulls and saves of many people at once", bench::loomlink_load},
                          {"loomlink-growth", "Bytes that the store grows by with a save", bench::loomlink_growth}};

void add_cases(CLI::App& app, CommandOutcome& outcome) {
    for (const Case& one : cases) {
        CLI::App* const command = add_command(app, outcome, one.name, one.about);
        on_run(command, outcome, [&one, &outcome]() -> Status {
            const Json answer = one.run();
            outcome.answer(answer, answer.dump() + "\n");
            return {};
        });
    }
    bench::add_simd_latency(app, outcome);
    bench::add_simd_sessions(app, outcome);
    bench::add_simd_frames(app, outcome);
    bench::add_simd_recovery(app, outcome);
}

}  // namespace

int main(int count, char** words) {
    CLI::App app("Benchmarks; without a name they are listed");
    CommandOutcome outcome("weave_bench", JsonLayout::on_one_line);
    prepare_program(app, "weave_bench " WEAVE_VERSION);
    add_cases(app, outcome);
    if (count > 1) return run_program(app, outcome, count, words);
    for (const CLI::App* command : app.get_subcommands({})) std::printf("%s\n", command->get_name().c_str());
    return 0;
}
