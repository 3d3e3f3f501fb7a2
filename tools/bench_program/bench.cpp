// Benchmarks of libweave: each case prints times and the peak memory of its process, in words or as JSON.

#include <weave/block/operations.hpp>
#include <weave/block/preset.hpp>
#include <weave/core/file.hpp>
#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

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

struct Case {
    const char* name;
    Json (*run)();
};
constexpr Case cases[] = {{"shoe", shoe}, {"shoe-edit", shoe_edit}, {"stencil-20000", stencil_20000}};

}  // namespace

int main(int count, char** words) {
    for (const Case& one : cases) {
        if (count == 2 && one.name == std::string(words[1])) {
            std::printf("%s\n", one.run().dump().c_str());
            return 0;
        }
    }
    if (count == 1) {
        for (const Case& one : cases) std::printf("%s\n", one.name);
        return 0;
    }
    std::fprintf(stderr, "usage: weave_bench [NAME]; without a name the cases are listed\n");
    return 2;
}
